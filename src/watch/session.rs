//! Where a followed recipe stands.

use super::report::Failed;
use super::run::Switches;
use super::{Followed, Told};
use crate::world::{Doubt, Trace, World};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long files have to be quiet before a mistake in them is told.
pub(super) const QUIET: Duration = Duration::from_millis(250);

/// How long after the last change a mistake is told at the latest, however often the files are touched.
const LATEST: Duration = Duration::from_secs(2);

/// A recipe and what became of it.
pub(super) struct Session {
    pub(super) followed: Arc<Followed>,
    pub(super) state: State,
    /// When its files were last seen to have changed; the start of the watch at first.
    pub(super) changed: Instant,
    /// When anything was last heard of its files, or found: a file that is empty each time one looks may
    /// have been whole in between.
    pub(super) stirred: Instant,
    /// When something new was last to be seen of it.
    pub(super) shown: Option<Instant>,
    /// The number of its newest run; 0 before the first.
    pub(super) newest: u64,
    /// What the newest run has read so far.
    trace: Trace,
    /// What the run before had read: followed until the newest has ended.
    before: Trace,
}

/// What is to be done with a recipe.
pub(super) enum State {
    /// It has to run.
    Due,
    /// It runs.
    Running(Running),
    /// Its run failed; that is told when the files are quiet.
    Failing(Failed),
    /// It waits for a change.
    Settled,
}

/// A run that is going on.
pub(super) struct Running {
    pub(super) number: u64,
    pub(super) switches: Switches,
}

impl Session {
    pub(super) fn new(followed: Arc<Followed>, now: Instant) -> Session {
        Session {
            followed,
            state: State::Due,
            changed: now,
            stirred: now,
            shown: None,
            newest: 0,
            trace: Trace::new(),
            before: Trace::new(),
        }
    }

    /// Every path whose change may matter.
    pub(super) fn paths(&self) -> BTreeSet<PathBuf> {
        let mut paths = self.trace.paths();
        paths.extend(self.before.paths());
        // Before anything was read, and whatever was.
        paths.insert(self.followed.recipe.clone());
        paths
    }

    /// The files that a change is waited for, the recipe first.
    fn named(&self) -> Vec<PathBuf> {
        let recipe = std::iter::once(self.followed.recipe.clone());
        recipe.chain(self.trace.named()).collect()
    }

    /// Whether a change of one of these paths may matter.
    pub(super) fn reads_any(&self, paths: &BTreeSet<PathBuf>) -> bool {
        !self.paths().is_disjoint(paths)
    }

    /// A path that is not what the newest run has read.
    pub(super) fn changed_path(&self, world: &dyn World, doubt: Doubt<'_>) -> Option<PathBuf> {
        self.trace.changed(world, doubt)
    }

    /// Begins a run: what it reads is noted in the trace that this gives.
    pub(super) fn begin(&mut self, running: Running) -> Trace {
        self.before = std::mem::take(&mut self.trace);
        self.newest = running.number;
        self.state = State::Running(running);
        self.trace.clone()
    }

    /// Whether a run is going on that nothing has overtaken.
    pub(super) fn is_running(&self) -> bool {
        matches!(self.state, State::Running(_))
    }

    /// Forgets what the run before had read.
    pub(super) fn end(&mut self, state: State) {
        self.before = Trace::new();
        self.state = state;
    }

    /// When its mistakes are to be told.
    pub(super) fn tells_at(&self) -> Option<Instant> {
        let time = (self.stirred + QUIET).min(self.changed + LATEST);
        matches!(self.state, State::Failing(_)).then_some(time)
    }

    /// Settles what failed, if it is time: what is to be told of it.
    pub(super) fn failed(&mut self, now: Instant) -> Option<[Told; 2]> {
        if self.tells_at().is_none_or(|time| now < time) {
            return None;
        }
        match std::mem::replace(&mut self.state, State::Settled) {
            State::Failing(failed) => Some([Told::Failed(failed), Told::Waiting(self.named())]),
            other => {
                self.state = other;
                None
            }
        }
    }
}
