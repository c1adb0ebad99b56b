//! A test for worlds around others: whatever they are asked, the inner one has to hear of it, or the default
//! of the trait would answer in its place.

use super::{Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A world that notes what it is asked, and has nothing.
#[derive(Clone, Default)]
struct Noting(Arc<Mutex<Vec<&'static str>>>);

impl Noting {
    fn note(&self, name: &'static str) {
        self.0.lock().expect("no test panics under it").push(name);
    }

    fn nothing<T>(&self, name: &'static str) -> io::Result<T> {
        self.note(name);
        Err(io::ErrorKind::NotFound.into())
    }
}

impl World for Noting {
    fn read(&self, _: &Path) -> io::Result<Vec<u8>> {
        self.nothing("read")
    }

    fn open(&self, _: &Path) -> io::Result<Box<dyn Read>> {
        self.nothing("open")
    }

    fn real_path(&self, _: &Path) -> io::Result<PathBuf> {
        self.nothing("real_path")
    }

    fn read_start(&self, _: &Path, _: usize) -> io::Result<Vec<u8>> {
        self.nothing("read_start")
    }

    fn create(&self, _: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.nothing("create")
    }

    fn create_aside(&self, _: &Path, _: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.nothing("create_aside")
    }

    fn sweep(&self, _: &Path) {
        self.note("sweep");
    }

    fn list(&self, _: &Path) -> io::Result<Vec<Listed>> {
        self.nothing("list")
    }

    fn is_link(&self, _: &Path) -> bool {
        self.note("is_link");
        false
    }

    fn touch(&self, _: &Path, _: Duration) -> io::Result<()> {
        self.nothing("touch")
    }

    fn remove(&self, _: &Path) -> io::Result<()> {
        self.nothing("remove")
    }

    fn stamp(&self, _: &Path) -> io::Result<Stamp> {
        self.nothing("stamp")
    }

    fn notices(&self, _: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        self.note("notices");
        Err(NoticesError::new("there are none"))
    }
}

/// Asks a world around another everything, and checks that the inner one heard it.
pub(crate) fn check(around: impl FnOnce(Arc<dyn World>) -> Box<dyn World>) {
    let inner = Noting::default();
    let world = around(Arc::new(inner.clone()));
    let path = Path::new("map.png");
    let heard = |name: &str| {
        let heard = std::mem::take(&mut *inner.0.lock().expect("no test panics under it"));
        assert!(heard.contains(&name), "{name}: {heard:?}");
    };
    assert!(world.real_path(path).is_err());
    heard("real_path");
    assert!(world.read_start(path, 1).is_err());
    heard("read_start");
    assert!(world.create(path).is_err());
    heard("create");
    assert!(world.create_aside(path, path).is_err());
    heard("create_aside");
    world.sweep(path);
    heard("sweep");
    assert!(world.list(path).is_err());
    heard("list");
    assert!(!world.is_link(path));
    heard("is_link");
    assert!(world.touch(path, Duration::ZERO).is_err());
    heard("touch");
    assert!(world.remove(path).is_err());
    heard("remove");
    assert!(world.stamp(path).is_err());
    heard("stamp");
    assert!(world.notices(Arc::new(|_| {})).is_err());
    heard("notices");
}
