//! The stable names of mistakes.

use serde::Serialize;

/// A kind of mistake, by a name that never changes its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// A node could not be built from its inputs.
    NodeFailed,
    /// A file could not be read.
    FileNotRead,
}

impl Code {
    /// The name in messages, for example `node-failed`.
    pub fn name(self) -> &'static str {
        match self {
            Code::NodeFailed => "node-failed",
            Code::FileNotRead => "file-not-read",
        }
    }
}
