//! Progress of a run: what is done, and when that is worth an event.

use super::event::{Event, Listener};
use super::pace::Pace;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between two events of progress, at least.
const QUIET: Duration = Duration::from_millis(100);

/// Says when there has been nothing to hear for a while, from any thread.
pub(super) struct Quiet(Mutex<Instant>);

impl Default for Quiet {
    fn default() -> Quiet {
        Quiet(Mutex::new(Instant::now()))
    }
}

impl Quiet {
    /// Whether the last time it was, or the start, is long enough ago.
    pub(super) fn is_over(&self) -> bool {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_over = last.elapsed() >= QUIET;
        if is_over {
            *last = Instant::now();
        }
        is_over
    }
}

/// Counts tiles and maps of a run, from any thread.
pub(super) struct Meter<'a> {
    listener: &'a dyn Listener,
    start: Instant,
    count: Mutex<Count>,
}

/// What a run has to do and has done; work is pixels times maps.
#[derive(Debug, Default)]
pub(super) struct Count {
    work: f64,
    /// Of the outputs that are finished.
    work_done: f64,
    maps: usize,
    maps_done: usize,
    output: String,
    tiles: usize,
    tiles_done: usize,
    work_of_output: f64,
    /// Time of all threads in tiles of the output.
    computing: Duration,
    heard: Option<Duration>,
    pace: Pace,
}

impl<'a> Meter<'a> {
    pub(super) fn new(listener: &'a dyn Listener) -> Meter<'a> {
        Meter {
            listener,
            start: Instant::now(),
            count: Mutex::default(),
        }
    }

    /// Changes what there is to do.
    pub(super) fn count(&self) -> MutexGuard<'_, Count> {
        self.count.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a tile that took a thread this long.
    pub(super) fn tile(&self, took: Duration) {
        let event = {
            let mut count = self.count();
            count.computing += took;
            count.tile(self.start.elapsed())
        };
        // Told outside the lock: a listener may take its time, or render something itself.
        event
            .into_iter()
            .for_each(|event| self.listener.hear(event));
    }

    /// Tells that the tiles of an output are done, however short ago something was told.
    pub(super) fn tiles_done(&self) {
        let event = self.count().event(self.start.elapsed());
        self.listener.hear(event);
    }
}

impl Count {
    /// Expects `maps` maps, of which `painted` have to be painted, each of `pixels` pixels.
    pub(super) fn expect(&mut self, maps: usize, painted: usize, pixels: [u32; 2]) {
        self.maps += maps;
        self.work += work(painted, pixels);
    }

    /// Begins to paint `painted` maps; `found` others need not be painted after all.
    pub(super) fn begin(&mut self, output: &str, [painted, found]: [usize; 2], pixels: [u32; 2]) {
        self.work -= work(found, pixels);
        self.work_done += self.work_of_output;
        self.work_of_output = work(painted, pixels);
        self.computing = Duration::ZERO;
        output.clone_into(&mut self.output);
        self.divide(1);
    }

    /// Divides what is painted into tiles.
    pub(super) fn divide(&mut self, tiles: usize) {
        (self.tiles, self.tiles_done) = (tiles, 0);
    }

    /// Time of all threads in the tiles of the output that was begun last.
    pub(super) fn computing(&self) -> Duration {
        self.computing
    }

    /// Counts maps that are in their places.
    pub(super) fn finish(&mut self, maps: usize) {
        self.maps_done += maps;
    }

    /// Counts a tile; gives an event if the last one is long enough ago and this tile not the last.
    fn tile(&mut self, now: Duration) -> Option<Event> {
        self.tiles_done += 1;
        let is_due = self.heard.is_none_or(|heard| now >= heard + QUIET);
        (is_due && self.tiles_done < self.tiles).then(|| self.event(now))
    }

    fn event(&mut self, now: Duration) -> Event {
        self.heard = Some(now);
        let share = self.tiles_done as f64 / self.tiles as f64;
        let fraction = (self.work_done + share * self.work_of_output) / self.work;
        self.pace.measure(now, fraction);
        Event::Progress {
            output: self.output.clone(),
            done: self.tiles_done,
            total: self.tiles,
            maps_done: self.maps_done,
            maps_total: self.maps,
            fraction,
            seconds_left: self.pace.seconds_left(),
        }
    }
}

fn work(maps: usize, [width, height]: [u32; 2]) -> f64 {
    maps as f64 * f64::from(width) * f64::from(height)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fraction and seconds left of an event.
    fn told(event: Event) -> (f64, Option<f64>) {
        match event {
            Event::Progress {
                fraction,
                seconds_left,
                ..
            } => (fraction, seconds_left),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn tiles_in_quick_succession_are_told_ten_times_a_second() {
        let mut count = Count::default();
        count.expect(1, 1, [1000, 1000]);
        count.begin("board", [1, 0], [1000, 1000]);
        count.divide(10_000);
        // A tile every millisecond: ten seconds.
        let now = |tile: u64| Duration::from_millis(tile);
        let events: Vec<Event> = (0..10_000)
            .filter_map(|tile| count.tile(now(tile)))
            .collect();
        assert_eq!(events.len(), 100);
        let (fraction, left) = told(events[50].clone());
        assert!((fraction - 0.5001).abs() < 1e-9, "{fraction}");
        assert!((left.unwrap() - 4.999).abs() < 1e-6, "{left:?}");
        assert_eq!(told(count.event(now(10_000))), (1.0, Some(0.0)));
    }

    #[test]
    fn the_fraction_is_that_of_the_run_and_never_falls() {
        let mut count = Count::default();
        count.expect(2, 0, [8, 8]);
        count.expect(3, 3, [10, 10]);
        count.expect(1, 1, [30, 10]);
        count.finish(2);
        // One of the three maps turned out to be there.
        count.begin("a", [2, 1], [10, 10]);
        count.divide(4);
        let mut fractions = vec![];
        for tile in 0..4 {
            count.tile(Duration::from_secs(tile));
            fractions.push(told(count.event(Duration::from_secs(tile))).0);
        }
        count.finish(3);
        count.begin("b", [1, 0], [30, 10]);
        count.tile(Duration::from_secs(5));
        let last = count.event(Duration::from_secs(5));
        assert_eq!(fractions, [0.1, 0.2, 0.3, 0.4]);
        let Event::Progress {
            maps_done,
            maps_total,
            ..
        } = last
        else {
            panic!("{last:?}")
        };
        assert_eq!((maps_done, maps_total, told(last).0), (5, 6, 1.0));
    }
}
