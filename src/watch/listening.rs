//! How changes are found: notices say where to look, and looks at all stamps find what no notice told of.

use super::mailbox::{Inbox, Mailbox};
use crate::world::{Notices, NoticesError, World};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time between two looks at the stamps of all files, in case notices do not come.
const LOOK: Duration = Duration::from_secs(1);

/// The same where it is known that they do not come.
pub(super) const POLL: Duration = Duration::from_millis(250);

/// Listens for notices as long as they come.
pub(super) struct Listening {
    notices: Option<Box<dyn Notices>>,
    /// What the notices follow.
    followed: BTreeSet<PathBuf>,
    /// Time between two looks.
    interval: Duration,
    next_look: Instant,
    /// A change that was found without a notice of it.
    unannounced: Option<PathBuf>,
}

impl Listening {
    /// Looks this often, or waits for notices.
    pub(super) fn new(poll: Option<Duration>) -> Listening {
        Listening {
            notices: None,
            followed: BTreeSet::new(),
            interval: poll.unwrap_or(LOOK),
            next_look: Instant::now(),
            unannounced: None,
        }
    }

    /// Asks for notices.
    ///
    /// # Errors
    /// Why there are none.
    pub(super) fn start(
        &mut self,
        world: &dyn World,
        mailbox: &Arc<Mailbox>,
    ) -> Result<(), NoticesError> {
        let mailbox = Arc::clone(mailbox);
        self.notices = Some(world.notices(Arc::new(move |heard| mailbox.hear(heard)))?);
        Ok(())
    }

    /// Waits for notices no more, and looks more often.
    pub(super) fn poll(&mut self) {
        self.notices = None;
        self.interval = POLL;
        self.next_look = Instant::now() + POLL;
    }

    /// When the next look is due.
    pub(super) fn looks_at(&self) -> Instant {
        self.next_look
    }

    /// Has the notices follow `paths`, and adds to the inbox where something may have been missed.
    ///
    /// # Errors
    /// Why that is not possible; notices come no more then.
    pub(super) fn follow(
        &mut self,
        paths: BTreeSet<PathBuf>,
        inbox: &mut Inbox,
    ) -> Result<(), NoticesError> {
        let Some(notices) = &mut self.notices else {
            return Ok(());
        };
        if paths == self.followed && !inbox.heard() {
            return Ok(());
        }
        inbox.all |= notices.follow(&paths)?;
        let new = paths.difference(&self.followed).cloned();
        inbox.paths.extend(new);
        self.followed = paths;
        Ok(())
    }

    /// Begins a look at everything: follows `paths` anew even if nothing was heard, since a folder may have
    /// gone without notice. Says whether something may have been missed.
    ///
    /// # Errors
    /// As [`Listening::follow`].
    pub(super) fn begin_look(&mut self, paths: BTreeSet<PathBuf>) -> Result<bool, NoticesError> {
        self.next_look = Instant::now() + self.interval;
        self.followed.clear();
        let mut inbox = Inbox::default();
        self.follow(paths, &mut inbox)?;
        Ok(inbox.all)
    }

    /// Takes note that something was heard.
    pub(super) fn hear(&mut self, inbox: &Inbox) {
        self.unannounced
            .take_if(|path| inbox.all || inbox.paths.contains(path));
    }

    /// Takes note of what a look has found.
    ///
    /// # Errors
    /// If no notice has come of what the look before had found.
    pub(super) fn end_look(&mut self, found: Option<PathBuf>) -> Result<(), NoticesError> {
        if self.notices.is_none() {
            return Ok(());
        }
        if let Some(path) = std::mem::replace(&mut self.unannounced, found) {
            let reason = format!("that of `{}` did not come", path.display());
            return Err(NoticesError::new(reason));
        }
        Ok(())
    }
}
