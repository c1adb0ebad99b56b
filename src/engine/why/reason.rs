//! What would happen to a node and why, as data and in words.

use serde::Serialize;
use std::fmt;
use std::path::PathBuf;

/// What a run would do with a node or an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// A structure that is taken from the memory of this process.
    ReusedFromMemory,
    /// A structure that is taken from the store.
    ReusedFromDisk,
    /// A structure that is built.
    Built,
    /// A structure that is built, unless what it reads comes out as it was before.
    BuiltUnlessKnown,
    /// A field or material that is evaluated tile by tile.
    Evaluated,
    /// No output that is painted reads it: it does not run.
    NotNeeded,
    /// An output whose files are all as they should be.
    UpToDate,
    /// An output of which files are copied from the store.
    Restored,
    /// An output of which maps are painted.
    Painted,
    /// An output of which those maps are painted that do not come out as before.
    PaintedUnlessKnown,
}

/// Why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub enum Cause {
    /// The store knows no earlier run of the recipe.
    NothingKnown,
    /// There is no store, so nothing is known of earlier runs.
    NoStore,
    /// The store has no result although nothing has changed since the last run.
    NotInStore,
    /// The last run had no such node or output.
    New,
    /// It is of another kind.
    KindChanged {
        /// The kind before.
        from: String,
        /// The kind now.
        to: String,
    },
    /// The program computes the kind in another way than before.
    VersionChanged {
        /// The version before.
        from: u32,
        /// The version now.
        to: u32,
    },
    /// The node draws random numbers, and the recipe's seed is another.
    SeedChanged {
        /// The seed before.
        from: u64,
        /// The seed now.
        to: u64,
    },
    /// Another size is asked for than the recipe's, or no longer.
    SizeChanged {
        /// The size before; `None` for the recipe's.
        from: Option<[u32; 2]>,
        /// The size now; `None` for the recipe's.
        to: Option<[u32; 2]>,
    },
    /// The kind did not have the input before.
    InputNew {
        /// The input.
        input: String,
    },
    /// An input has another value, or takes it from another place.
    InputChanged {
        /// The input.
        input: String,
        /// What it was, as a recipe would write it; long ones are cut.
        from: String,
        /// What it is.
        to: String,
    },
    /// A file has other contents.
    FileChanged {
        /// The input that names it.
        input: String,
        /// The file, in quotes.
        file: String,
    },
    /// A node that it reads has changed.
    NodeChanged {
        /// The input that reads it.
        input: String,
        /// The node.
        node: String,
    },
    /// Nothing in it has changed, but an output that reads it is painted.
    OutputPainted {
        /// The output.
        output: String,
    },
    /// A map is not there as it was written, and the store has no copy.
    MapLost {
        /// The file.
        path: PathBuf,
    },
    /// A map is not there as it was written.
    FileNotThere,
    /// All outputs that read it are up to date or are copied from the store.
    OutputsUpToDate,
    /// No output reads it.
    NotRead,
}

impl fmt::Display for Fate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Fate::ReusedFromMemory => "is reused from memory",
            Fate::ReusedFromDisk => "is reused from the store",
            Fate::Built => "is built",
            Fate::BuiltUnlessKnown => "is built, unless what it reads comes out as before",
            Fate::Evaluated => "is evaluated",
            Fate::NotNeeded => "does not run",
            Fate::UpToDate => "is up to date",
            Fate::Restored => "is copied from the store",
            Fate::Painted => "is painted",
            Fate::PaintedUnlessKnown => "is painted, unless its maps come out as before",
        })
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::NothingKnown => write!(formatter, "nothing is known of an earlier run"),
            Cause::NoStore => write!(formatter, "there is no store of earlier results"),
            Cause::NotInStore => write!(formatter, "it is not in the store"),
            Cause::New => write!(formatter, "it was not there in the last run"),
            Cause::KindChanged { from, to } => {
                write!(formatter, "its kind changed: {from} -> {to}")
            }
            Cause::VersionChanged { from, to } => {
                write!(formatter, "the version of its kind changed: {from} -> {to}")
            }
            Cause::SeedChanged { from, to } => {
                write!(formatter, "the seed around it changed: {from} -> {to}")
            }
            Cause::SizeChanged { from, to } => {
                write!(
                    formatter,
                    "the size changed: {} -> {}",
                    size(*from),
                    size(*to)
                )
            }
            Cause::InputNew { input } => write!(formatter, "input `{input}` is new"),
            Cause::InputChanged { input, from, to } if from == to => {
                write!(formatter, "input `{input}` changed")
            }
            Cause::InputChanged { input, from, to } => {
                write!(formatter, "input `{input}` changed: {from} -> {to}")
            }
            Cause::FileChanged { input, file } => {
                write!(
                    formatter,
                    "the contents of {file} changed (input `{input}`)"
                )
            }
            Cause::NodeChanged { input, node } => {
                write!(formatter, "`{node}` changed (input `{input}`)")
            }
            Cause::OutputPainted { output } => write!(formatter, "`{output}` is painted"),
            Cause::MapLost { path } => write!(
                formatter,
                "`{}` is not there as it was written, and the store has no copy",
                path.display()
            ),
            Cause::FileNotThere => write!(formatter, "a map is not there as it was written"),
            Cause::OutputsUpToDate => write!(formatter, "no output that reads it is painted"),
            Cause::NotRead => write!(formatter, "no output reads it"),
        }
    }
}

fn size(pixels: Option<[u32; 2]>) -> String {
    match pixels {
        Some([width, height]) => format!("{width}x{height}"),
        None => "the recipe's".to_owned(),
    }
}
