//! Programs that are killed, and readers that look meanwhile: nobody ever sees a torn file.
//!
//! The short tests kill a few dozen times. 2,000 kills of renders, 500 of watches, 500 signals and 100,000
//! replaced maps:
//! `cargo test --release --test kill -- --ignored --nocapture`.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "../support/signals.rs"]
mod heard;
mod place;
mod readers;
mod renders;
mod signals;
mod watches;

/// A number from the environment, or the usual one.
fn number(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().unwrap())
}

/// Random numbers by a linear congruence (Knuth's MMIX).
struct Dice(u64);

impl Dice {
    /// From 0 up to `sides`, which it never is.
    fn throw(&mut self, sides: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % sides
    }
}
