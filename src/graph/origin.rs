//! Where a node comes from: a file, and the uses of compounds that lead to it.

use super::compound::File;
use crate::diagnostics::{SourceFile, Use};
use crate::key::KeyHasher;
use std::sync::Arc;

/// What all nodes of a recipe share, or all nodes of one use of a compound.
#[derive(Debug)]
pub struct Origin {
    /// The file that holds the nodes.
    pub source: Arc<SourceFile>,
    /// Mixed into every random stream: the recipe's seed, and the seeds of the uses.
    pub seed: u64,
    /// The use of the compound that holds the nodes; `None` in the recipe.
    pub uses: Option<Arc<Use>>,
}

impl Origin {
    /// A file as the first use of it finds it.
    pub(super) fn of_file(file: &File) -> Origin {
        Origin {
            source: Arc::clone(&file.source),
            seed: 0,
            uses: file.first_use.clone(),
        }
    }

    /// The seed inside a compound whose use has the input `seed`: 0 changes nothing, so that a compound
    /// gives what its nodes give in its place.
    pub(super) fn mixed_seed(outer: u64, seed: i64) -> u64 {
        if seed == 0 {
            return outer;
        }
        let mut key = KeyHasher::new("compound seed", 1);
        key.bytes(&outer.to_le_bytes()).whole(seed);
        key.finish().short()
    }
}
