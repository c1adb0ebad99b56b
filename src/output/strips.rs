//! Strips of rows, worked on by all threads and handed on in order.

use crate::cancel::Cancel;
use rayon::prelude::*;
use std::io;

/// Most bytes of a strip unless a row is longer: half of a core's nearest but one cache, filtered rows too.
const STRIP_BYTES: usize = 1 << 17;

/// Strips that are worked on at once, for each thread.
const STRIPS_PER_THREAD: usize = 4;

/// How an image is divided into strips: this depends on its size and on nothing else.
#[derive(Clone, Copy, Debug)]
pub(super) struct Division {
    pub(super) row_bytes: usize,
    /// Rows of the image.
    pub(super) height: usize,
    /// Rows of every strip but the last, which may have fewer.
    pub(super) rows: usize,
    /// How many strips there are.
    pub(super) count: usize,
}

impl Division {
    /// Strips of about [`STRIP_BYTES`] for `height` rows of `row_bytes`.
    pub(super) fn new(row_bytes: usize, height: usize) -> Division {
        Division::of_rows(
            (STRIP_BYTES / row_bytes).clamp(1, height),
            row_bytes,
            height,
        )
    }

    /// Strips of `rows` rows.
    pub(super) fn of_rows(rows: usize, row_bytes: usize, height: usize) -> Division {
        Division {
            row_bytes,
            height,
            rows,
            count: height.div_ceil(rows),
        }
    }

    fn strip_bytes(self) -> usize {
        self.rows * self.row_bytes
    }
}

/// Some rows of an image.
#[derive(Clone, Copy)]
pub(super) struct Strip<'a> {
    pub(super) index: usize,
    pub(super) rows: &'a [u8],
    /// The row before them; zeros if there is none.
    pub(super) above: &'a [u8],
    pub(super) is_last: bool,
}

/// Gathers rows into strips: holds one strip that is not full yet.
pub(super) struct Strips {
    division: Division,
    missing_bytes: u64,
    next: usize,
    pending: Vec<u8>,
    above: Vec<u8>,
    cancel: Cancel,
}

impl Strips {
    pub(super) fn new(division: Division, cancel: &Cancel) -> Strips {
        Strips {
            division,
            missing_bytes: division.row_bytes as u64 * division.height as u64,
            next: 0,
            pending: vec![],
            above: vec![0; division.row_bytes],
            cancel: cancel.clone(),
        }
    }

    /// Takes whole rows, no more than the image has; `work` is done for each full strip and for the last, and
    /// `take` gets what it gives, in order.
    ///
    /// # Errors
    /// The first one of `work` or of `take`, and if the run is cancelled.
    pub(super) fn push<T: Send>(
        &mut self,
        rows: &[u8],
        work: impl Fn(Strip<'_>) -> io::Result<T> + Sync,
        take: impl FnMut(T) -> io::Result<()>,
    ) -> io::Result<()> {
        let strip_bytes = self.division.strip_bytes();
        self.missing_bytes -= rows.len() as u64;
        let ends = self.missing_bytes == 0;
        let begun = match self.pending.len() {
            0 => 0,
            pending => rows.len().min(strip_bytes - pending),
        };
        let (begun, rows) = rows.split_at(begun);
        self.pending.extend_from_slice(begun);
        let one = if ends || self.pending.len() == strip_bytes {
            std::mem::take(&mut self.pending)
        } else {
            vec![]
        };
        let rest = if ends { 0 } else { rows.len() % strip_bytes };
        let (whole, rest) = rows.split_at(rows.len() - rest);
        self.work_all(&one, whole, work, take)?;
        self.pending.extend_from_slice(rest);
        Ok(())
    }

    /// Works on one strip, if there is one, and on those that lie in `others` one after the other.
    fn work_all<T: Send>(
        &mut self,
        one: &[u8],
        others: &[u8],
        work: impl Fn(Strip<'_>) -> io::Result<T> + Sync,
        mut take: impl FnMut(T) -> io::Result<()>,
    ) -> io::Result<()> {
        let pieces = [one].into_iter().filter(|one| !one.is_empty());
        let pieces: Vec<&[u8]> = pieces
            .chain(others.chunks(self.division.strip_bytes()))
            .collect();
        let Some(last) = pieces.last() else {
            return Ok(());
        };
        let above = self.above.clone();
        let last_row = |rows: &[u8]| rows.len() - self.division.row_bytes;
        self.above.copy_from_slice(&last[last_row(last)..]);
        let strip = |place: usize| Strip {
            index: self.next + place,
            rows: pieces[place],
            above: match place.checked_sub(1) {
                Some(before) => &pieces[before][last_row(pieces[before])..],
                None => &above,
            },
            is_last: self.next + place + 1 == self.division.count,
        };
        let places: Vec<usize> = (0..pieces.len()).collect();
        for wave in places.chunks(STRIPS_PER_THREAD * rayon::current_num_threads()) {
            let work = |place: &usize| {
                self.cancel.check()?;
                work(strip(*place))
            };
            let done: Vec<io::Result<T>> = wave.par_iter().map(work).collect();
            done.into_iter().try_for_each(|result| take(result?))?;
        }
        self.next += pieces.len();
        Ok(())
    }
}
