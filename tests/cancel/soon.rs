//! How soon a cancelled run ends, measured: each case is cancelled at many moments of its run.
//!
//! ```sh
//! cargo test --release --test cancel -- --ignored --nocapture soon
//! ```
//!
//! `YOSEGI_CANCELS` is the number of moments for each case, `YOSEGI_CASES` a part of the names of cases.

use super::*;
use crate::recipes;
use std::fs;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use yosegi::engine::{Engine, Render};
use yosegi::graph::{Graph, Settings, load, load_until};
use yosegi::world::Disk;

/// Moments lie within this time from the start of a run.
const LONGEST: Duration = Duration::from_secs(3);

/// What is there when a run starts.
#[derive(Clone, Copy, PartialEq)]
enum There {
    Nothing,
    /// A store that knows the maps, and has copies of them.
    Store,
    /// The store, and the maps in their places.
    Maps,
}

struct Case {
    name: String,
    graph: Graph,
    size: Option<[u32; 2]>,
    there: There,
}

fn graph(path: &Path) -> Graph {
    load(&Disk, path, &Settings::default())
        .unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)))
        .graph
}

fn gallery() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
    let files = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut recipes: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|it| it == "ron"))
        .collect();
    recipes.sort();
    recipes
}

/// The scratch folder of the campaign, with recipes written into it.
pub(crate) struct Folder(pub(crate) tempfile::TempDir);

impl Folder {
    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        path
    }

    /// A recipe of the gallery with one piece of its text replaced.
    fn edited(&self, name: &str, from: &str, to: &str) -> Graph {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let recipe = fs::read_to_string(folder.join("graphs").join(name)).unwrap();
        assert!(recipe.contains(from), "{name} holds no `{from}`");
        for asset in [
            "spruce_log/Gran_1_pith.json",
            "spruce_log/Gran_1_knots.json",
        ] {
            self.write(asset, workshop::asset_bytes(asset));
        }
        graph(&self.write(
            &format!("{to}_{name}").replace([' ', ':', ','], ""),
            recipe.replace(from, to),
        ))
    }
}

fn cases(folder: &Folder) -> Vec<Case> {
    let mut cases = vec![];
    let mut add = |name: &str, graph: Graph, size: Option<[u32; 2]>, there: There| {
        let name = name.to_owned();
        cases.push(Case {
            name,
            graph,
            size,
            there,
        });
    };
    for recipe in gallery() {
        let name = recipe.file_stem().unwrap().to_str().unwrap();
        add(name, graph(&recipe), None, There::Nothing);
        add(
            &format!("{name} 4096"),
            graph(&recipe),
            Some([4096; 2]),
            There::Nothing,
        );
    }
    let plank = "straight_trunk.ron";
    for format in [
        "png16",
        "exr_half",
        "exr_float",
        "tiff8",
        "tiff16",
        "tiff_float",
        "bmp",
    ] {
        let formatted = |there: There| {
            (
                folder.edited(plank, "channels:", &format!("format: {format}, channels:")),
                there,
            )
        };
        let (graph, there) = formatted(There::Nothing);
        add(&format!("4096 {format}"), graph, Some([4096; 2]), there);
        if format == "exr_float" {
            let (graph, there) = formatted(There::Maps);
            add("up to date 4096 exr_float", graph, Some([4096; 2]), there);
        }
        if format == "png16" {
            let (graph, there) = formatted(There::Store);
            add("restored 2048 png16", graph, Some([2048; 2]), there);
        }
    }
    for (name, text) in [
        ("chain of 10000", recipes::chain(10_000)),
        ("chain of 100000", recipes::chain(100_000)),
        ("supersampled chain of 900", recipes::supersampled(900)),
        ("tree of 500000 rows", recipes::tree(folder, 500_000)),
        ("20000 branches", recipes::branches(20_000)),
    ] {
        add(
            name,
            graph(&folder.write(&format!("{name}.ron"), text)),
            None,
            There::Nothing,
        );
    }
    let path = folder.write("photo.ron", recipes::photograph(folder));
    add(
        "photograph of 36 megapixels",
        graph(&path),
        None,
        There::Nothing,
    );
    let path = folder.write("pattern.ron", recipes::pattern(folder));
    add(
        "pattern of 36 megapixels",
        graph(&path),
        None,
        There::Nothing,
    );
    cases
}

/// How a cancelled run ended.
#[derive(Default)]
struct Ended {
    /// Milliseconds from the call of `cancel` to the end.
    taken: f64,
    /// Milliseconds of processor of all threads in that time.
    busy: f64,
    /// Milliseconds that `cancel` itself took.
    returned: f64,
}

/// Milliseconds of processor that the threads have had so far.
fn busy() -> f64 {
    let nanoseconds = |path: PathBuf| -> Option<f64> {
        let times = fs::read_to_string(path.join("schedstat")).ok()?;
        times.split_whitespace().next()?.parse().ok()
    };
    let tasks = fs::read_dir("/proc/self/task").into_iter().flatten();
    let threads = tasks.filter_map(|task| nanoseconds(task.ok()?.path()));
    threads.sum::<f64>() * 1e-6
}

