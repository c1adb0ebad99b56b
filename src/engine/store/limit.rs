//! The limit of the store: its size is estimated while it grows, and entries that were used longest ago make
//! room.
//!
//! The folder is counted when the first entry is written, and again whenever a tenth of the limit was written or
//! the limit is exceeded; in between only numbers are added, so that counting costs a bounded time per byte
//! written. Other processes may write at the same time: what they add is seen when the folder is counted next,
//! and what they remove is a miss.

use super::Store;
use super::keeping::{self, Kept};
use crate::world::World;
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

/// Files take whole blocks.
const BLOCK: u64 = 4096;

/// A time further in the future than this is a fault of a clock.
const FUTURE: Duration = Duration::from_secs(24 * 3600);

/// What is known of a store's size, and what may not be removed.
pub(super) struct Limit {
    most: u64,
    size: Mutex<Size>,
    used: Mutex<Used>,
}

struct Size {
    /// Bytes in the folder, as far as is known; `None` before it was counted.
    total: Option<u64>,
    /// The total from which on it is counted again.
    counted_above: u64,
}

#[derive(Default)]
struct Used {
    /// Runs that are going on.
    runs: usize,
    /// What they have read or written.
    paths: HashSet<PathBuf>,
}

/// A run that uses the store; until it is dropped nothing that it uses is removed.
pub(in crate::engine) struct InUse<'a>(&'a Store);

impl Limit {
    pub(super) fn new(most: u64) -> Limit {
        let size = Size {
            total: None,
            counted_above: most,
        };
        Limit {
            most,
            size: Mutex::new(size),
            used: Mutex::default(),
        }
    }

    /// Whether an entry of this size can be kept at all.
    pub(super) fn allows(&self, size: u64) -> bool {
        on_disk(size) <= self.most
    }

    /// Keeps an entry as long as the runs last that go on now; false if there are none.
    pub(super) fn mark(&self, path: &Path) -> bool {
        let mut used = lock(&self.used);
        if used.runs > 0 && !used.paths.contains(path) {
            used.paths.insert(path.to_owned());
        }
        used.runs > 0
    }

    /// Whether runs go on now; otherwise the store is only looked at.
    pub(super) fn is_in_use(&self) -> bool {
        lock(&self.used).runs > 0
    }

    fn is_used(&self, path: &Path) -> bool {
        lock(&self.used).paths.contains(path)
    }

    /// Where eviction stops: not at once after the next entry.
    fn target(&self) -> u64 {
        self.most / 10 * 9
    }

    /// From which total on a store that was counted before is cut down: to stop just below the limit would
    /// mean to count again soon.
    fn nearly(&self) -> u64 {
        self.most - self.most / 20
    }

    /// Up to which total numbers are only added.
    fn trusted(&self, total: u64) -> u64 {
        let more = total.saturating_add(self.most / 10);
        if total > self.most {
            // The rest is in use or cannot be removed: to count again at every entry would not help.
            return more.saturating_add(1 << 20);
        }
        more.min(self.most)
    }
}

impl Store {
    /// Says that a run begins.
    pub(in crate::engine) fn begin(&self) -> InUse<'_> {
        lock(&self.limit.used).runs += 1;
        InUse(self)
    }

    /// Notes that the store has grown, and makes room if it is larger than it may be.
    ///
    /// # Errors
    /// If entries cannot be removed.
    pub(super) fn keep_limit(&self, grown: u64) -> io::Result<()> {
        let mut size = lock(&self.limit.size);
        let total = size.total.map(|it| it.saturating_add(on_disk(grown)));
        size.total = total;
        match total {
            Some(total) if total <= size.counted_above => Ok(()),
            _ => self.make_room(&mut size),
        }
    }

    /// Counts the folder, and removes what was used longest ago if there is too much.
    fn make_room(&self, size: &mut Size) -> io::Result<()> {
        let (world, limit) = (&*self.world, &self.limit);
        let Ok(mut entries) = keeping::kept(world, &self.folder) else {
            // The disk fails, or the run was cancelled: it is counted with the next entry.
            return Ok(());
        };
        let mut total = entries.iter().fold(0, |sum: u64, entry| {
            sum.saturating_add(on_disk(entry.bytes))
        });
        let mut result = Ok(());
        if total > size.total.map_or(limit.most, |_| limit.nearly()) {
            let now = SystemTime::now();
            entries.sort_by_cached_key(|entry| (last_use(entry, now), entry.path.clone()));
            for entry in entries {
                if total <= limit.target() {
                    break;
                }
                match self.evict(world, &entry) {
                    Ok(true) => total = total.saturating_sub(on_disk(entry.bytes)),
                    Ok(false) => {}
                    Err(error) => result = result.and(Err(error)),
                }
            }
        }
        size.total = Some(total);
        size.counted_above = limit.trusted(total);
        result
    }

    /// Removes an entry; false if it has to stay.
    fn evict(&self, world: &dyn World, entry: &Kept) -> io::Result<bool> {
        if self.limit.is_used(&entry.path) || !entry.is_ours(world) {
            return Ok(false);
        }
        keeping::remove(world, &entry.path).map(|()| true)
    }
}

impl Drop for InUse<'_> {
    fn drop(&mut self) {
        let limit = &self.0.limit;
        {
            let mut used = lock(&limit.used);
            used.runs -= 1;
            if used.runs > 0 {
                return;
            }
            used.paths.clear();
        }
        let mut size = lock(&limit.size);
        if size.total.is_some_and(|total| total > limit.most) {
            // The run has told already what cannot be removed.
            let _ = self.0.make_room(&mut size);
        }
    }
}

/// When an entry was used last. What lies in the future was used before the clock was set back.
fn last_use(entry: &Kept, now: SystemTime) -> (bool, Option<SystemTime>) {
    (!entry.is_ahead(now, FUTURE), entry.modified)
}

/// What a file of this size takes.
fn on_disk(bytes: u64) -> u64 {
    bytes.div_ceil(BLOCK).saturating_mul(BLOCK)
}

/// No panic leaves anything half-changed under these locks.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
