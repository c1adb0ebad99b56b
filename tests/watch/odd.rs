//! The disk with other notices, other stamps, or less speed.

use std::collections::BTreeSet;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use yosegi::world::{Disk, Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World};

/// What a disk does about notices.
#[derive(Clone, Copy)]
pub(crate) enum Behaviour {
    /// Promises them and sends none, as network drives do.
    Silent,
    /// Refuses, as when a limit is reached.
    Refused,
    /// Refuses to follow anything.
    Limited,
    /// Sends none, and has one stamp for all files.
    Stampless,
    /// Sends them; pictures are slow to read.
    Slow,
}

/// How long a picture takes.
pub(crate) const SLOW: Duration = Duration::from_millis(400);

/// The disk with other notices.
pub(crate) struct Odd {
    behaviour: Behaviour,
    pub(crate) wake: Mutex<Option<Wake>>,
    reading: AtomicUsize,
    /// The most pictures that were read at the same time.
    pub(crate) most: AtomicUsize,
}

impl Odd {
    pub(crate) fn new(behaviour: Behaviour) -> Arc<Odd> {
        Arc::new(Odd {
            behaviour,
            wake: Mutex::new(None),
            reading: AtomicUsize::new(0),
            most: AtomicUsize::new(0),
        })
    }

    /// Reads as slowly as a library decodes.
    fn delay(&self, path: &Path) {
        let is_picture = path.extension().is_some_and(|it| it == "png");
        let is_input = !path.components().any(|part| part.as_os_str() == "out");
        if matches!(self.behaviour, Behaviour::Slow) && is_picture && is_input {
            let reading = self.reading.fetch_add(1, Ordering::SeqCst) + 1;
            self.most.fetch_max(reading, Ordering::SeqCst);
            std::thread::sleep(SLOW);
            self.reading.fetch_sub(1, Ordering::SeqCst);
        }
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
        self.delay(path);
        Disk.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        self.delay(path);
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
        match self.behaviour {
            Behaviour::Stampless => Disk.stamp(Path::new(env!("CARGO_MANIFEST_DIR"))),
            _ => Disk.stamp(path),
        }
    }

    fn notices(&self, wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        *self.wake.lock().unwrap() = Some(Arc::clone(&wake));
        match self.behaviour {
            Behaviour::Slow => Disk.notices(wake),
            Behaviour::Refused => Err(NoticesError::new("there are none")),
            behaviour => Ok(Box::new(Deaf(behaviour))),
        }
    }
}
