//! What is told of a watched recipe.

use crate::diagnostics::Diagnostic;
use crate::engine::{Event, RunError};
use serde::{Serialize, Serializer};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// One thing that happened to a watched recipe.
#[derive(Clone, Debug)]
pub enum Told {
    /// Something that a run did.
    Run(Event),
    /// Small pictures are in their places.
    Previewed {
        /// The files.
        paths: Vec<PathBuf>,
        /// Since the change was noticed.
        milliseconds: f64,
    },
    /// The small pictures cannot be written: why.
    PreviewFailed(Vec<Diagnostic>),
    /// All maps are in their places.
    Rendered(Rendered),
    /// The recipe cannot be read or rendered; the maps that are there stay.
    Failed(Failed),
    /// What it waits for now: a change of any of these files, as they are named, the recipe first.
    Waiting(Vec<PathBuf>),
    /// The files are looked at again and again, because notices of changes do not come.
    Polling {
        /// Why, in words that continue "there are no notices of changes: ".
        reason: String,
        /// Time between two looks.
        milliseconds: u64,
    },
}

/// Why a recipe was not rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failed {
    /// It cannot be read.
    Loading(Vec<Diagnostic>),
    /// It could not be rendered.
    Running(RunError),
}

impl Failed {
    /// What is wrong.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Failed::Loading(diagnostics) => diagnostics,
            Failed::Running(error) => error.diagnostics(),
        }
    }
}

/// What a run did, and how long that took.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Rendered {
    /// What is worth knowing of the recipe.
    #[serde(skip)]
    pub warnings: Vec<Diagnostic>,
    /// Nodes that were built or computed.
    pub ran: Vec<String>,
    /// Nodes whose results were there already; of maps that are up to date no node is named.
    pub reused: Vec<String>,
    /// Maps that were painted.
    #[serde(serialize_with = "as_text")]
    pub written: Vec<PathBuf>,
    /// Maps that were copied from the store.
    #[serde(serialize_with = "as_text")]
    pub restored: Vec<PathBuf>,
    /// Maps that needed nothing.
    #[serde(serialize_with = "as_text")]
    pub up_to_date: Vec<PathBuf>,
    /// How long it took.
    pub times: Times,
}

/// Paths as a person reads them: not all are Unicode.
fn as_text<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|path| path.to_string_lossy()))
}

/// How long a run took, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// From the notice of the change to the last map in its place.
    pub total: f64,
    /// From the notice to the start of the run.
    pub waiting: f64,
    /// Reading and checking the recipe.
    pub loading: f64,
    /// Small pictures.
    pub preview: f64,
    /// Everything else: building, painting, writing.
    pub rendering: f64,
    /// Computing the tiles, summed over all threads; part of the rendering.
    pub computing: f64,
}

/// Collects what a run did from its events.
#[derive(Debug, Default)]
pub(super) struct Collector(Mutex<Collected>);

#[derive(Debug, Default)]
struct Collected {
    ran: BTreeSet<String>,
    reused: BTreeSet<String>,
    rendered: Rendered,
}

impl Collector {
    pub(super) fn hear(&self, event: &Event) {
        // Whole at every moment: each event is one insertion.
        let mut collected = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        collected.hear(event);
    }

    pub(super) fn finish(self) -> Rendered {
        let collected = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let reused = collected.reused.difference(&collected.ran);
        Rendered {
            reused: reused.cloned().collect(),
            ran: collected.ran.into_iter().collect(),
            ..collected.rendered
        }
    }
}

impl Collected {
    fn hear(&mut self, event: &Event) {
        match event {
            Event::StructureBuilt { node, .. } => {
                self.ran.insert(node.clone());
            }
            Event::StructureReused { node, .. } => {
                self.reused.insert(node.clone());
            }
            Event::FieldTiles { node, computed, .. } => {
                let nodes = if *computed > 0 {
                    &mut self.ran
                } else {
                    &mut self.reused
                };
                nodes.insert(node.clone());
            }
            Event::OutputDone { computing, .. } => {
                self.rendered.times.computing += computing;
            }
            Event::MapWritten { path, .. } => self.rendered.written.push(path.clone()),
            Event::MapRestored { path, .. } => self.rendered.restored.push(path.clone()),
            Event::MapUpToDate { path, .. } => self.rendered.up_to_date.push(path.clone()),
            _ => {}
        }
    }
}
