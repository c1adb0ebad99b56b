//! The program as a user calls it: exit codes, what it prints, and what it leaves on disk.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
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

    fn names(&self, folder: &str) -> Vec<String> {
        self.files(folder)
            .into_iter()
            .map(|(name, _)| name)
            .collect()
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

const MAPS: [&str; 3] = [
    "board_base_color.png",
    "board_normal.png",
    "plain_roughness.png",
];

#[test]
fn a_render_prints_its_files_and_nothing_else() {
    let place = Place::new(BOARD);
    let output = place.render(&[]);
    assert_eq!((code(&output), stderr(&output)), (0, String::new()));
    let expected: Vec<PathBuf> = MAPS
        .iter()
        .map(|name| Path::new("out").join(name))
        .collect();
    let printed = stdout(&output);
    assert_eq!(
        printed.lines().map(PathBuf::from).collect::<Vec<_>>(),
        expected
    );
    assert_eq!(place.names("out"), MAPS);
}

#[test]
fn a_second_render_says_that_all_is_up_to_date() {
    let place = Place::new(BOARD);
    let first = place.render(&["--json"]);
    assert_eq!(code(&first), 0);
    assert_eq!(
        events(&first, "map_written"),
        ["board/base_color", "board/normal", "plain/roughness"]
    );
    assert!(events(&first, "map_up_to_date").is_empty());
    let second = place.render(&["--json"]);
    assert_eq!(
        events(&second, "map_up_to_date"),
        ["board/base_color", "board/normal", "plain/roughness"]
    );
    assert_eq!(lines(&second).len(), 3);
}

#[test]
fn without_a_cache_everything_is_written_again_and_no_store_is_made() {
    let place = Place::new(BOARD);
    for _ in 0..2 {
        let output = place.call(&["render", "recipe.ron", "--no-cache", "--json"]);
        assert_eq!(
            (code(&output), events(&output, "map_written").len()),
            (0, 3)
        );
    }
    let mut entries: Vec<_> = fs::read_dir(place.folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    entries.sort();
    assert_eq!(entries, ["out", "recipe.ron"]);
}

#[test]
fn vector_instructions_tiles_and_threads_give_the_same_files() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    let plain = place.files("out");
    for (index, arguments) in [
        ["--simd", "baseline"],
        ["--tile", "37"],
        ["--tile", "16"],
        ["--threads", "3"],
    ]
    .iter()
    .enumerate()
    {
        let folder = format!("out{index}");
        let rest = ["render", "recipe.ron", "--no-cache", "-o", &folder];
        assert_eq!(code(&place.call(&[&rest, &arguments[..]].concat())), 0);
        assert!(place.files(&folder) == plain, "{arguments:?}");
    }
}

#[test]
fn only_some_outputs_another_size_and_another_speed() {
    let place = Place::new(BOARD);
    assert_eq!(
        code(&place.render(&["--only", "plain", "--size", "8x6"])),
        0
    );
    assert_eq!(place.names("out"), ["plain_roughness.png"]);
    // Width and height stand in a PNG behind its signature and the head of its first chunk.
    let png = fs::read(place.path("out/plain_roughness.png")).unwrap();
    assert_eq!(png[16..24], [0, 0, 0, 8, 0, 0, 0, 6]);
    assert_eq!(code(&place.render(&["-o", "slow"])), 0);
    assert_eq!(code(&place.render(&["-o", "fast", "--set", "speed=4"])), 0);
    assert_ne!(place.files("slow")[0], place.files("fast")[0]);
    // Neither the height nor the roughness has to do with the growth.
    assert_eq!(place.files("slow")[1..], place.files("fast")[1..]);
}

/// `BOARD` with one piece of its text replaced.
fn edit(from: &str, to: &str) -> String {
    assert_eq!(BOARD.matches(from).count(), 1, "`{from}` is not there once");
    BOARD.replace(from, to)
}

#[test]
fn a_failing_node_is_1() {
    let place = Place::new(&edit(
        "cut: quarter_sawn",
        "across: (1, 0, 0), along: (1, 0, 0)",
    ));
    let output = place.render(&[]);
    assert_eq!(code(&output), 1);
    assert!(
        stderr(&output).contains("span no plane") && stderr(&output).contains("recipe.ron:9"),
        "{}",
        stderr(&output)
    );
    assert!(stdout(&output).is_empty() && place.names("out").is_empty());
    let json = lines(&place.render(&["--json"]));
    assert_eq!(
        (
            json.last().unwrap()["code"].as_str(),
            json.last().unwrap()["node"].as_str()
        ),
        (Some("node-failed"), Some("plank"))
    );
}

#[test]
fn a_wrong_recipe_or_call_is_2() {
    let place = Place::new(&edit("growth_field", "growth_fild"));
    let output = place.render(&[]);
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("growth_field"),
        "{}",
        stderr(&output)
    );
    let place = Place::new(BOARD);
    for arguments in [
        &["--only", "bord"][..],
        &["--set", "speed=fast"],
        &["--set", "speed=99"],
        &["--set", "sped=4"],
        &["--set", "speed"],
        &["--size", "0x4"],
        &["--size", "12"],
        &["--tile", "0"],
        &["--threads", "0"],
        &["--simd", "mmx"],
        &["--no-cache"],
    ] {
        let output = place.render(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stderr(&output));
        assert!(
            !stderr(&output).is_empty() && stdout(&output).is_empty(),
            "{arguments:?}"
        );
    }
    assert!(place.names("out").is_empty());
    assert!(stderr(&place.render(&["--only", "bord"])).contains("`board`"));
}

