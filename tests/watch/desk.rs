//! A desk: a folder on disk with a recipe in it, and a watch that follows it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use yosegi::engine::{Engine, Options as EngineOptions};
use yosegi::watch::{Followed, Options, Stop, Told, Watch};
use yosegi::world::{Disk, World};

/// How long a test waits for what has to happen; only a watch that hangs takes as long.
pub(crate) const LONG: Duration = Duration::from_secs(20);

/// A folder, a watch of a recipe in it, and what was told.
pub(crate) struct Desk {
    pub(crate) folder: Arc<TempDir>,
    told: Arc<Mutex<Vec<Told>>>,
    stop: Stop,
    thread: Option<JoinHandle<()>>,
}

/// How a desk is set up.
pub(crate) struct Setup {
    /// Below the desk's folder.
    pub(crate) recipes: Vec<PathBuf>,
    /// Where maps go, below the desk's folder.
    pub(crate) output: PathBuf,
    pub(crate) options: Options,
    pub(crate) world: Arc<dyn World>,
    /// Whether there is a store, in the folder `store`.
    pub(crate) store: bool,
}

impl Default for Setup {
    fn default() -> Setup {
        Setup {
            recipes: vec!["recipe.ron".into()],
            output: "out".into(),
            options: Options::default(),
            world: Arc::new(Disk),
            store: false,
        }
    }
}

impl Setup {
    /// With small pictures.
    pub(crate) fn with_preview() -> Setup {
        let options = Options {
            preview: true,
            poll: None,
        };
        Setup {
            options,
            ..Setup::default()
        }
    }
}

impl Desk {
    /// A desk whose recipe lies where it should and has the colour 1.
    pub(crate) fn new() -> Desk {
        Desk::with(Setup::default(), |folder| {
            fs::write(folder.join("recipe.ron"), recipe(1)).unwrap();
        })
    }

    /// A desk whose files are laid out by `lay`, which gets its folder.
    pub(crate) fn with(setup: Setup, lay: impl FnOnce(&Path)) -> Desk {
        let folder = tempfile::tempdir().unwrap();
        lay(folder.path());
        Desk::at_folder(Arc::new(folder), setup)
    }

    /// Another watch in the same folder.
    pub(crate) fn beside(&self, setup: Setup) -> Desk {
        Desk::at_folder(Arc::clone(&self.folder), setup)
    }

    fn at_folder(folder: Arc<TempDir>, setup: Setup) -> Desk {
        let options = EngineOptions {
            threads: Some(1),
            memory: 16 << 20,
            store: setup.store.then(|| folder.path().join("store")),
            ..EngineOptions::default()
        };
        let engine = Engine::new(Arc::clone(&setup.world), options).unwrap();
        let followed = setup.recipes.iter().map(|recipe| Followed {
            recipe: folder.path().join(recipe),
            folder: folder.path().join(&setup.output),
            ..Followed::default()
        });
        let told: Arc<Mutex<Vec<Told>>> = Arc::default();
        let heard = Arc::clone(&told);
        let hear = move |_: &Path, it: Told| heard.lock().unwrap().push(it);
        let watch = Watch::new(
            engine,
            setup.world,
            followed.collect(),
            setup.options,
            Arc::new(hear),
        );
        let stop = watch.stop();
        Desk {
            folder,
            told,
            stop,
            thread: Some(std::thread::spawn(move || watch.run().unwrap())),
        }
    }

    /// A path below the desk's folder.
    pub(crate) fn at(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    /// Writes the recipe in place.
    pub(crate) fn save(&self, text: &str) {
        fs::write(self.at("recipe.ron"), text).unwrap();
    }

    /// Everything told so far.
    pub(crate) fn told(&self) -> Vec<Told> {
        self.told.lock().unwrap().clone()
    }

    /// Waits until something is told that `is` holds for, from the `from`-th on; gives its number.
    pub(crate) fn wait_for(&self, from: usize, is: impl Fn(&Told) -> bool) -> usize {
        let mut found = None;
        wait_until(|| {
            let told = self.told.lock().unwrap();
            found = (from..told.len()).find(|index| is(&told[*index]));
            found.is_some()
        });
        found.unwrap_or_else(|| panic!("not told in time; only {:?}", &self.told()[from..]))
    }

    /// Waits until all maps are in their places once more than before `from`.
    pub(crate) fn wait_for_render(&self, from: usize) -> usize {
        self.wait_for(from, |told| matches!(told, Told::Rendered(_)))
    }

    /// Waits for a mistake to be told; gives the text of the first.
    pub(crate) fn wait_for_failure(&self, from: usize) -> String {
        let index = self.wait_for(from, |told| matches!(told, Told::Failed(_)));
        let Told::Failed(failed) = &self.told()[index] else {
            unreachable!("the told is kept")
        };
        failed.diagnostics()[0].message.clone()
    }

    /// How often something was told.
    pub(crate) fn count(&self, is: impl Fn(&Told) -> bool) -> usize {
        self.told().iter().filter(|told| is(told)).count()
    }

    /// Waits until the map has the colour; whether it has.
    pub(crate) fn shows(&self, colour: u32) -> bool {
        self.shows_at("out", colour)
    }

    /// Waits until the map in a folder has the colour; whether it has.
    pub(crate) fn shows_at(&self, folder: &str, colour: u32) -> bool {
        let path = self.at(folder).join("tile_base_color.png");
        wait_until(|| colour_of(&path) == Some(colour))
    }

    /// The colour of the map now.
    pub(crate) fn colour(&self) -> Option<u32> {
        colour_of(&self.at("out/tile_base_color.png"))
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        self.stop.stop();
        let ended = self.thread.take().map(JoinHandle::join);
        if !std::thread::panicking() {
            assert!(ended.is_some_and(|ended| ended.is_ok()));
        }
    }
}

/// Looks again and again until `holds` or it is too late; whether it holds.
pub(crate) fn wait_until(mut holds: impl FnMut() -> bool) -> bool {
    let end = Instant::now() + LONG;
    while !holds() {
        if Instant::now() > end {
            return false;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    true
}

/// Lets time pass in which nothing ought to happen.
pub(crate) fn pause(milliseconds: u64) {
    std::thread::sleep(Duration::from_millis(milliseconds));
}

/// A small map of one colour, which is a number below 2^24.
pub(crate) fn recipe(colour: u32) -> String {
    recipe_of(&format!("\"#{colour:06x}\""))
}

/// A small map of a colour that is written as `colour`.
pub(crate) fn recipe_of(colour: &str) -> String {
    format!(
        r##"(
    nodes: {{
        "wood": material(base_color: {colour}),
        "piece": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (40, 40)),
    }},
    outputs: {{
        "tile": maps(of: "piece", pixels: (8, 8), channels: [base_color]),
    }},
)"##
    )
}

/// The colour of the first pixel of a map; `None` if the map is not whole.
fn colour_of(path: &Path) -> Option<u32> {
    let bytes = fs::read(path).ok()?;
    let image = image::load_from_memory(&bytes).ok()?.to_rgb8();
    let [red, green, blue] = image.get_pixel(0, 0).0.map(u32::from);
    Some(red << 16 | green << 8 | blue)
}
