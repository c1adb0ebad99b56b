//! The world as a run sees it that may be cancelled: whatever is slow is done in pieces, and once the run is
//! cancelled nothing is read, written or put in place any more.

use crate::cancel::Cancel;
use crate::world::{Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Bytes that are read or written between two looks at the switch: less than a millisecond's.
const PIECE: usize = 1 << 20;

/// A world that ends with a run.
pub(super) struct Stoppable {
    world: Arc<dyn World>,
    cancel: Cancel,
}

impl Stoppable {
    /// `world` until `cancel` is thrown.
    pub(super) fn new(world: Arc<dyn World>, cancel: Cancel) -> Stoppable {
        Stoppable { world, cancel }
    }

    fn stoppable(&self, file: Box<dyn PendingFile>) -> Box<dyn PendingFile> {
        let cancel = self.cancel.clone();
        Box::new(StoppableFile { file, cancel })
    }
}

impl World for Stoppable {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let mut stream = self.open(path)?;
        let mut bytes = vec![];
        while stream.by_ref().take(PIECE as u64).read_to_end(&mut bytes)? > 0 {}
        Ok(bytes)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        self.cancel.check()?;
        Ok(Box::new(StoppableStream {
            stream: self.world.open(path)?,
            cancel: self.cancel.clone(),
        }))
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        self.world.real_path(path)
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        self.cancel.check()?;
        self.world.read_start(path, length)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.cancel.check()?;
        Ok(self.stoppable(self.world.create(path)?))
    }

    fn create_aside(&self, path: &Path, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.cancel.check()?;
        Ok(self.stoppable(self.world.create_aside(path, aside)?))
    }

    fn sweep(&self, folder: &Path) {
        self.world.sweep(folder);
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.cancel.check()?;
        self.world.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.cancel.check()?;
        self.world.remove(path)
    }

    fn is_link(&self, path: &Path) -> bool {
        self.world.is_link(path)
    }

    fn touch(&self, path: &Path, after: Duration) -> io::Result<()> {
        self.world.touch(path, after)
    }

    fn stamp(&self, path: &Path) -> io::Result<Stamp> {
        self.world.stamp(path)
    }

    fn notices(&self, wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        self.world.notices(wake)
    }
}

struct StoppableStream {
    stream: Box<dyn Read>,
    cancel: Cancel,
}

impl Read for StoppableStream {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.cancel.check()?;
        let length = buffer.len().min(PIECE);
        self.stream.read(&mut buffer[..length])
    }
}

struct StoppableFile {
    file: Box<dyn PendingFile>,
    cancel: Cancel,
}

impl Read for StoppableFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.cancel.check()?;
        let length = buffer.len().min(PIECE);
        self.file.read(&mut buffer[..length])
    }
}

impl Write for StoppableFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.cancel.check()?;
        self.file.write(&bytes[..bytes.len().min(PIECE)])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.cancel.check()?;
        self.file.flush()
    }
}

impl Seek for StoppableFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for StoppableFile {
    fn sync(&mut self) -> io::Result<()> {
        self.cancel.check()?;
        self.file.sync()
    }

    fn commit(mut self: Box<Self>) -> io::Result<()> {
        // What is slow comes before the lock, under which nothing is left to do but a rename.
        self.flush()?;
        let StoppableFile { file, cancel } = *self;
        let placed = cancel.unless_cancelled(|| file.commit());
        placed.unwrap_or_else(|| cancel.check())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Trace, Traced, forwarded};
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn whatever_is_asked_is_passed_on() {
        forwarded::check(|world| Box::new(Stoppable::new(world, Cancel::new())));
    }

    /// A world with files without end, of which the reading cancels a run.
    struct Endless {
        cancel: Cancel,
        read: Arc<AtomicU64>,
    }

    impl Read for Endless {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.read.fetch_add(buffer.len() as u64, Ordering::Relaxed);
            self.cancel.cancel();
            Ok(buffer.len())
        }
    }

    impl World for Endless {
        fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
            panic!("a reading that does not end")
        }

        fn open(&self, _: &Path) -> io::Result<Box<dyn Read>> {
            let (cancel, read) = (self.cancel.clone(), Arc::clone(&self.read));
            Ok(Box::new(Endless { cancel, read }))
        }

        fn create(&self, _: &Path) -> io::Result<Box<dyn PendingFile>> {
            Err(io::ErrorKind::Unsupported.into())
        }
    }

    #[test]
    fn reading_ends_with_its_piece_even_if_it_is_noted() {
        let (cancel, read) = (Cancel::new(), Arc::<AtomicU64>::default());
        let endless = Arc::new(Endless {
            cancel: cancel.clone(),
            read: Arc::clone(&read),
        });
        let traced = Traced::new(endless, Trace::new(), |_| {});
        let world = Stoppable::new(Arc::new(traced), cancel);
        assert!(world.read(Path::new("photograph")).is_err());
        assert!((1..=PIECE as u64).contains(&read.load(Ordering::Relaxed)));
    }
}
