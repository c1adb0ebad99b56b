//! `yosegi why` and `cache`.

use super::*;

fn why(place: &Place, arguments: &[&str]) -> Output {
    place.call(&[&["why", "recipe.ron", "--cache", "store"], arguments].concat())
}

#[test]
fn why_says_what_changed() {
    let place = Place::new(BOARD);
    let first = why(&place, &["time"]);
    assert_eq!((code(&first), stderr(&first)), (0, String::new()));
    assert!(stdout(&first).contains("nothing is known of an earlier run"));
    assert!(!place.path("store").exists() && !place.path("out").exists());
    assert_eq!(code(&place.render(&[])), 0);
    assert!(stdout(&why(&place, &["time"])).starts_with("`time` (growth_field) does not run"));
    assert_eq!(
        stdout(&why(&place, &["time", "--set", "speed=4"])),
        "`time` (growth_field) is evaluated: input `thickening` changed: 3 -> 4\n\
         \n\
         read by the outputs\n  \
           `board` (maps) is painted, unless its maps come out as before: `plank` changed (input `of`)\n  \
           `plain` (maps) is painted, unless its maps come out as before: `plank` changed (input `of`)\n\
         \n\
         it depends on\n  \
           `tree` (skeleton) is reused from the store\n"
    );
    let deep = stdout(&why(&place, &["board", "--set", "speed=4"]));
    assert!(
        deep.contains("the first cause: `time` (growth_field)"),
        "{deep}"
    );
    let size = stdout(&why(&place, &["board", "--size", "8x6"]));
    assert!(
        size.contains("the size changed: the recipe's -> 8x6"),
        "{size}"
    );
    let elsewhere = stdout(&why(&place, &["board", "-o", "elsewhere"]));
    assert!(
        elsewhere.contains("is copied from the store"),
        "{elsewhere}"
    );
    let without = place.call(&["why", "recipe.ron", "tree", "--no-cache"]);
    assert!(
        stdout(&without).contains("there is no store"),
        "{}",
        stdout(&without)
    );
}

#[test]
fn why_compares_with_the_last_run_from_any_folder() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    fs::create_dir(place.path("below")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_yosegi"));
    let output = command
        .current_dir(place.path("below"))
        .args(["why", "../recipe.ron", "time", "--cache", "../store"])
        .output()
        .unwrap();
    assert!(
        !stdout(&output).contains("nothing is known"),
        "{}",
        stdout(&output)
    );
}

#[test]
fn why_of_nothing_is_2() {
    let place = Place::new(BOARD);
    let output = why(&place, &["tyme"]);
    assert_eq!((code(&output), stdout(&output)), (2, String::new()));
    assert!(stderr(&output).contains("`time`"), "{}", stderr(&output));
}

#[test]
fn the_cache_is_counted_and_cleaned() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    place.write("store/notes.txt", "mine");
    let cache = |command| place.call(&["cache", command, "--cache", "store", "--json"]);
    let count = |output: &Output| lines(output)[0]["entries"].as_u64().unwrap();
    // Two structures, three maps with their contents, two plans and the run.
    assert_eq!(count(&cache("status")), 11);
    let removed = cache("clean");
    assert_eq!((code(&removed), count(&removed)), (0, 11));
    assert_eq!(count(&cache("status")), 0);
    assert_eq!(place.names("store"), ["notes.txt"]);
    let text = stdout(&place.call(&["cache", "status", "--cache", "store"]));
    assert!(
        text.starts_with("store holds 0 entries, 0 bytes of at most 2.0 GiB\n"),
        "{text}"
    );
    // What was there is there again.
    assert_eq!(events(&place.render(&["--json"]), "map_written").len(), 3);
}
