//! Entries that are damaged are misses, and are replaced or removed.

use super::*;

/// A store of a board whose maps are painted over, so that a run needs them from the store.
struct Damaged {
    workshop: Workshop,
    right: [Vec<u8>; 2],
}

impl Damaged {
    fn new() -> Damaged {
        let workshop = workshop(options());
        workshop.run(BOARD);
        Damaged {
            right: MAPS.map(|name| workshop.map(name)),
            workshop,
        }
    }

    /// Renders with an entry in another state; gives what lies there afterwards.
    fn with(&self, path: &Path, bytes: &[u8]) -> Option<Vec<u8>> {
        let files = &self.workshop.files;
        let whole = files.read(path).unwrap();
        files.insert(path, bytes);
        for map in MAPS {
            files.insert(place(&self.workshop, map), "painted over");
        }
        self.workshop.another(options()).run(BOARD);
        let maps = MAPS.map(|name| self.workshop.map(name));
        assert!(maps == self.right, "{}", path.display());
        let after = files.read(path).ok();
        files.insert(path, whole);
        after
    }
}

#[test]
fn an_entry_cut_at_every_length_is_a_miss_and_is_written_again() {
    let damaged = Damaged::new();
    for family in ["plan", "map"] {
        let path = entries_of(&damaged.workshop, family).remove(0);
        let whole = damaged.workshop.files.read(&path).unwrap();
        for length in 0..whole.len() {
            let after = damaged.with(&path, &whole[..length]);
            assert_eq!(after.as_ref(), Some(&whole), "{family} {length}");
        }
    }
}

#[test]
fn an_entry_with_a_turned_bit_is_a_miss_and_is_written_again() {
    let damaged = Damaged::new();
    for family in ["plan", "map", "file"] {
        let path = entries_of(&damaged.workshop, family).remove(0);
        let whole = damaged.workshop.files.read(&path).unwrap();
        // Every bit of the header's bytes, and bits all over the rest.
        let bits = (0..8 * HEADER)
            .step_by(3)
            .chain((8 * HEADER..8 * whole.len()).step_by(41));
        for bit in bits {
            let mut turned = whole.clone();
            turned[bit / 8] ^= 1 << (bit % 8);
            let after = damaged.with(&path, &turned);
            assert_eq!(after.as_ref(), Some(&whole), "{family} {bit}");
        }
    }
}

#[test]
fn damaged_structures_are_removed_when_they_are_looked_up() {
    let first = workshop(options());
    first.run(BOARD);
    let changed = BOARD.replace("sharpness: 3", "sharpness: 4");
    let right = workshop(Options {
        store: None,
        ..options()
    });
    right.run(&changed);
    for path in entries_of(&first, "structure") {
        let whole = first.files.read(&path).unwrap();
        for wrong in [&whole[..whole.len() - 1], &[], &vec![0; whole.len()]] {
            first.files.insert(&path, wrong);
            for old in ["plan", "map", "file"] {
                for path in entries_of(&first, old) {
                    first.files.remove(&path).unwrap();
                }
            }
            assert!(first.another(options()).run(&changed).contains("built"));
            assert_eq!(
                MAPS.map(|name| first.map(name)),
                MAPS.map(|it| right.map(it))
            );
            assert_eq!(first.files.read(&path).unwrap(), whole);
        }
    }
}

#[test]
fn exchanged_entries_are_misses_within_a_family_and_between_families() {
    let damaged = Damaged::new();
    let all = entries(&damaged.workshop);
    let read = |path: &PathBuf| damaged.workshop.files.read(path).unwrap();
    for (index, path) in all.iter().enumerate() {
        for other in &all[index + 1..] {
            let bytes = [read(path), read(other)];
            damaged.workshop.files.insert(path, bytes[1].clone());
            damaged.with(other, &bytes[0]);
            damaged.workshop.files.insert(path, bytes[0].clone());
        }
    }
}

#[test]
fn the_same_payload_under_another_family_or_key_is_a_miss() {
    let damaged = Damaged::new();
    for path in entries(&damaged.workshop) {
        let payload = payload(&damaged.workshop.files.read(&path).unwrap());
        let (_, key) = name_of(&path);
        for family in ["structure", "map", "file", "plan", "run"] {
            let elsewhere = path_of(family, &key);
            if elsewhere != path {
                damaged.with(&path, &sealed(&elsewhere, &payload));
            }
        }
        let other = path_of("plan", &Key::of_bytes(b"other"));
        damaged.with(&path, &sealed(&other, &payload));
    }
}

#[test]
fn older_and_newer_layouts_are_misses_and_stay_until_they_are_replaced() {
    let damaged = Damaged::new();
    for path in entries(&damaged.workshop) {
        let whole = damaged.workshop.files.read(&path).unwrap();
        for layout in ["yosegi01", "yosegi99"] {
            let other = [layout.as_bytes(), &whole[layout.len()..]].concat();
            let after = damaged.with(&path, &other).unwrap();
            assert!(after == whole || after == other, "{}", path.display());
            let is_needed = !path.starts_with("store/structure") && !path.starts_with("store/run");
            assert!(!is_needed || after == whole, "{}", path.display());
        }
    }
}

#[test]
fn contents_that_never_reached_the_disk_are_misses() {
    let damaged = Damaged::new();
    for path in entries(&damaged.workshop) {
        let whole = damaged.workshop.files.read(&path).unwrap();
        let half = whole.len() / 2;
        let half_zero = [&whole[..half], &vec![0; whole.len() - half]].concat();
        for lost in [vec![], vec![0; whole.len()], half_zero] {
            damaged.with(&path, &lost);
        }
    }
}
