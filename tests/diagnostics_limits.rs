//! What no recipe can do to the reader: crash it, stop it, or fill the memory.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fmt::Write;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};
use yosegi::diagnostics::{Code, Diagnostic, render_all, render_json};
use yosegi::graph::{Loaded, Settings, load, load_text, load_text_with};
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::nodes::KINDS;
use yosegi::value::{Domain, Type, Unit, Value};
use yosegi::world::{Disk, PendingFile, World};

const RECIPE: &str = r##"(
    about: "ä \u{e4} \"quoted\"", seed: 1,
    parameters: { "w": number(default: 2.4, range: (0.5, 8.0), unit: "mm/year") },
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (12, 4, 9e2)], /* c */ branches: [(at: 1, direction: (1, 0, 0))]),
        "time": growth_field(skeleton: "tree", elongation: 420, thickening: "$w"), // d
        "bar": colour_pattern(stops: [(at: 0, colour: r#"#ffffff"#), (at: 1, colour: (0, 0, 1))]),
        "look": pattern_lookup(time: "time", pattern: "bar"),
        "wood": material(base_color: "look", height: "= 2 * (look.position - 1)", extras: { "t": "time" }),
        "board": slice_cut(of: "wood", origin: (0, 38, 900), size: (140, 900)),
    },
    outputs: { "board": maps(of: "board", channels: [base_color]) },
)"##;

fn load_plain(text: impl Into<String>) -> Result<Loaded, Vec<Diagnostic>> {
    load_text("a.ron", text, &Settings::default())
}

fn errors(text: impl Into<String>) -> Vec<Diagnostic> {
    load_plain(text).expect_err("the recipe is wrong")
}

/// Reads on the stack of a small thread, as a worker would.
fn errors_on_small_stack(text: String) -> Vec<Diagnostic> {
    let thread = std::thread::Builder::new()
        .stack_size(512 << 10)
        .spawn(move || errors(text));
    thread.unwrap().join().expect("reading does not panic")
}

/// Loads, and prints whatever is wrong in every way.
fn survive(text: &str) {
    if let Err(diagnostics) = load_plain(text) {
        assert!(!render_all(&diagnostics).is_empty());
        let lines: Vec<_> = diagnostics.iter().map(render_json).collect();
        assert!(lines.iter().all(|line| !line.contains('\n')));
    }
}

#[test]
fn every_beginning_of_a_recipe_is_read() {
    assert!(
        load_plain(RECIPE).is_ok(),
        "{}",
        render_all(&errors(RECIPE))
    );
    for end in (0..RECIPE.len()).filter(|end| RECIPE.is_char_boundary(*end)) {
        assert!(load_plain(&RECIPE[..end]).is_err(), "{}", &RECIPE[..end]);
        survive(&RECIPE[..end]);
    }
}

#[test]
fn every_beginning_of_every_gallery_recipe_is_read() {
    for recipe in ["bent_trunk", "spruce_log_board", "straight_trunk"] {
        let text = std::fs::read_to_string(format!("graphs/{recipe}.ron")).unwrap();
        let whole = text.trim_end().len();
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            assert_eq!(
                load_plain(&text[..end]).is_ok(),
                end >= whole,
                "{}",
                &text[..end]
            );
            survive(&text[..end]);
        }
    }
}

#[test]
fn small_numbers_and_minus_zero_count_as_what_they_are() {
    let text = |number: &str| {
        format!("(nodes: {{ \"w\": material(base_color: (0, 0, 0), roughness: {number}) }})")
    };
    for number in [
        "1e-999",
        "-0.0",
        "4.9e-324",
        "-1e-999",
        "2.2250738585072011e-308",
    ] {
        assert!(load_plain(text(number)).is_ok(), "{number}");
    }
}

