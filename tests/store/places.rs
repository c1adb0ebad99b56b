//! Folders and disks that the store cannot rely on: runs go on without it, and say so once.

use super::*;
use std::fs;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;
use workshop::Run;
use yosegi::engine::{Event, clean_store, store_status};
use yosegi::world::{Disk, Listed, Memory, PendingFile};

/// Why the store failed, once for each time it was said.
fn failures(run: &Run) -> Vec<String> {
    assert!(run.result.is_ok(), "{:?}", run.result);
    let failures = run.events.iter().filter_map(|event| match event {
        Event::StoreFailed { reason } => Some(reason.clone()),
        _ => None,
    });
    failures.collect()
}

fn render(workshop: &Workshop) -> Run {
    workshop.render(BOARD, &[], Cancel::new(), &|_| {})
}

/// A workshop on disk, with its store in a folder of the temporary one.
fn on_disk(folder: &TempDir, store: &Path) -> Workshop {
    let options = Options {
        store: Some(folder.path().join(store)),
        ..options()
    };
    let mut workshop = workshop(options.clone()).another_on(Arc::new(Disk), options);
    workshop.folder = folder.path().to_owned();
    workshop
}

fn maps_on_disk(folder: &TempDir) -> [Vec<u8>; 2] {
    MAPS.map(|name| fs::read(folder.path().join("out").join(name)).unwrap())
}

/// What a faulty disk does with the store; everything else is well.
#[derive(Clone)]
struct Faulty {
    files: Memory,
    fault: Fault,
    /// Bytes written to the store, or entries put in place.
    done: Arc<AtomicUsize>,
}

#[derive(Clone, Copy)]
enum Fault {
    /// Nothing can be made.
    NotMade(io::ErrorKind),
    /// Nothing can be read or made.
    Closed(io::ErrorKind),
    /// There is room for so many bytes.
    Full(usize),
    /// Of the entries put in place every so many-th is there in part only.
    Torn(usize),
    /// Every so many-th is lost.
    Lost(usize),
}

impl Faulty {
    fn check(&self, path: &Path, makes: bool) -> io::Result<()> {
        match self.fault {
            _ if !path.starts_with(STORE) => Ok(()),
            Fault::Closed(kind) => Err(kind.into()),
            Fault::NotMade(kind) if makes => Err(kind.into()),
            _ => Ok(()),
        }
    }
}

impl World for Faulty {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.check(path, false)?;
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.check(path, true)?;
        let file = self.files.create(path)?;
        if !path.starts_with(STORE) {
            return Ok(file);
        }
        Ok(Box::new(FaultyFile {
            file,
            bytes: vec![],
            path: path.to_owned(),
            world: self.clone(),
        }))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.check(folder, false)?;
        self.files.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.check(path, true)?;
        self.files.remove(path)
    }
}

struct FaultyFile {
    file: Box<dyn PendingFile>,
    bytes: Vec<u8>,
    path: PathBuf,
    world: Faulty,
}

impl Read for FaultyFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for FaultyFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Fault::Full(room) = self.world.fault {
            let done = self.world.done.fetch_add(bytes.len(), Ordering::Relaxed);
            if done + bytes.len() > room {
                return Err(io::ErrorKind::StorageFull.into());
            }
        }
        self.bytes.extend_from_slice(bytes);
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for FaultyFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for FaultyFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        let number = self.world.done.fetch_add(1, Ordering::Relaxed);
        match self.world.fault {
            Fault::Torn(every) if number.is_multiple_of(every) => {
                let part = self.bytes.len() * (number % 7) / 7;
                self.world.files.insert(self.path, &self.bytes[..part]);
                Ok(())
            }
            Fault::Lost(every) if number.is_multiple_of(every) => Ok(()),
            _ => self.file.commit(),
        }
    }
}

fn faulty(workshop: &Workshop, fault: Fault) -> (Workshop, Arc<AtomicUsize>) {
    let done = Arc::default();
    let world = Faulty {
        files: workshop.files.clone(),
        fault,
        done: Arc::clone(&done),
    };
    (workshop.another_on(Arc::new(world), options()), done)
}

#[test]
fn a_store_that_cannot_be_used_is_told_once_and_the_run_goes_on() {
    let right = right_maps();
    let kinds = [
        io::ErrorKind::PermissionDenied,
        io::ErrorKind::ReadOnlyFilesystem,
        io::ErrorKind::NotADirectory,
        io::ErrorKind::Other,
    ];
    for kind in kinds {
        for fault in [Fault::Closed(kind), Fault::NotMade(kind)] {
            let workshop = workshop(options());
            let (faulty, _) = faulty(&workshop, fault);
            // Each run says it, and says it once although nothing of eight entries can be written.
            for _ in 0..2 {
                assert_eq!(failures(&render(&faulty)).len(), 1);
                assert_eq!(MAPS.map(|name| workshop.map(name)), right);
            }
            assert_eq!(entries(&workshop), [] as [PathBuf; 0]);
        }
    }
}

