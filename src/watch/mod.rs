//! Follows recipes: renders them, and again whenever something that they read has changed.
//!
//! One thread waits for notices and decides; each run has a thread of its own, a switch that stops it and a
//! trace of what it has read. A change of anything in the trace stops the run and starts the newest one. A
//! mistake is told when the files have been quiet for a moment, since editors save in several steps, and the
//! last good maps stay in their places.

mod follow;
mod lane;
mod listening;
mod mailbox;
mod report;
mod run;
mod session;

pub use report::{Failed, Rendered, Times, Told};

use crate::engine::Engine;
use crate::graph::Settings;
use crate::world::World;
use mailbox::Mailbox;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// A recipe to follow.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// The recipe's file.
    pub recipe: PathBuf,
    /// The folder that the maps go to.
    pub folder: PathBuf,
    /// What the caller changes in the recipe.
    pub settings: Settings,
    /// Only these outputs; empty for all.
    pub only: Vec<String>,
    /// Width and height in pixels, instead of what the outputs state.
    pub pixels: Option<[u32; 2]>,
}

/// How to watch.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Whether a small `NAME.preview.png` of each changed output is written first.
    pub preview: bool,
    /// Looks at all files this often instead of waiting for notices.
    pub poll: Option<Duration>,
}

/// Hears what happens, and to which recipe; possibly from several threads at once.
pub type Audience = Arc<dyn Fn(&Path, Told) + Send + Sync>;

/// Follows recipes until it is stopped.
pub struct Watch {
    engine: Engine,
    world: Arc<dyn World>,
    followed: Vec<Arc<Followed>>,
    options: Options,
    audience: Audience,
    mailbox: Arc<Mailbox>,
}

/// Stops a [`Watch`] from anywhere.
#[derive(Clone)]
pub struct Stop(Arc<Mailbox>);

impl Watch {
    /// Will follow recipes with an engine, which should remember things in memory. `world` is where changes
    /// are looked for, the one of the engine.
    pub fn new(
        engine: Engine,
        world: Arc<dyn World>,
        followed: Vec<Followed>,
        options: Options,
        audience: Audience,
    ) -> Watch {
        Watch {
            engine,
            world,
            followed: followed.into_iter().map(Arc::new).collect(),
            options,
            audience,
            mailbox: Arc::default(),
        }
    }

    /// A way to stop it.
    pub fn stop(&self) -> Stop {
        Stop(Arc::clone(&self.mailbox))
    }

    /// Renders all recipes, then follows them until it is stopped. A run that is going on then has 300 ms to
    /// end; whatever it does later is dropped.
    ///
    /// # Errors
    /// If the system gives no thread to run on.
    pub fn run(self) -> io::Result<()> {
        follow::Follow::new(self)?.run();
        Ok(())
    }
}

impl Stop {
    /// Ends [`Watch::run`] within half a second.
    pub fn stop(&self) {
        self.0.post(|inbox| inbox.stop = true);
    }
}
