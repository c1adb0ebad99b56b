//! From pressing save to the new map in its place: a real process that watches a real file.
//!
//! `cargo bench --bench latency` prints milliseconds, medians and 95th percentiles of 40 saves, and what the
//! time went to. The map is the base colour of a board of the measured spruce log, 1024 x 1024 pixels.

use serde_json::Value as Json;
use std::io::{BufRead, BufReader, Lines};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

const SAVES: usize = 40;

/// An edit: its name, how the text of the recipe changes with the number of the save, and the target in ms.
type Edit = (&'static str, fn(&str, usize) -> String, Option<f64>);

const EDITS: [Edit; 4] = [
    ("comment", comment, Some(10.0)),
    ("colour", colour, Some(60.0)),
    ("middle node", middle, None),
    ("skeleton", skeleton, Some(150.0)),
];

fn comment(text: &str, save: usize) -> String {
    format!("{text}// {save}\n")
}

fn colour(text: &str, save: usize) -> String {
    let warm = "\"warm\": mix(a: \"look.colour\", b: \"#";
    let start = text.find(warm).expect("the recipe has a warm colour") + warm.len();
    let mut text = text.to_owned();
    text.replace_range(start..start + 2, &format!("{:02x}", 20 + save));
    text
}

fn middle(text: &str, save: usize) -> String {
    text.replace("elongation: 450", &format!("elongation: {}", 451 + save))
}

fn skeleton(text: &str, save: usize) -> String {
    let text = text.replace("every: 5", &format!("every: {}", 4 + save % 3));
    // The same distance comes again, so that something else makes each state new.
    text.replace("sharpness: 4", &format!("sharpness: 4.{:04}", 1 + save))
}

/// The spruce board with one map.
fn recipe() -> String {
    let text = include_str!("../graphs/spruce_log_board.ron");
    let outputs = text.find("    outputs: {").expect("the recipe has outputs");
    format!(
        "{}    outputs: {{ \"board\": maps(of: \"plain\", pixels: (1024, 1024), channels: [base_color]) }},\n)\n",
        &text[..outputs]
    )
}

/// A process that watches, and what it says.
struct Watched {
    process: Child,
    lines: Lines<BufReader<ChildStdout>>,
    recipe: PathBuf,
}

/// What one save took, in milliseconds.
#[derive(Clone, Copy, Default)]
struct Save {
    total: f64,
    waiting: f64,
    parsing: f64,
    evaluation: f64,
    encoding: f64,
}

impl Watched {
    fn start(folder: &Path, text: &str) -> Watched {
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
        let recipe = folder.join("board.ron");
        for asset in [
            "spruce_log/Gran_1_pith.json",
            "spruce_log/Gran_1_knots.json",
            "spruce_bar/spruce_bar.png",
        ] {
            let place = folder.join("assets").join(asset);
            std::fs::create_dir_all(place.parent().expect("it is in a folder")).expect("a folder");
            std::fs::copy(assets.join(asset), place).expect("the assets can be copied");
        }
        std::fs::write(&recipe, text).expect("the recipe can be written");
        let mut process = Command::new(env!("CARGO_BIN_EXE_yosegi"))
            .args(["watch", "--json", "-o"])
            .arg(folder.join("out"))
            .arg("--cache")
            .arg(folder.join("store"))
            .arg(&recipe)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let stdout = process.stdout.take().expect("it has a stdout");
        let lines = BufReader::new(stdout).lines();
        let mut watched = Watched {
            process,
            lines,
            recipe,
        };
        watched.until("rendered");
        watched
    }

    /// The next event of a kind.
    fn until(&mut self, kind: &str) -> Json {
        loop {
            let line = self
                .lines
                .next()
                .expect("it goes on")
                .expect("it can be read");
            let event: Json = serde_json::from_str(&line).expect("it is JSON");
            assert_ne!(event["event"], "failed", "{line}");
            if event["event"] == kind {
                return event;
            }
        }
    }

    /// Saves a text and waits for the new map, or for word that nothing changed.
    fn save(&mut self, text: &str, is_new: bool) -> Save {
        std::thread::sleep(Duration::from_millis(150));
        let milliseconds = |since: Instant| since.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        std::fs::write(&self.recipe, text).expect("the recipe can be written");
        if is_new {
            self.until("map_written");
        }
        let placed = milliseconds(start);
        let rendered = self.until("rendered");
        let ended = milliseconds(start);
        let total = if is_new { placed } else { ended };
        let times = |name: &str| rendered["times"][name].as_f64().expect("it is a number");
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        // Behind the map in its place the store is told.
        let rendering = times("rendering") - (ended - total);
        let evaluation = times("computing") / threads as f64;
        Save {
            total,
            waiting: total - times("loading") - rendering,
            parsing: times("loading"),
            evaluation,
            encoding: rendering - evaluation,
        }
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        // Ended already, or it ends now.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn main() {
    let folder = tempfile::tempdir().expect("a folder for a while");
    let text = recipe();
    let mut watched = Watched::start(folder.path(), &text);
    println!("                 median     95 %   target   waiting  parsing  evaluation  rest");
    for (name, edit, target) in EDITS {
        let saves: Vec<Save> = (0..SAVES)
            .map(|save| watched.save(&edit(&text, save), name != "comment"))
            .collect();
        let middle = |part| quantile(&saves, part, 50);
        let target = target.map_or("-".to_owned(), |target| format!("{target:.0}"));
        println!(
            "{name:15} {:7.1}  {:7.1}  {target:>7}  {:8.1} {:8.1}  {:10.1}  {:4.1}",
            middle(|save| save.total),
            quantile(&saves, |save| save.total, 95),
            middle(|save| save.waiting),
            middle(|save| save.parsing),
            middle(|save| save.evaluation),
            middle(|save| save.encoding),
        );
    }
}

/// What `percent` of the saves do not exceed.
fn quantile(saves: &[Save], part: fn(&Save) -> f64, percent: usize) -> f64 {
    let mut parts: Vec<f64> = saves.iter().map(part).collect();
    parts.sort_by(f64::total_cmp);
    parts[parts.len() * percent / 100]
}
