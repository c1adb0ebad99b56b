//! A world in memory, for tests and for callers that want maps without files.

use super::{Listed, PendingFile, World};
use std::collections::BTreeMap;
use std::io::{self, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Files by path, without folders or links; clones share the files.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: Arc<Mutex<Files>>,
}

impl Memory {
    /// Puts a file in place, replacing what was there.
    pub fn insert(&self, path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) {
        self.lock().insert(path.into(), bytes.into());
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
        self.lock().get(path).cloned().ok_or_else(not_found)
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
        for (path, contents) in self.lock().iter() {
            let mut parts = match path.strip_prefix(folder) {
                Ok(inside) => inside.components(),
                Err(_) => continue,
            };
            if let Some(name) = parts.next() {
                let is_file = parts.next().is_none();
                listed.insert(folder.join(name), is_file.then_some(contents.len() as u64));
            }
        }
        if listed.is_empty() {
            return Err(not_found());
        }
        let entry = |(path, bytes)| Listed { path, bytes };
        Ok(listed.into_iter().map(entry).collect())
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
        let listed = |path: &str, bytes| Listed {
            path: path.into(),
            bytes,
        };
        let expected = [listed("maps/a", Some(4)), listed("maps/b", None)];
        assert_eq!(world.list(Path::new("maps")).unwrap(), expected);
        world.remove(Path::new("maps/a")).unwrap();
        assert!(world.remove(Path::new("maps/a")).is_err());
        assert_eq!(world.list(Path::new("maps")).unwrap(), expected[1..]);
        assert!(world.list(Path::new("none")).is_err());
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
