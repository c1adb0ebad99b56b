//! A long session: one process that loads and renders a recipe again after every save, for thousands of
//! saves. What it takes of memory and files must not grow.
//!
//! ```sh
//! cargo test --release --test session -- --ignored --nocapture
//! ```
//!
//! `YOSEGI_SAVES` is the number of saves, `YOSEGI_EDITS` a letter for each kind of edit that is made, all if it
//! is not set. A line of figures comes every 2,500 saves.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::Duration;
use yosegi::engine::{Cancel, Engine, Options, Render, RunError};
use yosegi::graph::{Settings, load};
use yosegi::world::{Disk, World};

/// Saves after which memory is looked at first.
const WARM: usize = 500;

/// The letters of edits, in the order in which they are made.
const EDITS: &str = "cmskrxyudnqa";

/// A session in a folder of its own.
struct Session {
    folder: tempfile::TempDir,
    engine: Engine,
}

/// A recipe and the compound that it uses.
struct Files {
    recipe: String,
    compound: String,
}

impl Files {
    /// What an author has written at save `number`; every one is new.
    fn at(number: usize, edit: char) -> Files {
        let shade = number % 0x00ff_ffff;
        let small = number as f64 * 1e-6;
        let pick = |wanted: char, edited: String, plain: &str| match edit == wanted {
            true => edited,
            false => plain.to_owned(),
        };
        let colour = pick('c', format!("#{shade:06x}"), "#c8a06e");
        let middle = pick('m', format!("{}", 2.0 + small), "2");
        let trunk = pick('s', format!("{}", 10.0 + small), "10");
        let comment = pick('k', format!("// {number}"), "");
        let name = pick('r', format!("node_{number}"), "knots");
        let kind = pick('x', format!("unheard_of_{number}"), "material");
        let closed = pick('y', format!(" [{number} "), "");
        let link = pick('u', format!("nobody_{number}"), "look.colour");
        let default = pick('d', format!("{}", 0.5 + small), "0.5");
        let input = pick('n', format!("amount_{number}"), "amount");
        let inside = pick('q', format!("{}", 0.25 + small), "0.25");
        let about = pick('a', format!("share {number}"), "share");
        let recipe = format!(
            "{comment}
(nodes: {{
    \"tree\": skeleton(trunk: [(0, 0, 0), ({trunk}, 4, 600), (0, 0, 1200)]),
    \"time\": growth_field(skeleton: \"tree\", elongation: 300, thickening: {middle}),
    \"year\": colour_pattern(stops: [(at: 0, colour: \"#e8c99b\"), (at: 1, colour: \"#9a6438\")]),
    \"look\": pattern_lookup(time: \"time\", pattern: \"year\"),
    \"{name}\": mix(a: \"{link}\", b: \"{colour}\", amount: 0.2),
    \"stained\": stain(of: \"{name}\"),
    \"wood\": {kind}(base_color: \"stained\"){closed},
    \"plank\": slice_cut(of: \"wood\", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
}}, outputs: {{ \"board\": maps(of: \"plank\", pixels: (256, 256), channels: [base_color]) }})"
        );
        let compound = format!(
            "(about: \"{about}\", source: \"own construction\",
    inputs: {{
        \"of\": colour(per_point: true, about: \"what is stained\"),
        \"{input}\": number(default: {default}, range: (0, 1), about: \"how much, {about}\"),
    }},
    nodes: {{
        \"dark\": mix(a: \"$of\", b: \"#402010\", amount: {inside}),
        \"stained\": mix(a: \"$of\", b: \"dark\", amount: \"${input}\"),
    }},
    outputs: {{ \"colour\": \"stained.colour\" }})"
        );
        Files { recipe, compound }
    }
}

impl Session {
    fn new() -> Session {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("nodes")).unwrap();
        let options = Options {
            threads: Some(2),
            memory: 64 << 20,
            store: Some(folder.path().join("store")),
            ..Options::default()
        };
        let engine = Engine::new(Arc::new(Disk), options).unwrap();
        Session { folder, engine }
    }

    fn place(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Saves and renders; every seventh run is cancelled at some moment. Gives whether there is a new map.
    fn save(&self, number: usize, edit: char) -> bool {
        let Files { recipe, compound } = Files::at(number, edit);
        let path = self.place("board.ron");
        fs::write(&path, recipe).unwrap();
        fs::write(self.place("nodes/stain.ron"), compound).unwrap();
        let Ok(loaded) = load(&Disk, &path, &Settings::default()) else {
            assert!("xyu".contains(edit), "edit {edit} at save {number}");
            return false;
        };
        let cancel = Cancel::new();
        let request = Render {
            graph: &loaded.graph,
            folder: self.place("out"),
            only: vec![],
            pixels: None,
            listener: &|_| {},
            cancel: cancel.clone(),
        };
        let result = thread::scope(|scope| {
            if number % 7 == 3 {
                let moment = Duration::from_micros(number as u64 * 37 % 4000);
                scope.spawn(move || {
                    thread::sleep(moment);
                    cancel.cancel();
                });
            }
            self.engine.render(&request)
        });
        match result {
            Ok(maps) => assert_eq!(maps.len(), 1),
            Err(RunError::Cancelled) => return false,
            Err(error) => panic!("edit {edit} at save {number}: {error:?}"),
        }
        true
    }
}

/// KiB that the process holds in memory, if the system tells.
fn resident() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse().ok()
}

fn handles() -> usize {
    fs::read_dir("/proc/self/fd").map_or(0, Iterator::count)
}

/// Saves and renders; gives by how much the memory has grown since it was warm, and new maps.
fn drive(saves: usize, edits: &str) -> (f64, usize) {
    let session = Session::new();
    let edits: Vec<char> = edits.chars().collect();
    let (mut warm, mut rendered) = ((0.0, 0), 0);
    for number in 1..=saves {
        rendered += usize::from(session.save(number, edits[number % edits.len()]));
        if number % 1000 == 0 {
            // The store has its own limit, which is not what is measured.
            let _ = fs::remove_dir_all(session.place("store"));
        }
        if number == WARM.min(saves / 2) {
            warm = (resident().unwrap_or(0.0), handles());
        }
        if number % 2500 == 0 || number == WARM {
            let remembered = session.engine.remembered_bytes() >> 20;
            let resident = resident().unwrap_or(0.0) / 1024.0;
            println!(
                "{number:6} saves, {rendered:6} maps: {resident:7.2} MiB resident, {remembered} MiB remembered, {} handles",
                handles()
            );
        }
    }
    assert_eq!(handles(), warm.1);
    assert!(Disk.list(&session.place("out")).unwrap().len() == 1);
    let grown = resident().map_or(1.0, |now| now / warm.0);
    (grown, rendered)
}

#[test]
fn a_short_session_renders_what_can_be_rendered_and_closes_its_files() {
    let (_, rendered) = drive(48, EDITS);
    // Three of twelve edits are mistakes, and of seven runs one may be cancelled.
    assert!((24..=36).contains(&rendered), "{rendered}");
}

#[test]
#[ignore = "takes minutes"]
fn thousands_of_saves_take_no_more_memory_than_hundreds() {
    let saves = std::env::var("YOSEGI_SAVES").map_or(20_000, |text| text.parse().unwrap());
    let edits = std::env::var("YOSEGI_EDITS").unwrap_or_else(|_| EDITS.to_owned());
    let (grown, rendered) = drive(saves, &edits);
    println!(
        "{saves} saves, {rendered} maps: memory has grown by {:.1} % since save {WARM}",
        100.0 * (grown - 1.0)
    );
    assert!(grown < 1.05, "{grown}");
}
