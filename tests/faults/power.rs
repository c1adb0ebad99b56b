//! A loss of power: what was not synced is gone, though it was in its place already.

use super::place::{End, STATES, State};
use super::*;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use yosegi::world::{Disk, Listed, PendingFile, World};

/// A disk that remembers which of its files were put in place without a sync.
#[derive(Clone, Default)]
struct Forgetful {
    unsynced: Arc<Mutex<BTreeSet<PathBuf>>>,
}

struct ForgetfulFile {
    file: Box<dyn PendingFile>,
    path: PathBuf,
    is_synced: bool,
    world: Forgetful,
}

impl Forgetful {
    fn file(&self, path: &Path, file: Box<dyn PendingFile>) -> Box<dyn PendingFile> {
        Box::new(ForgetfulFile {
            file,
            path: path.to_owned(),
            is_synced: false,
            world: self.clone(),
        })
    }
}

impl World for Forgetful {
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
        Ok(self.file(path, Disk.create(path)?))
    }

    fn create_aside(&self, path: &Path, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        Ok(self.file(path, Disk.create_aside(path, aside)?))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        Disk.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        Disk.remove(path)
    }
}

impl Read for ForgetfulFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for ForgetfulFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.is_synced = false;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for ForgetfulFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for ForgetfulFile {
    fn sync(&mut self) -> io::Result<()> {
        self.is_synced = true;
        self.file.sync()
    }

    fn commit(self: Box<Self>) -> io::Result<()> {
        let mut unsynced = self.world.unsynced.lock().unwrap();
        if self.is_synced {
            unsynced.remove(&self.path);
        } else {
            unsynced.insert(self.path);
        }
        self.file.commit()
    }
}

/// What a file may be after a loss of power: empty, cut off, or as long as it was and without its contents.
const LOSSES: [fn(&mut Vec<u8>); 3] = [
    Vec::clear,
    |bytes| bytes.truncate(bytes.len() / 2),
    |bytes| bytes.fill(0),
];

#[test]
fn a_loss_of_power_leaves_old_or_new_maps_and_at_worst_an_empty_store() {
    for (case, state) in CASES
        .into_iter()
        .flat_map(|case| STATES.map(|it| (case, it)))
    {
        let place = Place::new(case, state);
        for loss in LOSSES {
            place.reset();
            let world = Forgetful::default();
            let shared: Arc<dyn World> = Arc::new(world.clone());
            assert_eq!(place.render(&shared, "store").end, End::Done);
            let lost = world.unsynced.lock().unwrap().clone();
            let context = format!("{}, {state:?}", case.name);
            for path in &lost {
                assert!(
                    path.starts_with(place.path("store")),
                    "{context}: {}",
                    path.display()
                );
                let mut bytes = fs::read(path).unwrap();
                loss(&mut bytes);
                fs::write(path, bytes).unwrap();
            }
            assert!(!lost.is_empty() || state != State::Cold, "{context}");
            place.judge(true, &context);
            place.recover(&context);
            // Again with nothing in place, so that the store is asked for the maps.
            fs::remove_dir_all(place.path("out")).unwrap();
            place.recover(&context);
        }
    }
}

#[test]
fn maps_that_need_not_be_durable_do_not_wait_for_the_disk() {
    for state in [State::Cold, State::Warm] {
        let place = Place::new(CASES[0], state);
        place.reset();
        let world = Forgetful::default();
        let shared: Arc<dyn World> = Arc::new(world.clone());
        assert_eq!(place.render_as(&shared, "store", false).end, End::Done);
        let unsynced = world.unsynced.lock().unwrap();
        for map in place.case.maps {
            assert!(
                unsynced.contains(&place.path("out").join(map)),
                "{state:?}: {map}"
            );
        }
        place.judge(true, "not durable");
    }
}
