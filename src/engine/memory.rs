//! What a process remembers between runs: structures, and columns of expensive fields.
//!
//! Both share one budget in bytes. What is dropped first has saved the least time per byte for the
//! longest: an entry's rank is a clock that rises with every eviction plus its cost per byte
//! (GreedyDual-Size, Cao & Irani 1997).

use crate::field::{ColumnCache, Columns};
use crate::key::Key;
use crate::value::Value;
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A structure with the key of its content.
#[derive(Clone, Debug)]
pub(super) struct Structure {
    /// One value for each output of the node.
    pub(super) values: Vec<Value>,
    /// The content key of each.
    pub(super) keys: Vec<Key>,
    /// What the node warned of when it was built.
    pub(super) warnings: Vec<String>,
    /// Memory that it took for decoded files, in bytes.
    pub(super) taken: u64,
}

/// What a structure takes besides its contents: keys, names, links, and the holes that thousands of small
/// things leave between columns in a long session.
const BESIDES: usize = 4096;

/// Remembers structures and columns within a budget.
#[derive(Debug)]
pub(super) struct Memory {
    budget: usize,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    entries: HashMap<Key, Entry>,
    /// Ranks of all entries, the next to be dropped first.
    ranks: BTreeSet<(u64, Key)>,
    bytes: usize,
    clock: u64,
    spare: Spare,
}

/// Dropped columns that wait to be used again. If each were given back to the system's allocator, what is
/// allocated for a moment would settle in their places, and a long session would grow.
#[derive(Debug, Default)]
struct Spare {
    columns: Vec<Vec<f32>>,
    bytes: usize,
}

/// Bytes of dropped columns that are kept, at most.
const SPARE_BYTES: usize = 4 << 20;

impl Spare {
    fn put(&mut self, mut dropped: Columns) {
        // Someone may still be reading them.
        for column in Arc::get_mut(&mut dropped).into_iter().flatten() {
            let bytes = column_bytes(column);
            if self.bytes + bytes <= SPARE_BYTES {
                self.bytes += bytes;
                self.columns.push(std::mem::take(column));
            }
        }
    }

    /// A column with room for `length` values and not much more.
    fn take(&mut self, length: usize) -> Option<Vec<f32>> {
        let fits = |column: &Vec<f32>| {
            let room = column.capacity();
            room >= length && room - length <= length / 8
        };
        let place = self.columns.iter().position(fits)?;
        let mut column = self.columns.swap_remove(place);
        self.bytes -= column_bytes(&column);
        column.clear();
        Some(column)
    }
}

fn column_bytes(column: &Vec<f32>) -> usize {
    column.capacity() * size_of::<f32>()
}

#[derive(Debug)]
struct Entry {
    content: Content,
    bytes: usize,
    /// Picoseconds of work per byte.
    worth: u64,
    rank: u64,
}

#[derive(Clone, Debug)]
enum Content {
    Structure(Structure),
    Columns(Columns),
}

impl Memory {
    /// Remembers up to `budget` bytes; 0 remembers nothing.
    pub(super) fn new(budget: usize) -> Memory {
        Memory {
            budget,
            state: Mutex::default(),
        }
    }

    /// Whether anything can be remembered.
    pub(super) fn is_enabled(&self) -> bool {
        self.budget > 0
    }

    /// Bytes in use.
    pub(super) fn bytes(&self) -> usize {
        self.lock().bytes
    }

    pub(super) fn structure(&self, key: &Key) -> Option<Structure> {
        match self.lock().touch(key)? {
            Content::Structure(structure) => Some(structure),
            Content::Columns(_) => None,
        }
    }

    pub(super) fn put_structure(
        &self,
        key: Key,
        structure: Structure,
        bytes: usize,
        nanoseconds: f64,
    ) {
        let bytes = bytes.saturating_add(BESIDES);
        self.put_content(key, Content::Structure(structure), bytes, nanoseconds);
    }

