//! Notices that are lost, that do not come, and that the system refuses.

use super::desk::{Desk, Setup, recipe};
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use yosegi::watch::{Options, Told};
use yosegi::world::{Disk, Heard, Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World};

/// What a disk does about notices.
#[derive(Clone, Copy)]
enum Behaviour {
    /// Promises them and sends none, as network drives do.
    Silent,
    /// Refuses, as when a limit is reached.
    Refused,
    /// Refuses to follow anything.
    Limited,
}

/// The disk with other notices.
struct Odd {
    behaviour: Behaviour,
    wake: Mutex<Option<Wake>>,
}

impl Odd {
    fn new(behaviour: Behaviour) -> Arc<Odd> {
        let wake = Mutex::new(None);
        Arc::new(Odd { behaviour, wake })
    }
}

struct Deaf(Behaviour);

impl Notices for Deaf {
    fn follow(&mut self, _: &BTreeSet<PathBuf>) -> Result<bool, NoticesError> {
        match self.0 {
            Behaviour::Limited => Err(NoticesError::new("the limit is reached")),
            _ => Ok(false),
        }
    }
}

impl World for Odd {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        Disk.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        Disk.open(path)
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        Disk.real_path(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        Disk.create(path)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        Disk.list(folder)
    }

    fn stamp(&self, path: &Path) -> io::Result<Stamp> {
        Disk.stamp(path)
    }

    fn notices(&self, wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        *self.wake.lock().unwrap() = Some(wake);
        match self.behaviour {
            Behaviour::Refused => Err(NoticesError::new("there are none")),
            behaviour => Ok(Box::new(Deaf(behaviour))),
        }
    }
}

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
    let world = Odd::new(Behaviour::Silent);
    let desk = desk(Arc::clone(&world), Options::default());
    assert!(desk.shows(1));
    // The same size and the same stamp: only reading finds it, and only the loss makes it read.
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
