//! Disks that fail from some operation on; `tests/faults` has those that fail once.

use super::*;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use yosegi::world::{Memory, PendingFile};

/// A disk whose operation number `first` fails, and all that follow.
#[derive(Clone)]
struct Failing {
    files: Memory,
    first: usize,
    done: Arc<AtomicUsize>,
}

struct FailingFile {
    file: Box<dyn PendingFile>,
    world: Failing,
}

impl Failing {
    fn new(files: &Memory, first: usize) -> Failing {
        Failing {
            files: files.clone(),
            first,
            done: Arc::default(),
        }
    }

    fn step(&self) -> io::Result<()> {
        let number = self.done.fetch_add(1, Ordering::Relaxed);
        if number >= self.first {
            return Err(io::Error::new(
                io::ErrorKind::StorageFull,
                "the disk is full",
            ));
        }
        Ok(())
    }
}

impl World for Failing {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.step()?;
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.step()?;
        Ok(Box::new(FailingFile {
            file: self.files.create(path)?,
            world: self.clone(),
        }))
    }
}

impl Read for FailingFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for FailingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.world.step()?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for FailingFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.world.step()?;
        self.file.seek(to)
    }
}

impl PendingFile for FailingFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        self.world.step()?;
        self.file.commit()
    }
}

/// A PNG and an EXR.
fn recipe() -> String {
    edit(
        PAIR,
        "\"deep\": maps(of: \"right\",",
        "\"deep\": maps(of: \"right\", format: exr_half,",
    )
}

const MAPS: [&str; 2] = ["deep_base_color.exr", "pale_base_color.png"];

/// One thread, so that operations have an order.
fn alone() -> Options {
    Options {
        threads: Some(1),
        ..stored()
    }
}

/// Renders on a disk that fails from operation `first` on; gives the number of operations.
fn render_failing(first: usize, right: &[Vec<u8>]) -> usize {
    let healthy = Workshop::new("recipes", alone());
    let world = Failing::new(&healthy.files, first);
    let failing = healthy.another_on(Arc::new(world.clone()), alone());
    let run = failing.render(&recipe(), &[], Cancel::new(), &|_| {});
    assert!(
        matches!(run.result, Ok(_) | Err(RunError::Files(_))),
        "operation {first}: {:?}",
        run.result
    );
    if let Err(error) = &run.result {
        assert_eq!(
            error.diagnostics()[0].code,
            Code::OutputNotWritten,
            "operation {first}"
        );
    }
    let there = failing.maps();
    assert!(
        there.len() == 2 || run.result.is_err(),
        "operation {first}: {there:?}"
    );
    for (name, right) in MAPS.iter().zip(right) {
        let is_there = there.iter().any(|map| map == name);
        assert!(
            !is_there || failing.map(name) == *right,
            "operation {first}: {name}"
        );
    }
    // The disk is well again: whatever the store holds, the maps come out right.
    let next = healthy.another(alone());
    next.run(&recipe());
    assert!(
        MAPS.map(|name| next.map(name)) == right,
        "after operation {first}"
    );
    world.done.load(Ordering::Relaxed)
}

#[test]
fn a_disk_that_fails_from_anywhere_on_never_leaves_a_wrong_map() {
    let healthy = without_store();
    healthy.run(&recipe());
    let right = MAPS.map(|name| healthy.map(name));
    let operations = render_failing(usize::MAX, &right);
    assert!(operations > 30, "{operations}");
    for first in 0..operations {
        render_failing(first, &right);
    }
}

#[test]
fn a_store_that_cannot_be_written_is_said_and_does_no_harm() {
    let healthy = without_store();
    let log = healthy.run(&recipe());
    let full = Workshop::new("recipes", alone());
    let failing = full.another_on(Arc::new(NoStore(full.files.clone())), alone());
    let told = failing.run(&recipe());
    assert!(told.contains("store failed: the store is full"), "{told}");
    let rest: Vec<&str> = told
        .lines()
        .filter(|line| !line.starts_with("store"))
        .collect();
    assert_eq!(rest.join("\n"), log);
    assert_eq!(
        MAPS.map(|name| failing.map(name)),
        MAPS.map(|name| healthy.map(name))
    );
}

/// A disk with no room for a store.
struct NoStore(Memory);

impl World for NoStore {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.0.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        if path.starts_with("store") {
            return Err(io::Error::new(
                io::ErrorKind::StorageFull,
                "the store is full",
            ));
        }
        self.0.create(path)
    }
}

#[test]
fn runs_at_the_same_time_share_an_engine() {
    let alone = without_store();
    alone.run(PAIR);
    let names = ["deep_base_color.png", "pale_base_color.png"];
    let right = names.map(|name| alone.map(name));
    let shared = with_store();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| shared.run(PAIR));
        }
    });
    assert_eq!(names.map(|name| shared.map(name)), right);
    assert_snapshot!(shared.run(PAIR), @"
    up to date deep_base_color.png
    up to date pale_base_color.png
    ");
}

/// Another run puts its own map in place right after a map was written, before it is remembered.
struct Overtaken {
    files: Memory,
    other: Vec<u8>,
}

impl World for Overtaken {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn io::Read>> {
        if path.ends_with("board_base_color.png") {
            self.files.insert(path, self.other.clone());
        }
        Ok(Box::new(io::Cursor::new(self.files.read(path)?)))
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.files.create(path)
    }
}

#[test]
fn a_map_of_another_run_is_not_remembered_as_ours() {
    let other = without_store();
    let changed = BOARD.replace("thickening: 3,", "thickening: 4,");
    other.run(&changed);
    let right = without_store();
    right.run(BOARD);
    let workshop = with_store();
    let world = Overtaken {
        files: workshop.files.clone(),
        other: other.map("board_base_color.png"),
    };
    let options = Options {
        store: Some("store".into()),
        ..options()
    };
    workshop.another_on(Arc::new(world), options).run(BOARD);
    workshop.run(BOARD);
    assert_eq!(
        workshop.map("board_base_color.png"),
        right.map("board_base_color.png")
    );
}
