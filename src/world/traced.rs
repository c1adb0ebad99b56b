//! A world that notes what is read through it.

use super::trace::{self, Answer, Question};
use super::{Listed, Notices, NoticesError, PendingFile, Stamp, Trace, Wake, World};
use crate::key::{Key, KeyHasher};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// A world that notes in a trace what is read through it.
pub struct Traced {
    world: Arc<dyn World>,
    notes: Notes,
}

/// Where answers are noted.
#[derive(Clone)]
struct Notes {
    trace: Trace,
    /// Called for each path that was not asked about before.
    on_new: Arc<dyn Fn(&Path) + Send + Sync>,
}

impl Notes {
    fn note(&self, question: Question, key: Key, stamp: Option<Stamp>) {
        let (path, key) = (question.path().to_owned(), Some(key));
        if self.trace.note(question, Answer { key, stamp }) {
            (self.on_new)(&path);
        }
    }
}

impl Traced {
    /// Notes what is read from `world` in `trace`, and calls `on_new` after each new path.
    pub fn new(
        world: Arc<dyn World>,
        trace: Trace,
        on_new: impl Fn(&Path) + Send + Sync + 'static,
    ) -> Traced {
        let on_new = Arc::new(on_new);
        Traced {
            world,
            notes: Notes { trace, on_new },
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
        self.notes.note(question, key(&said), stamp);
        said
    }
}

/// A file that is hashed as it is read, and noted when that ends.
struct TracedStream {
    stream: Box<dyn Read>,
    notes: Notes,
    path: PathBuf,
    stamp: Option<Stamp>,
    hasher: KeyHasher,
    /// Bytes that were read.
    length: usize,
    is_noted: bool,
}

impl TracedStream {
    fn note(&mut self, question: Question, key: Key) {
        if !self.is_noted {
            self.is_noted = true;
            self.notes.note(question, key, self.stamp.take());
        }
    }
}

impl Read for TracedStream {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(buffer);
        match &read {
            Ok(0) if !buffer.is_empty() => {
                self.note(Question::Read(self.path.clone()), self.hasher.finish());
            }
            Ok(length) => {
                self.hasher.part(&buffer[..*length]);
                self.length += length;
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => {
                self.note(Question::Read(self.path.clone()), trace::of_error(error));
            }
        }
        read
    }
}

impl Drop for TracedStream {
    fn drop(&mut self) {
        // Whoever reads no further, or was cancelled, has seen the start and nothing else.
        let question = Question::ReadStart(self.path.clone(), self.length);
        self.note(question, self.hasher.finish());
    }
}

impl World for Traced {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let question = Question::Read(path.to_owned());
        self.noted(question, || self.world.read(path), trace::of_bytes)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        let question = Question::Read(path.to_owned());
        let stamp = question.stamp(&*self.world);
        let opened = self.world.open(path).inspect_err(|error| {
            let key = trace::of_error(error);
            self.notes.note(question, key, stamp.clone());
        });
        Ok(Box::new(TracedStream {
            stream: opened?,
            notes: self.notes.clone(),
            path: path.to_owned(),
            stamp,
            hasher: trace::contents(),
            length: 0,
            is_noted: false,
        }))
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        let question = Question::RealPath(path.to_owned());
        self.noted(question, || self.world.real_path(path), trace::of_path)
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        let question = Question::ReadStart(path.to_owned(), length);
        self.noted(
            question,
            || self.world.read_start(path, length),
            trace::of_bytes,
        )
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
    use crate::world::{Doubt, Memory, forwarded};

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
    fn two_answers_in_one_run_are_a_change_even_if_the_first_comes_back() {
        let files = Memory::default();
        let trace = Trace::new();
        let world = Traced::new(Arc::new(files.clone()), trace.clone(), |_| {});
        for (text, is_changed) in [("one", false), ("one", false), ("two", true)] {
            files.insert("a", text);
            world.read(Path::new("a")).unwrap();
            let changed = trace.changed(&files, Doubt::All);
            assert_eq!(changed.is_some(), is_changed, "{text}");
        }
        files.insert("a", "one");
        assert_eq!(trace.changed(&files, Doubt::All), Some("a".into()));
        world.read(Path::new("a")).unwrap();
        assert_eq!(trace.changed(&files, Doubt::All), Some("a".into()));
    }

    #[test]
    fn a_stream_is_noted_as_far_as_it_was_read() {
        let files = Memory::default();
        files.insert("a", "abcdef");
        let changed = |trace: &Trace, text: &str| {
            files.insert("a", text);
            let changed = trace.changed(&files, Doubt::All).is_some();
            files.insert("a", "abcdef");
            changed
        };
        let traced = |length: u64| {
            let trace = Trace::new();
            let world = Traced::new(Arc::new(files.clone()), trace.clone(), |_| {});
            let mut stream = world.open(Path::new("a")).unwrap();
            let mut text = String::new();
            stream
                .by_ref()
                .take(length)
                .read_to_string(&mut text)
                .unwrap();
            drop(stream);
            // What a stream and what a whole reading say is the same.
            assert_eq!(trace.changed(&files, Doubt::All), None);
            trace
        };
        let (start, whole) = (traced(3), traced(9));
        assert!(!changed(&start, "abcxyz") && !changed(&start, "abc"));
        assert!(changed(&start, "abXdef") && changed(&start, "ab"));
        assert!(changed(&whole, "abcxyz") && changed(&whole, "abcdefg"));
    }

    #[test]
    fn a_stream_that_cannot_be_opened_is_noted() {
        let files = Memory::default();
        let trace = Trace::new();
        let world = Traced::new(Arc::new(files.clone()), trace.clone(), |_| {});
        assert!(world.open(Path::new("a")).is_err());
        assert_eq!(trace.changed(&files, Doubt::All), None);
        files.insert("a", "");
        assert_eq!(trace.changed(&files, Doubt::All), Some("a".into()));
    }
}
