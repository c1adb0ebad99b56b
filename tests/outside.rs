//! Recipes read nothing outside their folders, and write over nothing that they read.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use tempfile::TempDir;
use yosegi::diagnostics::{Code, Diagnostic};
use yosegi::engine::{Cancel, Engine, Options, Render, RunError};
use yosegi::graph::{Settings, load};
use yosegi::world::{Disk, PendingFile, World};

const RECIPE: &str = r#"(
    nodes: {
        "bar": sample_pattern(file: "bar.png"),
        "look": pattern_lookup(time: 0.5, pattern: "bar"),
        "wood": material(base_color: "look"),
        "board": slice_cut(of: "wood", cut: end_grain, origin: (0, 38, 900), size: (4, 4)),
    },
    outputs: { "bar": maps(of: "board", pixels_per_mm: 1, channels: [base_color]) },
)"#;

/// A folder with a recipe in `recipes/`, and a picture beside that folder.
struct Place(TempDir);

impl Place {
    fn new(recipe: &str) -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        fs::create_dir_all(place.path("recipes/inner")).unwrap();
        fs::write(place.path("recipes/a.ron"), recipe).unwrap();
        fs::copy(
            "assets/spruce_bar/spruce_bar.png",
            place.path("outside.png"),
        )
        .unwrap();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// What is wrong with a run whose maps go to `folder`.
    fn problem(&self, folder: &str, allow_outside: bool) -> Option<Diagnostic> {
        let settings = Settings {
            allow_outside,
            ..Settings::default()
        };
        let loaded = match load(&Disk, &self.path("recipes/a.ron"), &settings) {
            Ok(loaded) => loaded,
            Err(errors) => return errors.into_iter().next(),
        };
        let options = Options {
            threads: Some(1),
            store: Some(self.path("store")),
            ..Options::default()
        };
        let result = Engine::new(Arc::new(Disk), options)
            .unwrap()
            .render(&Render {
                graph: &loaded.graph,
                folder: self.path(folder),
                only: vec![],
                pixels: None,
                listener: &|_| {},
                cancel: Cancel::new(),
            });
        result.err().map(|error| match error {
            RunError::Request(mut all) | RunError::Files(mut all) => all.remove(0),
            other => panic!("{other:?}"),
        })
    }
}

fn code(problem: Option<Diagnostic>) -> Option<Code> {
    problem.map(|problem| problem.code)
}

#[test]
fn links_within_the_folder_are_followed_and_others_not() {
    let place = Place::new(RECIPE);
    let link = place.path("recipes/bar.png");
    fs::copy(
        place.path("outside.png"),
        place.path("recipes/inner/real.png"),
    )
    .unwrap();
    symlink("inner/real.png", &link).unwrap();
    assert_eq!(place.problem("out", false), None);
    fs::remove_file(&link).unwrap();
    symlink("../outside.png", &link).unwrap();
    let existing = place.problem("out", false).unwrap();
    assert_eq!(existing.code, Code::FileNotRead);
    fs::remove_file(&link).unwrap();
    symlink("../nothing.png", &link).unwrap();
    let missing = place.problem("out", false).unwrap();
    assert_eq!(existing, missing, "nothing is learnt about other folders");
    // A folder that is a link leads outside as well.
    fs::remove_file(&link).unwrap();
    symlink("..", place.path("recipes/up")).unwrap();
    fs::write(
        place.path("recipes/a.ron"),
        RECIPE.replace("bar.png", "up/outside.png"),
    )
    .unwrap();
    assert_eq!(code(place.problem("out", false)), Some(Code::FileNotRead));
    assert_eq!(place.problem("out", true), None);
}

#[test]
fn a_link_to_itself_is_an_error() {
    let place = Place::new(RECIPE);
    symlink("bar.png", place.path("recipes/bar.png")).unwrap();
    assert_eq!(code(place.problem("out", false)), Some(Code::FileNotRead));
}

#[test]
fn paths_outside_are_refused_unless_they_are_allowed() {
    for path in ["../outside.png", "FOLDER/outside.png"] {
        let place = Place::new("");
        let absolute = place.0.path().to_str().unwrap();
        let recipe = RECIPE.replace("bar.png", &path.replace("FOLDER", absolute));
        fs::write(place.path("recipes/a.ron"), recipe).unwrap();
        let existing = place.problem("out", false).unwrap();
        assert_eq!(existing.code, Code::PathOutside);
        assert_eq!(place.problem("out", true), None);
        fs::remove_file(place.path("outside.png")).unwrap();
        assert_eq!(place.problem("out", false).unwrap(), existing);
        assert_eq!(code(place.problem("out", true)), Some(Code::FileNotRead));
    }
}

#[test]
fn a_recipe_may_be_a_link_to_elsewhere() {
    let place = Place::new(RECIPE);
    fs::copy(place.path("outside.png"), place.path("recipes/bar.png")).unwrap();
    fs::rename(place.path("recipes/a.ron"), place.path("real.ron")).unwrap();
    symlink("../real.ron", place.path("recipes/a.ron")).unwrap();
    assert_eq!(place.problem("out", false), None);
}

