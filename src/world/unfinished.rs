//! Files on their way to their place: written under a name of their own, locked meanwhile, then renamed.
//!
//! A lock ends with its program, however that ends. So a file with such a name whose lock can be taken
//! belongs to nobody, and is removed by whoever comes next.

use super::PendingFile;
use super::again::{Patience, uninterrupted};
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Read, Seek, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{NamedTempFile, PersistError};

/// What the names of unfinished files begin and end with.
pub(super) const PREFIX: &str = ".yosegi-";
pub(super) const SUFFIX: &str = ".part";

/// How often a new file may be taken for an abandoned one before that is an error.
const ATTEMPTS: usize = 64;

/// The unfinished files of this program.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes the unfinished files of this program, for one that is about to end without giving its threads
/// the time to do so. Whoever starts another file waits for that end.
pub fn abandon_unfinished() {
    let live = live();
    for path in live.iter() {
        // It may have been put in its place just now.
        let _ = fs::remove_file(path);
    }
    mem::forget(live);
}

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // Every change is one insertion or removal, so a panic elsewhere leaves the set whole.
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Says in [`LIVE`] that a file is there, as long as it is.
struct Mark(PathBuf);

impl Drop for Mark {
    fn drop(&mut self) {
        live().remove(&self.0);
    }
}

/// A file on its way.
pub(super) struct Unfinished {
    file: BufWriter<NamedTempFile>,
    /// After the file, so that it is dropped when that is gone.
    mark: Mark,
    path: PathBuf,
}

impl Unfinished {
    /// Starts the file that is to lie at `path`, in the folder `aside`, which is made if it is missing.
    pub(super) fn new(path: PathBuf, aside: &Path) -> io::Result<Unfinished> {
        let mut live = live();
        let file = held_file(aside)?;
        let mark = Mark(file.path().to_owned());
        live.insert(mark.0.clone());
        let file = BufWriter::with_capacity(1 << 18, file);
        Ok(Unfinished { file, mark, path })
    }
}

impl Read for Unfinished {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.flush()?;
        self.file.get_mut().read(buffer)
    }
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Unfinished {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for Unfinished {
    fn sync(&mut self) -> io::Result<()> {
        self.file.flush()?;
        match self.file.get_ref().as_file().sync_data() {
            // Some file systems over a network cannot.
            Err(error) if is_missing(&error) => Ok(()),
            synced => synced,
        }
    }

    fn commit(self: Box<Self>) -> io::Result<()> {
        let Unfinished { file, mark, path } = *self;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        keep_permissions(file.as_file(), &path)?;
        put_in_place(file, &path)?;
        drop(mark);
        Ok(())
    }
}

/// Whether the error says that the file system does not know the call.
fn is_missing(error: &io::Error) -> bool {
    use io::ErrorKind::{InvalidInput, Unsupported};
    matches!(error.kind(), InvalidInput | Unsupported)
}

fn put_in_place(mut file: NamedTempFile, path: &Path) -> io::Result<()> {
    let mut patience = Patience::default();
    let mut has_folder = true;
    loop {
        let Err(PersistError { error, file: back }) = file.persist(path) else {
            return Ok(());
        };
        if has_folder && error.kind() == io::ErrorKind::NotFound {
            make_folder(path.parent())?;
            has_folder = false;
        } else if !patience.again(&error) {
            return Err(error);
        }
        file = back;
    }
}

/// Makes a folder, with those that it lies in; no path is the working folder.
fn make_folder(folder: Option<&Path>) -> io::Result<()> {
    let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), |folder| {
        uninterrupted(|| fs::create_dir_all(folder))
    })
}

/// Gives the new file the mode of the one that it replaces.
fn keep_permissions(file: &File, replaced: &Path) -> io::Result<()> {
    let old = match fs::metadata(replaced) {
        Ok(metadata) => metadata.permissions(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    // File systems without modes refuse to set one, even the one they report.
    if file.metadata()?.permissions() == old {
        return Ok(());
    }
    uninterrupted(|| file.set_permissions(old.clone()))
}

/// A new file in `folder` that no sweep takes away.
fn held_file(folder: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..ATTEMPTS {
        match uninterrupted(|| temporary_file(folder)) {
            Ok(file) if is_ours(&file) => return Ok(file),
            Ok(_) => {}
            // It may be removed again before the file is made: the store is rid of empty folders.
            Err(error) if error.kind() == io::ErrorKind::NotFound => make_folder(Some(folder))?,
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("other programs take new files away"))
}

/// Locks a new file; false if a sweep was there between making and locking it. Where a lock cannot be had,
/// none can be had by a sweep either.
fn is_ours(file: &NamedTempFile) -> bool {
    if let Err(TryLockError::WouldBlock) = file.as_file().try_lock() {
        return false;
    }
    let there = fs::symlink_metadata(file.path());
    !there.is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
}

fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    builder.permissions(ordinary_permissions());
    builder.tempfile_in(folder)
}

/// What a plain new file gets, instead of the owner-only mode of temporary files; the umask applies.
#[cfg(unix)]
fn ordinary_permissions() -> fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    fs::Permissions::from_mode(0o666)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn a_file_lies_aside_until_it_is_put_in_place() {
        let folder = tempfile::tempdir().unwrap();
        let [aside, far] = ["aside", "far"].map(|name| folder.path().join(name));
        fs::create_dir(&far).unwrap();
        let mut file = Unfinished::new(far.join("entry"), &aside).unwrap();
        file.write_all(b"entry").unwrap();
        file.sync().unwrap();
        assert_eq!((count(&aside), count(&far)), (1, 0));
        Box::new(file).commit().unwrap();
        assert_eq!((count(&aside), count(&far)), (0, 1));
    }

    #[test]
    fn a_folder_that_is_removed_meanwhile_is_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let [aside, far] = ["aside", "far"].map(|name| folder.path().join(name));
        let file = Unfinished::new(far.join("entry"), &aside).unwrap();
        assert!(!far.exists());
        Box::new(file).commit().unwrap();
        assert_eq!(count(&far), 1);
    }
}
