//! A recipe that is read for a run which is cancelled.

use super::*;
use yosegi::graph::{Settings, load_until};
use yosegi::world::Memory;

/// Files that cancel when one of them is read.
struct Cancelling {
    files: Memory,
    at: &'static str,
    cancel: Cancel,
}

impl World for Cancelling {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        if path.ends_with(self.at) {
            self.cancel.cancel();
        }
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> std::io::Result<Box<dyn yosegi::world::PendingFile>> {
        self.files.create(path)
    }
}

#[test]
fn reading_ends_without_a_graph_and_without_mistakes() {
    let files = Memory::default();
    files.insert(
        "recipes/board.ron",
        "(nodes: { \"one\": pale(), \"two\": nonsense(), })",
    );
    files.insert(
        "recipes/nodes/pale.ron",
        "(inputs: {}, nodes: {}, outputs: {})",
    );
    for (at, is_cancelled) in [
        ("board.ron", true),
        ("pale.ron", true),
        ("other.ron", false),
    ] {
        let cancel = Cancel::new();
        let world = Cancelling {
            files: files.clone(),
            at,
            cancel: cancel.clone(),
        };
        let path = Path::new("recipes/board.ron");
        let loaded = load_until(&world, path, &Settings::default(), &cancel);
        assert_eq!(loaded.is_none(), is_cancelled, "{at}");
        if let Some(loaded) = loaded {
            assert!(loaded.unwrap_err().len() > 1);
        }
    }
}
