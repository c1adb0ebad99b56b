//! Keeps the house in order: what the documents name exists, and every source file says what it is.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use yosegi::graph::{Settings, load};
use yosegi::nodes::KINDS;
use yosegi::world::Disk;

const LONGEST_FILE: usize = 400;

/// The folders of the project that hold what people write.
const FOLDERS: [&str; 8] = [
    "src", "tests", "examples", "benches", "graphs", "assets", "docs", ".ci",
];

/// Extensions of files that documents speak of.
const EXTENSIONS: [&str; 9] = [
    ".rs", ".md", ".ron", ".toml", ".png", ".exr", ".json", ".csv", ".txt",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files below `folder` whose names end in `extension`, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    let mut pending = vec![folder.to_owned()];
    while let Some(folder) = pending.pop() {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        for entry in entries {
            let path = entry.expect("the folder can be listed").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn rust_files() -> Vec<PathBuf> {
    ["src", "tests", "examples", "benches"]
        .iter()
        .flat_map(|folder| files(&root().join(folder), "rs"))
        .collect()
}

/// The documents, with the path each is called in messages.
fn documents() -> Vec<PathBuf> {
    let mut documents: Vec<PathBuf> = fs::read_dir(root())
        .expect("the project can be listed")
        .map(|entry| entry.expect("the project can be listed").path())
        .filter(|path| path.extension().is_some_and(|found| found == "md"))
        .collect();
    for folder in ["docs", "assets", "tests", "graphs"] {
        documents.extend(files(&root().join(folder), "md"));
    }
    documents.sort();
    documents
}

fn none(problems: &[String]) {
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root())
        .unwrap_or(path)
        .display()
        .to_string()
}

#[test]
fn source_files_say_what_they_are_and_are_short() {
    let mut problems = vec![];
    for path in rust_files() {
        let text = read(&path);
        let name = shown(&path);
        if !text.starts_with("//! ") {
            problems.push(format!("{name}: begin with `//!` and a sentence"));
        }
        let lines = text.lines().count();
        if name.starts_with("src") && lines > LONGEST_FILE {
            problems.push(format!("{name}: {lines} lines; divide it"));
        }
    }
    none(&problems);
}

#[test]
fn nothing_is_left_over() {
    // Written apart, so that this file does not find itself.
    let leftovers = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("dbg", "!("),
    ];
    let mut problems = vec![];
    for path in rust_files() {
        for (number, line) in read(&path).lines().enumerate() {
            for leftover in leftovers
                .iter()
                .filter(|leftover| line.contains(**leftover))
            {
                problems.push(format!("{}:{}: {leftover}", shown(&path), number + 1));
            }
        }
    }
    none(&problems);
}

/// What stands between single backticks on a line, outside fenced blocks.
fn quoted(text: &str) -> Vec<&str> {
    let mut is_fenced = false;
    let mut quoted = vec![];
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_fenced = !is_fenced;
        } else if !is_fenced {
            quoted.extend(line.split('`').skip(1).step_by(2));
        }
    }
    quoted
}

/// Targets of links and pictures, `[text](target)`, that are not addresses.
fn linked(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1);
    targets
        .filter_map(|rest| rest.split(')').next())
        .map(|target| target.split('#').next().unwrap_or_default())
        .filter(|target| !target.is_empty() && !target.contains("://"))
        .collect()
}

/// Whether a quoted word is meant as a path of this project.
fn is_path(word: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let in_folder = FOLDERS.iter().any(|folder| {
        word.strip_prefix(folder)
            .is_some_and(|rest| rest.starts_with('/'))
    });
    let is_document = !word.contains('/') && word.ends_with(".md");
    let is_elsewhere = word.contains('/') && EXTENSIONS.iter().any(|end| word.ends_with(end));
    word.chars().all(plain)
        && (in_folder || is_document || is_elsewhere && !word.starts_with("out/"))
}

#[test]
fn paths_in_documents_exist() {
    let mut problems = vec![];
    for document in documents() {
        let text = read(&document);
        let folder = document.parent().unwrap();
        for word in quoted(&text).into_iter().filter(|word| is_path(word)) {
            // As in recipes: from the project, beside the document, or from the assets.
            let places = [
                root().join(word),
                folder.join(word),
                root().join("assets").join(word),
            ];
            if !places.iter().any(|place| place.exists()) {
                problems.push(format!("{}: no `{word}`", shown(&document)));
            }
        }
        for target in linked(&text) {
            if !folder.join(target).exists() {
                problems.push(format!("{}: link to no `{target}`", shown(&document)));
            }
        }
    }
    none(&problems);
}

#[test]
fn the_readme_names_every_kind() {
    let readme = read(&root().join("README.md"));
    let named: BTreeSet<&str> = quoted(&readme).into_iter().collect();
    let missing: Vec<String> = KINDS
        .iter()
        .filter(|kind| !named.contains(kind.name))
        .map(|kind| format!("README.md: the kind `{}` is not named", kind.name))
        .collect();
    none(&missing);
}

#[test]
fn recipes_load_without_a_word_and_say_what_they_are_for() {
    let mut recipes = files(&root().join("graphs"), "ron");
    recipes.extend(files(&root().join("docs"), "ron"));
    assert!(recipes.len() > 1);
    let mut problems = vec![];
    for path in recipes {
        match load(&Disk, &path, &Settings::default()) {
            Ok(loaded) => {
                let messages = loaded.warnings.iter().map(|warning| &warning.message);
                problems.extend(messages.map(|message| format!("{}: {message}", shown(&path))));
                if loaded.graph.about.is_empty() {
                    problems.push(format!("{}: `about` is empty", shown(&path)));
                }
            }
            Err(errors) => problems.push(yosegi::diagnostics::render_all(&errors)),
        }
    }
    none(&problems);
}

#[test]
fn the_first_recipe_of_the_readme_is_the_one_that_is_checked() {
    let recipe = read(&root().join("docs/first_board.ron"));
    assert!(read(&root().join("README.md")).contains(recipe.trim_end()));
}

#[test]
fn the_test_command_of_the_readme_is_the_one_that_is_checked() {
    let (readme, check) = (
        read(&root().join("README.md")),
        read(&root().join(".ci/run")),
    );
    for command in [
        "cargo test",
        "cargo run --release -- render graphs/spruce_log_board.ron",
    ] {
        assert!(
            readme.lines().any(|line| line.trim() == command),
            "README.md: {command}"
        );
        assert!(check.contains(command), ".ci/run: {command}");
    }
}

#[test]
fn pictures_of_the_documents_are_small() {
    for path in files(&root().join("docs"), "png") {
        let bytes = fs::metadata(&path).unwrap().len();
        assert!(bytes < 150_000, "{}: {bytes} bytes", shown(&path));
    }
}
