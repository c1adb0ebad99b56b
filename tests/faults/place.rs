//! Recipes to render on failing disks, and what the disk holds before.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;
use yosegi::engine::{Cancel, Engine, Event, Listener, Options, Render, RunError};
use yosegi::graph::{Settings, load};
use yosegi::world::{Disk, World};

/// A recipe, and a change to it.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    recipe: &'static str,
    /// A piece of the recipe, and what it was before.
    change: [&'static str; 2],
    /// Files beside the recipe, and where they come from.
    beside: &'static [[&'static str; 2]],
    pub(crate) maps: &'static [&'static str],
}

/// One output with two maps.
const PLAIN: Case = Case {
    name: "plain",
    recipe: r##"(
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look", height: "= 0.05 * look.position"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: { "board": maps(of: "plank", pixels: (24, 20), channels: [base_color, normal]) },
)"##,
    change: ["thickening: 3", "thickening: 4"],
    beside: &[],
    maps: &["board_base_color.png", "board_normal.png"],
};

/// A compound, a table, a picture, and outputs of every type of file.
const MIXED: Case = Case {
    name: "mixed",
    recipe: r##"(
    nodes: {
        "log": skeleton_from_file(pith: "pith.json", every: 20),
        "cherry": cherry(tree: "log", ring_width: 3),
        "time": growth_field(skeleton: "log", elongation: 900, thickening: 2.4),
        "bar": sample_pattern(file: "bar.png", spans: bar, rings: 47),
        "look": pattern_lookup(time: "time", pattern: "bar"),
        "wood": material(base_color: "look", roughness: 0.4),
        "left": slice_cut(of: "cherry.wood", cut: plain_sawn, origin: (182, 170, 1000), size: (120, 100)),
        "right": slice_cut(of: "wood", cut: quarter_sawn, origin: (182, 170, 1000), size: (120, 100)),
    },
    outputs: {
        "first": maps(of: "left", pixels: (24, 20), channels: [base_color, normal]),
        "second": maps(of: "right", pixels: (24, 20), channels: [base_color], format: exr_half),
        "third": maps(of: "right", pixels: (12, 10), channels: [roughness], format: tiff16),
        "fourth": maps(of: "left", pixels: (12, 10), channels: [base_color], format: bmp),
    },
)"##,
    change: ["ring_width: 3", "ring_width: 4"],
    beside: &[
        ["nodes/cherry.ron", "graphs/nodes/cherry.ron"],
        ["pith.json", "assets/spruce_log/Gran_1_pith.json"],
        ["bar.png", "assets/spruce_bar/spruce_bar.png"],
    ],
    maps: &[
        "first_base_color.png",
        "first_normal.png",
        "second_base_color.exr",
        "third_roughness.tif",
        "fourth_base_color.bmp",
    ],
};

pub(crate) const CASES: [Case; 2] = [PLAIN, MIXED];

impl Case {
    fn old_recipe(&self) -> String {
        let [new, old] = self.change;
        assert_eq!(self.recipe.matches(new).count(), 1, "{new}");
        self.recipe.replace(new, old)
    }
}

/// What the disk holds before the run that fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    /// The maps of the recipe before its change, and no store.
    Cold,
    /// The same, and a store that has all.
    Warm,
    /// The right maps, and a store that knows it.
    UpToDate,
}

pub(crate) const STATES: [State; 3] = [State::Cold, State::Warm, State::UpToDate];

/// A folder with a recipe, its files, its maps and its store.
pub(crate) struct Place {
    home: TempDir,
    pub(crate) case: Case,
    pub(crate) state: State,
    old: BTreeMap<String, Vec<u8>>,
    new: BTreeMap<String, Vec<u8>>,
}

impl Place {
    pub(crate) fn new(case: Case, state: State) -> Place {
        let shared = Path::new("/dev/shm");
        let home = if shared.is_dir() {
            tempfile::tempdir_in(shared)
        } else {
            tempfile::tempdir()
        };
        let mut place = Place {
            home: home.unwrap(),
            case,
            state,
            old: BTreeMap::new(),
            new: BTreeMap::new(),
        };
        place.fill();
        place
    }

    /// Makes the recipe, the files it reads, and what the state says.
    fn fill(&mut self) {
        for [to, from] in self.case.beside {
            let to = self.path(to);
            fs::create_dir_all(to.parent().unwrap()).unwrap();
            let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(from);
            fs::copy(from, to).unwrap();
        }
        let disk: Arc<dyn World> = Arc::new(Disk);
        fs::create_dir_all(self.work()).unwrap();
        fs::write(self.path("recipe.ron"), self.case.recipe).unwrap();
        assert_eq!(self.render(&disk, "store").end, End::Done);
        self.new = self.maps();
        if self.state != State::UpToDate {
            fs::write(self.path("recipe.ron"), self.case.old_recipe()).unwrap();
            assert_eq!(self.render(&disk, "other").end, End::Done);
            fs::write(self.path("recipe.ron"), self.case.recipe).unwrap();
            fs::remove_dir_all(self.path("other")).unwrap();
        }
        self.old = self.maps();
        if self.state == State::Cold {
            fs::remove_dir_all(self.path("store")).unwrap();
        }
        for name in self.case.maps {
            assert!(self.new.contains_key(*name), "{name}");
        }
        assert_eq!(self.old.len(), self.case.maps.len());
        copy(&self.work(), &self.home.path().join("template"));
    }

