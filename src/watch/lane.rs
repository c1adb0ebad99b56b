//! The threads of runs: one run goes on, and one more may be left behind in a call that cannot be stopped.

use super::run::{PATIENCE, Run, Runner, Switches};
use super::session::Running;
use crate::engine::Engine;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time between the starts of two runs of which the first was overtaken by a change.
const BREATH: Duration = Duration::from_millis(30);

/// Says when the next run may start, and starts it.
pub(super) struct Lane {
    engine: Arc<Engine>,
    runner: Runner,
    stopping: Option<Stopping>,
    /// The number of a run that did not end in time; it ends in the background.
    left_behind: Option<u64>,
    /// When the next run may start.
    breath: Instant,
}

/// A run that was overtaken and has not ended.
struct Stopping {
    number: u64,
    switches: Switches,
    /// Until when its end is waited for.
    until: Instant,
    /// Whether its switch is thrown; before, its small pictures may come.
    is_thrown: bool,
}

impl Lane {
    /// # Errors
    /// If the system gives no thread.
    pub(super) fn new(engine: Engine) -> io::Result<Lane> {
        Ok(Lane {
            engine: Arc::new(engine),
            runner: Runner::new()?,
            stopping: None,
            left_behind: None,
            breath: Instant::now(),
        })
    }

    /// The engine of the next run.
    pub(super) fn engine(&self) -> Arc<Engine> {
        Arc::clone(&self.engine)
    }

    /// Starts a run; only if the lane is free.
    pub(super) fn start(&self, run: Run) {
        self.runner.start(run);
    }

    /// Stops a run, or has it stop behind its small pictures.
    pub(super) fn stop(&mut self, running: &Running, previews: bool, now: Instant) {
        let switches = running.switches.clone();
        let patience = previews.then(|| switches.stop_after_preview()).flatten();
        if patience.is_none() {
            switches.stop();
        }
        self.stopping = Some(Stopping {
            number: running.number,
            switches,
            until: now + patience.unwrap_or(PATIENCE),
            is_thrown: patience.is_none(),
        });
    }

    /// Takes note that a run has ended.
    pub(super) fn end(&mut self, number: u64, now: Instant) {
        if self.stopping.take_if(|it| it.number == number).is_some() {
            self.breath = now + BREATH;
        }
        self.left_behind.take_if(|left| *left == number);
    }

    /// Whether the next run may start, as far as the one before it is concerned.
    pub(super) fn is_free(&mut self, now: Instant) -> bool {
        if now < self.breath {
            return false;
        }
        let Some(stopping) = &mut self.stopping else {
            return true;
        };
        if now < stopping.until {
            return false;
        }
        if !stopping.is_thrown {
            stopping.switches.stop();
            (stopping.is_thrown, stopping.until) = (true, now + PATIENCE);
            return false;
        }
        self.left_behind.is_none() && self.leave_behind()
    }

    /// When to ask again whether it is free; `None` if only the end of a run can make it so.
    pub(super) fn frees_at(&self) -> Option<Instant> {
        match &self.stopping {
            Some(stopping) if stopping.is_thrown && self.left_behind.is_some() => None,
            Some(stopping) => Some(stopping.until.max(self.breath)),
            None => Some(self.breath),
        }
    }

    /// The number of the run that was stopped and has not ended.
    pub(super) fn stopping(&self) -> Option<u64> {
        self.stopping.as_ref().map(|stopping| stopping.number)
    }

    /// The run that is stopping is in a call that cannot be stopped: the next one gets threads of its own,
    /// and what the old one still gives is dropped. False if the system has no more threads.
    fn leave_behind(&mut self) -> bool {
        let (Ok(engine), Ok(runner)) = (self.engine.beside(), Runner::new()) else {
            // Perhaps later, or the run ends.
            self.breath = Instant::now() + BREATH;
            return false;
        };
        (self.engine, self.runner) = (Arc::new(engine), runner);
        self.left_behind = self.stopping.take().map(|stopping| stopping.number);
        true
    }
}
