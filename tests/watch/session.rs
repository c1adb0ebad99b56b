//! A long session of the real program: thousands of saves take no more memory and no more files than hundreds.

use serde_json::Value as Json;
use std::fs;
use std::io::{BufRead, BufReader, Lines};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};

/// A board with a tree, a compound and a picture of 256 x 256 pixels.
fn recipe(save: usize) -> String {
    let colour = format!("#{:06x}", save * 40_503 % (1 << 24));
    let skeleton = 1000 + save / 50 % 400;
    let thickening = 2.0 + (save / 10 % 97) as f64 * 0.01;
    let mistake = if save % 100 == 99 { "colur" } else { "colour" };
    format!(
        r##"(
    nodes: {{
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, {skeleton}), (0, 0, 2400)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: {thickening}),
        "year": colour_pattern(stops: [(at: 0, colour: "{colour}"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "dyed": dye(of: "look.{mistake}"),
        "wood": material(base_color: "dyed.colour"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 120)),
    }},
    outputs: {{ "tile": maps(of: "plank", pixels: (256, 256)) }},
)
// {save}
"##
    )
}

/// A compound, with a range and a text that change.
fn dye(save: usize) -> String {
    let (amount, most) = (save % 100, 1 + save / 7 % 1000);
    format!(
        r##"(
    about: "Dyes a colour, as of {amount}",
    inputs: {{
        "of": colour(per_point: true, about: "What is dyed"),
        "amount": number(default: 0.{amount:02}, range: (0, {most}), about: "How much"),
    }},
    nodes: {{ "mixed": mix(a: "$of", b: "#203040", amount: "= min($amount, 1)") }},
    outputs: {{ "colour": "mixed" }},
)"##
    )
}

struct Session {
    process: Child,
    lines: Lines<BufReader<ChildStdout>>,
    folder: PathBuf,
}

impl Session {
    fn start(folder: &Path) -> Session {
        fs::create_dir(folder.join("nodes")).unwrap();
        fs::write(folder.join("nodes/dye.ron"), dye(0)).unwrap();
        fs::write(folder.join("board.ron"), recipe(0)).unwrap();
        let mut process = Command::new(env!("CARGO_BIN_EXE_yosegi"))
            .args(["watch", "board.ron", "--json", "--cache", "store"])
            .args(["--memory", "64MiB", "--cache-size", "64MiB"])
            .current_dir(folder)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let stdout = process.stdout.take().unwrap();
        let mut session = Session {
            process,
            lines: BufReader::new(stdout).lines(),
            folder: folder.to_owned(),
        };
        session.wait();
        session
    }

    /// Waits for word that a recipe was rendered, or why not.
    fn wait(&mut self) {
        loop {
            let line = self.lines.next().unwrap().unwrap();
            let event: Json = serde_json::from_str(&line).unwrap();
            if event["event"] == "rendered" || event["event"] == "failed" {
                return;
            }
        }
    }

    fn save(&mut self, save: usize) {
        let (name, text) = match save % 23 {
            0 => ("nodes/dye.ron", dye(save)),
            _ => ("board.ron", recipe(save)),
        };
        let new = self.folder.join("new");
        fs::write(&new, text).unwrap();
        fs::rename(new, self.folder.join(name)).unwrap();
        self.wait();
    }

    /// Resident bytes, and files that are open; nothing where the system does not say.
    fn takes(&self) -> Option<(u64, usize)> {
        let place = PathBuf::from(format!("/proc/{}", self.process.id()));
        let status = fs::read_to_string(place.join("status")).ok()?;
        let resident = status
            .lines()
            .find_map(|line| line.strip_prefix("VmRSS:"))?;
        let kibibytes: u64 = resident.trim().strip_suffix(" kB")?.trim().parse().ok()?;
        let files = fs::read_dir(place.join("fd")).ok()?.count();
        Some((kibibytes << 10, files))
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Bytes in a folder and all below it.
fn size(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.metadata() {
        Ok(metadata) if metadata.is_dir() => size(&entry.path()),
        Ok(metadata) => metadata.len(),
        Err(_) => 0,
    });
    sizes.sum()
}

fn session(saves: usize, settled: usize) {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::start(folder.path());
    let mut before = None;
    for save in 1..=saves {
        session.save(save);
        if save == settled {
            before = session.takes();
        }
        if save % 1000 == 0 {
            println!("{save} saves: {:?}", session.takes());
        }
    }
    let (Some((before, files)), Some((after, open))) = (before, session.takes()) else {
        // The system does not tell.
        return;
    };
    let growth = after as f64 / before as f64 - 1.0;
    let store = size(&folder.path().join("store"));
    println!(
        "{saves} saves: {:.1} MiB resident after {settled}, {:.1} MiB at the end ({:+.1} %), {files} and {open} \
         files open, store {:.1} MiB",
        before as f64 / f64::from(1 << 20),
        after as f64 / f64::from(1 << 20),
        100.0 * growth,
        store as f64 / f64::from(1 << 20)
    );
    assert_eq!(files, open);
    assert!(store <= 64 << 20, "{store}");
    // Before that the memory fills up to its budget.
    assert!(settled < 500 || growth < 0.05, "{growth}");
}

#[test]
fn a_session_leaves_no_file_open() {
    session(60, 30);
}

/// `cargo test --release --test watch -- --ignored --nocapture session`
#[test]
#[ignore = "takes minutes: the whole campaign"]
fn session_of_20000_saves() {
    let saves = std::env::var("YOSEGI_SAVES").map_or(20_000, |saves| saves.parse().unwrap());
    session(saves, 500);
}
