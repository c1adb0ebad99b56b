//! The state of a file without its contents.

use std::fs::Metadata;
use std::time::SystemTime;

/// What the system says of a file; another one after almost every change, but only contents decide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stamp {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Device, number of the file on it, and time of the last change to either contents or mode in seconds
    /// and nanoseconds, where the system has them. Nobody can set that time back.
    identity: [i128; 4],
}

impl Stamp {
    /// Of a file with these metadata.
    pub(super) fn of(metadata: &Metadata) -> Stamp {
        Stamp {
            bytes: metadata.len(),
            modified: metadata.modified().ok(),
            identity: identity(metadata),
        }
    }

    /// Whether the file was last changed before `time`, as far as the system knows.
    pub fn is_older_than(&self, time: SystemTime) -> bool {
        let [.., seconds, nanoseconds] = self.identity;
        let since_epoch = |time: SystemTime| match time.duration_since(SystemTime::UNIX_EPOCH) {
            Ok(after) => after.as_nanos() as i128,
            Err(before) => -(before.duration().as_nanos() as i128),
        };
        let changed = seconds * 1_000_000_000 + nanoseconds;
        let modified = self.modified.map_or(i128::MAX, since_epoch);
        changed.max(modified) < since_epoch(time)
    }
}

#[cfg(unix)]
fn identity(metadata: &Metadata) -> [i128; 4] {
    use std::os::unix::fs::MetadataExt;
    [
        metadata.dev().into(),
        metadata.ino().into(),
        metadata.ctime().into(),
        metadata.ctime_nsec().into(),
    ]
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> [i128; 4] {
    [0; 4]
}
