//! What two threads can gain at a moment: a loop that shares nothing.

use std::hint::black_box;
use std::time::Instant;

/// Multiplications and additions that stay in registers, as many on each of some threads.
pub(crate) fn control(threads: usize) {
    let work = || {
        let mut sums = [1.0f32; 64];
        for _ in 0..4_000_000 {
            for sum in &mut sums {
                *sum = *sum * 0.999 + 0.001;
            }
            black_box(&mut sums);
        }
    };
    std::thread::scope(|scope| {
        (1..threads).for_each(|_| {
            scope.spawn(work);
        });
        work();
    });
}

/// Seconds that `work` takes.
pub(crate) fn wall(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}
