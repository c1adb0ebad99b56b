//! A disk on which one operation fails.

use super::Errno;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use yosegi::world::{Disk, Listed, PendingFile, World};

/// What is done to files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Act {
    Read,
    Open,
    /// Reads from a file that is open.
    Stream,
    ReadStart,
    RealPath,
    Create,
    Write,
    Seek,
    Sync,
    /// The rename into place.
    Commit,
    List,
    Remove,
    /// A new time for a file.
    Touch,
}

/// An operation: what is done, and to which file.
pub(crate) type Step = (Act, PathBuf);

/// A disk whose operation number `fails` fails; remembers the operations.
#[derive(Clone)]
pub(crate) struct Faulty {
    fails: usize,
    error: Errno,
    steps: Arc<Mutex<Vec<Step>>>,
}

impl Faulty {
    pub(crate) fn new(fails: usize, error: Errno) -> Faulty {
        Faulty {
            fails,
            error,
            steps: Arc::default(),
        }
    }

    /// What was done so far.
    pub(crate) fn steps(&self) -> Vec<Step> {
        self.steps.lock().unwrap().clone()
    }

    fn step(&self, act: Act, path: &Path) -> io::Result<()> {
        let mut steps = self.steps.lock().unwrap();
        steps.push((act, path.to_owned()));
        if steps.len() - 1 == self.fails {
            return Err(self.error.error());
        }
        Ok(())
    }

    fn file(&self, path: &Path, file: Box<dyn PendingFile>) -> Box<dyn PendingFile> {
        Box::new(FaultyFile {
            file,
            path: path.to_owned(),
            world: self.clone(),
        })
    }
}

impl World for Faulty {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.step(Act::Read, path)?;
        Disk.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        self.step(Act::Open, path)?;
        Ok(Box::new(Stream {
            stream: Disk.open(path)?,
            path: path.to_owned(),
            world: self.clone(),
        }))
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        self.step(Act::RealPath, path)?;
        Disk.real_path(path)
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        self.step(Act::ReadStart, path)?;
        Disk.read_start(path, length)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.step(Act::Create, path)?;
        Ok(self.file(path, Disk.create(path)?))
    }

    fn create_aside(&self, path: &Path, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.step(Act::Create, path)?;
        Ok(self.file(path, Disk.create_aside(path, aside)?))
    }

    fn sweep(&self, folder: &Path) {
        Disk.sweep(folder);
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.step(Act::List, folder)?;
        Disk.list(folder)
    }

    fn is_link(&self, path: &Path) -> bool {
        Disk.is_link(path)
    }

    fn touch(&self, path: &Path, after: Duration) -> io::Result<()> {
        self.step(Act::Touch, path)?;
        Disk.touch(path, after)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.step(Act::Remove, path)?;
        Disk.remove(path)
    }
}

struct Stream {
    stream: Box<dyn Read>,
    path: PathBuf,
    world: Faulty,
}

impl Read for Stream {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.world.step(Act::Stream, &self.path)?;
        self.stream.read(buffer)
    }
}

struct FaultyFile {
    file: Box<dyn PendingFile>,
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
        self.world.step(Act::Write, &self.path)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for FaultyFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.world.step(Act::Seek, &self.path)?;
        self.file.seek(to)
    }
}

impl PendingFile for FaultyFile {
    fn sync(&mut self) -> io::Result<()> {
        self.world.step(Act::Sync, &self.path)?;
        self.file.sync()
    }

    fn commit(self: Box<Self>) -> io::Result<()> {
        self.world.step(Act::Commit, &self.path)?;
        self.file.commit()
    }
}
