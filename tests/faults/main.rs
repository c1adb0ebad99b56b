//! Faults of the disk: every operation of a run fails once, and the run ends as it is promised to.
//!
//! The short tests fail every operation with one error in turn. All of them with every error:
//! `cargo test --release --test faults -- --ignored --nocapture`.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod calls;
mod full;
mod place;
mod power;
mod trace;
mod world;

use place::{CASES, Place};

/// Number and name of an error of the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Errno(i32, &'static str);

const FULL: Errno = Errno(28, "ENOSPC");
const BROKEN: Errno = Errno(5, "EIO");
const FORBIDDEN: Errno = Errno(13, "EACCES");
const TOO_MANY: Errno = Errno(24, "EMFILE");
const INTERRUPTED: Errno = Errno(4, "EINTR");

const ERRORS: [Errno; 5] = [FULL, BROKEN, FORBIDDEN, TOO_MANY, INTERRUPTED];

impl Errno {
    fn error(self) -> std::io::Error {
        std::io::Error::from_raw_os_error(self.0)
    }

    /// What the system says about it.
    fn reason(self) -> String {
        let text = self.error().to_string();
        text.split(" (os error").next().unwrap().to_owned()
    }
}
