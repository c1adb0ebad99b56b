//! The store on disk: structures and finished maps, as plain files named by key.
//!
//! Every entry holds the key it belongs to and a checksum, is written beside its place and renamed. An
//! entry that is damaged, cut short or of another key is a miss. Nothing here makes a run fail: without a
//! store everything is computed.

use crate::key::Key;
use crate::output;
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Raised when the layout of entries changes.
const LAYOUT: &[u8; 8] = b"yosegi01";

/// What every layout begins with.
pub(super) const LAYOUT_NAME: &[u8] = b"yosegi";

/// The families of entries, each a folder of the store.
pub(super) const FAMILIES: [&str; 5] = ["structure", "map", "file", "plan", "run"];

/// The folder of the store in which entries lie until they are whole.
pub(super) const UNFINISHED: &str = "unfinished";

/// Layout, and the hexadecimal digits of a key and of a checksum.
const HEADER: usize = LAYOUT.len() + 64 + 64;

/// Files larger than this are not copied into the store; their checksums are.
const LARGEST_COPY: u64 = 64 << 20;

/// What the store knows of a map that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct MapRecord {
    /// Samples that were not finite, and samples that were clamped: every run warns of them.
    pub(super) faults: [u64; 2],
    /// Hash of the whole file.
    pub(super) file: Key,
    /// Size of the file in bytes.
    pub(super) bytes: u64,
}

/// A folder of entries.
#[derive(Clone)]
pub(super) struct Store {
    world: Arc<dyn World>,
    folder: PathBuf,
}

impl Store {
    /// A store in `folder`, which is made when the first entry is written. What runs that were killed have
    /// left half-written is removed.
    pub(super) fn new(world: Arc<dyn World>, folder: PathBuf) -> Store {
        world.sweep(&folder.join(UNFINISHED));
        Store { world, folder }
    }

    /// The same store behind another world.
    pub(super) fn through(&self, world: Arc<dyn World>) -> Store {
        Store {
            world,
            ..self.clone()
        }
    }

    /// The bytes of the entry `key` of the family `family`.
    pub(super) fn get(&self, family: &str, key: &Key) -> Option<Vec<u8>> {
        let mut entry = self.world.read(&self.path(family, key)).ok()?;
        let payload = entry.get(HEADER..)?;
        if entry[..HEADER] != header(key, payload)[..] {
            return None;
        }
        entry.drain(..HEADER);
        Some(entry)
    }

    /// Stores an entry.
    ///
    /// # Errors
    /// Whatever the operating system says; the entry is then not there.
    pub(super) fn put(&self, family: &str, key: &Key, payload: &[u8]) -> io::Result<()> {
        let (path, aside) = (self.path(family, key), self.folder.join(UNFINISHED));
        let mut file = self.world.create_aside(&path, &aside)?;
        file.write_all(&header(key, payload))?;
        file.write_all(payload)?;
        file.commit()
    }

    /// The record of a map.
    pub(super) fn map(&self, key: &Key) -> Option<MapRecord> {
        postcard::from_bytes(&self.get("map", key)?).ok()
    }

    /// Remembers a map that was just written to `path`, unless another run has put its own there.
    ///
    /// # Errors
    /// Whatever the operating system says.
    pub(super) fn put_map(&self, key: &Key, path: &Path, faults: [u64; 2]) -> io::Result<()> {
        // Another run may have replaced the file since: what is hashed, checked and copied is one reading.
        let mut stream = self.world.open(path)?;
        let mut copy = vec![];
        stream
            .by_ref()
            .take(LARGEST_COPY + 1)
            .read_to_end(&mut copy)?;
        if output::key_in(&copy).is_some_and(|found| found != *key) {
            return Ok(());
        }
        let (file, bytes) = Key::of_stream(&mut copy.as_slice().chain(stream))?;
        let record = MapRecord {
            faults,
            file,
            bytes,
        };
        if record.bytes <= LARGEST_COPY {
            self.put("file", &record.file, &copy)?;
        }
        let bytes = postcard::to_stdvec(&record).map_err(io::Error::other)?;
        self.put("map", key, &bytes)
    }

    /// Whether the file at `path` is the map `key` as the store remembers it.
    pub(super) fn matches(&self, record: &MapRecord, key: &Key, path: &Path) -> bool {
        // A key inside is quicker to compare, but a paint program may have kept it, and a BMP has none.
        output::read_key(&*self.world, path).is_none_or(|found| found == *key)
            && self
                .hash(path)
                .is_ok_and(|found| found == (record.file, record.bytes))
    }

    /// Whether the contents of a remembered map seem to be there; only [`Store::restore`] looks at them all.
    pub(super) fn holds(&self, record: &MapRecord) -> bool {
        // The key of a file is its checksum.
        let digits = record.file.hexadecimal();
        let expected = [LAYOUT, digits.as_bytes(), digits.as_bytes()].concat();
        let start = self
            .world
            .read_start(&self.path("file", &record.file), HEADER);
        start.is_ok_and(|start| start == expected)
    }

    /// Puts a remembered map at `path`, as `durable` as a painted one; false if its contents are not in the
    /// store.
    pub(super) fn restore(&self, record: &MapRecord, path: &Path, durable: bool) -> bool {
        let contents = self.get("file", &record.file);
        let is_whole = |contents: &Vec<u8>| Key::of_bytes(contents) == record.file;
        let Some(contents) = contents.filter(is_whole) else {
            return false;
        };
        let write = || {
            let mut file = self.world.create(path)?;
            file.write_all(&contents)?;
            if durable {
                file.sync()?;
            }
            file.commit()
        };
        write().is_ok()
    }

    /// Hash and size of a file, read as a stream.
    fn hash(&self, path: &Path) -> io::Result<(Key, u64)> {
        Key::of_stream(&mut self.world.open(path)?)
    }

    fn path(&self, family: &str, key: &Key) -> PathBuf {
        let name = key.hexadecimal();
        self.folder.join(family).join(&name[..2]).join(&name[2..])
    }
}

/// Layout, key and checksum of an entry.
fn header(key: &Key, payload: &[u8]) -> Vec<u8> {
    let mut header = LAYOUT.to_vec();
    header.extend_from_slice(key.hexadecimal().as_bytes());
    header.extend_from_slice(Key::of_bytes(payload).hexadecimal().as_bytes());
    header
}
