//! The store of earlier results: what harms it, what it keeps, and that it never gives a wrong result.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod campaign;
mod damage;
mod foreign;
mod keys;
mod limit;
mod malice;
mod places;
mod sharing;
mod verify;

#[path = "../support/workshop.rs"]
mod workshop;

use std::path::{Path, PathBuf};
use workshop::Workshop;
use yosegi::engine::{Cancel, Options};
use yosegi::key::{Key, KeyHasher};
use yosegi::world::World;

const STORE: &str = "store";

/// Two structures, a kernel whose columns are kept, and two maps.
const BOARD: &str = r##"(
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)],
            branches: [(at: 590, direction: (1, 0, 0.5), thickening: 0.8)],
        ),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3, sharpness: 3),
        "year": colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look.colour", height: "= 0.05 * look.position"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "board": maps(of: "plank", pixels: (24, 20), channels: [base_color, height],
            ranges: [(channel: "height", low: 0, high: 0.05)]),
    },
)"##;

const MAPS: [&str; 2] = ["board_base_color.png", "board_height.png"];

fn options() -> Options {
    Options {
        threads: Some(1),
        tile: 16,
        store: Some(PathBuf::from(STORE)),
        ..Options::default()
    }
}

fn workshop(options: Options) -> Workshop {
    Workshop::new("recipes", options)
}

/// The files in the store, sorted.
fn entries(workshop: &Workshop) -> Vec<PathBuf> {
    let paths = workshop.files.paths().into_iter();
    paths.filter(|path| path.starts_with(STORE)).collect()
}

/// The entries of a family.
fn entries_of(workshop: &Workshop, family: &str) -> Vec<PathBuf> {
    let folder = Path::new(STORE).join(family);
    let mut entries = entries(workshop);
    entries.retain(|path| path.starts_with(&folder));
    entries
}

/// An entry's header is the layout, a checksum, the key, the family and the length.
const HEADER: usize = 8 + 64 + 64 + 16 + 16;

/// What is stored in an entry.
fn payload(entry: &[u8]) -> Vec<u8> {
    entry[HEADER..].to_vec()
}

/// The family and the key of the entry at a path.
fn name_of(path: &Path) -> (String, Key) {
    let parts: Vec<&str> = path.iter().map(|part| part.to_str().unwrap()).collect();
    let [.., family, start, end] = &parts[..] else {
        panic!("{}", path.display())
    };
    let key = Key::from_hexadecimal(&format!("{start}{end}")).unwrap();
    ((*family).to_owned(), key)
}

/// The whole entry of a path with other contents, as one writes it who knows the layout.
fn sealed(path: &Path, payload: &[u8]) -> Vec<u8> {
    let (family, key) = name_of(path);
    let mut checksum = KeyHasher::new(&family, 2);
    let checksum = checksum.key(key).bytes(payload).finish().hexadecimal();
    let (key, length) = (key.hexadecimal(), payload.len());
    let header = format!("yosegi02{checksum}{key}{family:16}{length:016x}");
    assert_eq!(header.len(), HEADER);
    [header.as_bytes(), payload].concat()
}

fn path_of(family: &str, key: &Key) -> PathBuf {
    let digits = key.hexadecimal();
    let folder = Path::new(STORE).join(family).join(&digits[..2]);
    folder.join(&digits[2..])
}

/// The maps of [`BOARD`] as they are without a store.
fn right_maps() -> [Vec<u8>; 2] {
    let plain = workshop(Options {
        store: None,
        ..options()
    });
    plain.run(BOARD);
    MAPS.map(|name| plain.map(name))
}

fn place(workshop: &Workshop, map: &str) -> PathBuf {
    workshop.folder.join("out").join(map)
}

#[test]
fn entries_are_laid_out_as_these_tests_believe() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let entries = entries(&workshop);
    assert_eq!(entries.len(), 8);
    for path in entries {
        let entry = workshop.files.read(&path).unwrap();
        assert_eq!(sealed(&path, &payload(&entry)), entry, "{}", path.display());
        let (family, key) = name_of(&path);
        assert_eq!(path_of(&family, &key), path);
    }
    let again = workshop.render(BOARD, &[], Cancel::new(), &|_| {});
    assert!(again.log().contains("up to date"), "{}", again.log());
}