#[test]
fn files_that_cannot_be_read_or_written_are_3() {
    let place = Place::new(BOARD);
    let missing = place.call(&["render", "no.ron", "--cache", "store"]);
    assert_eq!(code(&missing), 3);
    assert!(stderr(&missing).contains("no.ron"), "{}", stderr(&missing));
    // A folder cannot lie inside a file.
    let unwritable = place.render(&["-o", "recipe.ron/out"]);
    assert_eq!(code(&unwritable), 3, "{}", stderr(&unwritable));
    let unread = Place::new(&edit(
        r#"skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)])"#,
        r#"skeleton_from_file(pith: "none.json")"#,
    ));
    let output = unread.render(&[]);
    assert_eq!(code(&output), 3);
    assert!(stderr(&output).contains("none.json"), "{}", stderr(&output));
    let points = place.call(&[
        "sample",
        "recipe.ron",
        "--node",
        "time",
        "--points",
        "none.csv",
    ]);
    assert_eq!(code(&points), 3);
}

#[test]
fn too_many_pixels_are_4() {
    let place = Place::new(BOARD);
    let output = place.render(&["--max-pixels", "2999"]);
    assert_eq!(code(&output), 4);
    assert!(
        stderr(&output).contains("--max-pixels 3000"),
        "{}",
        stderr(&output)
    );
    assert_eq!(code(&place.render(&["--max-pixels", "3000"])), 0);
}

#[test]
fn one_wrong_recipe_does_not_keep_the_others_from_rendering() {
    let place = Place::new(BOARD);
    place.write("wrong.ron", "(nodes: {})");
    let output = place.call(&["render", "wrong.ron", "recipe.ron", "--cache", "store"]);
    assert_eq!(code(&output), 2);
    assert_eq!(place.names("out"), MAPS);
}

#[test]
fn a_recipe_without_outputs_is_not_rendered() {
    let (nodes, _) = BOARD.split_once("    outputs").unwrap();
    let place = Place::new(&format!("{nodes})"));
    let output = place.render(&["--json"]);
    assert_eq!(code(&output), 2);
    assert_eq!(lines(&output).last().unwrap()["code"], "no-output");
    assert!(stderr(&place.render(&[])).contains("no output"));
}

#[test]
fn a_broken_store_is_said_and_does_no_harm() {
    let place = Place::new(BOARD);
    place.write("store", "not a folder");
    let output = place.render(&[]);
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("store of earlier results"),
        "{}",
        stderr(&output)
    );
    assert_eq!(place.names("out"), MAPS);
}

