//! Places: where the positions of fields come from, and what is known there of the places around.

use super::compile::POSITION;
use super::{Field, Opening};
use crate::key::{Key, KeyHasher};
use std::collections::HashMap;
use std::sync::Arc;

/// The columns of fields by their keys, in each place.
pub(super) type ColumnsOf = HashMap<(Key, usize), Vec<usize>>;

/// Where positions come from: the samples themselves, or three columns of another place.
struct Place {
    key: Key,
    position: [usize; 3],
    /// The place this one was opened in, and the way into this one.
    outer: Option<(usize, Arc<Opening>)>,
}

/// All places of a program; the first is that of the samples.
pub(super) struct Places {
    list: Vec<Place>,
    by_opening: HashMap<(usize, Key), usize>,
}

impl Places {
    pub(super) fn new() -> Places {
        let root = Place {
            key: KeyHasher::new("root", 1).finish(),
            position: POSITION,
            outer: None,
        };
        Places {
            list: vec![root],
            by_opening: HashMap::new(),
        }
    }

    /// Identifies a place.
    pub(super) fn key(&self, place: usize) -> Key {
        self.list[place].key
    }

    /// Whether it is the place of the samples.
    pub(super) fn is_root(&self, place: usize) -> bool {
        self.list[place].outer.is_none()
    }

    /// The columns of the positions.
    pub(super) fn position(&self, place: usize) -> [usize; 3] {
        self.list[place].position
    }

    /// The place that an opening leads to from `place`, once the columns of its fields are known.
    pub(super) fn open(
        &mut self,
        place: usize,
        opening: &Arc<Opening>,
        columns_of: &ColumnsOf,
    ) -> Option<usize> {
        if let Some(known) = self.by_opening.get(&(place, opening.key)) {
            return Some(*known);
        }
        let is_known = |field: &Field| columns_of.contains_key(&(field.key(), place));
        if !opening.fields().all(is_known) {
            return None;
        }
        let columns = &columns_of[&(opening.position.key(), place)];
        let key = KeyHasher::new("place", 1)
            .key(self.key(place))
            .key(opening.key)
            .finish();
        self.list.push(Place {
            key,
            position: [columns[0], columns[1], columns[2]],
            outer: Some((place, Arc::clone(opening))),
        });
        let inner = self.list.len() - 1;
        self.by_opening.insert((place, opening.key), inner);
        Some(inner)
    }

    /// The place that an opening has led to.
    pub(super) fn inner(&self, place: usize, opening: &Opening) -> usize {
        self.by_opening[&(place, opening.key)]
    }

    /// The field, by its key and place, that the nearest opening around `place` gives under a name.
    pub(super) fn given(&self, name: &str, width: usize, mut place: usize) -> Option<(Key, usize)> {
        while let Some((outer, opening)) = &self.list[place].outer {
            let is_meant =
                |(given, field): &&(Arc<str>, Field)| &**given == name && field.width() == width;
            if let Some((_, field)) = opening.given.iter().find(is_meant) {
                return Some((field.key(), *outer));
            }
            place = *outer;
        }
        None
    }

    /// A field as seen from the samples' own positions.
    pub(super) fn seen_from_root(&self, field: &Field, mut place: usize) -> Field {
        let mut field = field.clone();
        while let Some((outer, opening)) = &self.list[place].outer {
            field = field.through(opening);
            place = *outer;
        }
        field
    }
}
