//! The signals that a program started by a test hears.

use std::fs;

/// Names and numbers.
const SIGNALS: [(&str, i32); 3] = [("INT", 2), ("TERM", 15), ("HUP", 1)];

/// Signals that ask the program to stop, without those that the tests themselves were started to ignore:
/// programs inherit that, and keep to it.
pub(crate) fn heard() -> Vec<(&'static str, i32)> {
    let ignored = match fs::read_to_string("/proc/self/status") {
        Ok(status) => mask(&status),
        // Only there can the program know whether it is to ignore the end of its terminal.
        Err(_) => 1,
    };
    let is_heard = |(_, number): &(&str, i32)| ignored >> (number - 1) & 1 == 0;
    SIGNALS.into_iter().filter(is_heard).collect()
}

fn mask(status: &str) -> u64 {
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    u64::from_str_radix(line.unwrap().trim(), 16).unwrap()
}
