//! What a run reports while it goes on: progress bars, `--json`, tests and `why` read the same events.

use crate::cancel::Cancel;
use crate::diagnostics::Position;
use crate::graph::Node;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;

/// Where something came from that did not have to be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum From {
    /// The memory of this process.
    Memory,
    /// The store on disk.
    Disk,
}

/// A pixel of a map, and what it lies on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spot {
    /// Its column and its row, counted from 0 at the upper left corner of the picture.
    pub pixel: [u32; 2],
    /// The place of its middle in mm, to the right and upwards from the lower left corner of the piece.
    pub place: [f32; 2],
}

/// One thing that happened during a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// A structure was built, or the file of a node was decoded.
    StructureBuilt {
        /// The node.
        node: String,
        /// How long it took.
        milliseconds: f64,
    },
    /// A structure was there already.
    StructureReused {
        /// The node.
        node: String,
        /// Where it was.
        from: From,
    },
    /// How far a structure is that takes its time; at most ten a second.
    StructureProgress {
        /// The node.
        node: String,
        /// How much of it is done, from 0 to 1.
        fraction: f64,
    },
    /// How many tiles of an output a node's kernels computed, and how many the cache gave.
    FieldTiles {
        /// The output.
        output: String,
        /// The node.
        node: String,
        /// Tiles in which a kernel of the node ran.
        computed: usize,
        /// Tiles that needed nothing but cached columns of the node.
        reused: usize,
    },
    /// Tiles of an output that are done; at most ten a second, and one at the end of each output.
    Progress {
        /// The output that is being painted.
        output: String,
        /// Tiles of it done so far.
        done: usize,
        /// All tiles of it.
        total: usize,
        /// Maps of the run that are in their places.
        maps_done: usize,
        /// All maps of the run.
        maps_total: usize,
        /// How much of the painting of the run is done, from 0 to 1: pixels times maps.
        fraction: f64,
        /// How long the rest takes at the measured pace; `None` as long as that would be a guess.
        seconds_left: Option<f64>,
    },
    /// A map is in its place.
    MapWritten {
        /// The output.
        output: String,
        /// The channel.
        channel: String,
        /// The file.
        path: PathBuf,
        /// Samples that were not finite: a PNG holds 0 or the nearest it can.
        not_finite: u64,
        /// The first of them.
        first_not_finite: Option<Spot>,
        /// Samples outside the range that the format can hold.
        clamped: u64,
    },
    /// The file on disk is what it should be.
    MapUpToDate {
        /// The output.
        output: String,
        /// The channel.
        channel: String,
        /// The file.
        path: PathBuf,
        /// Samples that were not finite: a PNG holds 0 or the nearest it can.
        not_finite: u64,
        /// The first of them.
        first_not_finite: Option<Spot>,
        /// Samples outside the range that the format can hold.
        clamped: u64,
    },
    /// The file was copied from the store.
    MapRestored {
        /// The output.
        output: String,
        /// The channel.
        channel: String,
        /// The file.
        path: PathBuf,
        /// Samples that were not finite: a PNG holds 0 or the nearest it can.
        not_finite: u64,
        /// The first of them.
        first_not_finite: Option<Spot>,
        /// Samples outside the range that the format can hold.
        clamped: u64,
    },
    /// A file that an earlier run wrote for the output, which no longer asks for it; it is left alone.
    MapStale {
        /// The output.
        output: String,
        /// The channel.
        channel: String,
        /// The file.
        path: PathBuf,
    },
    /// An output is complete.
    OutputDone {
        /// The output.
        output: String,
        /// How long it took.
        milliseconds: f64,
        /// How long its tiles took, summed over all threads; the rest is building, encoding and writing.
        computing: f64,
    },
    /// A node says something that the recipe's author should know.
    Warning {
        /// The node.
        node: String,
        /// The recipe.
        file: PathBuf,
        /// The line of the recipe with the name of the node, or of the compound's use that holds it, counted from 1.
        line: usize,
        /// The character in the line, counted from 1.
        column: usize,
        /// What it says.
        message: String,
    },
    /// The store cannot be used; the run goes on without it.
    StoreFailed {
        /// What the operating system says.
        reason: String,
    },
    /// Results that the caches had were made again and compared; what differs is an error of the run.
    CacheVerified {
        /// How many results.
        compared: usize,
    },
    /// The run was stopped before its end.
    Cancelled,
}

/// What a node says that the recipe's author should know.
pub(super) fn warning(node: &Node, message: &str) -> Event {
    let uses = node.origin.uses.as_deref();
    let (source, span) = match uses.and_then(|inner| inner.chain().last()) {
        Some(outermost) => (&outermost.source, &outermost.span),
        None => (&node.origin.source, &node.span),
    };
    let Position { line, column } = source.position(span.start);
    Event::Warning {
        node: node.name.to_string(),
        file: source.path.clone(),
        line,
        column,
        message: message.to_owned(),
    }
}

/// Says that the store cannot be used, unless that comes of a cancelled run.
pub(super) fn tell_store_failed(listener: &dyn Listener, cancel: &Cancel, error: &io::Error) {
    if !cancel.is_cancelled() {
        let reason = error.to_string();
        listener.hear(Event::StoreFailed { reason });
    }
}

/// Receives events, possibly from several threads at once.
pub trait Listener: Sync {
    /// Takes one event.
    fn hear(&self, event: Event);
}

impl<F: Fn(Event) + Sync> Listener for F {
    fn hear(&self, event: Event) {
        self(event);
    }
}
