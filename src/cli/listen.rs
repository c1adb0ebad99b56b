//! What is heard during a run: a bar on a terminal, warnings, or events as JSON.

use super::report;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use yosegi::engine::{Event, Listener, Spot};

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Hears the events of a run.
pub(super) struct Listen {
    json: bool,
    bar: ProgressBar,
    placed: Mutex<Vec<PathBuf>>,
    /// Maps that were as they should be, and maps that were put in place.
    maps: [AtomicUsize; 2],
}

impl Listen {
    /// A bar if stderr is a terminal; with `json` events on stdout instead.
    pub(super) fn new(json: bool) -> Listen {
        // Draws nothing where stderr is no terminal.
        let target = if json {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        let style = ProgressStyle::with_template("{prefix:16!} {bar:30} {percent:>3} %  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Listen {
            json,
            bar,
            placed: Mutex::default(),
            maps: Default::default(),
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// The files of the maps that are in place, for a run that fails after some of them.
    pub(super) fn placed(&self) -> Vec<PathBuf> {
        let placed = self.placed.lock();
        placed.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether there were maps, and all of them were there already.
    pub(super) fn was_up_to_date(&self) -> bool {
        let [there, put] = [0, 1].map(|index| self.maps[index].load(Ordering::Relaxed));
        there > 0 && put == 0
    }

    fn count(&self, event: &Event) {
        let index = match event {
            Event::MapUpToDate { .. } => 0,
            Event::MapWritten { .. } | Event::MapRestored { .. } => 1,
            _ => return,
        };
        self.maps[index].fetch_add(1, Ordering::Relaxed);
    }

    fn warn(&self, text: &str) {
        self.bar
            .suspend(|| report::note(&format!("warning: {text}")));
    }

    fn warn_of_faults(&self, faults: &Faults<'_>) {
        let (path, channel) = (faults.path.display(), faults.channel);
        if faults.not_finite > 0 {
            let first = faults.first.map_or(String::new(), |spot| {
                let ([x, y], [u, v]) = (spot.pixel, spot.place);
                format!(", the first at pixel ({x}, {y}) from the upper left, ({u:.3}, {v:.3}) mm from the lower left")
            });
            let samples = samples(faults.not_finite, ["is", "are"]);
            self.warn(&format!(
                "{path}: {samples} not finite in the channel `{channel}`{first}; look for a division by 0 in what is \
                 linked to it"
            ));
        }
        if faults.clamped > 0 {
            let samples = samples(faults.clamped, ["was", "were"]);
            self.warn(&format!(
                "{path}: {samples} clamped; widen the range of `{channel}`, or write EXR"
            ));
        }
    }

    fn tell(&self, event: &Event) {
        match event {
            Event::Progress {
                output, fraction, ..
            } => {
                self.bar.set_prefix(output.clone());
                self.bar.set_message(progress(event));
                self.bar.set_position((fraction * STEPS as f64) as u64);
            }
            Event::StructureProgress { node, fraction } => {
                self.bar.set_prefix(node.clone());
                self.bar.set_message(format!("{:.0} %", 100.0 * fraction));
            }
            Event::MapStale { output, path, .. } => self.warn(&format!(
                "{} is from an earlier run: `{output}` no longer writes it",
                path.display()
            )),
            Event::Warning {
                node,
                file,
                line,
                column,
                message,
            } => {
                let file = file.display();
                self.warn(&format!("{file}:{line}:{column}: node `{node}`: {message}"));
            }
            Event::CacheVerified { compared } => self.bar.suspend(|| {
                report::note(&format!(
                    "{compared} results were computed again and compared"
                ));
            }),
            Event::StoreFailed { reason } => self.warn(&format!(
                "the store of earlier results cannot be used: {reason}"
            )),
            _ => faults(event).iter().for_each(|faults| {
                let placed = self.placed.lock();
                let mut placed = placed.unwrap_or_else(PoisonError::into_inner);
                placed.push(faults.path.to_owned());
                self.warn_of_faults(faults);
            }),
        }
    }
}

/// So many samples, with the verb that fits the number.
fn samples(count: u64, [one, many]: [&str; 2]) -> String {
    match count {
        1 => format!("1 sample {one}"),
        _ => format!("{count} samples {many}"),
    }
}

/// What is wrong with the samples of a map.
struct Faults<'a> {
    channel: &'a str,
    path: &'a Path,
    not_finite: u64,
    first: Option<Spot>,
    clamped: u64,
}

/// The faults of a map that is in its place; one that was there already has those it was written with.
fn faults(event: &Event) -> Option<Faults<'_>> {
    match event {
        Event::MapWritten {
            channel,
            path,
            not_finite,
            first_not_finite,
            clamped,
            ..
        }
        | Event::MapUpToDate {
            channel,
            path,
            not_finite,
            first_not_finite,
            clamped,
            ..
        }
        | Event::MapRestored {
            channel,
            path,
            not_finite,
            first_not_finite,
            clamped,
            ..
        } => Some(Faults {
            channel,
            path,
            not_finite: *not_finite,
            first: *first_not_finite,
            clamped: *clamped,
        }),
        _ => None,
    }
}

impl Listener for Listen {
    fn hear(&self, event: Event) {
        self.count(&event);
        if !self.json {
            self.tell(&event);
        } else if let Ok(text) = serde_json::to_string(&event) {
            // Events are not the result: whoever stops listening does not stop the run.
            report::line(&text);
        }
    }
}

/// What stands behind the bar: `12 of 40 tiles, 1 of 3 maps, 20 s left`.
fn progress(event: &Event) -> String {
    let Event::Progress {
        done,
        total,
        maps_done,
        maps_total,
        seconds_left,
        ..
    } = event
    else {
        return String::new();
    };
    let left = seconds_left.map(|seconds| format!(", {} left", duration(seconds)));
    format!(
        "{done} of {total} tiles, {maps_done} of {maps_total} maps{}",
        left.unwrap_or_default()
    )
}

/// A time as exactly as an estimate deserves: `20 s`, `5 min`, `2 h 10 min`.
fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).ceil() as u64;
    match seconds {
        ..60.0 => format!("{} s", seconds.ceil() as u64),
        ..3600.0 => format!("{minutes} min"),
        _ => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_is_in_words_that_fit_it() {
        let cases = [
            (0.0, "0 s"),
            (0.2, "1 s"),
            (59.5, "60 s"),
            (61.0, "2 min"),
            (3599.0, "60 min"),
            (7800.0, "2 h 10 min"),
        ];
        for (seconds, expected) in cases {
            assert_eq!(duration(seconds), expected);
        }
    }

    #[test]
    fn the_bar_says_tiles_maps_and_time_only_when_that_is_known() {
        let event = |seconds_left| Event::Progress {
            output: "board".to_owned(),
            done: 12,
            total: 40,
            maps_done: 1,
            maps_total: 3,
            fraction: 0.3,
            seconds_left,
        };
        assert_eq!(progress(&event(None)), "12 of 40 tiles, 1 of 3 maps");
        assert_eq!(
            progress(&event(Some(19.2))),
            "12 of 40 tiles, 1 of 3 maps, 20 s left"
        );
    }
}
