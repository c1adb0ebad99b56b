//! Programs that give one field inside single pixels, where a kernel cannot filter.

use super::Field;
use super::compile::{Compiler, Program};
use crate::cancel::Cancel;
use std::sync::{Mutex, OnceLock};

/// The program that gives one field at its samples' own positions, and behind it their charts, compiled when it is first needed:
/// each holds the whole way to its field, so a long chain of kernels that cannot filter would grow with
/// the square of its length.
#[derive(Debug)]
pub(super) struct Within {
    field: Field,
    charts: Vec<Field>,
    program: OnceLock<Program>,
    compiling: Mutex<()>,
}

impl Within {
    pub(super) fn new(field: Field, charts: Vec<Field>) -> Within {
        Within {
            field,
            charts,
            program: OnceLock::new(),
            compiling: Mutex::new(()),
        }
    }

    /// `None` if the run is cancelled before it is compiled.
    pub(super) fn program(&self, cancel: Option<&Cancel>) -> Option<&Program> {
        if let Some(program) = self.program.get() {
            return Some(program);
        }
        // One thread compiles, the others wait for it.
        let _compiling = self.compiling.lock();
        if self.program.get().is_none() {
            let fields = [std::slice::from_ref(&self.field), &self.charts].concat();
            let compiled = Compiler::new(false, &self.charts).compile(&fields, cancel)?;
            let _ = self.program.set(compiled);
        }
        self.program.get()
    }
}
