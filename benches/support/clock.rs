//! Clocks of the benchmarks.

use std::time::Instant;

/// Seconds of processor that `work` takes, over all threads that are there before and after it, where the
/// system tells: other programs disturb them less than the wall clock, which is taken elsewhere.
pub(crate) fn seconds(work: &mut dyn FnMut()) -> f64 {
    let (start, busy) = (Instant::now(), busy_seconds());
    work();
    match (busy, busy_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => start.elapsed().as_secs_f64(),
    }
}

/// Seconds that the threads have run so far.
fn busy_seconds() -> Option<f64> {
    // The system counts up to the last time that it looked at a thread.
    std::thread::yield_now();
    let mut nanoseconds = 0.0;
    for thread in std::fs::read_dir("/proc/self/task").ok()? {
        let times = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += times.split_whitespace().next()?.parse::<f64>().ok()?;
    }
    Some(nanoseconds * 1e-9)
}

/// The middle one.
pub(crate) fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}
