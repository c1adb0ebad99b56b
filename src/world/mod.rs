//! The one door to files: everything that Yosegi reads or writes passes here.

mod again;
mod disk;
#[cfg(test)]
pub(crate) mod forwarded;
mod memory;
mod notices;
mod stamp;
mod sweep;
mod trace;
mod traced;
mod unfinished;

pub use disk::Disk;
pub use memory::Memory;
pub use notices::{Heard, Notices, NoticesError, Wake};
pub use stamp::Stamp;
pub use trace::{Doubt, Trace};
pub use traced::Traced;
pub use unfinished::abandon_unfinished;

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

    /// As [`World::create`], for a file that lies in the folder `aside` until it is committed: one folder
    /// to sweep, where the places are many. Both have to be on one file system.
    ///
    /// # Errors
    /// As [`World::create`].
    fn create_aside(&self, path: &Path, _aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.create(path)
    }

    /// Removes the files in a folder that programs have started and not committed, and that no program
    /// still writes: one that is killed leaves them behind. What cannot be looked at stays.
    fn sweep(&self, _folder: &Path) {}

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

    /// The state of a file, which is another one after almost every change.
    ///
    /// # Errors
    /// As [`World::list`].
    fn stamp(&self, _path: &Path) -> io::Result<Stamp> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Starts to listen for changes; `wake` hears of them.
    ///
    /// # Errors
    /// Why there are no notices: then one has to look again and again.
    fn notices(&self, _wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        Err(NoticesError::new("this kind of file system sends none"))
    }
}

/// Whether two times are further apart than `most`.
fn are_apart(one: SystemTime, other: SystemTime, most: Duration) -> bool {
    let apart = one.duration_since(other);
    apart.unwrap_or_else(|error| error.duration()) > most
}

/// A file that is not there yet, in which what was written can be read again: dropped without a commit, it
/// leaves nothing behind.
pub trait PendingFile: Read + Write + Seek + Send {
    /// Waits until what was written is on the disk: after a loss of power the file is then the old one or
    /// the new one, never an empty one.
    ///
    /// # Errors
    /// Whatever the operating system says; the file can then only be dropped.
    fn sync(&mut self) -> io::Result<()> {
        self.flush()
    }

    /// Puts the file in its place at once, replacing what was there.
    ///
    /// # Errors
    /// Whatever the operating system says; the old file is then still whole.
    fn commit(self: Box<Self>) -> io::Result<()>;
}