#[test]
fn check_says_what_is_wrong_and_writes_nothing() {
    let place = Place::new(BOARD);
    let clean = place.call(&["check", "recipe.ron"]);
    assert_eq!((code(&clean), stderr(&clean)), (0, String::new()));
    assert_eq!(
        stdout(&clean),
        "recipe.ron: 6 nodes, 2 outputs, nothing wrong\n"
    );
    place.write("dirty.ron", &edit("thickening", "thickning"));
    let dirty = place.call(&["check", "dirty.ron", "recipe.ron"]);
    assert_eq!(code(&dirty), 2);
    assert!(
        stderr(&dirty).contains("thickning") && stderr(&dirty).contains("dirty.ron:5"),
        "{}",
        stderr(&dirty)
    );
    assert!(stdout(&dirty).contains("recipe.ron: 6 nodes"));
    let json = lines(&place.call(&["check", "dirty.ron", "--json"]));
    assert!(
        json.iter().any(|line| line["code"] == "unknown-input"),
        "{json:?}"
    );
    assert_eq!(code(&place.call(&["check", "none.ron"])), 3);
    assert!(!place.path("out").exists());
}

#[test]
fn sample_prints_values_in_a_solid() {
    let (nodes, _) = BOARD.split_once("    outputs").unwrap();
    let place = Place::new(&format!("{nodes})"));
    let height = place.sample("wood.height", "x,y,z\n1,2,3\n-4.5,5e1,6\n");
    assert_eq!(
        (code(&height), stdout(&height)),
        (0, "x,y,z,height\n1,2,3,2.5\n-4.5,5e1,6,2.5\n".to_owned())
    );
    let time = place.sample("time.time", "x,y,z\n10,0,100\n40,0,100\n10,0,100\n");
    let text = stdout(&time);
    let values: Vec<f32> = text
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    assert!(
        text.starts_with("x,y,z,time\n") && values.len() == 3,
        "{text}"
    );
    assert!(
        values[0] > 0.0 && values[1] > values[0] && values[2] == values[0],
        "{text}"
    );
    let colour = stdout(&place.sample("look.colour", "x,y,z\n10,0,100\n"));
    assert!(
        colour.starts_with("x,y,z,colour.r,colour.g,colour.b\n"),
        "{colour}"
    );
}

#[test]
fn sample_prints_values_on_a_plane() {
    let place = Place::new(BOARD);
    let output = place.sample("plank.base_color", "u,v\n60,50\n");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    // The middle of the piece is the cut's origin.
    let [plane, solid] =
        [output, place.sample("wood.base_color", "x,y,z\n0,0,600\n")].map(|output| {
            let text = stdout(&output);
            text.lines()
                .nth(1)
                .unwrap()
                .split(',')
                .rev()
                .take(3)
                .map(str::to_owned)
                .collect::<Vec<_>>()
        });
    assert_eq!(plane, solid);
}

#[test]
fn sample_says_what_is_wrong_with_its_points_or_its_node() {
    let place = Place::new(BOARD);
    for (node, points, expected) in [
        ("time", "u,v\n1,2\n", "expected the header x,y,z, found u,v"),
        ("time", "x,y\n1,2\n", "expected the header x,y,z, found x,y"),
        (
            "plank",
            "x,y,z\n1,2,3\n",
            "expected the header u,v, found x,y,z",
        ),
        ("time", "", "expected the header x,y,z"),
        (
            "time",
            "x,y,z\n1,2,nan\n",
            "line 2: expected a finite number, found `nan`",
        ),
        (
            "time",
            "x,y,z\n1,2,3\n1,inf,3\n",
            "line 3: expected a finite number, found `inf`",
        ),
        ("time", "x,y,z\n1,two,3\n", "found `two`"),
        ("time", "x,y,z\n1,2\n", "points.csv"),
        ("tim", "x,y,z\n1,2,3\n", "`time`"),
        ("time.age", "x,y,z\n1,2,3\n", "it gives time, branch"),
        ("tree", "x,y,z\n1,2,3\n", "gives no field"),
    ] {
        let output = place.sample(node, points);
        assert_eq!(code(&output), 2, "{node}, {points:?}: {}", stderr(&output));
        assert!(
            stderr(&output).contains(expected),
            "{node}, {points:?}: {}",
            stderr(&output)
        );
        assert!(stdout(&output).is_empty(), "{node}, {points:?}");
    }
}

