//! Mistakes cost nothing: they are told, the last good maps stay, and the next good save goes on.

use super::desk::{Desk, Setup, pause, recipe, recipe_of};
use std::fs;
use std::time::{Duration, Instant};
use yosegi::watch::Told;

#[test]
fn a_mistake_is_told_and_the_next_good_save_goes_on_by_itself() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    for round in 2..5 {
        let from = desk.told().len();
        desk.save(&recipe_of("\"no colour\""));
        let message = desk.wait_for_failure(from);
        assert!(message.contains("colour"), "{message}");
        desk.wait_for(from, |told| matches!(told, Told::Waiting(_)));
        assert_eq!(desk.colour(), Some(round - 1));
        desk.save(&recipe(round));
        assert!(desk.shows(round));
    }
}

#[test]
fn it_says_which_paths_it_waits_for() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    desk.save("(");
    let index = desk.wait_for(0, |told| matches!(told, Told::Waiting(_)));
    let Told::Waiting(paths) = &desk.told()[index] else {
        unreachable!("it was found")
    };
    assert_eq!(paths, &[desk.at("recipe.ron")]);
}

#[test]
fn what_is_mended_at_once_is_never_told() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    let mut was_in_time = true;
    for colour in 2..6 {
        let start = Instant::now();
        desk.save("");
        pause(80);
        desk.save(&recipe(colour)[..60]);
        pause(80);
        desk.save(&recipe(colour));
        // A machine that is busy may take its time: then it is right to tell.
        was_in_time &= start.elapsed() < Duration::from_millis(240);
        assert!(desk.shows(colour));
    }
    pause(400);
    let told = desk.count(|told| matches!(told, Told::Failed(_)));
    assert!(told == 0 || !was_in_time, "{told}");
}

#[test]
fn an_empty_file_is_told_when_it_stays_empty() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    desk.save("");
    let message = desk.wait_for_failure(0);
    assert!(message.contains("holds no recipe"), "{message}");
    assert_eq!(desk.colour(), Some(1));
}

#[test]
fn a_recipe_that_is_not_there_is_waited_for() {
    let desk = Desk::with(Setup::default(), |_| ());
    let message = desk.wait_for_failure(0);
    assert!(message.contains("could not be read"), "{message}");
    desk.save(&recipe(7));
    assert!(desk.shows(7));
    fs::remove_file(desk.at("recipe.ron")).unwrap();
    desk.wait_for_failure(desk.told().len());
    assert_eq!(desk.colour(), Some(7));
    desk.save(&recipe(8));
    assert!(desk.shows(8));
}

#[test]
fn a_folder_that_is_not_there_is_waited_for() {
    let setup = Setup {
        recipes: vec!["far/away/recipe.ron".into()],
        ..Setup::default()
    };
    let desk = Desk::with(setup, |_| ());
    desk.wait_for_failure(0);
    fs::create_dir_all(desk.at("far/away")).unwrap();
    fs::write(desk.at("far/away/recipe.ron"), recipe(9)).unwrap();
    assert!(desk.shows(9));
}

#[test]
fn an_output_that_cannot_be_written_is_told_and_tried_again_after_the_next_change() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    fs::remove_dir_all(desk.at("out")).unwrap();
    fs::write(desk.at("out"), "in the way").unwrap();
    let from = desk.told().len();
    desk.save(&recipe(2));
    let message = desk.wait_for_failure(from);
    assert!(message.contains("out"), "{message}");
    fs::remove_file(desk.at("out")).unwrap();
    desk.save(&recipe(3));
    assert!(desk.shows(3));
}
