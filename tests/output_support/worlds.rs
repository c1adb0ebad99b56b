//! Disks that fail, and disks that only count.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use yosegi::world::{Memory, PendingFile, World};

/// A disk that fails from a certain operation on.
pub(crate) struct Failing {
    pub(crate) files: Memory,
    pub(crate) left: Arc<AtomicUsize>,
}

struct FailingFile {
    file: Box<dyn PendingFile>,
    left: Arc<AtomicUsize>,
}

fn spend(left: &AtomicUsize) -> io::Result<()> {
    let spent = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| {
        left.checked_sub(1)
    });
    spent
        .map(|_| ())
        .map_err(|_| io::Error::new(io::ErrorKind::StorageFull, "the disk is full"))
}

impl World for Failing {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        spend(&self.left)?;
        Ok(Box::new(FailingFile {
            file: self.files.create(path)?,
            left: self.left.clone(),
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
        spend(&self.left)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for FailingFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        spend(&self.left)?;
        self.file.seek(to)
    }
}

impl PendingFile for FailingFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        spend(&self.left)?;
        self.file.commit()
    }
}

/// Bytes that no compressor shortens (splitmix64; Steele, Lea & Flood 2014).
pub(crate) fn noise(length: usize, seed: u64) -> Vec<u8> {
    let word = |index: u64| {
        let mixed = (seed << 40 | index).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    };
    let words = 1..=length.div_ceil(8) as u64;
    let mut bytes: Vec<u8> = words.flat_map(|index| word(index).to_le_bytes()).collect();
    bytes.truncate(length);
    bytes
}

/// A disk that forgets what it gets and counts it.
#[derive(Clone, Default)]
pub(crate) struct Counting(pub(crate) Arc<AtomicUsize>);

impl World for Counting {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        Err(io::ErrorKind::NotFound.into())
    }

    fn create(&self, _: &Path) -> io::Result<Box<dyn PendingFile>> {
        Ok(Box::new(self.clone()))
    }
}

impl Read for Counting {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        io::empty().read(buffer)
    }
}

impl Write for Counting {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.fetch_add(bytes.len(), Ordering::Relaxed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Counting {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match to {
            SeekFrom::Start(position) => Ok(position),
            SeekFrom::End(_) | SeekFrom::Current(_) => Err(io::ErrorKind::Unsupported.into()),
        }
    }
}

impl PendingFile for Counting {
    fn commit(self: Box<Self>) -> io::Result<()> {
        Ok(())
    }
}