#[test]
fn nodes_lists_and_describes_kinds() {
    let place = Place::new(BOARD);
    let list = stdout(&place.call(&["nodes"]));
    let names: Vec<&str> = list
        .lines()
        .map(|line| line.split(' ').next().unwrap())
        .collect();
    let kinds: Vec<&str> = yosegi::nodes::KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(names, kinds);
    let growth = stdout(&place.call(&["nodes", "growth_field"]));
    for part in [
        "elongation: number in mm/year",
        "Inputs",
        "Outputs",
        "Source",
        "Example",
        "default 1",
    ] {
        assert!(growth.contains(part), "no `{part}` in\n{growth}");
    }
    for kind in kinds {
        assert_eq!(code(&place.call(&["nodes", kind])), 0, "{kind}");
    }
    let wrong = place.call(&["nodes", "growth_fild"]);
    assert_eq!(code(&wrong), 2);
    assert_eq!(
        stderr(&wrong),
        "error: there is no kind `growth_fild`; did you mean `growth_field`?\n"
    );
}

#[test]
fn nodes_gives_json() {
    let place = Place::new(BOARD);
    let all: Value = serde_json::from_str(&stdout(&place.call(&["nodes", "--json"]))).unwrap();
    let kinds = all.as_array().unwrap();
    assert_eq!(kinds.len(), yosegi::nodes::KINDS.len());
    let one: Value =
        serde_json::from_str(&stdout(&place.call(&["nodes", "slice_cut", "--json"]))).unwrap();
    assert!(kinds.contains(&one));
    let input = |name: &str| {
        one["inputs"]
            .as_array()
            .unwrap()
            .iter()
            .find(|input| input["name"] == name)
            .unwrap()
            .clone()
    };
    assert_eq!(
        (&input("cut")["default"], &input("of")["required"]),
        (&Value::from("plane"), &Value::from(true))
    );
    assert_eq!(one["outputs"][0]["domain"], "plane");
}

#[test]
fn a_call_without_a_command_is_2_and_help_is_0() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.call(&[])), 2);
    assert_eq!(code(&place.call(&["paint"])), 2);
    let help = place.call(&["--help"]);
    assert!(code(&help) == 0 && stdout(&help).contains("Exit codes"));
    assert_eq!(
        stdout(&place.call(&["--version"])),
        format!("yosegi {}\n", env!("CARGO_PKG_VERSION"))
    );
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

#[test]
fn a_reader_that_closes_the_pipe_is_no_failure() {
    let place = Place::new(BOARD);
    // More than any pipe holds.
    let points: String = (0..20_000).map(|x| format!("{x},1,2\n")).collect();
    place.write("points.csv", &format!("x,y,z\n{points}"));
    for arguments in [
        &[
            "sample",
            "recipe.ron",
            "--node",
            "time",
            "--points",
            "points.csv",
        ][..],
        &["nodes", "--json"],
        &["render", "recipe.ron", "--no-cache", "--json"],
    ] {
        let mut child = start(&place, arguments);
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            (code(&output), stderr(&output)),
            (0, String::new()),
            "{arguments:?}"
        );
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_map_and_is_130() {
    let place = Place::new(BOARD);
    let mut child = start(
        &place,
        &[
            "render",
            "recipe.ron",
            "--only",
            "board",
            "--size",
            "6000x6000",
            "--no-cache",
            "--json",
            "--threads",
            "2",
        ],
    );
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(
        lines.any(|line| line.unwrap().contains("\"progress\"")),
        "it was never under way"
    );
    let kill = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    let rest: Vec<String> = lines.map(Result::unwrap).collect();
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 130, "{}", stderr(&output));
    assert!(rest.last().unwrap().contains("\"cancelled\""), "{rest:?}");
    assert!(place.names("out").is_empty());
}
