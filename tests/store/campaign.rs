//! Random damage to the store, over and over: no run may give a wrong pixel.
//!
//! One iteration damages some entries of a store that is otherwise whole, in one of the ways of [`WAYS`] each,
//! paints over or removes some of the maps, renders with an engine that remembers nothing, and compares every map
//! byte for byte with what a run without a store writes. `cargo test --release --test store -- --ignored --nocapture
//! campaign` damages as many entries as `YOSEGI_DAMAGES` says (10,000), from the seed `YOSEGI_SEED`.

use super::*;
use std::collections::BTreeMap;
use std::time::Instant;

/// Another cut, size and format of the board, and one without branches.
fn recipes() -> [String; 4] {
    let edit = |pairs: &[(&str, &str)]| {
        pairs.iter().fold(BOARD.to_owned(), |text, (from, to)| {
            assert_eq!(text.matches(from).count(), 1, "{from}");
            text.replace(from, to)
        })
    };
    [
        BOARD.to_owned(),
        edit(&[
            ("quarter_sawn", "plain_sawn"),
            ("channels: [base_color, height]", "channels: [base_color]"),
        ]),
        edit(&[
            ("pixels: (24, 20)", "pixels: (10, 8), format: exr_half"),
            ("sharpness: 3", "sharpness: 5"),
        ]),
        edit(&[
            ("pixels: (24, 20)", "pixels: (9, 7), format: bmp"),
            ("thickening: 0.8", "thickening: 0.9"),
        ]),
    ]
}

/// SplitMix64 (Steele, Lea & Flood 2014).
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// A number below `limit`.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }
}

type Files = BTreeMap<PathBuf, Vec<u8>>;
type Way = fn(&Files, &PathBuf, &mut Random) -> Vec<u8>;

/// Damages to the entry at a path; none gives an entry with wrong contents and right checksum.
const WAYS: [(&str, Way); 9] = [
    ("cut short", |all, path, random| {
        all[path][..random.below(all[path].len())].to_vec()
    }),
    ("one bit turned", |all, path, random| {
        let mut bytes = all[path].clone();
        let bit = random.below(8 * bytes.len());
        bytes[bit / 8] ^= 1 << (bit % 8);
        bytes
    }),
    ("bytes overwritten", |all, path, random| {
        let mut bytes = all[path].clone();
        let start = random.below(bytes.len());
        let end = bytes.len().min(start + 1 + random.below(64));
        bytes[start..end].iter_mut().for_each(|byte| *byte = !*byte);
        bytes
    }),
    ("another entry", |all, path, random| {
        let others: Vec<_> = all.iter().filter(|(other, _)| *other != path).collect();
        others[random.below(others.len())].1.clone()
    }),
    ("zeros", |all, path, _| vec![0; all[path].len()]),
    ("zeros from somewhere on", |all, path, random| {
        let mut bytes = all[path].clone();
        // The last byte may be a zero already.
        let start = random.below(bytes.len() - 40);
        bytes[start..].fill(0);
        bytes
    }),
    ("another layout", |all, path, random| {
        let mut bytes = all[path].clone();
        bytes[7] = [b'0', b'1', b'3', b'9'][random.below(4)];
        bytes
    }),
    ("another family", |all, path, random| {
        let (family, key) = name_of(path);
        let families = ["structure", "map", "file", "plan", "run"];
        let others = families.map(|it| if it == family { "other" } else { it });
        let elsewhere = path_of(others[random.below(5)], &key);
        sealed(&elsewhere, &payload(&all[path]))
    }),
    ("longer", |all, path, random| {
        let more = 1 + random.below(200);
        let more: Vec<u8> = (0..more).map(|_| random.next() as u8).collect();
        [&all[path][..], &more].concat()
    }),
];

/// The world of the campaign, and what is right.
struct Campaign {
    workshop: Workshop,
    recipes: [String; 4],
    /// The maps of each recipe as they are without a store.
    right: Vec<Files>,
    /// The whole store.
    store: Files,
}

