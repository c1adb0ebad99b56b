//! Notices that are lost, that do not come, and that the system refuses.

use super::desk::{Desk, Setup, pause, recipe};
use super::odd::{Behaviour, Odd};
use std::fs;
use std::sync::Arc;
use std::time::Duration;
use yosegi::watch::{Options, Told};
use yosegi::world::Heard;

fn desk(world: Arc<Odd>, options: Options) -> Desk {
    let setup = Setup {
        world,
        options,
        ..Setup::default()
    };
    Desk::with(setup, |folder| {
        fs::write(folder.join("recipe.ron"), recipe(1)).unwrap();
    })
}

fn is_polling(told: &Told) -> bool {
    matches!(told, Told::Polling { .. })
}

#[test]
fn where_there_are_no_notices_files_are_looked_at_and_that_is_said_once() {
    for behaviour in [Behaviour::Refused, Behaviour::Limited] {
        let desk = desk(Odd::new(behaviour), Options::default());
        assert!(desk.shows(1));
        for colour in 2..5 {
            desk.save(&recipe(colour));
            assert!(desk.shows(colour));
        }
        assert_eq!(desk.count(is_polling), 1);
    }
}

#[test]
fn where_promised_notices_do_not_come_that_is_found_out() {
    let desk = desk(Odd::new(Behaviour::Silent), Options::default());
    assert!(desk.shows(1));
    desk.save(&recipe(2));
    assert!(desk.shows(2));
    let index = desk.wait_for(0, is_polling);
    let Told::Polling { reason, .. } = &desk.told()[index] else {
        unreachable!("it was found")
    };
    assert!(reason.contains("recipe.ron"), "{reason}");
    desk.save(&recipe(3));
    assert!(desk.shows(3));
    assert_eq!(desk.count(is_polling), 1);
}

#[test]
fn lost_notices_make_everything_be_read_again() {
    let world = Odd::new(Behaviour::Stampless);
    let desk = desk(Arc::clone(&world), Options::default());
    assert!(desk.shows(1));
    // Every stamp is the same: only reading finds it, and only the loss makes it read.
    desk.save(&recipe(9));
    pause(1300);
    assert_eq!(desk.colour(), Some(1));
    for colour in 2..5 {
        desk.save(&recipe(colour));
        let wake = world.wake.lock().unwrap().clone().unwrap();
        wake(Heard::All);
        assert!(desk.shows(colour));
    }
}

#[test]
fn whoever_asks_for_looks_gets_no_notices() {
    let world = Odd::new(Behaviour::Silent);
    let options = Options {
        preview: false,
        poll: Some(Duration::from_millis(20)),
    };
    let desk = desk(Arc::clone(&world), options);
    assert!(desk.shows(1));
    desk.save(&recipe(2));
    assert!(desk.shows(2));
    assert!(world.wake.lock().unwrap().is_none());
    assert_eq!(desk.count(is_polling), 0);
}

#[test]
fn a_flood_of_notices_hides_no_save() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    for round in 0..4000 {
        fs::write(desk.at(&format!("noise{}", round % 50)), "x").unwrap();
    }
    desk.save(&recipe(2));
    assert!(desk.shows(2));
}

#[test]
fn half_saved_files_are_no_mistakes_between_rare_looks() {
    let options = Options {
        preview: false,
        poll: Some(Duration::from_millis(600)),
    };
    let desk = desk(Odd::new(Behaviour::Silent), options);
    assert!(desk.shows(1));
    for colour in 2..8 {
        desk.save("");
        pause(150);
        desk.save(&recipe(colour));
        pause(370);
    }
    assert!(desk.shows(7));
    assert_eq!(desk.count(|told| matches!(told, Told::Failed(_))), 0);
}