#[test]
fn mutated_recipes_are_read() {
    let mut seed = 1_u64;
    let mut draw = |end: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as usize % end
    };
    let pieces = [
        "(", ")", "[", "]", "{", "}", "\"", "\\", ",", ":", "$", "=", "#", "/*", "\u{202e}",
    ];
    for _ in 0..4000 {
        let mut letters: Vec<char> = RECIPE.chars().collect();
        for _ in 0..1 + draw(4) {
            let at = draw(letters.len());
            match draw(4) {
                0 => letters[at] = pieces[draw(pieces.len())].chars().next().unwrap(),
                1 => letters.insert(at, letters[draw(letters.len())]),
                2 => letters.truncate(at.max(1)),
                _ => drop(letters.splice(at..at, pieces[draw(pieces.len())].chars())),
            }
        }
        survive(&letters.into_iter().collect::<String>());
    }
}

#[test]
fn a_million_of_anything_is_refused_soon() {
    let many = |text: &str| text.repeat(1_000_000);
    let recipe = |value: String| format!("(nodes: {{ \"a\": skeleton(trunk: {value}) }})");
    let start = Instant::now();
    for (text, code) in [
        (many("["), Code::NestedTooDeep),
        (many("("), Code::NestedTooDeep),
        (many("{"), Code::NestedTooDeep),
        (many("Some("), Code::NestedTooDeep),
        (many("{\"a\":"), Code::NestedTooDeep),
        (many("/*"), Code::Unclosed),
        (format!("r{}\"text", many("#")), Code::Unclosed),
        (format!("\"{}", many("\\u")), Code::Unclosed),
        (format!("[{}]", "1,".repeat(4_000_001)), Code::TooLarge),
        (many("\"\""), Code::Syntax),
        (many("\"a\"b"), Code::Syntax),
        (many("\"a\n\"b"), Code::Unclosed),
        (many("\"a\\\"\n"), Code::Unclosed),
        (many("r#\"a\n"), Code::Unclosed),
        (many("(\n"), Code::NestedTooDeep),
        (format!("({{{}", many("\"a\": b(\n")), Code::Unclosed),
        (format!("({{{}", many("\"a\": b())")), Code::Unclosed),
        (format!("({{{}", many("\"a\": b()]\n")), Code::Syntax),
        (many(")"), Code::Syntax),
        (many(";"), Code::Syntax),
        (many(", "), Code::Syntax),
        (many("; "), Code::Syntax),
        (recipe(many("9")), Code::TypeMismatch),
        (recipe(format!("[({}, 0, 0)]", many("9"))), Code::NotFinite),
        (recipe(format!("\"{}\"", many("a"))), Code::UnknownNode),
        (recipe(format!("\"= {}\"", many("("))), Code::TypeMismatch),
        (
            format!(
                "(nodes: {{ \"a\": material(height: \"= {}\") }})",
                many("-(")
            ),
            Code::NestedTooDeep,
        ),
    ] {
        let diagnostics = errors_on_small_stack(text);
        assert!(
            diagnostics.iter().any(|one| one.code == code),
            "{}",
            render_all(&diagnostics)
        );
        assert!(render_all(&diagnostics).len() < 40_000);
    }
    assert!(
        start.elapsed() < Duration::from_secs(60),
        "{:?}",
        start.elapsed()
    );
}

#[test]
fn a_thousand_mistakes_are_found_and_twenty_printed() {
    let nodes: String = (0..1000).fold(String::new(), |mut text, index| {
        writeln!(text, "\"n{index}\": materail(),").unwrap();
        text
    });
    let diagnostics = errors(format!("(nodes: {{\n{nodes}}})"));
    assert_eq!(diagnostics.len(), 1000);
    let text = render_all(&diagnostics);
    assert_eq!(text.matches("error[unknown-kind]").count(), 20);
    assert!(text.ends_with("1000 errors; the first 20 are shown\n"));
    let lines: Vec<_> = diagnostics
        .iter()
        .map(|one| one.label.as_ref().unwrap().span.start)
        .collect();
    assert!(
        lines.is_sorted(),
        "diagnostics are in the order of the file"
    );
}

#[test]
fn mistakes_beyond_two_thousand_are_left_out() {
    let diagnostics = errors(format!("(nodes: {{ {} }})", "\"a\": b(),".repeat(5000)));
    assert_eq!(diagnostics.len(), 2001);
    assert_eq!(diagnostics[0].code, Code::TooLarge);
}

