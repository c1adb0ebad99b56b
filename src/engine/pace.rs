//! How long the rest of a run will take, from what was measured so far.

use std::collections::VecDeque;
use std::time::Duration;

/// Most measurements that are looked back on.
const LOOKED_BACK: usize = 100;
/// Fewest measurements that an estimate rests on.
const FEWEST: usize = 4;
/// Shortest time that an estimate rests on.
const SHORTEST: Duration = Duration::from_secs(1);

/// Measures how fast something gets done, and says how long the rest of it takes at that pace.
///
/// Only the latest 100 measurements count, so that a pause or a cheaper part is soon forgotten. Nothing
/// is said before they span a second.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    measured: VecDeque<(Duration, f64)>,
}

impl Pace {
    /// Takes in that `fraction` (0 to 1) is done at the time `now`; neither may go back.
    pub fn measure(&mut self, now: Duration, fraction: f64) {
        if self.measured.len() == LOOKED_BACK {
            self.measured.pop_front();
        }
        self.measured.push_back((now, fraction));
    }

    /// Seconds that the rest takes; `None` as long as that would be a guess.
    pub fn seconds_left(&self) -> Option<f64> {
        let ((first, before), (last, done)) = (self.measured.front()?, self.measured.back()?);
        if *done >= 1.0 {
            return Some(0.0);
        }
        let time = last.checked_sub(*first)?;
        let is_known = self.measured.len() >= FEWEST && time >= SHORTEST && done > before;
        is_known.then(|| (1.0 - done) * time.as_secs_f64() / (done - before))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(seconds: f64) -> Duration {
        Duration::from_secs_f64(seconds)
    }

    #[test]
    fn an_even_pace_is_told_exactly_and_not_too_early() {
        let mut pace = Pace::default();
        assert_eq!(pace.seconds_left(), None);
        // A tenth every half second: five seconds in all.
        for (step, expected) in [
            (0, None),
            (1, None),
            (2, None),
            (3, Some(3.5)),
            (9, Some(0.5)),
        ] {
            pace.measure(seconds(0.5 * f64::from(step)), 0.1 * f64::from(step));
            let left = pace.seconds_left();
            assert_eq!(left.is_some(), expected.is_some(), "step {step}");
            assert!((left.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-9);
        }
        pace.measure(seconds(5.0), 1.0);
        assert_eq!(pace.seconds_left(), Some(0.0));
    }

    #[test]
    fn many_measurements_in_no_time_say_nothing() {
        let mut pace = Pace::default();
        for step in 0..50 {
            pace.measure(seconds(0.01 * f64::from(step)), 0.01 * f64::from(step));
        }
        assert_eq!(pace.seconds_left(), None);
    }

    #[test]
    fn nothing_done_is_no_pace() {
        let mut pace = Pace::default();
        (0..9).for_each(|step| pace.measure(seconds(f64::from(step)), 0.3));
        assert_eq!(pace.seconds_left(), None);
    }

    #[test]
    fn an_old_pace_is_forgotten() {
        let mut pace = Pace::default();
        // A slow start, then a tenth of a percent every tenth of a second.
        pace.measure(seconds(0.0), 0.0);
        let now = |step: u32| seconds(1000.0 + 0.1 * f64::from(step));
        (0..100).for_each(|step| pace.measure(now(step), 0.5 + 0.001 * f64::from(step)));
        let left = pace.seconds_left().unwrap();
        assert!((left - 40.1).abs() < 1e-6, "{left}");
    }
}