    fn put_content(&self, key: Key, content: Content, bytes: usize, nanoseconds: f64) {
        if bytes > self.budget {
            return;
        }
        let worth = (1000.0 * nanoseconds / bytes.max(1) as f64) as u64;
        self.lock().insert(key, content, bytes, worth, self.budget);
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // A panic elsewhere leaves whole entries behind: nothing is half-written under this lock.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ColumnCache for Memory {
    fn get(&self, key: &Key) -> Option<Columns> {
        match self.lock().touch(key)? {
            Content::Columns(columns) => Some(columns),
            Content::Structure(_) => None,
        }
    }

    fn column(&self, length: usize) -> Vec<f32> {
        let spare = self.lock().spare.take(length);
        spare.unwrap_or_else(|| Vec::with_capacity(length))
    }

    fn put(&self, _: &str, key: Key, columns: Columns, nanoseconds: f64) {
        let bytes = columns.iter().map(column_bytes).sum();
        self.put_content(key, Content::Columns(columns), bytes, nanoseconds);
    }
}

impl State {
    fn touch(&mut self, key: &Key) -> Option<Content> {
        let clock = self.clock;
        let entry = self.entries.get_mut(key)?;
        self.ranks.remove(&(entry.rank, *key));
        entry.rank = clock + entry.worth;
        self.ranks.insert((entry.rank, *key));
        Some(entry.content.clone())
    }

    fn insert(&mut self, key: Key, content: Content, bytes: usize, worth: u64, budget: usize) {
        self.remove(&key);
        while self.bytes + bytes > budget {
            let Some((rank, oldest)) = self.ranks.first().copied() else {
                break;
            };
            self.clock = rank;
            self.remove(&oldest);
        }
        let rank = self.clock + worth;
        self.ranks.insert((rank, key));
        self.bytes += bytes;
        self.entries.insert(
            key,
            Entry {
                content,
                bytes,
                worth,
                rank,
            },
        );
    }

    fn remove(&mut self, key: &Key) {
        if let Some(entry) = self.entries.remove(key) {
            self.ranks.remove(&(entry.rank, *key));
            self.bytes -= entry.bytes;
            if let Content::Columns(columns) = entry.content {
                self.spare.put(columns);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(value: f32) -> Columns {
        vec![vec![value; 256]].into()
    }

    fn key(name: &str) -> Key {
        Key::of_bytes(name.as_bytes())
    }

    #[test]
    fn the_cheapest_per_byte_is_dropped_first_and_the_budget_holds() {
        let memory = Memory::new(3 * 1024);
        memory.put("node", key("dear"), columns(1.0), 1e6);
        memory.put("node", key("cheap"), columns(2.0), 1e3);
        memory.put("node", key("middle"), columns(3.0), 1e5);
        memory.put("node", key("new"), columns(4.0), 1e5);
        assert!(memory.get(&key("cheap")).is_none());
        assert_eq!(
            memory.get(&key("dear")).map(|columns| columns[0][0]),
            Some(1.0)
        );
        assert!(memory.bytes() <= 3 * 1024);
    }

    #[test]
    fn dropped_columns_are_used_again_unless_someone_reads_them() {
        let memory = Memory::new(1024);
        memory.put("node", key("first"), columns(1.0), 1.0);
        let place = memory.get(&key("first")).unwrap()[0].as_ptr();
        memory.put("node", key("second"), columns(2.0), 1.0);
        assert!(memory.get(&key("first")).is_none());
        // Too large or too small for it.
        let unfit = [257, 200].map(|length| memory.column(length));
        assert!(unfit.iter().all(|column| column.as_ptr() != place));
        let again = memory.column(250);
        assert_eq!((again.as_ptr(), again.len()), (place, 0));
        let read = memory.get(&key("second")).unwrap();
        memory.put("node", key("third"), columns(3.0), 1.0);
        let other = memory.column(256);
        assert!(other.as_ptr() != read[0].as_ptr());
    }

    #[test]
    fn what_does_not_fit_is_not_kept() {
        let memory = Memory::new(100);
        memory.put("node", key("large"), columns(1.0), 1e9);
        assert!(memory.get(&key("large")).is_none());
        assert_eq!(memory.bytes(), 0);
    }
}