/// A chain of mixes: each reads the one before.
fn chain(length: usize, first: &str) -> String {
    let mut text =
        format!("(nodes: {{ \"n0\": mix(a: \"{first}\", b: \"#c8a06e\", amount: 0.5),\n");
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: 0.5),"
        )
        .unwrap();
    }
    text + "})"
}

#[test]
fn long_chains_load() {
    let start = Instant::now();
    let loaded = load_plain(chain(100_000, "#5b3a1e")).expect("the chain is right");
    assert_eq!(loaded.graph.nodes.edge_count(), 99_999);
    assert!(
        start.elapsed() < Duration::from_secs(30),
        "{:?}",
        start.elapsed()
    );
}

#[test]
fn long_circles_are_cut_to_ten_names() {
    let diagnostics = errors(chain(100_000, "n99999"));
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(diagnostics[0].code, Code::Cycle);
    let message = &diagnostics[0].message;
    assert_eq!(message.matches("->").count(), 11, "{message}");
    assert!(message.contains("(100000 nodes in all)"), "{message}");
}

#[test]
fn a_node_with_many_links_loads() {
    let mut text = String::from("(nodes: {\n");
    for index in 0..20_000 {
        writeln!(
            text,
            "\"m{index}\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),"
        )
        .unwrap();
    }
    text += "\"all\": material(base_color: \"m0\", extras: {";
    (0..20_000).for_each(|index| write!(text, "\"c{index}\": \"m{index}\",").unwrap());
    let loaded = load_plain(text + "}) })").expect("the recipe is right");
    assert_eq!(loaded.graph.nodes.edge_count(), 20_000);
}

/// Files that cannot or need not be on a disk.
struct Given(io::Result<Vec<u8>>);

impl World for Given {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        match &self.0 {
            Ok(bytes) => Ok(bytes.clone()),
            Err(error) => Err(error.kind().into()),
        }
    }

    fn create(&self, _: &Path) -> io::Result<Box<dyn PendingFile>> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

fn read_error(world: &dyn World, path: &str) -> Diagnostic {
    load(world, path.as_ref(), &Settings::default())
        .expect_err("the file is wrong")
        .remove(0)
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let missing = read_error(&Disk, "tests/diagnostics/missing/none.ron");
    let folder = read_error(&Disk, "tests");
    let denied = read_error(&Given(Err(io::ErrorKind::PermissionDenied.into())), "a.ron");
    for (diagnostic, path) in [(missing, "none.ron"), (folder, "tests"), (denied, "a.ron")] {
        assert_eq!(diagnostic.code, Code::FileNotRead);
        assert!(diagnostic.message.contains(path), "{}", diagnostic.message);
    }
}

/// What never ends, or is no file at all, is refused at once.
#[cfg(unix)]
#[test]
fn devices_pipes_and_sockets_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.ron");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let socket = folder.path().join("socket.ron");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let start = Instant::now();
    for path in [
        Path::new("/dev/zero"),
        Path::new("/dev/null"),
        &pipe,
        &socket,
        folder.path(),
    ] {
        let problem = read_error(&Disk, path.to_str().unwrap());
        assert_eq!(problem.code, Code::FileNotRead, "{}", path.display());
        assert!(
            problem.message.ends_with("not a regular file"),
            "{}",
            problem.message
        );
    }
    assert!(start.elapsed() < Duration::from_secs(5));
}

/// A file of 100 MB, most of it a hole, is refused by its first 16 MiB.
#[test]
fn a_large_file_is_refused_soon() {
    let file = tempfile::NamedTempFile::new().unwrap();
    file.as_file().set_len(100_000_000).unwrap();
    let start = Instant::now();
    let problem = read_error(&Disk, file.path().to_str().unwrap());
    assert_eq!(problem.code, Code::TooLarge);
    assert!(start.elapsed() < Duration::from_secs(5));
}

