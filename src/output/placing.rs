//! What comes before a finished map is put in place: it is brought to the disk, and its contents are noted.

use crate::key::Key;
use crate::world::PendingFile;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::{Arc, OnceLock};

/// Hash and size in bytes of a finished map; the copies are the same cell.
///
/// They are taken before anyone else sees the file: what lies in its place later may be another program's.
pub(crate) type Contents = Arc<OnceLock<(Key, u64)>>;

/// What comes before a finished map is put in place.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placing {
    /// Whether the map is on the disk before it replaces what is there, so that a loss of power leaves the
    /// one or the other.
    pub(crate) durable: bool,
    /// Where hash and size of the map are noted, if anyone asks.
    pub(crate) contents: Option<Contents>,
}

impl Placing {
    /// A file that does all this when it is committed.
    pub(crate) fn of(self, file: Box<dyn PendingFile>) -> Box<dyn PendingFile> {
        let placing = self;
        Box::new(Placed { file, placing })
    }
}

struct Placed {
    file: Box<dyn PendingFile>,
    placing: Placing,
}

impl Read for Placed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for Placed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Placed {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for Placed {
    fn sync(&mut self) -> io::Result<()> {
        self.file.sync()
    }

    fn commit(mut self: Box<Self>) -> io::Result<()> {
        if self.placing.durable {
            self.file.sync()?;
        }
        if let Some(contents) = self.placing.contents {
            // Read back, since writers go back to complete what they have written.
            self.file.rewind()?;
            let known = Key::of_stream(&mut self.file)?;
            contents.get_or_init(|| known);
        }
        self.file.commit()
    }
}
