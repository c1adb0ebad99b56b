//! The store on disk: structures and finished maps, as plain files named by key.
//!
//! Every entry holds the key it belongs to and a checksum, is written beside its place and renamed. An
//! entry that is damaged, cut short or of another key is a miss, and is removed. Nothing here makes a run
//! fail: without a store everything is computed. Symbolic links in the store are never followed, and what
//! is not ours is never removed.

mod entry;
mod family;
mod keeping;
mod limit;
mod map;
mod told;

pub use keeping::{StoreFamily, clean_store, store_status};

pub(super) use family::Family;
pub(super) use map::MapRecord;
pub(super) use told::ToldOnce;

use crate::key::Key;
use crate::world::World;
use entry::Found;
use limit::Limit;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// An entry that is used is touched if its time is further away than this: most uses write nothing.
const TOUCHED_AFTER: Duration = Duration::from_secs(4 * 3600);

/// The folder of the store in which entries lie until they are whole.
const UNFINISHED: &str = "unfinished";

/// A folder of entries.
#[derive(Clone)]
pub(super) struct Store {
    world: Arc<dyn World>,
    folder: PathBuf,
    limit: Arc<Limit>,
}

impl Store {
    /// A store in `folder`, which is made when the first entry is written, of at most `limit` bytes. What
    /// runs that were killed have left half-written is removed.
    pub(super) fn new(world: Arc<dyn World>, folder: PathBuf, limit: u64) -> Store {
        let store = Store {
            world,
            folder,
            limit: Arc::new(Limit::new(limit)),
        };
        if let Ok(unfinished) = store.unfinished() {
            store.world.sweep(&unfinished);
        }
        store
    }

    /// The same store behind another world.
    pub(super) fn through(&self, world: Arc<dyn World>) -> Store {
        Store {
            world,
            ..self.clone()
        }
    }

    /// The bytes of the entry `key` of the family `family`.
    pub(super) fn get(&self, family: Family, key: &Key) -> Option<Vec<u8>> {
        let path = self.place(family, key).ok()?;
        match entry::read(&*self.world, &path, family, key) {
            Found::Whole(payload) => {
                self.mark_used(&path);
                Some(payload)
            }
            Found::Nothing => None,
            Found::Damaged => {
                self.discard(&path);
                None
            }
        }
    }

    /// Stores an entry, unless it is larger than entries may be; older ones make room for it.
    ///
    /// # Errors
    /// Whatever the operating system says. The entry is then not there, or the store larger than its limit.
    pub(super) fn put(&self, family: Family, key: &Key, payload: &[u8]) -> io::Result<()> {
        let size = entry::whole_size(payload.len());
        if payload.len() as u64 > family.most_bytes() || !self.limit.allows(size) {
            return self.keep_limit(0);
        }
        let path = self.place(family, key)?;
        self.limit.mark(&path);
        let mut file = self.world.create_aside(&path, &self.unfinished()?)?;
        file.write_all(&entry::header(family, key, payload))?;
        file.write_all(payload)?;
        file.commit()?;
        self.keep_limit(size)
    }

    /// Removes an entry of which the contents are wrong.
    pub(super) fn forget(&self, family: Family, key: &Key) {
        if let Ok(path) = self.place(family, key) {
            self.discard(&path);
        }
    }

    /// Removes a damaged entry, in a run.
    fn discard(&self, path: &Path) {
        if self.limit.is_in_use() {
            // What cannot be removed is found to be damaged again.
            let _ = self.world.remove(path);
        }
    }

    /// Keeps an entry from being evicted, in this run by name and in others by its time.
    fn mark_used(&self, path: &Path) {
        if self.limit.mark(path) {
            // Only the order of eviction depends on it.
            let _ = self.world.touch(path, TOUCHED_AFTER);
        }
    }

    /// Where an entry is.
    ///
    /// # Errors
    /// If a symbolic link stands in the way.
    fn place(&self, family: Family, key: &Key) -> io::Result<PathBuf> {
        let path = self.path(family, key);
        path.ancestors()
            .take(3)
            .try_for_each(|it| self.refuse_link(it))?;
        Ok(path)
    }

    /// Where entries lie until they are whole.
    ///
    /// # Errors
    /// If that is a symbolic link.
    fn unfinished(&self) -> io::Result<PathBuf> {
        let folder = self.folder.join(UNFINISHED);
        self.refuse_link(&folder)?;
        Ok(folder)
    }

    fn refuse_link(&self, path: &Path) -> io::Result<()> {
        if !self.world.is_link(path) {
            return Ok(());
        }
        Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("`{}` is a symbolic link", path.display()),
        ))
    }

    fn path(&self, family: Family, key: &Key) -> PathBuf {
        let name = key.hexadecimal();
        let folder = self.folder.join(family.name()).join(&name[..2]);
        folder.join(&name[2..])
    }
}
