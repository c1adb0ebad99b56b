//! Signals that ask the program to stop: the first ends the run, the second the program.

use super::{Exit, report};
use arrivals::Arrivals;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use yosegi::world::abandon_unfinished;

/// How long a run may take to stop by itself: it may be in the midst of what cannot be stopped, such as
/// decoding a photograph.
const GRACE: Duration = Duration::from_millis(400);

/// How often the second signal is looked for.
const PAUSE: Duration = Duration::from_millis(5);

/// Which signal has arrived.
pub(super) struct Signals {
    /// The exit code that follows; 0 if none has arrived.
    exit: Arc<AtomicU8>,
}

impl Signals {
    /// The exit code that follows from the first signal that has arrived: interrupted (130), terminated
    /// (143), or the terminal has gone (129).
    pub(super) fn exit(&self) -> Option<Exit> {
        let arrived = self.exit.load(Ordering::Relaxed);
        arrivals::EXITS
            .into_iter()
            .map(|(_, exit)| exit)
            .find(|exit| *exit as u8 == arrived)
    }
}

/// From now on the first signal calls `stop`. After a second one, or if the run does not stop soon, the
/// program ends at once; whatever it has begun to write is gone then, and no file is torn.
///
/// Signals that the caller has the program ignore, as `nohup` does, stay ignored.
pub(super) fn listen(stop: impl FnOnce() + Send + 'static) -> Signals {
    let exit = Arc::new(AtomicU8::new(0));
    let first = Arc::clone(&exit);
    let started = Arrivals::new().and_then(|arrivals| {
        let thread = thread::Builder::new().name("signals".to_owned());
        thread.spawn(move || follow(arrivals, &first, stop))
    });
    if let Err(error) = started {
        report::problem(&format!("signals will end the program at once: {error}"));
    }
    Signals { exit }
}

fn follow(mut arrivals: Arrivals, first: &AtomicU8, stop: impl FnOnce() + Send + 'static) {
    let exit = arrivals.wait();
    first.store(exit as u8, Ordering::Relaxed);
    let end = Instant::now() + GRACE;
    // A run that puts a file in place has to be waited for, but not by whoever hears the second signal.
    // Without a thread for it the program ends all the same.
    let _ = thread::Builder::new().spawn(stop);
    while Instant::now() < end && !arrivals.is_another() {
        thread::sleep(PAUSE);
    }
    abandon_unfinished();
    signal_hook::low_level::exit(exit as i32);
}

#[cfg(unix)]
mod arrivals {
    //! Signals as they come, from a pipe that their handler writes to.

    use super::Exit;
    use signal_hook::consts::signal::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::{fs, io};

    pub(super) const EXITS: [(i32, Exit); 3] = [
        (SIGHUP, Exit::HungUp),
        (SIGINT, Exit::Interrupted),
        (SIGTERM, Exit::Terminated),
    ];

    pub(super) struct Arrivals(Signals);

    impl Arrivals {
        pub(super) fn new() -> io::Result<Arrivals> {
            let heard = EXITS.iter().map(|(signal, _)| *signal);
            Signals::new(heard.filter(|signal| !is_ignored(*signal))).map(Arrivals)
        }

        /// Waits for a signal; gives the exit code that follows.
        pub(super) fn wait(&mut self) -> Exit {
            let signal = self.0.forever().next();
            let exit = EXITS.into_iter().find(|(known, _)| Some(*known) == signal);
            exit.map_or(Exit::Interrupted, |(_, exit)| exit)
        }

        /// Whether one has arrived since.
        pub(super) fn is_another(&mut self) -> bool {
            self.0.pending().next().is_some()
        }
    }

    /// Whether whoever called the program has it ignore the signal.
    fn is_ignored(signal: i32) -> bool {
        match fs::read_to_string("/proc/self/status") {
            Ok(status) => in_mask(&status, signal),
            // Not said by other systems than Linux: there `nohup` counts for more than an orderly end.
            Err(_) => signal == SIGHUP,
        }
    }

    fn in_mask(status: &str, signal: i32) -> bool {
        let mask = status
            .lines()
            .find_map(|line| line.strip_prefix("SigIgn:"))
            .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
    }

    #[test]
    fn ignored_signals_are_read_from_the_mask() {
        let status = "Name:\tyosegi\nSigBlk:\t00000000ffffffff\nSigIgn:\t0000000000001001\n";
        let ignored = [SIGHUP, SIGINT, 13, SIGTERM].map(|signal| in_mask(status, signal));
        assert_eq!(ignored, [true, false, true, false]);
        assert!(!in_mask("", SIGHUP));
    }
}

#[cfg(not(unix))]
mod arrivals {
    //! Signals as they come, looked for in a cell that their handler writes to.

    use super::{Exit, PAUSE};
    use signal_hook::consts::signal::{SIGINT, SIGTERM};
    use signal_hook::flag;
    use std::io;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    pub(super) const EXITS: [(i32, Exit); 2] =
        [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated)];

    /// The exit code of the signal that has arrived last; 0 once it was seen.
    pub(super) struct Arrivals(Arc<AtomicUsize>);

    impl Arrivals {
        pub(super) fn new() -> io::Result<Arrivals> {
            let arrived = Arc::new(AtomicUsize::new(0));
            for (signal, exit) in EXITS {
                flag::register_usize(signal, Arc::clone(&arrived), exit as usize)?;
            }
            Ok(Arrivals(arrived))
        }

        /// Waits for a signal; gives the exit code that follows.
        pub(super) fn wait(&mut self) -> Exit {
            loop {
                let arrived = self.0.swap(0, Ordering::Relaxed);
                let exits = EXITS.into_iter().map(|(_, exit)| exit);
                if let Some(exit) = exits.into_iter().find(|exit| *exit as usize == arrived) {
                    return exit;
                }
                std::thread::sleep(PAUSE);
            }
        }

        /// Whether one has arrived since.
        pub(super) fn is_another(&mut self) -> bool {
            self.0.swap(0, Ordering::Relaxed) != 0
        }
    }
}
