//! Evaluates checked graphs: plans, builds structures, paints outputs, remembers both.

mod arithmetic;
mod beside;
mod build;
mod check;
mod content;
mod event;
mod files;
mod known;
mod look_up;
mod memory;
mod pace;
mod paint;
mod plan;
mod preview;
mod progress;
mod render;
mod reuse;
mod sample;
mod stoppable;
mod store;
mod target;
mod verify;
mod wanted;
mod why;
mod write;

pub use crate::cancel::Cancel;
pub use event::{Event, From as ReusedFrom, Listener, Spot};
pub use pace::Pace;
pub use render::{Render, RenderedMap};
pub use sample::SampledField;
pub use store::{StoreFamily, clean_store, store_status};
pub use target::FlatPiece;
pub use why::{Cause, Explained, Fate, Why};

use crate::diagnostics::{Code, Diagnostic};
use crate::field::{ColumnCache, RunContext};
use crate::graph::Graph;
use crate::world::World;
use build::{Builder, Built};
use fearless_simd::Level;
use memory::Memory;
use petgraph::graph::NodeIndex;
use plan::Plan;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use stoppable::Stoppable;
use store::Store;
use verify::Verification;

/// Raised whenever pixels or files change for a reason outside a kind: filtering, arithmetic, encoding.
const RESULTS: u32 = 4;

/// Largest side of a tile: every thread holds some twenty columns of a tile at once.
const LARGEST_TILE: u32 = 512;

/// How an engine works. Only `filtering` changes pixels.
#[derive(Clone, Debug)]
pub struct Options {
    /// Number of threads; `None` takes all processors.
    pub threads: Option<usize>,
    /// Side of a tile in pixels, from 1 to 512; others are taken as the nearest of these.
    pub tile: u32,
    /// Vector instructions; `None` takes the best of the machine.
    pub level: Option<Level>,
    /// Bytes that structures and columns may take in memory between runs.
    pub memory: usize,
    /// The folder of the store; `None` keeps nothing on disk.
    pub store: Option<PathBuf>,
    /// Bytes that the store may take on disk, in whole blocks of 4096: more than that, and entries go that
    /// were used longest ago. What a run uses stays until it ends. 0 keeps nothing.
    pub store_limit: u64,
    /// Whether everything that the caches would give is made again and compared. Differences are errors with
    /// the code [`Code::CacheMismatch`], and are replaced.
    pub verify: bool,
    /// Most pixels that one output may have.
    pub largest_output: u64,
    /// Whether maps are on the disk before they replace what is there, so that a loss of power leaves the
    /// one or the other; costs the time that the disk takes.
    pub durable: bool,
    /// Whether fields are filtered. Off only to show what filtering is good for: this one changes results.
    pub filtering: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            threads: None,
            tile: 128,
            level: None,
            memory: 512 << 20,
            store: None,
            store_limit: 2 << 30,
            verify: false,
            largest_output: 1 << 30,
            durable: true,
            filtering: true,
        }
    }
}

/// Evaluates recipes, and remembers what it has made; its copies share everything.
#[derive(Clone)]
pub struct Engine {
    world: Arc<dyn World>,
    /// Where the files that a recipe names are read.
    inputs: Arc<dyn World>,
    options: Options,
    memory: Arc<Memory>,
    store: Option<Store>,
    threads: Arc<rayon::ThreadPool>,
    /// Stops the run that this engine was made for; nobody throws that of a caller's engine.
    cancel: Cancel,
}

/// Why a run ended without its results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunError {
    /// Nodes could not be built.
    Nodes(Vec<Diagnostic>),
    /// Files could not be read or written.
    Files(Vec<Diagnostic>),
    /// A limit was reached.
    Limit(Vec<Diagnostic>),
    /// What was asked for does not exist in the recipe.
    Request(Vec<Diagnostic>),
    /// The run was cancelled.
    Cancelled,
}

impl RunError {
    /// What is wrong; empty for a cancelled run.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            RunError::Nodes(diagnostics)
            | RunError::Files(diagnostics)
            | RunError::Limit(diagnostics)
            | RunError::Request(diagnostics) => diagnostics,
            RunError::Cancelled => &[],
        }
    }

    fn not_written(error: &io::Error) -> RunError {
        RunError::Files(vec![Diagnostic::error(
            Code::OutputNotWritten,
            error.to_string(),
        )])
    }
}

impl Engine {
    /// An engine that reads and writes through `world`.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(world: Arc<dyn World>, mut options: Options) -> io::Result<Engine> {
        options.tile = options.tile.clamp(1, LARGEST_TILE);
        let store = options
            .store
            .clone()
            .map(|folder| Store::new(Arc::clone(&world), folder, options.store_limit));
        Ok(Engine {
            memory: Arc::new(Memory::new(options.memory)),
            threads: threads(&options)?,
            inputs: Arc::clone(&world),
            world,
            options,
            store,
            cancel: Cancel::new(),
        })
    }

    /// An engine with threads of its own that shares the memory and the store of this one: it starts at
    /// once even if this one is in a call that nothing can stop.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn beside(&self) -> io::Result<Engine> {
        Ok(Engine {
            threads: threads(&self.options)?,
            ..self.clone()
        })
    }

    /// This engine for one run: whatever it does ends when `cancel` is thrown, and what the recipe names is
    /// read from `inputs`.
    fn until(&self, cancel: &Cancel, inputs: &Arc<dyn World>) -> Engine {
        let stoppable = |world: &Arc<dyn World>| -> Arc<dyn World> {
            Arc::new(Stoppable::new(Arc::clone(world), cancel.clone()))
        };
        let world = stoppable(&self.world);
        let store = self.store.as_ref();
        Engine {
            store: store.map(|store| store.through(Arc::clone(&world))),
            inputs: stoppable(inputs),
            world,
            cancel: cancel.clone(),
            ..self.clone()
        }
    }

    /// Bytes of structures and columns that the engine remembers.
    pub fn remembered_bytes(&self) -> usize {
        self.memory.bytes()
    }

    fn build(&self, plan: &Plan<'_>, listener: &dyn Listener) -> Result<Built, RunError> {
        let builder = Builder {
            memory: &self.memory,
            store: self.store.as_ref(),
            listener,
            budget: std::sync::Arc::default(),
            cancel: &self.cancel,
            verification: self.options.verify.then(Verification::default),
        };
        builder.build(plan)
    }

    fn plan<'g>(&self, graph: &'g Graph, wanted: &[NodeIndex]) -> Result<Plan<'g>, RunError> {
        Plan::new(graph, wanted, &*self.inputs, &self.cancel)
    }

    fn context(&self) -> RunContext<'_> {
        RunContext {
            level: self.options.level.unwrap_or_else(Level::new),
            cache: self
                .memory
                .is_enabled()
                .then_some(&*self.memory as &dyn ColumnCache),
            filtering: self.options.filtering,
            cancel: Some(&self.cancel),
        }
    }
}

fn threads(options: &Options) -> io::Result<Arc<rayon::ThreadPool>> {
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0))
        .build();
    threads.map(Arc::new).map_err(io::Error::other)
}
