//! What the thread that decides has to hear of: it is collected, so that nothing piles up.

use super::run::Ended;
use crate::world::Heard;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Instant;

/// What has come since it was last looked into.
#[derive(Default)]
pub(super) struct Inbox {
    /// Paths that may have changed.
    pub(super) paths: BTreeSet<PathBuf>,
    /// Notices were lost, or a folder is listened to anew: anything may have changed.
    pub(super) all: bool,
    /// What a run has read for the first time.
    pub(super) reads: BTreeSet<PathBuf>,
    /// Runs that ended.
    pub(super) ended: Vec<Ended>,
    /// The watch is to end.
    pub(super) stop: bool,
}

impl Inbox {
    /// Whether files may have changed.
    pub(super) fn heard(&self) -> bool {
        self.all || !self.paths.is_empty()
    }

    fn is_empty(&self) -> bool {
        !self.heard() && self.reads.is_empty() && self.ended.is_empty() && !self.stop
    }
}

/// Takes messages from any thread.
#[derive(Default)]
pub(super) struct Mailbox {
    inbox: Mutex<Inbox>,
    arrived: Condvar,
}

impl Mailbox {
    /// Adds to the inbox.
    pub(super) fn post(&self, add: impl FnOnce(&mut Inbox)) {
        // Every message is whole when the lock is given back.
        add(&mut self.inbox.lock().unwrap_or_else(PoisonError::into_inner));
        self.arrived.notify_one();
    }

    /// Adds what was heard of files.
    pub(super) fn hear(&self, heard: Heard) {
        self.post(|inbox| match heard {
            Heard::All => inbox.all = true,
            Heard::Paths(paths) => inbox.paths.extend(paths),
        });
    }

    /// Waits for messages, but not beyond `end`, and takes them.
    pub(super) fn take(&self, end: Instant) -> Inbox {
        let inbox = self.inbox.lock().unwrap_or_else(PoisonError::into_inner);
        let left = end.saturating_duration_since(Instant::now());
        let waited = self
            .arrived
            .wait_timeout_while(inbox, left, |inbox| inbox.is_empty());
        let (mut inbox, _) = waited.unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut inbox)
    }
}
