//! Text and kinds that are made while the program runs and live as long as it does.
//!
//! A kind is `&'static`: nodes, messages and caches name it freely. Compounds make kinds at run time, so
//! these are kept for good, each different one once. Recipes are checked against names, types and ranges, so
//! only an edit of these costs anything, and that once: some 150 bytes for each input and output.

use super::{Failure, Input, Kind, Output};
use crate::key::{Key, KeyHasher};
use std::collections::{HashMap, HashSet};
use std::sync::{LazyLock, Mutex, PoisonError};

static TEXTS: LazyLock<Mutex<HashSet<&'static str>>> = LazyLock::new(Mutex::default);
static NAMES: LazyLock<Mutex<HashSet<&'static [&'static str]>>> = LazyLock::new(Mutex::default);
static KINDS: LazyLock<Mutex<HashMap<Key, &'static Kind>>> = LazyLock::new(Mutex::default);

/// The one copy of a text.
pub(crate) fn text(text: &str) -> &'static str {
    let mut texts = TEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = texts.get(text) {
        return known;
    }
    let kept: &'static str = Box::leak(text.into());
    texts.insert(kept);
    kept
}

/// The one copy of a list of names.
pub(crate) fn names(names: &[String]) -> &'static [&'static str] {
    let all: Vec<&'static str> = names.iter().map(|name| text(name)).collect();
    let mut lists = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = lists.get(all.as_slice()) {
        return known;
    }
    let kept: &'static [&'static str] = Box::leak(all.into());
    lists.insert(kept);
    kept
}

/// The interface of a compound.
#[derive(Debug)]
pub(crate) struct Interface<'t> {
    /// The name of its file without the ending.
    pub(crate) name: &'t str,
    /// What it states as its version.
    pub(crate) version: u32,
    /// What it states that it does.
    pub(crate) about: &'static str,
    /// What it states as its source.
    pub(crate) source: &'static str,
    /// What goes in.
    pub(crate) inputs: Vec<Input>,
    /// What comes out.
    pub(crate) outputs: Vec<Output>,
}

/// The one copy of the kind with this interface; it has no example and cannot be built, since its nodes
/// take its place.
pub(crate) fn kind(interface: Interface<'_>) -> &'static Kind {
    let mut key = KeyHasher::new("kind", 1);
    let key = key.text(&format!("{interface:?}")).finish();
    let make = || -> &'static Kind {
        Box::leak(Box::new(Kind {
            name: text(interface.name),
            version: interface.version,
            about: interface.about,
            source: interface.source,
            inputs: Box::leak(interface.inputs.into_boxed_slice()),
            outputs: Box::leak(interface.outputs.into_boxed_slice()),
            example: "",
            build: |_, _| {
                let failure = Failure::new("an input of a compound has no value of its own");
                Err(failure.with_hint("use the compound in a recipe"))
            },
        }))
    };
    let mut kinds = KINDS.lock().unwrap_or_else(PoisonError::into_inner);
    kinds.entry(key).or_insert_with(make)
}
