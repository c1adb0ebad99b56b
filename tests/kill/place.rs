//! A recipe with its maps and its store, and what a program that was killed may leave of them.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// Files of three types, so that each is written in its own way.
const RECIPE: &str = r##"(
    parameters: { "hue": number(default: 0, range: (0, 1), unit: "1", about: "Which of the variants") },
    nodes: {
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: "= 2 + $hue"),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look", height: "= 0.05 * look.position"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "first": maps(of: "plank", pixels: (120, 100), channels: [base_color, normal]),
        "second": maps(of: "plank", pixels: (60, 50), channels: [base_color], format: exr_half),
        "third": maps(of: "plank", pixels: (60, 50), channels: [base_color], format: tiff16),
    },
)"##;

/// Values of the parameter.
pub(crate) const VARIANTS: [&str; 4] = ["0", "0.25", "0.5", "1"];

type Maps = BTreeMap<String, Vec<u8>>;

/// A folder with the recipe, its maps and its store, and what the maps of every variant have to be.
pub(crate) struct Place {
    home: TempDir,
    right: Vec<Maps>,
}

/// What the kills have met.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) kills: u64,
    /// Kills after which a map was half-written.
    pub(crate) in_outputs: u64,
    /// Kills after which an entry of the store was half-written.
    pub(crate) in_store: u64,
    /// Runs that were quicker than the kill.
    pub(crate) late: u64,
    /// Kills that left maps of several variants.
    between: u64,
}

impl Place {
    /// A place with maps of the last variant, rendered without a store.
    pub(crate) fn new() -> Place {
        let mut place = Place {
            home: tempfile::tempdir().unwrap(),
            right: vec![],
        };
        place.save(0);
        for variant in 0..VARIANTS.len() {
            let mut render = place.command("render");
            render.args(["--no-cache", "--set", &setting(variant)]);
            assert!(render.status().unwrap().success());
            let maps = place.maps();
            maps.iter()
                .for_each(|(name, bytes)| assert_whole(name, bytes));
            assert!(maps.len() == 4 && !place.right.contains(&maps));
            place.right.push(maps);
        }
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    fn command(&self, command: &str) -> Command {
        let mut yosegi = Command::new(env!("CARGO_BIN_EXE_yosegi"));
        yosegi.args([command, "recipe.ron", "--threads", "2"]);
        yosegi.current_dir(self.home.path()).stdin(Stdio::null());
        yosegi.stdout(Stdio::null()).stderr(Stdio::null());
        yosegi
    }

    /// A render of a variant with the store.
    pub(crate) fn render(&self, variant: usize) -> Command {
        let mut render = self.command("render");
        render.args(["--cache", "store", "--set", &setting(variant)]);
        render
    }

    /// A watch with the store.
    pub(crate) fn watch(&self) -> Command {
        let mut watch = self.command("watch");
        watch.args(["--cache", "store", "--preview"]);
        watch
    }

    /// Saves the recipe as a variant, in one piece.
    pub(crate) fn save(&self, variant: usize) {
        let default = format!("default: {}", VARIANTS[variant]);
        let text = RECIPE.replace("default: 0", &default);
        fs::write(self.path("recipe.new"), text).unwrap();
        fs::rename(self.path("recipe.new"), self.path("recipe.ron")).unwrap();
    }

    /// The maps that are in place.
    pub(crate) fn maps(&self) -> Maps {
        let mut maps = self.finished();
        maps.retain(|name, _| !name.ends_with(".preview.png"));
        maps
    }

    /// Maps and small pictures.
    fn finished(&self) -> Maps {
        let files = files(&self.path("out"));
        let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
        let finished = files.iter().filter(|path| !is_unfinished(path));
        finished
            .map(|path| (name(path), fs::read(path).unwrap()))
            .collect()
    }

    /// How many unfinished files are in a folder and in those below.
    pub(crate) fn unfinished(&self, folder: &str) -> usize {
        let files = files(&self.path(folder));
        files.iter().filter(|path| is_unfinished(path)).count()
    }

    /// Kills a program, and looks at what it has left: maps that were there `before`, and maps of
    /// `variants`. True if it had ended already.
    pub(crate) fn kill(
        &self,
        mut child: Child,
        before: &Maps,
        variants: &[usize],
        tally: &mut Tally,
    ) -> bool {
        let is_late = child.try_wait().unwrap().is_some();
        child.kill().unwrap();
        child.wait().unwrap();
        tally.kills += 1;
        tally.late += u64::from(is_late);
        tally.in_outputs += u64::from(self.unfinished("out") > 0);
        tally.in_store += u64::from(self.unfinished("store") > 0);
        tally.between += u64::from(self.look(before, variants));
        is_late
    }

    /// That every map is one of `before` or one of `variants`; whether there are some of both.
    pub(crate) fn look(&self, before: &Maps, variants: &[usize]) -> bool {
        let mut is_old = vec![];
        for (name, bytes) in &self.finished() {
            if name.ends_with(".preview.png") {
                assert_whole(name, bytes);
                continue;
            }
            let is_new = |variant: &usize| self.right[*variant][name] == *bytes;
            is_old.push(before[name] == *bytes);
            let is_whole = before[name] == *bytes || variants.iter().any(is_new);
            assert!(is_whole, "{name} is torn");
        }
        assert_eq!(is_old.len(), before.len(), "a map is gone");
        is_old.contains(&true) && is_old.contains(&false)
    }

    /// The next start: the right maps from the store that the kill has left, and nothing unfinished.
    pub(crate) fn start_again(&self, variant: usize) {
        assert!(self.render(variant).status().unwrap().success());
        assert!(self.maps() == self.right[variant], "a wrong hit");
        let left = self.unfinished("out") + self.unfinished("store");
        assert_eq!(left, 0, "unfinished files");
    }
}

fn setting(variant: usize) -> String {
    format!("hue={}", VARIANTS[variant])
}

/// The files in a folder and in those below.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = vec![];
    let mut pending = vec![folder.to_owned()];
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                pending.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found
}

fn is_unfinished(path: &Path) -> bool {
    path.extension().is_some_and(|it| it == "part")
}

/// That a map can be decoded to the end, by the libraries of others.
fn assert_whole(name: &str, bytes: &[u8]) {
    if name.ends_with(".png") {
        image::load_from_memory(bytes).unwrap();
    } else if name.ends_with(".exr") {
        use exr::prelude::{ReadChannels, ReadLayers};
        let reader = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level();
        let reader = reader.all_channels().all_layers().all_attributes();
        reader.from_buffered(Cursor::new(bytes)).unwrap();
    } else {
        let mut decoder = tiff::decoder::Decoder::new(Cursor::new(bytes)).unwrap();
        decoder.read_image().unwrap();
    }
}