fn contents(path: &Path) -> Vec<u8> {
    fs::read(path).unwrap()
}

#[test]
fn a_map_never_replaces_what_is_read() {
    let place = Place::new(&RECIPE.replace("bar.png", "bar_base_color.png"));
    let photo = place.path("recipes/bar_base_color.png");
    fs::copy(place.path("outside.png"), &photo).unwrap();
    let before = contents(&photo);
    let over_input = Some(Code::OutputOverInput);
    assert_eq!(code(place.problem("recipes", false)), over_input);
    // Behind a link, and when all maps are known already.
    symlink("recipes", place.path("linked")).unwrap();
    assert_eq!(code(place.problem("linked", false)), over_input);
    assert_eq!(place.problem("out", false), None);
    assert_eq!(code(place.problem("recipes", false)), over_input);
    assert_eq!(code(place.problem("store", false)), over_input);
    assert_eq!(code(place.problem("store/plan", false)), over_input);
    assert_eq!(contents(&photo), before);
    // A map that is a link to the recipe.
    let recipe = contents(&place.path("recipes/a.ron"));
    fs::remove_file(place.path("out/bar_base_color.png")).unwrap();
    symlink("../recipes/a.ron", place.path("out/bar_base_color.png")).unwrap();
    assert_eq!(code(place.problem("out", false)), over_input);
    assert_eq!(contents(&place.path("recipes/a.ron")), recipe);
}

/// A disk that counts how often each file is read, and may cut pictures short.
#[derive(Default)]
struct Counting {
    reads: Mutex<BTreeMap<PathBuf, usize>>,
    shortest: Option<usize>,
}

impl World for Counting {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let mut reads = self.reads.lock().unwrap();
        *reads.entry(path.to_owned()).or_default() += 1;
        let mut bytes = Disk.read(path)?;
        bytes.truncate(self.shortest.unwrap_or(bytes.len()));
        Ok(bytes)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        Disk.create(path)
    }
}

fn render_in(world: Arc<Counting>, place: &Place) -> Result<usize, RunError> {
    let loaded = load(&Disk, &place.path("recipes/a.ron"), &Settings::default()).unwrap();
    let rendered = Engine::new(world, Options::default())
        .unwrap()
        .render(&Render {
            graph: &loaded.graph,
            folder: place.path("out"),
            only: vec![],
            pixels: None,
            listener: &|_| {},
            cancel: Cancel::new(),
        });
    rendered.map(|maps| maps.len())
}

/// What is hashed is what is decoded: a file that is swapped in between cannot be taken for the other.
#[test]
fn every_file_is_read_once() {
    let place = Place::new(RECIPE);
    fs::copy(place.path("outside.png"), place.path("recipes/bar.png")).unwrap();
    let world = Arc::new(Counting::default());
    assert_eq!(render_in(Arc::clone(&world), &place).unwrap(), 1);
    let reads = world.reads.lock().unwrap();
    assert_eq!(reads.get(&place.path("recipes/bar.png")), Some(&1));
    assert!(reads.values().all(|count| *count == 1), "{reads:?}");
}

/// A picture that is cut short while it is read fails its node, and the old map stays.
#[test]
fn a_file_cut_short_fails_its_node() {
    let place = Place::new(RECIPE);
    fs::copy(place.path("outside.png"), place.path("recipes/bar.png")).unwrap();
    render_in(Arc::new(Counting::default()), &place).unwrap();
    let before = contents(&place.path("out/bar_base_color.png"));
    for shortest in [0, 1, 8, 30, 100, 2000] {
        let world = Counting {
            shortest: Some(shortest),
            ..Counting::default()
        };
        let Err(RunError::Nodes(problems)) = render_in(Arc::new(world), &place) else {
            panic!("a picture of {shortest} bytes is read");
        };
        assert_eq!(problems[0].node.as_deref(), Some("bar"));
        assert_eq!(contents(&place.path("out/bar_base_color.png")), before);
    }
}

#[test]
fn the_item_of_a_list_is_blamed() {
    let recipe = RECIPE.replace(
        "\"bar\": sample_pattern(file: \"bar.png\"),",
        "\"tree\": skeleton(trunk: [(0, 0, 0), (0, 0, 900)], branches: [(at: 1, direction: (1, 0, 0), \
         thickening: 1), (at: 950, direction: (1, 0, 0), thickening: 1)]),",
    );
    let recipe = recipe.replace(
        "pattern_lookup(time: 0.5, pattern: \"bar\")",
        "growth_field(skeleton: \"tree\", elongation: 400, thickening: 2)",
    );
    let recipe = recipe.replace(
        "base_color: \"look\"",
        "base_color: (0, 0, 0), opacity: \"look.branch\"",
    );
    let place = Place::new(&recipe);
    let Err(RunError::Nodes(problems)) = render_in(Arc::default(), &place) else {
        panic!("the second branch leaves the trunk");
    };
    let label = problems[0].label.as_ref().unwrap();
    assert!(
        recipe[label.span.clone()].starts_with("(at: 950"),
        "{:?}",
        problems[0]
    );
}
