//! A world that notes what is read through it, so that the same can be asked again later.

use super::{Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World};
use crate::key::{Key, KeyHasher};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

/// A stamp younger than this when it was taken may hide a later change: clocks of file systems tick slowly.
const TICK: Duration = Duration::from_millis(100);

/// What was asked of a world.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Question {
    RealPath(PathBuf),
    Read(PathBuf),
    ReadStart(PathBuf, usize),
}

/// What the world said.
#[derive(Clone, Debug)]
struct Answer {
    /// Hash of the contents or the path, or of the kind of error.
    key: Key,
    /// The state of the file just before, if it can be told from later ones.
    stamp: Option<Stamp>,
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
            if now.key != answer.key {
                return Some(question.path().to_owned());
            }
            renewed.push((question, now));
        }
        // What was looked at need not be looked at again until its stamp changes.
        self.lock().extend(renewed);
        None
    }

    fn note(&self, question: Question, answer: impl FnOnce() -> Answer) -> bool {
        let mut answers = self.lock();
        let is_new = !answers.contains_key(&question);
        // The first answer counts: a run that has seen two must be repeated.
        answers.entry(question).or_insert_with(answer);
        is_new
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<Question, Answer>> {
        // Every change is one insertion, so a panic elsewhere leaves the map whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Question {
    fn path(&self) -> &Path {
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
        Answer { key, stamp }
    }

    fn stamp(&self, world: &dyn World) -> Option<Stamp> {
        match self {
            Question::RealPath(_) => None,
            Question::Read(path) | Question::ReadStart(path, _) => stamp(world, path),
        }
    }
}

/// The state of a file, unless it is so young that a later one could look the same.
fn stamp(world: &dyn World, path: &Path) -> Option<Stamp> {
    let stamp = world.stamp(path).ok()?;
    stamp
        .is_older_than(SystemTime::now().checked_sub(TICK)?)
        .then_some(stamp)
}

fn of_bytes(read: &io::Result<Vec<u8>>) -> Key {
    match read {
        Ok(bytes) => KeyHasher::new("contents", 1).bytes(bytes).finish(),
        Err(error) => of_error(error),
    }
}

fn of_path(path: &io::Result<PathBuf>) -> Key {
    match path {
        Ok(path) => KeyHasher::new("place", 1)
            .bytes(path.as_os_str().as_encoded_bytes())
            .finish(),
        Err(error) => of_error(error),
    }
}

fn of_error(error: &io::Error) -> Key {
    KeyHasher::new("error", 1).text(&error.to_string()).finish()
}

/// A world that notes in a trace what is read through it.
pub struct Traced {
    world: Arc<dyn World>,
    trace: Trace,
    on_new: OnNew,
}

/// Called for each path that was not asked about before.
type OnNew = Box<dyn Fn(&Path) + Send + Sync>;

impl Traced {
    /// Notes what is read from `world` in `trace`, and calls `on_new` after each new path.
    pub fn new(
        world: Arc<dyn World>,
        trace: Trace,
        on_new: impl Fn(&Path) + Send + Sync + 'static,
    ) -> Traced {
        Traced {
            world,
            trace,
            on_new: Box::new(on_new),
        }
    }

    fn noted<T>(
        &self,
        question: Question,
        ask: impl FnOnce() -> io::Result<T>,
        key: fn(&io::Result<T>) -> Key,
    ) -> io::Result<T> {
        let stamp = question.stamp(&*self.world);
        let said = ask();
        let answer = || Answer {
            key: key(&said),
            stamp,
        };
        let path = question.path().to_owned();
        if self.trace.note(question, answer) {
            (self.on_new)(&path);
        }
        said
    }
}

impl World for Traced {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let question = Question::Read(path.to_owned());
        self.noted(question, || self.world.read(path), of_bytes)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        Ok(Box::new(io::Cursor::new(self.read(path)?)))
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        let question = Question::RealPath(path.to_owned());
        self.noted(question, || self.world.real_path(path), of_path)
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        let question = Question::ReadStart(path.to_owned(), length);
        self.noted(question, || self.world.read_start(path, length), of_bytes)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.world.create(path)
    }

    fn create_aside(&self, path: &Path, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.world.create_aside(path, aside)
    }

    fn sweep(&self, folder: &Path) {
        self.world.sweep(folder);
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.world.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.world.remove(path)
    }

    fn is_link(&self, path: &Path) -> bool {
        self.world.is_link(path)
    }

    fn touch(&self, path: &Path, after: Duration) -> io::Result<()> {
        self.world.touch(path, after)
    }

    fn stamp(&self, path: &Path) -> io::Result<Stamp> {
        self.world.stamp(path)
    }

    fn notices(&self, wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        self.world.notices(wake)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Memory, forwarded};

    #[test]
    fn whatever_is_asked_is_passed_on() {
        forwarded::check(|world| Box::new(Traced::new(world, Trace::new(), |_| {})));
    }

    #[test]
    fn a_trace_knows_what_is_another_now_and_what_was_not_there() {
        let files = Memory::default();
        files.insert("a", "one");
        let trace = Trace::new();
        let world = Traced::new(Arc::new(files.clone()), trace.clone(), |_| {});
        world.read(Path::new("a")).unwrap();
        assert!(world.read(Path::new("b")).is_err());
        assert_eq!(trace.changed(&files, Doubt::All), None);
        files.insert("c", "not asked for");
        files.insert("a", "one");
        assert_eq!(trace.changed(&files, Doubt::All), None);
        files.insert("b", "new");
        assert_eq!(trace.changed(&files, Doubt::All), Some("b".into()));
    }

    #[test]
    fn of_two_answers_in_one_run_the_first_counts() {
        let files = Memory::default();
        files.insert("a", "one");
        let trace = Trace::new();
        let world = Traced::new(Arc::new(files.clone()), trace.clone(), |_| {});
        world.read(Path::new("a")).unwrap();
        files.insert("a", "two");
        world.read(Path::new("a")).unwrap();
        assert_eq!(trace.changed(&files, Doubt::All), Some("a".into()));
    }
}
