//! The one door to files: everything that Yosegi reads or writes passes here.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Where recipes, assets and the store are read from, and where maps go.
pub trait World: Send + Sync {
    /// The contents of a file.
    ///
    /// # Errors
    /// Whatever the operating system says; a folder or a device is an error as well.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// Starts a file that appears at `path` only when it is committed. Missing folders are made.
    ///
    /// # Errors
    /// Whatever the operating system says.
    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>>;
}

/// A file that is not there yet: dropped without a commit, it leaves nothing behind.
pub trait PendingFile: Write + Seek + Send {
    /// Puts the file in its place at once, replacing what was there.
    ///
    /// # Errors
    /// Whatever the operating system says; the old file is then still whole.
    fn commit(self: Box<Self>) -> io::Result<()>;
}

/// The disk.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl World for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        // A FIFO or a device would never end.
        if !std::fs::metadata(path)?.is_file() {
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "not a regular file",
            ));
        }
        std::fs::read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        std::fs::create_dir_all(folder)?;
        let file = tempfile::Builder::new()
            .prefix(".yosegi-")
            .suffix(".part")
            .permissions(ordinary_permissions())
            .tempfile_in(folder)?;
        Ok(Box::new(DiskFile {
            file: BufWriter::with_capacity(1 << 18, file),
            path: path.to_owned(),
        }))
    }
}

/// What a plain new file gets, instead of the owner-only mode of temporary files; the umask applies.
#[cfg(unix)]
fn ordinary_permissions() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    std::fs::Permissions::from_mode(0o666)
}

struct DiskFile {
    file: BufWriter<NamedTempFile<File>>,
    path: PathBuf,
}

impl Write for DiskFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for DiskFile {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for DiskFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        let file = self
            .file
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?;
        file.persist(&self.path)?;
        Ok(())
    }
}
