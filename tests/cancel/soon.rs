//! How soon a cancelled run ends, measured: each case is cancelled at many moments of its run.
//!
//! ```sh
//! cargo test --release --test cancel -- --ignored --nocapture soon
//! ```
//!
//! `YOSEGI_CANCELS` is the number of moments for each case, `YOSEGI_CASES` a part of the names of cases.

use super::*;
use std::fmt::Write as _;
use std::fs;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use yosegi::engine::{Engine, Render};
use yosegi::graph::{Graph, Settings, load};
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
struct Folder(tempfile::TempDir);

impl Folder {
    fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
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
            self.write(asset, asset_bytes(asset));
        }
        graph(&self.write(
            &format!("{to}_{name}").replace([' ', ':', ','], ""),
            recipe.replace(from, to),
        ))
    }
}

use workshop::asset_bytes;

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
        ("chain of 10000", chain(10_000)),
        ("chain of 100000", chain(100_000)),
        ("supersampled chain of 900", supersampled(900)),
        ("tree of 500000 rows", tree(folder, 500_000)),
        ("20000 branches", branches(20_000)),
    ] {
        add(
            name,
            graph(&folder.write(&format!("{name}.ron"), text)),
            None,
            There::Nothing,
        );
    }
    let path = folder.write("photo.ron", photograph(folder));
    add(
        "photograph of 36 megapixels",
        graph(&path),
        None,
        There::Nothing,
    );
    let path = folder.write("pattern.ron", pattern(folder));
    add(
        "pattern of 36 megapixels",
        graph(&path),
        None,
        There::Nothing,
    );
    cases
}

const END: &str = "
    \"wood\": material(base_color: \"last\"),
    \"board\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 0), size: (40, 40)),
}, outputs: { \"board\": maps(of: \"board\", pixels: (256, 256)) })";

fn chain(length: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"fibre\": solid_noise(size: (5, 5, 150)),
        \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),\n",
    );
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: 0.01),"
        )
        .unwrap();
    }
    let last = length - 1;
    write!(
        text,
        "\"last\": mix(a: \"n{last}\", b: \"#000000\", amount: \"fibre.value\"),{END}"
    )
    .unwrap();
    text
}

fn supersampled(length: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"fibre\": solid_noise(size: (5, 5, 150)),
        \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"fibre.value\"),\n",
    );
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: \"fibre.value\"),"
        )
        .unwrap();
    }
    let last = length - 1;
    write!(
        text,
        "\"last\": mix(a: \"n{last}\", b: \"#000000\", amount: 0),{END}"
    )
    .unwrap();
    text
}

fn tree(folder: &Folder, rows: usize) -> String {
    let mut text = String::from("# unit: mm\nid,parent,x,y,z,radius\n");
    for index in 1..=rows {
        let parent = if index % 10 == 1 && index > 1 {
            index - 10
        } else {
            index - 1
        };
        let (x, z) = ((index % 10) as f64 * 0.1, (index / 10 * 20) as f64);
        writeln!(text, "{index},{parent},{x},0,{z},5").unwrap();
    }
    folder.write("tree.csv", text);
    format!(
        "(nodes: {{ \"tree\": skeleton_from_file(tree: \"tree.csv\"),
        \"time\": growth_field(skeleton: \"tree\", elongation: 300, thickening: 3, reach: (100, 20)),
        \"last\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"time.branch\"),{END}"
    )
}

fn branches(count: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"tree\": skeleton(trunk: [(0, 0, -50), (3, 1, 900), (0, 0, 2000)], branches: [",
    );
    for index in 0..count {
        let (at, x) = (index % 1900, index % 7);
        write!(
            text,
            "(at: {at}, direction: ({x}, 1, 0.5), thickening: 0.4),"
        )
        .unwrap();
    }
    text + "]), \"time\": growth_field(skeleton: \"tree\", elongation: 300, thickening: 3, sharpness: 3),
        \"last\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"time.branch\")," + END
}

fn noise_picture() -> image::RgbImage {
    let mut state = 1u32;
    image::RgbImage::from_fn(6000, 6000, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        image::Rgb([state >> 24, state >> 16 & 255, 60 + (state >> 29)].map(|part| part as u8))
    })
}