impl Campaign {
    fn new() -> Campaign {
        let recipes = recipes();
        let right = |recipe: &String| {
            let plain = workshop(Options {
                store: None,
                ..options()
            });
            plain.run(recipe);
            let names = plain.maps().into_iter();
            names
                .map(|name| (place(&plain, &name), plain.map(&name)))
                .collect()
        };
        let right = recipes.iter().map(right).collect();
        let workshop = workshop(options());
        recipes.iter().for_each(|recipe| {
            workshop.run(recipe);
        });
        let read = |path: PathBuf| (path.clone(), workshop.files.read(&path).unwrap());
        let store = entries(&workshop).into_iter().map(read).collect();
        Campaign {
            workshop,
            recipes,
            right,
            store,
        }
    }

    /// The store whole, some of it damaged; gives how many entries and how often each way.
    fn damage(&self, random: &mut Random, ways: &mut [usize; WAYS.len()]) -> usize {
        let files = &self.workshop.files;
        for path in entries(&self.workshop) {
            if !self.store.contains_key(&path) {
                files.remove(&path).unwrap();
            }
        }
        for (path, bytes) in &self.store {
            files.insert(path, bytes.clone());
        }
        let paths: Vec<&PathBuf> = self.store.keys().collect();
        let count = 1 + random.below(4);
        for _ in 0..count {
            let (path, way) = (paths[random.below(paths.len())], random.below(WAYS.len()));
            files.insert(path, WAYS[way].1(&self.store, path, random));
            ways[way] += 1;
        }
        if random.below(3) == 0 {
            // Without what is known of the maps, structures are needed.
            let known =
                |path: &&PathBuf| path.starts_with("store/plan") || path.starts_with("store/map");
            for path in self.store.keys().filter(known) {
                files.remove(path).unwrap();
            }
        }
        count
    }

    /// Renders one of the recipes on the store as it is; true if every map is right.
    fn is_right(&self, recipe: usize, random: &mut Random) -> bool {
        let files = &self.workshop.files;
        for (path, bytes) in &self.right[recipe] {
            match random.below(4) {
                0 => files.insert(path, bytes.clone()),
                1 => {
                    let mut painted_over = bytes.clone();
                    let last = painted_over.len() - 1 - random.below(bytes.len() / 2);
                    painted_over[last] ^= 1;
                    files.insert(path, painted_over);
                }
                _ => {
                    // It may not be there: the recipes share names.
                    let _ = files.remove(path);
                }
            }
        }
        self.workshop.another(options()).run(&self.recipes[recipe]);
        let mut maps = self.right[recipe].iter();
        maps.all(|(path, right)| files.read(path).is_ok_and(|found| found == *right))
    }
}

fn run(most: usize, seed: u64) {
    let campaign = Campaign::new();
    let (mut random, start) = (Random::new(seed), Instant::now());
    let (mut damaged, mut iterations, mut wrong) = (0, 0, 0);
    let mut ways = [0; WAYS.len()];
    while damaged < most {
        damaged += campaign.damage(&mut random, &mut ways);
        let recipe = random.below(campaign.recipes.len());
        wrong += usize::from(!campaign.is_right(recipe, &mut random));
        iterations += 1;
    }
    let told: Vec<String> = WAYS
        .iter()
        .zip(ways)
        .map(|((way, _), count)| format!("{way} {count}"))
        .collect();
    println!(
        "{damaged} entries damaged ({}), {iterations} renders, {wrong} with a wrong map, seed {seed}, {:.1} s",
        told.join(", "),
        start.elapsed().as_secs_f64()
    );
    assert_eq!(wrong, 0);
    assert!(most < 300 || ways.iter().all(|count| *count > 0));
}

pub(super) fn variable(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap())
}

#[test]
fn damaged_entries_never_give_a_wrong_map() {
    run(300, variable("YOSEGI_SEED", 1));
}

#[test]
#[ignore = "takes a minute"]
fn campaign_of_damages() {
    let most = usize::try_from(variable("YOSEGI_DAMAGES", 10_000)).unwrap();
    run(most, variable("YOSEGI_SEED", 1));
}
