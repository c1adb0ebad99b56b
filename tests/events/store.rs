//! What the store gives back, and that damage to it is a miss.

use super::*;

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
    // Two structures, the plan, the map's record and the file itself.
    assert_eq!(entries.len(), 5);
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
            let needed = !entry.starts_with("store/structure");
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
        assert_eq!(workshop.run(&recipe), format!("up to date {name}"));
    }
}
