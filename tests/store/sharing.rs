//! A store that several engines use at the same time, and runs that find nothing to do.

use super::*;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use yosegi::engine::store_status;
use yosegi::world::{Disk, Listed, Memory, PendingFile};

fn boards() -> Vec<String> {
    let board =
        |number: usize| BOARD.replace("thickening: 3,", &format!("thickening: 3.{number},"));
    (0..3).map(board).collect()
}

/// Two and eight engines on disk, each as a process of its own would have it, at the same keys; the eight with
/// a limit that makes them evict what the others have just written.
#[test]
fn engines_at_the_same_time_give_right_maps_and_leave_whole_entries() {
    let boards = boards();
    let plain = workshop(Options {
        store: None,
        ..options()
    });
    let right: Vec<_> = boards
        .iter()
        .map(|board| {
            plain.run(board);
            MAPS.map(|name| plain.map(name))
        })
        .collect();
    for (engines, limit) in [(2, 1 << 30), (8, 1 << 30), (8, 20 * 4096)] {
        let folder = tempfile::tempdir().unwrap();
        let options = Options {
            store: Some(folder.path().join("store")),
            store_limit: limit,
            ..options()
        };
        std::thread::scope(|scope| {
            for engine in 0..engines {
                let (boards, right, options) = (&boards, &right, &options);
                let out = folder.path().join(format!("{engine}"));
                scope.spawn(move || {
                    for round in 0..6 {
                        let mut own =
                            workshop(options.clone()).another_on(Arc::new(Disk), options.clone());
                        own.folder = out.clone();
                        let number = (engine + round) % boards.len();
                        let log = own.run(&boards[number]);
                        assert!(!log.contains("store failed"), "{log}");
                        let maps =
                            MAPS.map(|name| std::fs::read(out.join("out").join(name)).unwrap());
                        assert!(maps == right[number], "{engine} {round}");
                    }
                });
            }
        });
        let bytes = whole_and_nothing_else(&folder.path().join("store"));
        assert!(bytes <= 2 * limit, "{bytes}");
    }
}

/// Every file in the store is an entry that is what its name says; gives the whole blocks they take.
fn whole_and_nothing_else(store: &Path) -> u64 {
    let mut pending = vec![store.to_owned()];
    let (mut files, mut taken) = (0, 0);
    while let Some(folder) = pending.pop() {
        for entry in Disk.list(&folder).unwrap() {
            if entry.bytes.is_none() {
                pending.push(entry.path);
                continue;
            }
            let bytes = std::fs::read(&entry.path).unwrap();
            assert_eq!(sealed(&entry.path, &payload(&bytes)), bytes);
            files += 1;
            taken += bytes.len().div_ceil(4096) as u64 * 4096;
        }
    }
    let families = store_status(&Disk, store).unwrap();
    assert_eq!(families.iter().map(|it| it.entries).sum::<usize>(), files);
    taken
}

/// Counts what is made, removed or touched.
struct Counting {
    files: Memory,
    writes: Arc<AtomicUsize>,
}

impl World for Counting {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.writes.fetch_add(1, Ordering::Relaxed);
        self.files.create(path)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.files.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.writes.fetch_add(1, Ordering::Relaxed);
        self.files.remove(path)
    }
}

#[test]
fn a_run_that_finds_nothing_to_do_writes_nothing() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let writes = Arc::new(AtomicUsize::new(0));
    let world = Counting {
        files: workshop.files.clone(),
        writes: Arc::clone(&writes),
    };
    let again = workshop.another_on(Arc::new(world), options());
    for _ in 0..2 {
        assert_eq!(
            again.run(BOARD),
            "up to date board_base_color.png\nup to date board_height.png"
        );
        assert_eq!(writes.load(Ordering::Relaxed), 0);
    }
    // Painted over behind its key, a map is put back, and that is all that is written.
    let mut painted_over = workshop.map(MAPS[0]);
    let middle = painted_over.len() / 2;
    painted_over[middle] ^= 1;
    workshop
        .files
        .insert(place(&workshop, MAPS[0]), painted_over);
    assert!(again.run(BOARD).contains("restored board_base_color.png"));
    assert_eq!(writes.load(Ordering::Relaxed), 1);
    assert_eq!(MAPS.map(|name| workshop.map(name)), right_maps());
}
