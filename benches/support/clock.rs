//! Clocks of the benchmarks.

use std::time::Instant;

/// Seconds that the calling thread is busy with `work`: of its processor where the system tells, which
/// other programs disturb less, else of the wall clock.
pub(crate) fn seconds(work: &mut dyn FnMut()) -> f64 {
    let (start, busy) = (Instant::now(), busy_seconds());
    work();
    match (busy, busy_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => start.elapsed().as_secs_f64(),
    }
}

/// Seconds that the calling thread has run so far.
fn busy_seconds() -> Option<f64> {
    // The system counts up to the last time that it looked at the thread.
    std::thread::yield_now();
    let times = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = times.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// The middle one.
pub(crate) fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}