#[test]
fn long_lines_are_cut_in_messages() {
    let text = format!("(nodes: {{ \"a\": {} }})", "x".repeat(10_000_000));
    let diagnostics = errors(text);
    let shown = render_all(&diagnostics);
    assert!(
        shown.lines().all(|line| line.chars().count() <= 200),
        "{shown}"
    );
    let json = render_json(&diagnostics[0]);
    assert!(json.len() < 1000, "{} bytes", json.len());
}

#[test]
fn files_over_the_limit_are_refused() {
    let limit = 16 << 20;
    let world = |bytes: usize| Given(Ok(vec![b' '; bytes]));
    assert_eq!(read_error(&world(limit), "a.ron").code, Code::NotARecipe);
    assert_eq!(read_error(&world(limit + 1), "a.ron").code, Code::TooLarge);
    assert_eq!(errors(" ".repeat(limit + 1))[0].code, Code::TooLarge);
}

fn nothing(_: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    Err(Failure::new("these kinds are only checked"))
}

static PLANE: Kind = Kind {
    name: "plane",
    version: 1,
    about: "A plane field.",
    source: "test",
    inputs: &[],
    outputs: &[Output::field("u", Type::Number(Unit::One), "").on(Domain::Plane)],
    example: "",
    build: nothing,
};

static SUM: Kind = Kind {
    name: "sum",
    version: 1,
    about: "Takes fields of any domain.",
    source: "test",
    inputs: &[
        Input::number("a", Unit::One, "").per_point(),
        Input::number("b", Unit::One, "").per_point(),
        Input::number("solid", Unit::One, "")
            .per_point()
            .of(Domain::Solid)
            .default("0"),
    ],
    outputs: &[Output::field("sum", Type::Number(Unit::One), "")],
    example: "",
    build: nothing,
};

fn with_plane_fields(nodes: &str) -> Result<Loaded, Vec<Diagnostic>> {
    let kinds: Vec<_> = KINDS.iter().copied().chain([&PLANE, &SUM]).collect();
    let text = format!(
        "(nodes: {{
            \"tree\": skeleton(trunk: [(0, 0, 0), (12, 4, 900)]),
            \"time\": growth_field(skeleton: \"tree\", elongation: 420, thickening: 2.4),
            \"flat\": plane(),
            {nodes}
        }})"
    );
    load_text_with(&kinds, "a.ron", text, &Settings::default())
}

fn code_of(nodes: &str) -> Option<Code> {
    with_plane_fields(nodes).err().map(|diagnostics| {
        assert_eq!(diagnostics.len(), 1, "{}", render_all(&diagnostics));
        diagnostics[0].code
    })
}

#[test]
fn solids_and_planes_do_not_mix() {
    let mixed = Some(Code::MixedDomains);
    assert_eq!(
        code_of("\"s\": sum(a: \"flat\", b: \"time.branch\"),"),
        mixed
    );
    assert_eq!(
        code_of("\"s\": sum(a: \"= flat * time.branch\", b: 1),"),
        mixed
    );
    assert_eq!(
        code_of("\"s\": sum(a: \"flat\", b: 0, solid: \"time.branch\"),"),
        mixed
    );
    let extras =
        "\"w\": material(base_color: (1, 1, 1), extras: { \"f\": \"flat\", \"t\": \"time\" }),";
    assert_eq!(code_of(extras), mixed);
    assert_eq!(
        code_of("\"s\": sum(a: 1, b: 0, solid: \"flat\"),"),
        Some(Code::WrongDomain)
    );
    assert_eq!(
        code_of("\"s\": sum(a: \"time.branch\", b: 0, solid: \"s2\"), \"s2\": sum(a: 1, b: 2),"),
        None
    );
}

#[test]
fn a_wrong_node_is_not_blamed_twice() {
    let nodes = "\"s\": sum(a: \"flat\", b: \"time.branch\"), \"t\": sum(a: \"s\", b: \"flat\"),";
    assert_eq!(code_of(nodes), Some(Code::MixedDomains));
    let nodes = "\"s\": smu(a: 1), \"t\": sum(a: \"s.none\", b: \"s\"),";
    assert_eq!(code_of(nodes), Some(Code::UnknownKind));
}
