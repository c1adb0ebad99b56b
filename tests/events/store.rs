//! What the store gives back, and that damage to it is a miss.

use super::*;
use yosegi::engine::{StoreFamily, clean_store, store_status};

#[test]
fn an_overwritten_map_is_restored_from_the_store() {
    let workshop = with_store();
    workshop.run(BOARD);
    let path = workshop.folder.join("out/board_base_color.png");
    let right = workshop.map("board_base_color.png");
    // One byte of the pixels, behind the key in the header: only the hash of the file tells.
    let mut painted_over = right.clone();
    let middle = right.len() / 2;
    painted_over[middle] ^= 1;
    for wrong in [painted_over, right[..middle].to_vec(), vec![]] {
        workshop.files.insert(&path, wrong);
        assert_eq!(workshop.run(BOARD), "restored board_base_color.png");
        assert_eq!(workshop.map("board_base_color.png"), right);
    }
    assert_eq!(workshop.run(BOARD), "up to date board_base_color.png");
}

#[test]
fn a_map_is_restored_where_it_is_not_there_yet() {
    let mut workshop = with_store();
    workshop.run(BOARD);
    let right = workshop.map("board_base_color.png");
    workshop.folder = "elsewhere".into();
    assert_eq!(workshop.run(BOARD), "restored board_base_color.png");
    assert_eq!(workshop.map("board_base_color.png"), right);
}

#[test]
fn another_process_finds_structures_and_maps_in_the_store() {
    let first = with_store();
    first.run(BOARD);
    let second = first.another(stored());
    assert_eq!(second.run(BOARD), "up to date board_base_color.png");
    assert_snapshot!(second.run(&edit(BOARD, "thickening: 3,", "thickening: 4,")), @"
    reused tree (disk)
    reused year (disk)
    tiles of board: knots computed 9, reused 0
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

/// What harms an entry of the store.
const DAMAGES: [fn(&mut Vec<u8>); 5] = [
    |bytes| *bytes.last_mut().unwrap() ^= 1,
    |bytes| bytes[0] ^= 1,
    |bytes| bytes[40] ^= 1,
    |bytes| bytes.truncate(100),
    |bytes| bytes.clear(),
];

#[test]
fn a_damaged_entry_of_the_store_is_a_miss() {
    let first = with_store();
    first.run(BOARD);
    let right = first.map("board_base_color.png");
    let entries: Vec<PathBuf> = first
        .files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with("store"))
        .collect();
    // Two structures, the plan, the map's record, the file itself, and what the run was.
    assert_eq!(entries.len(), 6);
    for entry in &entries {
        for damage in DAMAGES {
            let mut bytes = first.files.read(entry).unwrap();
            let whole = bytes.clone();
            damage(&mut bytes);
            first.files.insert(entry, bytes);
            first.files.insert(
                first.folder.join("out/board_base_color.png"),
                "painted over",
            );
            first.another(stored()).run(BOARD);
            assert_eq!(
                first.map("board_base_color.png"),
                right,
                "{}",
                entry.display()
            );
            // The run has put the entry back, if it needed it.
            let needed = !entry.starts_with("store/structure") && !entry.starts_with("store/run");
            assert!(
                !needed || first.files.read(entry).unwrap() == whole,
                "{}",
                entry.display()
            );
            first.files.insert(entry, whole);
        }
    }
}

#[test]
fn exchanged_entries_of_the_store_are_misses() {
    let first = with_store();
    first.run(PAIR);
    let right = first.map("pale_base_color.png");
    let files: Vec<PathBuf> = first
        .files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with("store/file"))
        .collect();
    let [a, b] = files.as_slice() else {
        panic!("{files:?}")
    };
    let bytes = [a, b].map(|path| first.files.read(Path::new(path)).unwrap());
    first.files.insert(a, bytes[1].clone());
    first.files.insert(b, bytes[0].clone());
    first
        .files
        .insert(first.folder.join("out/pale_base_color.png"), "");
    let second = first.another(stored());
    second.run(PAIR);
    assert_eq!(second.map("pale_base_color.png"), right);
}