#[test]
fn a_full_store_that_cannot_be_written_is_read_without_a_word() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let fault = Fault::NotMade(io::ErrorKind::ReadOnlyFilesystem);
    workshop.files.remove(&place(&workshop, MAPS[0])).unwrap();
    let run = render(&faulty(&workshop, fault).0);
    assert!(failures(&run).is_empty());
    assert!(
        run.log().contains("restored board_base_color.png"),
        "{}",
        run.log()
    );
}

#[test]
fn a_disk_that_is_full_at_any_byte_costs_one_warning_and_no_map() {
    let right = right_maps();
    let whole = workshop(options());
    let (counting, written) = faulty(&whole, Fault::Full(usize::MAX));
    render(&counting);
    let bytes = written.load(Ordering::Relaxed);
    assert!(bytes > 3000, "{bytes}");
    // Every byte around the ends of entries lies on some step.
    for room in (0..bytes).step_by(17).chain([bytes - 9]) {
        let workshop = workshop(options());
        let (full, _) = faulty(&workshop, Fault::Full(room));
        assert_eq!(failures(&render(&full)).len(), 1, "{room}");
        assert_eq!(MAPS.map(|name| workshop.map(name)), right);
        // Nothing half-written is found later.
        for map in MAPS {
            workshop.files.remove(&place(&workshop, map)).unwrap();
        }
        assert!(failures(&render(&workshop.another(options()))).is_empty());
        assert_eq!(MAPS.map(|name| workshop.map(name)), right, "{room}");
    }
}

#[test]
fn a_disk_that_tears_or_loses_entries_never_gives_a_wrong_map() {
    let right = right_maps();
    for every in 1..8 {
        for fault in [Fault::Torn(every), Fault::Lost(every)] {
            let workshop = workshop(options());
            let (faulty, _) = faulty(&workshop, fault);
            for _ in 0..4 {
                assert!(failures(&render(&faulty)).is_empty());
                assert_eq!(MAPS.map(|name| workshop.map(name)), right);
                for map in MAPS {
                    workshop.files.remove(&place(&workshop, map)).unwrap();
                }
                let other = workshop.another(options());
                render(&other);
                assert_eq!(MAPS.map(|name| workshop.map(name)), right);
            }
        }
    }
}

#[test]
fn a_store_that_is_deleted_during_a_run_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let right = right_maps();
    let workshop = on_disk(&folder, Path::new("deep/store"));
    let store = folder.path().join("deep");
    for event in ["StructureBuilt", "MapWritten", "OutputDone"] {
        let run = workshop.render(BOARD, &[], Cancel::new(), &|heard| {
            if format!("{heard:?}").starts_with(event) && store.exists() {
                fs::remove_dir_all(&store).unwrap();
            }
        });
        assert!(failures(&run).is_empty(), "{event}");
        assert_eq!(maps_on_disk(&folder), right);
        let entries = store_status(&Disk, &store.join("store")).unwrap();
        assert!(entries.iter().map(|it| it.entries).sum::<usize>() > 0);
        fs::remove_dir_all(&store).unwrap();
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}

