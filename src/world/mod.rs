//! The one door to files: everything that Yosegi reads or writes passes here.

mod disk;
mod memory;

pub use disk::Disk;
pub use memory::Memory;

use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// One thing in a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Listed {
    /// Its path, the folder's included.
    pub path: PathBuf,
    /// Size in bytes; `None` for a folder.
    pub bytes: Option<u64>,
    /// Whether it is a symbolic link; size and time are those of what it leads to.
    pub is_link: bool,
    /// When it was last written or touched; `None` where the world does not know.
    pub modified: Option<SystemTime>,
}

/// Where recipes, assets and the store are read from, and where maps go.
pub trait World: Send + Sync {
    /// The contents of a file.
    ///
    /// # Errors
    /// Whatever the operating system says; a folder or a device is an error as well.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// The file as a stream, for contents too large to hold.
    ///
    /// # Errors
    /// As [`World::read`].
    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        Ok(Box::new(io::Cursor::new(self.read(path)?)))
    }

    /// Where the file or folder at `path` really lies, behind symbolic links; a world without links has
    /// it where it is.
    ///
    /// # Errors
    /// Whatever the operating system says; a path that leads nowhere is an error as well.
    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        Ok(path.to_owned())
    }

    /// The first `length` bytes of a file, or all of it if it is shorter.
    ///
    /// # Errors
    /// As [`World::read`].
    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        let mut bytes = self.read(path)?;
        bytes.truncate(length);
        Ok(bytes)
    }

    /// Starts a file that appears at `path` only when it is committed. Missing folders are made; a
    /// symbolic link at `path` is followed.
    ///
    /// # Errors
    /// Whatever the operating system says.
    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>>;

    /// The regular files and the folders in a folder, sorted by path.
    ///
    /// # Errors
    /// Whatever the operating system says; worlds without folders say [`io::ErrorKind::Unsupported`].
    fn list(&self, _folder: &Path) -> io::Result<Vec<Listed>> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Whether there is a symbolic link at `path` itself; a world without links has none.
    fn is_link(&self, _path: &Path) -> bool {
        false
    }

    /// Gives a file the present time, if its own is further than `after` from that, in the past or in the
    /// future. Worlds without times do nothing.
    ///
    /// # Errors
    /// Whatever the operating system says.
    fn touch(&self, _path: &Path, _after: Duration) -> io::Result<()> {
        Ok(())
    }

    /// Removes a file, or a folder that is empty; a symbolic link is removed itself.
    ///
    /// # Errors
    /// As [`World::list`].
    fn remove(&self, _path: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

/// Whether two times are further apart than `most`.
fn are_apart(one: SystemTime, other: SystemTime, most: Duration) -> bool {
    let apart = one.duration_since(other);
    apart.unwrap_or_else(|error| error.duration()) > most
}

/// A file that is not there yet: dropped without a commit, it leaves nothing behind.
pub trait PendingFile: Write + Seek + Send {
    /// Puts the file in its place at once, replacing what was there.
    ///
    /// # Errors
    /// Whatever the operating system says; the old file is then still whole.
    fn commit(self: Box<Self>) -> io::Result<()>;
}
