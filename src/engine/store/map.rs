//! Finished maps in the store: what is known of each, and a copy of its file.

use super::{Family, Store, entry};
use crate::engine::Spot;
use crate::key::Key;
use crate::output;
use serde::{Deserialize, Serialize};
use std::io::{self, Read};
use std::path::Path;

/// What the store knows of a map that was written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::engine) struct MapRecord {
    /// Samples that were not finite, and samples that were clamped: every run warns of them.
    pub(in crate::engine) faults: [u64; 2],
    /// Hash of the whole file.
    pub(in crate::engine) file: Key,
    /// Size of the file in bytes.
    pub(in crate::engine) bytes: u64,
    /// Where the first sample is that was not finite.
    pub(in crate::engine) first_not_finite: Option<Spot>,
}

impl Store {
    /// The record of a map.
    pub(in crate::engine) fn map(&self, key: &Key) -> Option<MapRecord> {
        postcard::from_bytes(&self.get(Family::Map, key)?).ok()
    }

    /// Remembers a map that was written to `path`; its file is known by hash and size. If something else lies
    /// there by now, it is that of another run or another program, and nothing is remembered.
    ///
    /// # Errors
    /// Whatever the operating system says.
    pub(in crate::engine) fn put_map(
        &self,
        key: &Key,
        path: &Path,
        record: &MapRecord,
    ) -> io::Result<()> {
        // What is hashed and copied is one reading.
        let mut stream = self.world.open(path)?;
        let mut copy = vec![];
        let largest = Family::File.most_bytes();
        stream.by_ref().take(largest + 1).read_to_end(&mut copy)?;
        let found = Key::of_stream(&mut copy.as_slice().chain(stream))?;
        if found != (record.file, record.bytes) {
            return Ok(());
        }
        if record.bytes <= largest {
            self.put(Family::File, &record.file, &copy)?;
        }
        let bytes = postcard::to_stdvec(record).map_err(io::Error::other)?;
        self.put(Family::Map, key, &bytes)
    }

    /// Whether the file at `path` is the map `key` as the store remembers it; its copy is then in use.
    pub(in crate::engine) fn matches(&self, record: &MapRecord, key: &Key, path: &Path) -> bool {
        // A key inside is quicker to compare, but a paint program may have kept it, and a BMP has none.
        let matches = output::read_key(&*self.world, path).is_none_or(|found| found == *key)
            && self
                .hash(path)
                .is_ok_and(|found| found == (record.file, record.bytes));
        if matches {
            self.mark_copy(record);
        }
        matches
    }

    /// The copy of a map that is in its place is used as well: whoever loses the file needs it.
    fn mark_copy(&self, record: &MapRecord) {
        if let Ok(copy) = self.place(Family::File, &record.file) {
            self.mark_used(&copy);
        }
    }

    /// Whether the contents of a remembered map seem to be there; only [`Store::restore`] looks at them all.
    pub(in crate::engine) fn holds(&self, record: &MapRecord) -> bool {
        let place = self.place(Family::File, &record.file);
        place.is_ok_and(|path| entry::is_begun(&*self.world, &path, Family::File, &record.file))
    }

    /// The contents of a remembered map.
    pub(in crate::engine) fn contents(&self, record: &MapRecord) -> Option<Vec<u8>> {
        let contents = self.get(Family::File, &record.file)?;
        if Key::of_bytes(&contents) == record.file {
            return Some(contents);
        }
        // The entry is whole, but nothing that was stored under this key.
        self.forget(Family::File, &record.file);
        None
    }

    /// Puts a remembered map at `path`, as `durable` as a painted one; false if its contents are not in the
    /// store.
    pub(in crate::engine) fn restore(
        &self,
        record: &MapRecord,
        path: &Path,
        durable: bool,
    ) -> bool {
        let Some(contents) = self.contents(record) else {
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
    pub(in crate::engine) fn hash(&self, path: &Path) -> io::Result<(Key, u64)> {
        Key::of_stream(&mut self.world.open(path)?)
    }
}