    /// The folder that holds that of the recipe, and `template`, which is what that was before a run.
    pub(crate) fn home(&self) -> &Path {
        self.home.path()
    }

    /// The folder of the recipe.
    pub(crate) fn work(&self) -> PathBuf {
        self.home.path().join("work")
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.work().join(name)
    }

    /// Puts everything back to what it was before the run.
    pub(crate) fn reset(&self) {
        fs::remove_dir_all(self.work()).unwrap();
        copy(&self.home.path().join("template"), &self.work());
    }

    /// What lies in the output folder, but for unfinished files.
    fn maps(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.path("out")).unwrap();
        let read = |path: PathBuf| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, fs::read(path).unwrap())
        };
        let paths = entries.map(|entry| entry.unwrap().path());
        paths
            .filter(|path| !is_unfinished(path))
            .map(read)
            .collect()
    }

    /// Renders the recipe through `world`, with one thread, so that operations have an order.
    pub(crate) fn render(&self, world: &Arc<dyn World>, store: &str) -> Outcome {
        self.render_as(world, store, true)
    }

    /// As [`Place::render`], with maps that need not be `durable`.
    pub(crate) fn render_as(&self, world: &Arc<dyn World>, store: &str, durable: bool) -> Outcome {
        let heard = Heard::default();
        let loaded = match load(&**world, &self.path("recipe.ron"), &Settings::default()) {
            Ok(loaded) => loaded,
            Err(errors) => {
                return Outcome {
                    end: End::NotLoaded(errors.len()),
                    said: yosegi::diagnostics::render_all(&errors),
                    has_store_failed: false,
                };
            }
        };
        let options = Options {
            threads: Some(1),
            store: Some(self.path(store)),
            memory: 0,
            durable,
            ..Options::default()
        };
        let engine = Engine::new(Arc::clone(world), options).unwrap();
        let result = engine.render(&Render {
            graph: &loaded.graph,
            folder: self.path("out"),
            only: vec![],
            pixels: None,
            listener: &heard,
            cancel: Cancel::new(),
        });
        let said = match &result {
            Ok(_) => String::new(),
            Err(error) => yosegi::diagnostics::render_all(error.diagnostics()),
        };
        let end = match result {
            Ok(_) => End::Done,
            Err(RunError::Files(_)) => End::Files,
            Err(other) => End::Else(format!("{other:?}")),
        };
        Outcome {
            end,
            said,
            has_store_failed: heard.0.into_inner().unwrap(),
        }
    }

    /// That every map is the old or the new one, and all are new if the run is done.
    pub(crate) fn judge(&self, is_done: bool, context: &str) {
        let maps = self.maps();
        let names: Vec<&String> = maps.keys().collect();
        assert_eq!(names, self.new.keys().collect::<Vec<_>>(), "{context}");
        for (name, bytes) in &maps {
            let is_old = !is_done && *bytes == self.old[name];
            assert!(is_old || *bytes == self.new[name], "{context}: {name}");
        }
    }

    /// That a run without faults gives the right maps and leaves nothing behind.
    pub(crate) fn recover(&self, context: &str) {
        let disk: Arc<dyn World> = Arc::new(Disk);
        let outcome = self.render(&disk, "store");
        assert_eq!(outcome.end, End::Done, "after {context}: {}", outcome.said);
        assert!(!outcome.has_store_failed, "after {context}");
        assert!(self.maps() == self.new, "after {context}");
        assert_eq!(self.unfinished(), [] as [PathBuf; 0], "after {context}");
    }

    /// Unfinished files anywhere.
    pub(crate) fn unfinished(&self) -> Vec<PathBuf> {
        let mut found = vec![];
        let mut pending = vec![self.work()];
        while let Some(folder) = pending.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    pending.push(path);
                } else if is_unfinished(&path) {
                    found.push(path);
                }
            }
        }
        found
    }
}

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) end: End,
    /// What was said to be wrong.
    pub(crate) said: String,
    pub(crate) has_store_failed: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Done,
    /// The recipe was not loaded, with so many errors.
    NotLoaded(usize),
    /// Files could not be read or written.
    Files,
    Else(String),
}

/// Hears whether the store failed.
#[derive(Default)]
struct Heard(std::sync::Mutex<bool>);

impl Listener for Heard {
    fn hear(&self, event: Event) {
        if matches!(event, Event::StoreFailed { .. }) {
            *self.0.lock().unwrap() = true;
        }
    }
}

fn is_unfinished(path: &Path) -> bool {
    path.extension().is_some_and(|it| it == "part")
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &to);
        } else {
            fs::copy(&path, &to).unwrap();
        }
    }
}
