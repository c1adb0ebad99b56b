//! After a run was cancelled it puts nothing in place, whatever it was doing.

use super::*;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use yosegi::world::{Memory, PendingFile};

/// What is told of an operation before it is done.
type Watcher = Arc<dyn Fn(&'static str, &Path) + Send + Sync>;

/// Files that tell of each operation on them.
#[derive(Clone)]
struct Watched {
    files: Memory,
    watcher: Watcher,
}

struct WatchedFile {
    file: Box<dyn PendingFile>,
    path: PathBuf,
    watcher: Watcher,
}

struct WatchedStream {
    stream: Box<dyn Read>,
    path: PathBuf,
    watcher: Watcher,
}

impl World for Watched {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        (self.watcher)("read", path);
        self.files.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        (self.watcher)("open", path);
        Ok(Box::new(WatchedStream {
            stream: self.files.open(path)?,
            path: path.to_owned(),
            watcher: Arc::clone(&self.watcher),
        }))
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        (self.watcher)("create", path);
        Ok(Box::new(WatchedFile {
            file: self.files.create(path)?,
            path: path.to_owned(),
            watcher: Arc::clone(&self.watcher),
        }))
    }
}

impl Read for WatchedStream {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        (self.watcher)("read", &self.path);
        self.stream.read(buffer)
    }
}

impl Read for WatchedFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for WatchedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        (self.watcher)("write", &self.path);
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        (self.watcher)("flush", &self.path);
        self.file.flush()
    }
}

impl Seek for WatchedFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for WatchedFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        (self.watcher)("commit", &self.path);
        self.file.commit()
    }
}

/// The files of `workshop` with someone who watches, and an engine on them.
fn watched(
    workshop: &Workshop,
    watcher: impl Fn(&'static str, &Path) + Send + Sync + 'static,
) -> Workshop {
    let world = Watched {
        files: workshop.files.clone(),
        watcher: Arc::new(watcher),
    };
    workshop.another_on(Arc::new(world), alone())
}

/// The maps as they should be.
fn right_maps() -> [Vec<u8>; 2] {
    let workshop = Workshop::new("recipes", alone());
    workshop.run(PAIR);
    MAPS.map(|name| workshop.map(name))
}

#[test]
fn a_file_on_its_way_is_waited_for_and_none_follows() {
    let workshop = Workshop::new("recipes", alone());
    let (reached, reaches) = mpsc::channel();
    let switch = Cancel::new();
    let seen = switch.clone();
    let slow = watched(&workshop, move |what, path| {
        if what == "commit" && path.ends_with(MAPS[0]) {
            reached.send(()).unwrap();
            // The map is put in place only after someone has cancelled the run.
            while !seen.is_cancelled() {
                thread::yield_now();
            }
        }
    });
    thread::scope(|scope| {
        let run = scope.spawn(|| slow.render(PAIR, &[], switch.clone(), &|_| {}));
        reaches.recv().unwrap();
        switch.cancel();
        let then = workshop.files.paths();
        assert_eq!(workshop.maps(), [MAPS[0]]);
        assert_eq!(run.join().unwrap().result, Err(RunError::Cancelled));
        assert_eq!(workshop.files.paths(), then);
    });
    assert_eq!(workshop.map(MAPS[0]), right_maps()[0]);
}

/// Cancels a run of `PAIR` at its operation number `at`; gives what it was about, if it came so far.
fn cancel_at(workshop: &Workshop, at: usize, right: &[Vec<u8>; 2]) -> Option<String> {
    let cancel = Cancel::new();
    let (count, switch) = (AtomicUsize::new(0), cancel.clone());
    let cancelled = Arc::new(Mutex::new(None));
    let (told, files) = (Arc::clone(&cancelled), workshop.files.clone());
    let doomed = watched(workshop, move |what, path| {
        if told.lock().unwrap().is_some() {
            assert_ne!(what, "commit", "{} after the end", path.display());
        } else if what != "commit" && count.fetch_add(1, Ordering::Relaxed) == at {
            switch.cancel();
            *told.lock().unwrap() = Some((format!("{what} {}", path.display()), files.paths()));
        }
    });
    let run = doomed.render(PAIR, &[], cancel, &|event| {
        assert!(!matches!(event, Event::StoreFailed { .. }), "{event:?}");
    });
    let (place, before) = cancelled.lock().unwrap().take()?;
    match run.result {
        Err(RunError::Cancelled) => assert_eq!(run.events.last(), Some(&Event::Cancelled)),
        Ok(maps) => assert_eq!(maps.len(), 2, "{place}"),
        Err(error) => panic!("{place}: {error:?}"),
    }
    assert_eq!(workshop.files.paths(), before, "{place}");
    for (name, right) in MAPS.iter().zip(right) {
        if workshop.maps().iter().any(|map| map == name) {
            assert!(workshop.map(name) == *right, "{place}: {name} is torn");
        }
    }
    Some(place)
}

/// Cancels runs at every operation, each on the files that `prepare` makes; gives the numbers of operations
/// by what they are about.
fn sweep(prepare: impl Fn() -> Workshop) -> [usize; 2] {
    let right = right_maps();
    let mut counts = [0; 2];
    for at in 0.. {
        let workshop = prepare();
        let Some(place) = cancel_at(&workshop, at, &right) else {
            assert_eq!(MAPS.map(|name| workshop.map(name)), right);
            break;
        };
        counts[usize::from(place.contains("/out/"))] += 1;
        // What is left helps the next run, and harms nothing.
        workshop.another(alone()).run(PAIR);
        assert_eq!(MAPS.map(|name| workshop.map(name)), right, "{place}");
    }
    counts
}

#[test]
fn a_run_that_paints_can_be_cancelled_at_every_operation() {
    let [others, maps] = sweep(|| Workshop::new("recipes", alone()));
    assert!(others > 30 && maps > 20, "{others} {maps}");
}

#[test]
fn a_run_that_restores_can_be_cancelled_at_every_operation() {
    let [others, maps] = sweep(|| {
        let workshop = Workshop::new("recipes", alone());
        workshop.run(PAIR);
        for name in MAPS {
            let path = workshop.folder.join("out").join(name);
            workshop.files.remove(&path).unwrap();
        }
        workshop
    });
    assert!(others > 10 && maps >= 6, "{others} {maps}");
}

#[test]
fn an_engine_beside_another_shares_what_both_remember() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            memory: 64 << 20,
            ..alone()
        },
    );
    workshop.run(PAIR);
    let beside = Workshop {
        engine: workshop.engine.beside().unwrap(),
        files: workshop.files.clone(),
        folder: workshop.folder.clone(),
        size: None,
    };
    assert_eq!(
        beside.engine.remembered_bytes(),
        workshop.engine.remembered_bytes()
    );
    let other_cut = PAIR.replace("offset: 20", "offset: 21");
    let log = beside.run(&other_cut);
    assert!(log.contains("reused tree (memory)"), "{log}");
    assert!(log.contains("up to date pale_base_color.png"), "{log}");
}
