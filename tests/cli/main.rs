//! The program as a user calls it: exit codes, what it prints, and what it leaves on disk.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod exits;
#[cfg(unix)]
#[path = "../support/signals.rs"]
mod heard;
mod json;
mod places;
mod render;
mod shell;
#[cfg(unix)]
mod signals;
mod tell;
#[cfg(unix)]
mod watch;
mod why;

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use tempfile::TempDir;

const BOARD: &str = r##"(
    parameters: { "speed": number(default: 3, range: (1, 9), unit: "mm/year", about: "Growth") },
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: "$speed"),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look", height: 2.5),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "board": maps(of: "plank", pixels: (60, 50), channels: [base_color, normal]),
        "plain": maps(of: "plank", pixels: (30, 25), channels: [roughness]),
    },
)"##;

/// A folder with a recipe in it.
struct Place {
    folder: TempDir,
}

impl Place {
    fn new(recipe: &str) -> Place {
        let place = Place {
            folder: tempfile::tempdir().unwrap(),
        };
        place.write("recipe.ron", recipe);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, contents: &str) {
        fs::write(self.path(name), contents).unwrap();
    }

    fn call(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_yosegi"));
        command
            .current_dir(self.folder.path())
            .args(arguments)
            .output()
            .unwrap()
    }

    /// Renders the recipe with a store of its own.
    fn render(&self, arguments: &[&str]) -> Output {
        self.call(&[&["render", "recipe.ron", "--cache", "store"], arguments].concat())
    }

    /// The points that `sample` prints for a node.
    fn sample(&self, node: &str, points: &str) -> Output {
        self.write("points.csv", points);
        self.call(&[
            "sample",
            "recipe.ron",
            "--node",
            node,
            "--points",
            "points.csv",
        ])
    }

    /// The names and contents of the files in a folder.
    fn files(&self, folder: &str) -> Vec<(String, Vec<u8>)> {
        let Ok(entries) = fs::read_dir(self.path(folder)) else {
            return vec![];
        };
        let read = |path: &Path| {
            (
                path.file_name().unwrap().to_str().unwrap().to_owned(),
                fs::read(path).unwrap(),
            )
        };
        let mut files: Vec<_> = entries.map(|entry| read(&entry.unwrap().path())).collect();
        files.sort();
        files
    }

    /// The names of what is in a folder, which may change meanwhile.
    fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).into_iter().flatten();
        let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<_> = entries.map(|it| name(it).into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Every line of stdout as JSON.
fn lines(output: &Output) -> Vec<Value> {
    stdout(output)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

/// The events of a kind, as `output/channel`.
fn events(output: &Output, kind: &str) -> Vec<String> {
    let text = |line: &Value, field: &str| line[field].as_str().unwrap_or_default().to_owned();
    let lines = lines(output);
    let chosen = lines.iter().filter(|line| line["event"] == kind);
    chosen
        .map(|line| format!("{}/{}", text(line, "output"), text(line, "channel")))
        .collect()
}

/// `BOARD` with one piece of its text replaced.
fn edit(from: &str, to: &str) -> String {
    assert_eq!(BOARD.matches(from).count(), 1, "`{from}` is not there once");
    BOARD.replace(from, to)
}

/// Starts the program with stdout in a pipe.
fn start(place: &Place, arguments: &[&str]) -> std::process::Child {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_yosegi"));
    command.current_dir(place.folder.path()).args(arguments);
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}
