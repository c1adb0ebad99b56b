//! Notices of changed files: what a watcher hears from the system.

use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// What may have changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Heard {
    /// These paths, in the words of whoever follows them.
    Paths(BTreeSet<PathBuf>),
    /// Anything: notices were lost.
    All,
}

/// Hears of changes, on a thread of the system's choice; has to be quick.
pub type Wake = Arc<dyn Fn(Heard) + Send + Sync>;

/// Why there are no notices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoticesError(String);

impl NoticesError {
    /// For a reason, in words that continue "there are no notices of changes: ".
    pub fn new(reason: impl Into<String>) -> NoticesError {
        NoticesError(reason.into())
    }
}

impl fmt::Display for NoticesError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for NoticesError {}

/// Listens for changes of files.
pub trait Notices: Send {
    /// Listens for changes of these paths and no others: of the files, whether they are there or not, of
    /// every link on the way to them and of every folder that they lie in. Says whether a folder was not
    /// listened to before, so that something may have been missed there.
    ///
    /// # Errors
    /// Why that is not possible.
    fn follow(&mut self, paths: &BTreeSet<PathBuf>) -> Result<bool, NoticesError>;
}
