//! The families of entries, each a folder of the store.

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum Family {
    /// A structure that a node was built into.
    Structure,
    /// What is known of a map.
    Map,
    /// A copy of a map's file.
    File,
    /// What the plan of an output has led to.
    Plan,
    /// What a recipe was when it last ran.
    Run,
}

impl Family {
    pub(in crate::engine) const ALL: [Family; 5] = [
        Family::Structure,
        Family::Map,
        Family::File,
        Family::Plan,
        Family::Run,
    ];

    /// Its folder.
    pub(in crate::engine) fn name(self) -> &'static str {
        match self {
            Family::Structure => "structure",
            Family::Map => "map",
            Family::File => "file",
            Family::Plan => "plan",
            Family::Run => "run",
        }
    }

    /// Most bytes that an entry has without its header: more are not stored, and never read.
    pub(super) fn most_bytes(self) -> u64 {
        match self {
            Family::Map => 4 << 10,
            Family::Plan => 16 << 20,
            Family::Structure | Family::File | Family::Run => 64 << 20,
        }
    }
}