#[test]
fn stores_in_deep_and_foreign_folders_work_and_impossible_ones_are_told_once() {
    let right = right_maps();
    let long = "a".repeat(200);
    for name in [
        "Größe 木目 寄木細工".to_owned(),
        "with space and 'quotes' $HOME".to_owned(),
        format!("{long}/{long}/{long}"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        for expected in ["written", "up to date"] {
            let run = render(&on_disk(&folder, Path::new(&name)));
            assert!(failures(&run).is_empty(), "{name}");
            assert!(run.log().contains(expected), "{name}");
        }
        assert_eq!(maps_on_disk(&folder), right);
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "not a folder").unwrap();
    for name in ["file", "file/store", &"a".repeat(300)] {
        assert_eq!(
            failures(&render(&on_disk(&folder, Path::new(name)))).len(),
            1
        );
        assert_eq!(maps_on_disk(&folder), right);
    }
    assert_eq!(
        fs::read(folder.path().join("file")).unwrap(),
        b"not a folder"
    );
}

/// Files, folders and links that are not ours, all over the store.
#[cfg(unix)]
#[test]
fn what_is_not_ours_is_neither_followed_nor_removed() {
    use std::os::unix::fs::symlink;
    let right = right_maps();
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("store");
    let first = on_disk(&folder, Path::new("store"));
    render(&first);
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    fs::write(elsewhere.join("mine"), "mine").unwrap();
    // Every entry gives way to a link to a file that must not be written.
    let mut links = vec![];
    for family in ["structure", "map", "plan", "run"] {
        for digits in fs::read_dir(store.join(family)).unwrap() {
            for entry in fs::read_dir(digits.unwrap().path()).unwrap() {
                let path = entry.unwrap().path();
                fs::remove_file(&path).unwrap();
                symlink(elsewhere.join("mine"), &path).unwrap();
                links.push(path);
            }
        }
    }
    // One family is a link to a folder of someone else, with a file that is named as an entry.
    fs::rename(store.join("file"), elsewhere.join("file")).unwrap();
    symlink(elsewhere.join("file"), store.join("file")).unwrap();
    links.push(store.join("file"));
    // The folder of unfinished entries leads to where someone else has one.
    fs::write(elsewhere.join(".yosegi-a.part"), "half").unwrap();
    fs::remove_dir(store.join("unfinished")).unwrap();
    symlink(&elsewhere, store.join("unfinished")).unwrap();
    links.push(store.join("unfinished"));
    fs::create_dir_all(store.join("map/ab").join("0".repeat(62))).unwrap();
    fs::write(store.join("map/ab/notes.txt"), "notes").unwrap();
    fs::create_dir_all(store.join("map/folder")).unwrap();
    let foreign = count(&elsewhere);

    let run = render(&on_disk(&folder, Path::new("store")));
    assert_eq!(failures(&run).len(), 1);
    assert!(
        failures(&run)[0].ends_with("is a symbolic link"),
        "{:?}",
        failures(&run)
    );
    assert_eq!(maps_on_disk(&folder), right);
    let small = Options {
        store: Some(store.clone()),
        store_limit: 0,
        ..options()
    };
    let mut small = first.another_on(Arc::new(Disk), small);
    small.folder = folder.path().to_owned();
    render(&small);
    clean_store(&Disk, &store).unwrap();
    assert!(links.iter().all(|path| path.is_symlink()));
    assert!(store.join("map/ab").join("0".repeat(62)).is_dir());
    assert!(store.join("map/ab/notes.txt").exists() && store.join("map/folder").is_dir());
    assert_eq!(count(&elsewhere), foreign);
    assert_eq!(fs::read(elsewhere.join("mine")).unwrap(), b"mine");
    // The store itself may lie behind a link, which is the user's own.
    let real = folder.path().join("real");
    symlink(&real, folder.path().join("linked")).unwrap();
    fs::create_dir(&real).unwrap();
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    assert!(failures(&render(&on_disk(&folder, Path::new("linked")))).is_empty());
    assert!(
        render(&on_disk(&folder, Path::new("linked")))
            .log()
            .contains("up to date")
    );
    clean_store(&Disk, &folder.path().join("linked")).unwrap();
    assert!(folder.path().join("linked").is_symlink());
}

/// Files below a folder; links are not followed.
#[cfg(unix)]
fn count(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).unwrap();
    let entries = entries.map(|entry| entry.unwrap().path());
    let inside = |path: PathBuf| {
        if path.is_dir() && !path.is_symlink() {
            count(&path)
        } else {
            1
        }
    };
    entries.map(inside).sum()
}

#[test]
fn cleaning_removes_no_folder_from_which_it_removed_nothing() {
    let folder = tempfile::tempdir().unwrap();
    // Named as a store names them, and of someone else.
    let empty = ["map/ab", "plan", "unfinished"].map(|name| folder.path().join(name));
    for place in &empty {
        fs::create_dir_all(place).unwrap();
    }
    clean_store(&Disk, folder.path()).unwrap();
    assert!(empty.iter().all(|place| place.is_dir()));

    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("store");
    let workshop = on_disk(&folder, Path::new("store"));
    render(&workshop);
    clean_store(&Disk, &store).unwrap();
    assert!(!store.exists());
    render(&workshop);
    fs::create_dir(store.join("mine")).unwrap();
    clean_store(&Disk, &store).unwrap();
    let left = fs::read_dir(&store).unwrap().map(|it| it.unwrap().path());
    assert_eq!(left.collect::<Vec<_>>(), [store.join("mine")]);
}

#[test]
fn much_junk_in_the_store_stays_and_costs_no_map() {
    let workshop = workshop(options());
    for number in 0..20_000 {
        let folder = ["store/map/ab", "store/file/cd", "store/junk", "store"][number % 4];
        workshop
            .files
            .insert(format!("{folder}/junk{number}"), "junk");
    }
    let log = workshop.run(BOARD);
    assert!(!log.contains("store failed"), "{log}");
    clean_store(&workshop.files, Path::new(STORE)).unwrap();
    assert_eq!(entries(&workshop).len(), 20_000);
}
