//! Edits of the files that a recipe names.

use super::*;

const LOG: &str = r##"(
    nodes: {
        "log": skeleton_from_file(pith: "spruce_log/Gran_1_pith.json", every: 20),
        "time": growth_field(skeleton: "log", elongation: 900, thickening: 2.4),
        "bar": sample_pattern(file: "spruce_bar/spruce_bar.png", spans: bar, rings: 47),
        "look": pattern_lookup(time: "time", pattern: "bar"),
        "wood": material(base_color: "look"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (182, 170, 1000), size: (120, 100)),
    },
    outputs: { "board": maps(of: "plank", pixels: (48, 40)) },
)"##;

#[test]
fn a_changed_file_rebuilds_what_reads_it() {
    let workshop = without_store();
    assert_snapshot!(workshop.run(LOG), @"
    built bar
    built log
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
    let pith = workshop.folder.join("spruce_log/Gran_1_pith.json");
    let text = String::from_utf8(workshop.files.read(&pith).unwrap()).unwrap();
    assert!(text.contains("184.201146323"));
    workshop
        .files
        .insert(&pith, text.replace("184.201146323", "185.201146323"));
    assert_snapshot!(workshop.run(LOG), @"
    built log
    reused bar (memory)
    tiles of board: look computed 9, reused 0
    tiles of board: plank computed 9, reused 0
    tiles of board: time computed 9, reused 0
    written board_base_color.png
    ");
}

#[test]
fn nothing_runs_after_a_structure_that_is_rebuilt_to_the_same_content() {
    for options in [options(), stored()] {
        let workshop = Workshop::new("recipes", options.clone());
        workshop.run(LOG);
        let pith = workshop.folder.join("spruce_log/Gran_1_pith.json");
        let text = String::from_utf8(workshop.files.read(&pith).unwrap()).unwrap();
        workshop
            .files
            .insert(&pith, text.replace("], [", "],\n   ["));
        let log = workshop.run(LOG);
        if options.store.is_some() {
            assert_snapshot!(log, @"
            built log
            reused bar (memory)
            up to date board_base_color.png
            ");
        } else {
            assert_snapshot!(log, @"
            built log
            reused bar (memory)
            tiles of board: look computed 0, reused 9
            written board_base_color.png
            ");
        }
    }
}

#[test]
fn a_missing_file_is_a_failure_of_files() {
    let workshop = without_store();
    let run = workshop.render(
        &edit(LOG, "Gran_1_pith", "Gran_7_pith"),
        &[],
        Cancel::new(),
        &|_| {},
    );
    let Err(RunError::Files(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    assert_eq!(
        (wrong[0].code, wrong[0].node.as_deref()),
        (Code::FileNotRead, Some("log"))
    );
}