#[test]
fn only_the_map_that_is_lost_is_painted_and_each_is_told_once() {
    let two = edit(BOARD, "[base_color]", "[base_color, normal]");
    let workshop = with_store();
    workshop.run(&two);
    let right = workshop.map("board_normal.png");
    // The map is gone from its place and from the store, which remembers only that it was there.
    for path in workshop.files.paths() {
        if workshop.files.read(&path).unwrap().ends_with(&right) {
            workshop.files.insert(path, "");
        }
    }
    let log = workshop.run(&two);
    let told = log.lines().filter(|line| !line.contains("tiles"));
    let expected = [
        "reused tree (memory)",
        "reused year (memory)",
        "up to date board_base_color.png",
        "written board_normal.png",
    ];
    assert_eq!(told.collect::<Vec<_>>(), expected);
    assert_eq!(workshop.map("board_normal.png"), right);
    assert!(!log.contains("knots"), "{log}");
}

/// A BMP has no place for its key: the store alone knows it.
#[test]
fn a_bmp_is_known_by_the_store_and_a_changed_one_is_noticed() {
    let workshop = with_store();
    let recipe = edit(BOARD, "channels:", "format: bmp, channels:");
    workshop.run(&recipe);
    let path = workshop.folder.join("out/board_base_color.bmp");
    let right = workshop.map("board_base_color.bmp");
    assert_eq!(workshop.run(&recipe), "up to date board_base_color.bmp");
    let second = workshop.another(stored());
    assert_eq!(second.run(&recipe), "up to date board_base_color.bmp");
    let mut painted_over = right.clone();
    *painted_over.last_mut().unwrap() ^= 1;
    workshop.files.insert(&path, painted_over);
    assert_eq!(workshop.run(&recipe), "restored board_base_color.bmp");
    assert_eq!(workshop.map("board_base_color.bmp"), right);
    // The BMP of another board in its place is no map of this one.
    let other = edit(&recipe, "thickening: 3,", "thickening: 4,");
    workshop.run(&other);
    assert!(workshop.map("board_base_color.bmp") != right);
    assert_eq!(workshop.run(&recipe), "restored board_base_color.bmp");
    assert_eq!(workshop.map("board_base_color.bmp"), right);
}

#[test]
fn maps_of_every_format_are_up_to_date_the_second_time() {
    let workshop = with_store();
    for format in yosegi::value::MapFormat::ALL {
        let recipe = edit(
            BOARD,
            "channels:",
            &format!("format: {}, channels:", format.name()),
        );
        let name = format!("board_base_color.{}", format.extension());
        assert!(workshop.run(&recipe).ends_with(&format!("written {name}")));
        // The maps of the other formats are still there, and are told to be stale.
        assert!(
            workshop
                .run(&recipe)
                .ends_with(&format!("up to date {name}"))
        );
    }
}

/// Two outputs of which one has lost its files, and a change that makes them share one.
#[test]
fn nothing_is_restored_before_outputs_that_share_a_file_are_refused() {
    let recipe = r##"(
        nodes: {
            "wood": material(base_color: "#c8a06e", extras: { "old": 1, "pale_old": 2 }),
            "piece": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (10, 10)),
        },
        outputs: {
            "board": maps(of: "piece", pixels: (8, 8), format: exr_half, channels: [pale_old]),
            "board_pale": maps(of: "piece", pixels: (8, 8), format: exr_half, channels: [roughness]),
        },
    )"##;
    let workshop = with_store();
    workshop.run(recipe);
    let path = workshop.folder.join("out/board_pale_old.exr");
    workshop.files.insert(&path, "painted over");
    let shared = edit(recipe, "[roughness]", "[old]");
    let run = workshop.render(&shared, &[], Cancel::new(), &|_| {});
    assert!(matches!(run.result, Err(RunError::Nodes(_))));
    assert_eq!(workshop.files.read(&path).unwrap(), b"painted over");
    assert!(!run.log().contains("restored"), "{}", run.log());
}

#[test]
fn a_restored_map_is_told_although_its_sibling_is_painted() {
    let two = edit(BOARD, "[base_color]", "[base_color, normal]");
    let workshop = with_store();
    workshop.run(&two);
    let names = ["board_base_color.png", "board_normal.png"];
    let right = names.map(|name| workshop.map(name));
    for path in workshop.files.paths() {
        if workshop.files.read(&path).unwrap().ends_with(&right[1]) {
            workshop.files.insert(path, "");
        }
    }
    let first = workshop.folder.join("out").join(names[0]);
    workshop.files.insert(first, "painted over");
    let log = workshop.run(&two);
    let told = log.lines().filter(|line| line.contains("board_"));
    let expected = ["restored board_base_color.png", "written board_normal.png"];
    assert_eq!(told.collect::<Vec<_>>(), expected);
    assert_eq!(names.map(|name| workshop.map(name)), right);
}

