//! The program is killed at random moments of a render.

use super::{Dice, number};
use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
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
const VARIANTS: [&str; 4] = ["0", "0.25", "0.5", "1"];

type Maps = BTreeMap<String, Vec<u8>>;

/// A folder with the recipe, its maps and its store, and what the maps of every variant have to be.
struct Place {
    home: TempDir,
    right: Vec<Maps>,
}

/// How much a run finds in the store.
#[derive(Clone, Copy, Debug)]
enum Work {
    /// Nothing: it paints, writes maps and fills the store.
    All,
    /// All: it copies maps into place.
    Restore,
}

#[derive(Debug, Default)]
struct Tally {
    kills: u64,
    /// Kills after which a map was half-written.
    in_outputs: u64,
    /// Kills after which an entry of the store was half-written.
    in_store: u64,
    /// Runs that were quicker than the kill.
    late: u64,
    /// Kills that left maps of both variants.
    between: u64,
}

impl Place {
    fn new() -> Place {
        let mut place = Place {
            home: tempfile::tempdir().unwrap(),
            right: vec![],
        };
        fs::write(place.path("recipe.ron"), RECIPE).unwrap();
        for variant in 0..VARIANTS.len() {
            let status = place.command(variant).arg("--no-cache").status();
            assert!(status.unwrap().success());
            let maps = place.maps();
            maps.iter()
                .for_each(|(name, bytes)| assert_whole(name, bytes));
            assert!(maps.len() == 4 && !place.right.contains(&maps));
            place.right.push(maps);
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    fn command(&self, variant: usize) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_yosegi"));
        command.args(["render", "recipe.ron", "--threads", "2", "--set"]);
        command.arg(format!("hue={}", VARIANTS[variant]));
        command.current_dir(self.home.path()).stdin(Stdio::null());
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// A run with the store.
    fn run(&self, variant: usize) -> Command {
        let mut command = self.command(variant);
        command.args(["--cache", "store"]);
        command
    }

    fn maps(&self) -> Maps {
        let files = files(&self.path("out"));
        let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
        let maps = files.iter().filter(|path| !is_unfinished(path));
        maps.map(|path| (name(path), fs::read(path).unwrap()))
            .collect()
    }

    fn unfinished(&self, folder: &str) -> usize {
        let files = files(&self.path(folder));
        files.iter().filter(|path| is_unfinished(path)).count()
    }

    /// Makes the store what the work needs.
    fn prepare(&self, work: Work, variant: usize) {
        match work {
            Work::All => {
                let _ = fs::remove_dir_all(self.path("store"));
            }
            Work::Restore => {
                let elsewhere = self.run(variant).args(["-o", "elsewhere"]).status();
                assert!(elsewhere.unwrap().success());
            }
        }
    }

    /// How long a run takes that is not killed: the median of five.
    fn time(&self, work: Work) -> Duration {
        let mut times = [0, 1, 2, 3, 0].map(|variant| {
            self.prepare(work, variant);
            let start = Instant::now();
            assert!(self.run(variant).status().unwrap().success());
            start.elapsed()
        });
        times.sort();
        times[2]
    }

    /// Kills a run after `delay`, and looks at what it has left; true if it was too late.
    fn kill(&self, variant: usize, delay: Duration, tally: &mut Tally) -> bool {
        let before = self.maps();
        let mut child = self.run(variant).spawn().unwrap();
        thread::sleep(delay);
        let is_late = child.try_wait().unwrap().is_some();
        child.kill().unwrap();
        child.wait().unwrap();
        tally.kills += 1;
        tally.late += u64::from(is_late);
        tally.in_outputs += u64::from(self.unfinished("out") > 0);
        tally.in_store += u64::from(self.unfinished("store") > 0);
        let after = self.maps();
        let right = &self.right[variant];
        for (name, bytes) in &after {
            let is_old = before.get(name) == Some(bytes);
            assert!(
                is_old || *bytes == right[name],
                "{name} is torn after {tally:?}"
            );
        }
        assert_eq!(after.len(), right.len(), "a map is gone after {tally:?}");
        let new = after.iter().filter(|(name, bytes)| right[*name] == **bytes);
        tally.between += u64::from((1..after.len()).contains(&new.count()));
        is_late
    }

    /// The next start: the right maps from the store that the kill has left, and nothing unfinished.
    fn start_again(&self, variant: usize, tally: &Tally) {
        assert!(self.run(variant).status().unwrap().success());
        assert!(
            self.maps() == self.right[variant],
            "a wrong hit after {tally:?}"
        );
        let left = self.unfinished("out") + self.unfinished("store");
        assert_eq!(left, 0, "unfinished files after {tally:?}");
    }
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

fn campaign(kills: u64) -> Tally {
    let seed = number("YOSEGI_SEED", 4);
    let (place, mut dice) = (Place::new(), Dice(seed));
    let mut times = [Work::All, Work::Restore].map(|work| (work, place.time(work)));
    let mut tally = Tally::default();
    for _ in 0..kills {
        let (work, time) = &mut times[dice.throw(3) as usize / 2];
        let work = *work;
        let variant = dice.throw(VARIANTS.len() as u64) as usize;
        place.prepare(work, variant);
        let delay = Duration::from_micros(dice.throw(time.as_micros().max(1) as u64));
        // Other programs share the machine, more of them or fewer as time goes by.
        *time = time.mul_f64(if place.kill(variant, delay, &mut tally) {
            0.96
        } else {
            1.01
        });
        // The same maps, or others that share structures with them.
        let next = [variant, dice.throw(VARIANTS.len() as u64) as usize];
        place.start_again(next[dice.throw(2) as usize], &tally);
    }
    println!("seed {seed}, {times:?}: {tally:?}, 0 torn maps, 0 wrong hits, 0 left over");
    tally
}

#[test]
fn kills_tear_nothing_and_leave_nothing() {
    assert_eq!(campaign(30).kills, 30);
}

#[test]
#[ignore = "a campaign"]
fn two_thousand_kills_tear_nothing_and_leave_nothing() {
    let tally = campaign(number("YOSEGI_KILLS", 2000));
    assert!(tally.in_outputs > 0 && tally.in_store > 0, "{tally:?}");
}
