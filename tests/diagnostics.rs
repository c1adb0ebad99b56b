//! Every mistake a recipe can have, against the text that the author is shown.
//!
//! `tests/diagnostics/NAME.ron` gives `NAME.txt`; `YOSEGI_BLESS=1` writes the texts anew. A first line
//! `// set: name=value` sets a parameter, and `// render` asks for an output.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use yosegi::diagnostics::{Code, Diagnostic, render_all, render_json};
use yosegi::graph::{Settings, load, no_output};
use yosegi::world::Disk;

const FOLDER: &str = "tests/diagnostics";

/// Codes that no file of reasonable size in this folder can cause, and the tests that cause them.
const ELSEWHERE: [(Code, &str); 8] = [
    (Code::OutputOverInput, "tests/outside.rs"),
    (Code::CacheMismatch, "tests/store/verify.rs"),
    (Code::InvalidEdit, "tests/edit.rs"),
    (Code::FileNotRead, "tests/diagnostics_limits.rs"),
    (Code::TooLarge, "tests/diagnostics_limits.rs"),
    (Code::NodeFailed, "tests/events/ends.rs"),
    (Code::TooMuch, "tests/events/ends.rs"),
    (Code::OutputNotWritten, "tests/events/faults.rs"),
];

fn recipes() -> Vec<PathBuf> {
    let entries = fs::read_dir(FOLDER)
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    let names = entries.map(|name| name.into_string().unwrap());
    let mut recipes: Vec<_> = names
        .filter(|name| name.ends_with(".ron"))
        .map(|name| PathBuf::from(format!("{FOLDER}/{name}")))
        .collect();
    recipes.sort();
    recipes
}

fn first_line(path: &Path) -> String {
    let text = String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned();
    text.lines().next().unwrap_or_default().to_owned()
}

fn diagnostics(path: &Path) -> Vec<Diagnostic> {
    let line = first_line(path);
    let set = line
        .strip_prefix("// set: ")
        .and_then(|set| set.split_once('='));
    let set = set.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let settings = Settings {
        set: set.into_iter().collect(),
        ..Settings::default()
    };
    match load(&Disk, path, &settings) {
        Err(diagnostics) => diagnostics,
        Ok(loaded) if line == "// render" && loaded.graph.outputs.is_empty() => {
            vec![no_output(&loaded.graph)]
        }
        Ok(loaded) => loaded.warnings,
    }
}

fn compare(golden: &Path, found: &str) -> Result<(), String> {
    if std::env::var_os("YOSEGI_BLESS").is_some() {
        fs::write(golden, found).unwrap();
    }
    let expected = fs::read_to_string(golden).unwrap_or_default();
    if expected == found {
        return Ok(());
    }
    Err(format!(
        "{}\n--- expected\n{expected}\n--- found\n{found}",
        golden.display()
    ))
}

#[test]
fn every_recipe_gives_its_text() {
    let compared = recipes().into_iter().map(|path| {
        let diagnostics = diagnostics(&path);
        assert!(!diagnostics.is_empty(), "{} has no mistake", path.display());
        compare(&path.with_extension("txt"), &render_all(&diagnostics))
    });
    let failures: Vec<_> = compared.filter_map(Result::err).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn json_has_every_field() {
    let names = [
        "unit_mismatch_link",
        "unknown_kind_typo",
        "unclosed_truncated",
        "not_text_utf16",
    ];
    let lines = names.iter().flat_map(|name| {
        diagnostics(Path::new(&format!("{FOLDER}/{name}.ron")))
            .iter()
            .map(|diagnostic| render_json(diagnostic) + "\n")
            .collect::<Vec<_>>()
    });
    compare(
        Path::new(&format!("{FOLDER}/json.jsonl")),
        &lines.collect::<String>(),
    )
    .unwrap();
}

#[test]
fn every_code_has_two_recipes() {
    let mut counts: BTreeMap<Code, usize> = BTreeMap::new();
    for path in recipes() {
        let mut codes: Vec<_> = diagnostics(&path).iter().map(|one| one.code).collect();
        codes.sort();
        codes.dedup();
        codes
            .into_iter()
            .for_each(|code| *counts.entry(code).or_default() += 1);
    }
    let is_elsewhere = |code: &Code| ELSEWHERE.iter().any(|(other, _)| other == code);
    let few: Vec<_> = Code::ALL
        .iter()
        .filter(|code| !is_elsewhere(code) && counts.get(code).copied().unwrap_or(0) < 2)
        .collect();
    assert!(few.is_empty(), "codes with fewer than two recipes: {few:?}");
}

#[test]
fn every_text_belongs_to_a_recipe() {
    let names: Vec<_> = recipes()
        .iter()
        .map(|path| path.with_extension("txt"))
        .collect();
    for entry in fs::read_dir(FOLDER).unwrap() {
        let path = PathBuf::from(FOLDER).join(entry.unwrap().file_name());
        let is_text = path.extension().is_some_and(|extension| extension == "txt");
        assert!(
            !is_text || names.contains(&path),
            "{} has no recipe",
            path.display()
        );
    }
}