/// The store still has the entry of a map's contents, but they are cut short.
#[test]
fn a_map_that_the_store_has_lost_behind_its_header_is_painted_and_each_is_told_once() {
    let two = edit(BOARD, "[base_color]", "[base_color, normal]");
    let workshop = with_store();
    workshop.run(&two);
    let names = ["board_base_color.png", "board_normal.png"];
    let right = names.map(|name| workshop.map(name));
    for path in workshop.files.paths() {
        let mut bytes = workshop.files.read(&path).unwrap();
        if path.starts_with("store/file") && bytes.ends_with(&right[1]) {
            bytes.pop();
            workshop.files.insert(path, bytes);
        }
    }
    for name in names {
        let path = workshop.folder.join("out").join(name);
        workshop.files.insert(path, "painted over");
    }
    let log = workshop.run(&two);
    let told = log.lines().filter(|line| line.contains("board_"));
    let expected = ["restored board_base_color.png", "written board_normal.png"];
    assert_eq!(told.collect::<Vec<_>>(), expected);
    assert_eq!(names.map(|name| workshop.map(name)), right);
}

#[test]
fn files_of_channels_that_are_gone_are_named_and_stay() {
    let two = edit(BOARD, "[base_color]", "[base_color, roughness]");
    let workshop = with_store();
    workshop.run(&two);
    let stale = workshop.map("board_roughness.png");
    // Neither is ours: no key, and the key of another channel.
    let place = |name: &str| workshop.folder.join("out").join(name);
    workshop.files.insert(place("board_height.png"), "mine");
    workshop
        .files
        .insert(place("board_occlusion.png"), stale.clone());
    // Of an output that was not asked for.
    workshop
        .files
        .insert(place("other_roughness.png"), stale.clone());
    for log in [workshop.run(BOARD), workshop.run(BOARD)] {
        let told: Vec<&str> = log
            .lines()
            .filter(|line| line.starts_with("stale"))
            .collect();
        assert_eq!(told, ["stale board_roughness.png"], "{log}");
    }
    assert_eq!(workshop.map("board_roughness.png"), stale);
    assert!(!workshop.run(&two).contains("stale"));
}

#[test]
fn the_store_is_counted_and_cleaned_and_what_is_not_an_entry_stays() {
    let workshop = with_store();
    workshop.run(BOARD);
    let files = &workshop.files;
    let folder = Path::new("store");
    let counts = |families: Vec<StoreFamily>| -> Vec<(&str, usize)> {
        families.iter().map(|it| (it.family, it.entries)).collect()
    };
    let whole = [
        ("structure", 2),
        ("map", 1),
        ("file", 1),
        ("plan", 1),
        ("run", 1),
    ];
    let status = store_status(files, folder).unwrap();
    let entries = files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with(folder));
    let bytes: usize = entries.map(|path| files.read(&path).unwrap().len()).sum();
    assert_eq!(status.iter().map(|it| it.bytes).sum::<u64>(), bytes as u64);
    assert_eq!(counts(status), whole);
    let digits = "0".repeat(62);
    let foreign = [
        "store/notes.txt".to_owned(),
        "store/map/ab/notes.txt".to_owned(),
        format!("store/map/ab/{digits}"),
        format!("store/map/xy/{digits}"),
        format!("store/other/ab/{digits}"),
        "store/map/ab/.yosegi-x1.part".to_owned(),
    ];
    for (index, path) in foreign.iter().enumerate() {
        // By its place the third could be an entry.
        files.insert(path, if index == 2 { "not ours" } else { "yosegi01" });
    }
    let maps = workshop.maps();
    let removed = clean_store(files, folder).unwrap();
    assert_eq!(removed[1].entries, 1);
    let left = files
        .paths()
        .into_iter()
        .filter(|path| path.starts_with(folder));
    let mut expected: Vec<PathBuf> = foreign.iter().map(PathBuf::from).collect();
    expected.sort();
    assert_eq!(left.collect::<Vec<_>>(), expected);
    assert_eq!(workshop.maps(), maps);
    assert_eq!(
        store_status(files, folder)
            .unwrap()
            .iter()
            .map(|it| it.entries)
            .sum::<usize>(),
        0
    );
    assert!(clean_store(files, Path::new("nowhere")).is_ok());
}
