//! A world in memory, for tests and for callers that want maps without files.

use super::{Listed, PendingFile, World, are_apart};
use std::collections::BTreeMap;
use std::io::{self, Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

type Files = BTreeMap<PathBuf, OneFile>;

#[derive(Debug)]
struct OneFile {
    bytes: Vec<u8>,
    modified: SystemTime,
}

/// Files by path, without folders or links; clones share the files.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: Arc<Mutex<Files>>,
}

impl Memory {
    /// Puts a file in place, replacing what was there.
    pub fn insert(&self, path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) {
        let file = OneFile {
            bytes: bytes.into(),
            modified: SystemTime::now(),
        };
        self.lock().insert(path.into(), file);
    }

    /// Sets when a file was last written; false if it is not there.
    pub fn set_modified(&self, path: &Path, modified: SystemTime) -> bool {
        let mut files = self.lock();
        let file = files.get_mut(path);
        file.map(|file| file.modified = modified).is_some()
    }

    /// The paths of all files, sorted.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.lock().keys().cloned().collect()
    }

    fn lock(&self) -> MutexGuard<'_, Files> {
        // Every change is one insertion, so a panic elsewhere leaves the map whole.
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl World for Memory {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let files = self.lock();
        let file = files.get(path).ok_or_else(not_found)?;
        Ok(file.bytes.clone())
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        let bytes = Cursor::new(Vec::new());
        Ok(Box::new(MemoryFile {
            bytes,
            path: path.to_owned(),
            world: self.clone(),
        }))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        let mut listed = BTreeMap::new();
        let files = self.lock();
        // Paths are sorted part by part, so what is in a folder follows it at once.
        for (path, file) in files.range(folder.to_owned()..) {
            let Ok(inside) = path.strip_prefix(folder) else {
                break;
            };
            let mut parts = inside.components();
            if let Some(name) = parts.next() {
                let is_file = parts.next().is_none();
                let path = folder.join(name);
                let entry = Listed {
                    path: path.clone(),
                    bytes: is_file.then_some(file.bytes.len() as u64),
                    is_link: false,
                    modified: Some(file.modified),
                };
                listed.insert(path, entry);
            }
        }
        if listed.is_empty() {
            return Err(not_found());
        }
        Ok(listed.into_values().collect())
    }

    fn touch(&self, path: &Path, after: Duration) -> io::Result<()> {
        let mut files = self.lock();
        let file = files.get_mut(path).ok_or_else(not_found)?;
        let now = SystemTime::now();
        if are_apart(file.modified, now, after) {
            file.modified = now;
        }
        Ok(())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.lock().remove(path).map(|_| ()).ok_or_else(not_found)
    }
}

fn not_found() -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, "no such file")
}

struct MemoryFile {
    bytes: Cursor<Vec<u8>>,
    path: PathBuf,
    world: Memory,
}

impl Read for MemoryFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.bytes.read(buffer)
    }
}

impl Write for MemoryFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for MemoryFile {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

impl PendingFile for MemoryFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        self.world.insert(self.path, self.bytes.into_inner());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_only_when_it_is_committed() {
        let world = Memory::default();
        let path = Path::new("maps/board.png");
        world.insert(path, "old");
        let mut file = world.create(path).unwrap();
        file.write_all(b"__w").unwrap();
        file.seek(io::SeekFrom::Start(0)).unwrap();
        file.write_all(b"ne").unwrap();
        file.rewind().unwrap();
        assert_eq!(io::read_to_string(&mut file).unwrap(), "new");
        assert_eq!(world.read(path).unwrap(), b"old");
        file.commit().unwrap();
        assert_eq!(world.read(path).unwrap(), b"new");
        assert_eq!(world.read_start(path, 2).unwrap(), b"ne");
    }

    #[test]
    fn folders_are_what_paths_say() {
        let world = Memory::default();
        world.insert("maps/a", "four");
        world.insert("maps/b/c", "");
        let listed = || {
            let listed = world.list(Path::new("maps")).unwrap().into_iter();
            let listed = listed.map(|it| (it.path, it.bytes));
            listed.collect::<Vec<_>>()
        };
        let expected = [("maps/a".into(), Some(4)), ("maps/b".into(), None)];
        assert_eq!(listed(), expected);
        world.remove(Path::new("maps/a")).unwrap();
        assert!(world.remove(Path::new("maps/a")).is_err());
        assert_eq!(listed(), expected[1..]);
        assert!(world.list(Path::new("none")).is_err());
    }

    #[test]
    fn a_file_is_touched_only_if_its_time_is_far_away() {
        let world = Memory::default();
        let path = Path::new("maps/a");
        world.insert(path, "");
        let hour = Duration::from_secs(3600);
        for (time, is_touched) in [
            (SystemTime::now() - 2 * hour, true),
            (SystemTime::now() + 2 * hour, true),
            (SystemTime::now() - hour / 2, false),
        ] {
            assert!(world.set_modified(path, time));
            world.touch(path, hour).unwrap();
            let listed = world.list(Path::new("maps")).unwrap();
            assert_eq!(listed[0].modified != Some(time), is_touched);
        }
        assert!(!world.set_modified(Path::new("none"), SystemTime::now()));
        assert!(world.touch(Path::new("none"), hour).is_err());
    }

    #[test]
    fn a_dropped_file_leaves_nothing() {
        let world = Memory::default();
        world
            .create(Path::new("a"))
            .unwrap()
            .write_all(b"half")
            .unwrap();
        assert_eq!(world.paths(), Vec::<PathBuf>::new());
        let error = world.read(Path::new("a")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
    }
}
