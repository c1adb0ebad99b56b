//! What was asked of a world and what it said, so that the same can be asked again later.

use super::{Stamp, World};
use crate::key::{Key, KeyHasher};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// What was asked of a world.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Question {
    RealPath(PathBuf),
    Read(PathBuf),
    ReadStart(PathBuf, usize),
}

/// What the world said.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    /// Hash of the contents or the path, or of the kind of error; `None` if the world has said two things,
    /// so that whatever it says later is another.
    pub(super) key: Option<Key>,
    /// The state of the file just before, if it can be told from later ones.
    pub(super) stamp: Option<Stamp>,
}

/// The questions that a run has asked about files, with the answers; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Trace(Arc<Mutex<BTreeMap<Question, Answer>>>);

/// Which answers of a trace to doubt.
#[derive(Clone, Copy, Debug)]
pub enum Doubt<'a> {
    /// All of them: everything is read again.
    All,
    /// Those about these paths and about what lies below them, and those whose file has another stamp.
    About(&'a BTreeSet<PathBuf>),
    /// Those about these paths and no others, if the file has another stamp than before it was read.
    Lately(&'a BTreeSet<PathBuf>),
}

impl Trace {
    /// A trace with nothing in it.
    pub fn new() -> Trace {
        Trace::default()
    }

    /// The paths that were asked about, whether anything was there or not.
    pub fn paths(&self) -> BTreeSet<PathBuf> {
        self.lock().keys().map(|it| it.path().to_owned()).collect()
    }

    /// The files that were looked for, as they are named: what a person would change.
    pub fn named(&self) -> BTreeSet<PathBuf> {
        let answers = self.lock();
        let named = answers.keys().filter_map(|question| match question {
            // Folders are asked for as well: to see whether files really lie in them.
            Question::RealPath(path) if path.extension().is_some() => Some(path.clone()),
            _ => None,
        });
        named.collect()
    }

    /// A path about which the world says something else now than it did; `None` if there is none.
    /// Contents count, and neither time stamps nor modes.
    pub fn changed(&self, world: &dyn World, doubt: Doubt<'_>) -> Option<PathBuf> {
        let answers: Vec<_> = self.lock().clone().into_iter().collect();
        let mut renewed = vec![];
        for (question, answer) in answers {
            if !question.is_in_doubt(&answer, world, doubt) {
                continue;
            }
            let now = question.ask(world);
            if answer.key.is_none() || now.key != answer.key {
                return Some(question.path().to_owned());
            }
            renewed.push((question, now));
        }
        // What was looked at need not be looked at again until its stamp changes.
        let mut answers = self.lock();
        for (question, now) in renewed {
            if let Some(answer) = answers.get_mut(&question)
                && answer.key == now.key
            {
                *answer = now;
            }
        }
        None
    }

    /// Notes an answer; says whether the question is new.
    pub(super) fn note(&self, question: Question, answer: Answer) -> bool {
        match self.lock().entry(question) {
            Entry::Vacant(place) => {
                place.insert(answer);
                true
            }
            Entry::Occupied(mut known) => {
                // A run that has seen two answers must be repeated, even if the first one comes back.
                if known.get().key != answer.key {
                    known.insert(Answer {
                        key: None,
                        stamp: None,
                    });
                }
                false
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<Question, Answer>> {
        // Every change is one insertion, so a panic elsewhere leaves the map whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Question {
    pub(super) fn path(&self) -> &Path {
        match self {
            Question::RealPath(path) | Question::Read(path) | Question::ReadStart(path, _) => path,
        }
    }

    fn is_in_doubt(&self, answer: &Answer, world: &dyn World, doubt: Doubt<'_>) -> bool {
        match doubt {
            Doubt::All => true,
            Doubt::About(paths) if paths.iter().any(|it| self.path().starts_with(it)) => true,
            // Where a link leads is cheap to ask.
            Doubt::About(_) if matches!(self, Question::RealPath(_)) => true,
            Doubt::Lately(paths) if !paths.contains(self.path()) => false,
            Doubt::Lately(_) if matches!(self, Question::RealPath(_)) => true,
            Doubt::About(_) | Doubt::Lately(_) => {
                answer.stamp.is_none() || stamp(world, self.path()) != answer.stamp
            }
        }
    }

    fn ask(&self, world: &dyn World) -> Answer {
        let stamp = self.stamp(world);
        let key = match self {
            Question::RealPath(path) => of_path(&world.real_path(path)),
            Question::Read(path) => of_bytes(&world.read(path)),
            Question::ReadStart(path, length) => of_bytes(&world.read_start(path, *length)),
        };
        let key = Some(key);
        Answer { key, stamp }
    }

    pub(super) fn stamp(&self, world: &dyn World) -> Option<Stamp> {
        match self {
            Question::RealPath(_) => None,
            Question::Read(path) | Question::ReadStart(path, _) => stamp(world, path),
        }
    }
}

/// The state of a file, unless it is so young that a later one could look the same.
fn stamp(world: &dyn World, path: &Path) -> Option<Stamp> {
    let stamp = world.stamp(path).ok()?;
    stamp.is_settled(SystemTime::now()).then_some(stamp)
}

/// A hasher for contents, which are added in parts.
pub(super) fn contents() -> KeyHasher {
    KeyHasher::new("contents", 2)
}

pub(super) fn of_bytes(read: &io::Result<Vec<u8>>) -> Key {
    match read {
        Ok(bytes) => contents().part(bytes).finish(),
        Err(error) => of_error(error),
    }
}

pub(super) fn of_path(path: &io::Result<PathBuf>) -> Key {
    match path {
        Ok(path) => KeyHasher::new("place", 1)
            .bytes(path.as_os_str().as_encoded_bytes())
            .finish(),
        Err(error) => of_error(error),
    }
}

pub(super) fn of_error(error: &io::Error) -> Key {
    KeyHasher::new("error", 1).text(&error.to_string()).finish()
}
