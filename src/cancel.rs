//! The switch that stops a run: its loops at their next step, and its files before they are put in place.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A switch that stops a run; its copies are the same switch.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<Switch>);

#[derive(Debug, Default)]
struct Switch {
    thrown: AtomicBool,
    /// Held by whoever puts a file in place.
    placing: Mutex<()>,
}

impl Cancel {
    /// A switch that is off.
    pub fn new() -> Cancel {
        Cancel::default()
    }

    /// Stops the runs that hold this switch. Once this has returned, none of them puts a file in place any
    /// more; one that is doing so is waited for, which takes no longer than a rename.
    ///
    /// Not to be called from within [`Cancel::unless_cancelled`], so not by a world while it commits a file.
    pub fn cancel(&self) {
        self.0.thrown.store(true, Ordering::Relaxed);
        // Whoever takes the lock after this has released it sees the switch thrown.
        drop(self.lock());
    }

    /// Whether it has been thrown.
    pub fn is_cancelled(&self) -> bool {
        self.0.thrown.load(Ordering::Relaxed)
    }

    /// Does what must not happen any more once [`Cancel::cancel`] has returned; `None` if it has been
    /// thrown. All else waits meanwhile, so `act` should be quick.
    pub fn unless_cancelled<T>(&self, act: impl FnOnce() -> T) -> Option<T> {
        let _placing = self.lock();
        (!self.is_cancelled()).then(act)
    }

    /// For loops that report errors of files.
    ///
    /// # Errors
    /// If it has been thrown.
    pub(crate) fn check(&self) -> io::Result<()> {
        if self.is_cancelled() {
            // Not `Interrupted`: that is tried again.
            Err(io::Error::other("the run was cancelled"))
        } else {
            Ok(())
        }
    }

    fn lock(&self) -> MutexGuard<'_, ()> {
        // Nothing is kept under the lock that a panic could leave half done.
        self.0
            .placing
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    #[test]
    fn what_is_under_way_is_waited_for_and_nothing_follows() {
        let cancel = Cancel::new();
        let (begun, begins) = mpsc::channel();
        let (may_end, ends) = mpsc::channel::<()>();
        let (returned, returns) = mpsc::channel();
        thread::scope(|scope| {
            let run = cancel.clone();
            scope.spawn(move || {
                let act = || {
                    begun.send(()).unwrap();
                    ends.recv().unwrap();
                };
                assert_eq!(run.unless_cancelled(act), Some(()));
            });
            begins.recv().unwrap();
            let switch = cancel.clone();
            scope.spawn(move || {
                switch.cancel();
                returned.send(()).unwrap();
            });
            // Thrown at once, though `cancel` has to wait.
            while !cancel.is_cancelled() {
                thread::yield_now();
            }
            let early = returns.recv_timeout(Duration::from_millis(20));
            assert_eq!(early, Err(mpsc::RecvTimeoutError::Timeout));
            may_end.send(()).unwrap();
            returns.recv().unwrap();
        });
        assert_eq!(cancel.unless_cancelled(|| ()), None);
        assert!(cancel.check().is_err());
    }
}
