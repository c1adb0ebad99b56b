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

    /// Whether any later change gives another stamp: this one is old enough, for clocks of file systems tick
    /// slowly. `now` is the time when it was taken.
    pub fn is_settled(&self, now: SystemTime) -> bool {
        let now = since_epoch(now);
        let modified = self.modified.map(since_epoch);
        let is_old = |time: i128| time + tick(time) < now;
        match self.changed() {
            // A program may have set the other time into the future, and every change sets this one.
            Some(changed) => is_old(changed) && modified.is_none_or(|it| it > now || is_old(it)),
            None => modified.is_some_and(is_old),
        }
    }

    /// The time of the last change, in nanoseconds, where the system has it.
    fn changed(&self) -> Option<i128> {
        let [.., seconds, nanoseconds] = self.identity;
        cfg!(unix).then_some(seconds * 1_000_000_000 + nanoseconds)
    }
}

/// For how many nanoseconds a clock that tells this time may go on telling it.
fn tick(time: i128) -> i128 {
    match time % 1_000_000_000 {
        // File systems that count seconds, or pairs of them.
        0 => 2_000_000_000,
        _ => 100_000_000,
    }
}

fn since_epoch(time: SystemTime) -> i128 {
    match time.duration_since(SystemTime::UNIX_EPOCH) {
        Ok(after) => after.as_nanos() as i128,
        Err(before) => -(before.duration().as_nanos() as i128),
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// Whether a file counts as unchanged for good that was changed and modified so many milliseconds ago.
    fn is_settled(changed: i64, modified: i64) -> bool {
        let now = SystemTime::UNIX_EPOCH + Duration::from_millis(1_000_000_500);
        let ago = |milliseconds: i64| 1_000_000_500 - milliseconds;
        let stamp = Stamp {
            bytes: 1,
            modified: Some(SystemTime::UNIX_EPOCH + Duration::from_millis(ago(modified) as u64)),
            identity: [
                1,
                1,
                i128::from(ago(changed) / 1000),
                i128::from(ago(changed) % 1000) * 1_000_000,
            ],
        };
        stamp.is_settled(now)
    }

    #[test]
    fn a_stamp_counts_once_its_clock_has_ticked() {
        assert!(is_settled(150, 150) && !is_settled(50, 50));
        // On a whole second the clock may count in pairs of them.
        assert!(!is_settled(500, 500) && !is_settled(1500, 1500));
        assert!(is_settled(2500, 2500));
    }

    #[test]
    fn the_later_of_two_times_counts() {
        assert!(!is_settled(10_150, 50));
        assert_eq!(is_settled(50, 10_150), !cfg!(unix));
    }

    #[cfg(unix)]
    #[test]
    fn a_modification_in_the_future_is_left_to_the_time_of_change() {
        assert!(is_settled(150, -3_600_000) && !is_settled(50, -3_600_000));
    }
}