fn photograph(folder: &Folder) -> String {
    noise_picture()
        .save(folder.0.path().join("noise.png"))
        .unwrap();
    "(nodes: {
        \"picture\": image_from_file(file: \"noise.png\", size: (600, 600)),
        \"board\": material(base_color: \"picture.colour\"),
    }, outputs: { \"board\": maps(of: \"board\", size: (600, 600), pixels: (512, 512)) })"
        .to_owned()
}

fn pattern(folder: &Folder) -> String {
    noise_picture()
        .save(folder.0.path().join("noise.bmp"))
        .unwrap();
    format!(
        "(nodes: {{ \"year\": sample_pattern(file: \"noise.bmp\", texels: 3000),
        \"last\": pattern_lookup(time: 0.5, pattern: \"year\"),{END}"
    )
}

/// How long after `after` the run ended that is cancelled then; `None` if it ended before.
fn cancelled(case: &Case, folder: &Path, after: Duration) -> Option<[Duration; 2]> {
    let store = folder.join("store");
    let engine = Engine::new(
        Arc::new(Disk),
        Options {
            threads: Some(2),
            memory: 0,
            store: Some(store),
            ..Options::default()
        },
    );
    let engine = engine.unwrap();
    let cancel = Cancel::new();
    let request = Render {
        graph: &case.graph,
        folder: folder.join("out"),
        only: vec![],
        pixels: case.size,
        listener: &|_| {},
        cancel: cancel.clone(),
    };
    thread::scope(|scope| {
        let run = scope.spawn(|| {
            let result = engine.render(&request);
            (result.is_ok(), Instant::now())
        });
        let start = Instant::now();
        while start.elapsed() < after && !run.is_finished() {
            thread::sleep((after - start.elapsed()).min(Duration::from_millis(1)));
        }
        let thrown = Instant::now();
        cancel.cancel();
        let returned = thrown.elapsed();
        let (is_done, end) = run.join().unwrap();
        (!is_done).then(|| [end.saturating_duration_since(thrown), returned])
    })
}

fn prepare(case: &Case, folder: &Path) {
    if case.there != There::Maps {
        let _ = fs::remove_dir_all(folder.join("out"));
    }
    if case.there == There::Nothing {
        let _ = fs::remove_dir_all(folder.join("store"));
    }
}

/// The numbers of a case: worst, 99th of a hundred, middle, all in milliseconds, and how many.
fn measure(case: &Case, moments: u32) -> String {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let start = Instant::now();
    let forever = Duration::from_secs(3600);
    // What is there already has to be whole.
    let first = if case.there == There::Nothing {
        LONGEST
    } else {
        forever
    };
    let _ = cancelled(case, folder, first);
    let mut length = start.elapsed().min(LONGEST);
    if case.there != There::Nothing {
        prepare(case, folder);
        let start = Instant::now();
        assert_eq!(cancelled(case, folder, forever), None);
        length = start.elapsed();
    }
    let mut taken = vec![];
    let mut returned = Duration::ZERO;
    for moment in 0..moments {
        prepare(case, folder);
        // The golden ratio spreads moments evenly, however many there are.
        let share = (f64::from(moment) * 0.618_033_988_75).fract();
        if let Some([end, back]) = cancelled(case, folder, length.mul_f64(share)) {
            taken.push(end.as_secs_f64() * 1e3);
            returned = returned.max(back);
        }
    }
    taken.sort_by(f64::total_cmp);
    let at = |share: f64| {
        taken
            .get(((taken.len() as f64 * share) as usize).min(taken.len().saturating_sub(1)))
            .copied()
            .unwrap_or(0.0)
    };
    format!(
        "{:34} worst {:7.1} ms  p99 {:7.1}  p50 {:6.1}  `cancel` {:5.2} ms  of {:3} in {:5.2} s",
        case.name,
        at(1.0),
        at(0.99),
        at(0.5),
        returned.as_secs_f64() * 1e3,
        taken.len(),
        length.as_secs_f64()
    )
}

#[test]
#[ignore = "takes some minutes, and is about release builds"]
fn soon_after_it_was_cancelled_a_run_has_ended() {
    let moments = std::env::var("YOSEGI_CANCELS").map_or(40, |text| text.parse().unwrap());
    let wanted = std::env::var("YOSEGI_CASES").unwrap_or_default();
    let folder = Folder(tempfile::tempdir().unwrap());
    for case in cases(&folder)
        .iter()
        .filter(|case| case.name.contains(&wanted))
    {
        println!("{}", measure(case, moments));
    }
}