/// Cancels `run`, which says whether it came to its end, `after` some time; `None` if it did.
fn cancelled(run: impl FnOnce(&Cancel) -> bool + Send, after: Duration) -> Option<Ended> {
    let cancel = &Cancel::new();
    thread::scope(|scope| {
        let run = scope.spawn(move || {
            let is_done = run(cancel);
            (is_done, Instant::now(), busy())
        });
        let start = Instant::now();
        while start.elapsed() < after && !run.is_finished() {
            thread::sleep((after - start.elapsed()).min(Duration::from_millis(1)));
        }
        let (thrown, before) = (Instant::now(), busy());
        cancel.cancel();
        let returned = thrown.elapsed();
        let (is_done, end, then) = run.join().unwrap();
        let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
        (!is_done).then(|| Ended {
            taken: milliseconds(end.saturating_duration_since(thrown)),
            busy: then - before,
            returned: milliseconds(returned),
        })
    })
}

/// An engine that has to do everything again in each run.
fn engine(folder: &Path) -> Engine {
    let options = Options {
        threads: Some(2),
        memory: 0,
        store: Some(folder.join("store")),
        ..Options::default()
    };
    Engine::new(Arc::new(Disk), options).unwrap()
}

impl Case {
    /// Whether a run came to its end.
    fn run(&self, engine: &Engine, folder: &Path, cancel: &Cancel) -> bool {
        let result = engine.render(&Render {
            graph: &self.graph,
            folder: folder.join("out"),
            only: vec![],
            pixels: self.size,
            listener: &|_| {},
            cancel: cancel.clone(),
        });
        result.is_ok()
    }

    fn prepare(&self, folder: &Path) {
        if self.there != There::Maps {
            let _ = fs::remove_dir_all(folder.join("out"));
        }
        if self.there == There::Nothing {
            let _ = fs::remove_dir_all(folder.join("store"));
        }
    }

    /// How long a run takes, but not much more than is asked for.
    fn length(&self, engine: &Engine, folder: &Path) -> Duration {
        let whole = Duration::from_secs(3600);
        if self.there != There::Nothing {
            assert!(cancelled(|cancel| self.run(engine, folder, cancel), whole).is_none());
            self.prepare(folder);
        }
        let start = Instant::now();
        let _ = cancelled(|cancel| self.run(engine, folder, cancel), LONGEST);
        start.elapsed().min(LONGEST)
    }
}

/// Cancels runs at many moments within `length`, and prints what that took.
fn measure(name: &str, length: Duration, prepare: impl Fn(), run: impl Fn(&Cancel) -> bool + Sync) {
    let moments = std::env::var("YOSEGI_CANCELS").map_or(40, |text| text.parse().unwrap());
    let end_at = |moment: u32| {
        prepare();
        // The golden ratio spreads moments evenly, however many there are.
        let share = (f64::from(moment) * 0.618_033_988_75).fract();
        cancelled(&run, length.mul_f64(share))
    };
    let ends: Vec<Ended> = (0..moments).filter_map(end_at).collect();
    let mut taken: Vec<f64> = ends.iter().map(|end| end.taken).collect();
    taken.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = ((taken.len() as f64 * share) as usize).min(taken.len().saturating_sub(1));
        taken.get(place).copied().unwrap_or_default()
    };
    let most = |of: fn(&Ended) -> f64| ends.iter().map(of).fold(0.0, f64::max);
    println!(
        "{name:34} ended after {:6.1} ms at worst, p99 {:6.1}, p50 {:5.1}; busy {:6.1} ms at worst; `cancel` took \
         {:4.2} ms at worst; {:3} in {:5.2} s",
        at(1.0),
        at(0.99),
        at(0.5),
        most(|end| end.busy),
        most(|end| end.returned),
        ends.len(),
        length.as_secs_f64(),
    );
}

#[test]
#[ignore = "takes some minutes, and is about release builds"]
fn soon_after_it_was_cancelled_a_run_has_ended() {
    let wanted = std::env::var("YOSEGI_CASES").unwrap_or_default();
    let folder = Folder(tempfile::tempdir().unwrap());
    for size in [10_000, 100_000] {
        let name = format!("reading {size} nodes");
        let path = folder.write("long.ron", recipes::chain(size));
        let read =
            |cancel: &Cancel| load_until(&Disk, &path, &Settings::default(), cancel).is_some();
        if name.contains(&wanted) {
            let start = Instant::now();
            assert!(read(&Cancel::new()));
            measure(&name, start.elapsed(), || (), read);
        }
    }
    for case in cases(&folder) {
        if case.name.contains(&wanted) {
            let place = tempfile::tempdir().unwrap();
            let place = place.path();
            let engine = engine(place);
            let length = case.length(&engine, place);
            measure(
                &case.name,
                length,
                || case.prepare(place),
                |cancel| case.run(&engine, place, cancel),
            );
        }
    }
}
