//! What a build function says and takes besides its result: warnings, and memory for what it decodes.

use super::Failure;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Bytes that decoded files may take in one run, all nodes together.
pub(crate) const DECODED_BYTES: u64 = 2 << 30;

/// Memory for decoded files that is left to the nodes of one run.
#[derive(Debug)]
pub(crate) struct Budget {
    left: AtomicU64,
}

impl Default for Budget {
    fn default() -> Budget {
        Budget {
            left: AtomicU64::new(DECODED_BYTES),
        }
    }
}

impl Budget {
    /// Takes bytes, if so many are left.
    pub(crate) fn take(&self, bytes: u64) -> bool {
        let less = |left: u64| left.checked_sub(bytes);
        let taken = self
            .left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, less);
        taken.is_ok()
    }
}

/// What one node has said and taken.
#[derive(Debug, Default)]
pub(crate) struct Ledger {
    warnings: Mutex<Vec<String>>,
    bytes: AtomicU64,
}

impl Ledger {
    pub(super) fn warn(&self, message: String) {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        warnings.push(message);
    }

    /// Takes bytes from the run's budget.
    pub(super) fn take(
        &self,
        budget: &Budget,
        input: &'static str,
        bytes: u64,
    ) -> Result<(), Failure> {
        if budget.take(bytes) {
            self.bytes.fetch_add(bytes, Ordering::Relaxed);
            return Ok(());
        }
        let mebibytes = bytes.div_ceil(1 << 20);
        let total = DECODED_BYTES >> 20;
        let message = format!(
            "decoded, the file takes {mebibytes} MiB, and all files of a recipe may take {total} MiB"
        );
        Err(Failure::of_input(input, message).with_hint("scale pictures down, or use fewer"))
    }

    /// The warnings and the bytes taken.
    pub(crate) fn close(self) -> (Vec<String>, u64) {
        let warnings = self.warnings.into_inner();
        (
            warnings.unwrap_or_else(PoisonError::into_inner),
            self.bytes.into_inner(),
        )
    }
}
