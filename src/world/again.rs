//! What is tried again: calls that a signal interrupted, and files that another program holds open.

use std::io;
use std::thread;
use std::time::Duration;

/// How long another program may hold a file open before that is an error: viewers that load a picture
/// anew, virus scanners and indexers let go within this time.
const LONGEST: Duration = Duration::from_millis(2500);

/// The first pause; each is twice the one before, up to the longest.
const SHORTEST_PAUSE: Duration = Duration::from_millis(5);
const LONGEST_PAUSE: Duration = Duration::from_millis(100);

/// Waits for others, up to a limit.
pub(super) struct Patience {
    waited: Duration,
    pause: Duration,
    is_held: fn(&io::Error) -> bool,
    sleep: fn(Duration),
}

impl Default for Patience {
    fn default() -> Patience {
        Patience {
            waited: Duration::ZERO,
            pause: SHORTEST_PAUSE,
            is_held,
            sleep: thread::sleep,
        }
    }
}

impl Patience {
    /// Whether to try again after `error`; waits first where another program has to let go.
    pub(super) fn again(&mut self, error: &io::Error) -> bool {
        if error.kind() == io::ErrorKind::Interrupted {
            return true;
        }
        if !(self.is_held)(error) || self.waited >= LONGEST {
            return false;
        }
        let pause = self.pause.min(LONGEST - self.waited);
        (self.sleep)(pause);
        self.waited += pause;
        self.pause = LONGEST_PAUSE.min(self.pause * 2);
        true
    }

    /// Acts until it is done or there is no use in waiting.
    pub(super) fn retry<T>(mut self, mut act: impl FnMut() -> io::Result<T>) -> io::Result<T> {
        loop {
            match act() {
                Err(error) if self.again(&error) => {}
                result => return result,
            }
        }
    }
}

/// Acts again as long as signals interrupt.
pub(super) fn uninterrupted<T>(mut act: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    loop {
        match act() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            result => return result,
        }
    }
}

/// Whether the error says that another program holds the file open, which only Windows minds: access
/// denied, sharing violation, lock violation.
fn is_held(error: &io::Error) -> bool {
    cfg!(windows) && matches!(error.raw_os_error(), Some(5 | 32 | 33))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    thread_local! {
        static SLEPT: Cell<Duration> = const { Cell::new(Duration::ZERO) };
    }

    /// Patience with files held open, on a clock of its own.
    fn patience() -> Patience {
        SLEPT.set(Duration::ZERO);
        Patience {
            is_held: |error| error.raw_os_error() == Some(32),
            sleep: |pause| SLEPT.set(SLEPT.get() + pause),
            ..Patience::default()
        }
    }

    fn held() -> io::Error {
        io::Error::from_raw_os_error(32)
    }

    #[test]
    fn a_file_that_is_let_go_in_time_is_replaced() {
        let result = patience().retry(|| match SLEPT.get().as_millis() {
            ..2000 => Err(held()),
            _ => Ok("replaced"),
        });
        assert_eq!(result.unwrap(), "replaced");
        assert!(SLEPT.get() < LONGEST);
    }

    #[test]
    fn a_file_that_is_never_let_go_is_an_error_after_two_and_a_half_seconds() {
        let error = patience().retry(|| Err::<(), _>(held())).unwrap_err();
        assert_eq!(error.raw_os_error(), Some(32));
        assert_eq!(SLEPT.get(), LONGEST);
    }

    #[test]
    fn other_errors_are_said_at_once_and_interruptions_never() {
        let mut left = 100;
        let result = patience().retry(|| {
            left -= 1;
            match left {
                0 => Err::<(), _>(io::ErrorKind::StorageFull.into()),
                _ => Err(io::ErrorKind::Interrupted.into()),
            }
        });
        assert_eq!(result.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!((left, SLEPT.get()), (0, Duration::ZERO));
    }

    #[test]
    fn only_windows_holds_files() {
        for code in [5, 32, 33] {
            let error = io::Error::from_raw_os_error(code);
            assert_eq!(is_held(&error), cfg!(windows), "{error}");
        }
        assert!(!is_held(&io::Error::from_raw_os_error(2)));
    }
}
