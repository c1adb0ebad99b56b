//! One run of a recipe, on a thread of its own.

use super::mailbox::Mailbox;
use super::report::{Collector, Failed};
use super::{Audience, Followed, Rendered, Times, Told};
use crate::diagnostics::{Code, Diagnostic};
use crate::engine::{Cancel, Engine, Event, Render, RunError};
use crate::graph::{Graph, load_until};
use crate::world::{Trace, Traced, World};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

/// How long after the notice of a change the last of the small pictures should be there.
const PREVIEW: Duration = Duration::from_millis(80);

/// How long a run that was stopped may take to end before the next one starts beside it.
pub(super) const PATIENCE: Duration = Duration::from_millis(50);

/// What a run needs.
pub(super) struct Run {
    pub(super) number: u64,
    pub(super) followed: Arc<Followed>,
    pub(super) engine: Arc<Engine>,
    pub(super) world: Arc<dyn World>,
    pub(super) audience: Audience,
    pub(super) mailbox: Arc<Mailbox>,
    pub(super) trace: Trace,
    pub(super) switches: Switches,
    pub(super) preview: bool,
    /// When the change was noticed that the run is for.
    pub(super) noticed: Instant,
}

/// How a run is stopped from outside; copies are the same switches.
#[derive(Clone, Default)]
pub(super) struct Switches {
    pub(super) cancel: Cancel,
    /// Whether the small pictures are still to come.
    previews: Arc<AtomicBool>,
    /// Whether the run is to end when they are there.
    no_further: Arc<AtomicBool>,
}

impl Switches {
    /// Stops the run at once.
    pub(super) fn stop(&self) {
        self.cancel.cancel();
    }

    /// Has the run stop when its small pictures are there; gives how long they may take, `None` if there are
    /// none to come.
    pub(super) fn stop_after_preview(&self) -> Option<Duration> {
        self.no_further.store(true, Ordering::SeqCst);
        self.previews.load(Ordering::SeqCst).then_some(2 * PREVIEW)
    }
}

/// How a run ended.
pub(super) struct Ended {
    pub(super) number: u64,
    /// Whether it gave something new to see.
    pub(super) shown: bool,
    pub(super) outcome: Outcome,
}

/// What came of a run.
pub(super) enum Outcome {
    Rendered(Rendered),
    Failed(Failed),
    Stopped,
}

/// A thread that runs one run after the other; it ends when this is dropped and its last run has ended.
pub(super) struct Runner(Sender<Run>);

impl Runner {
    /// Starts the thread.
    ///
    /// # Errors
    /// If the system gives none.
    pub(super) fn new() -> std::io::Result<Runner> {
        let (sender, runs) = channel::<Run>();
        let thread = std::thread::Builder::new().name("run".to_owned());
        thread.spawn(move || runs.into_iter().for_each(Run::run))?;
        Ok(Runner(sender))
    }

    /// Has a run started behind those before it.
    pub(super) fn start(&self, run: Run) {
        run.switches.previews.store(run.preview, Ordering::SeqCst);
        // Runs catch their panics, so the thread is there as long as this is.
        let _ = self.0.send(run);
    }
}

impl Run {
    fn run(self) {
        let outcome = catch_unwind(AssertUnwindSafe(|| self.outcome()));
        // The engine catches panics of nodes; whatever else goes wrong must not end the watch.
        let outcome = outcome.unwrap_or_else(|_| {
            let message =
                "the run ended by a mistake of Yosegi's own; the message above says where";
            Outcome::Failed(Failed::Loading(vec![Diagnostic::error(
                Code::NodeFailed,
                message,
            )]))
        });
        let has_previewed = self.preview && !self.switches.previews.load(Ordering::SeqCst);
        let ended = Ended {
            number: self.number,
            shown: has_previewed || matches!(outcome, Outcome::Rendered(_)),
            outcome,
        };
        self.mailbox.post(|inbox| inbox.ended.push(ended));
    }

    fn outcome(&self) -> Outcome {
        let start = Instant::now();
        let mailbox = Arc::clone(&self.mailbox);
        let on_new = move |path: &Path| {
            mailbox.post(|inbox| {
                inbox.reads.insert(path.to_owned());
            });
        };
        let inputs: Arc<dyn World> = Arc::new(Traced::new(
            Arc::clone(&self.world),
            self.trace.clone(),
            on_new,
        ));
        let (recipe, settings) = (&self.followed.recipe, &self.followed.settings);
        let loaded = match load_until(&*inputs, recipe, settings, &self.switches.cancel) {
            Some(Ok(loaded)) => loaded,
            Some(Err(diagnostics)) => return Outcome::Failed(Failed::Loading(diagnostics)),
            None => return Outcome::Stopped,
        };
        let loading = start.elapsed();
        let collector = Collector::default();
        let rendered = self.preview(&loaded.graph, &inputs).and_then(|preview| {
            self.render(&loaded.graph, &inputs, &collector)
                .map(|()| preview)
        });
        match rendered {
            Ok(preview) => {
                let rendered = collector.finish();
                let computing = rendered.times.computing;
                Outcome::Rendered(Rendered {
                    warnings: loaded.warnings,
                    times: self.times(start, [loading, preview], computing),
                    ..rendered
                })
            }
            Err(RunError::Cancelled) => Outcome::Stopped,
            Err(error) => Outcome::Failed(Failed::Running(error)),
        }
    }

    fn times(&self, start: Instant, [loading, preview]: [Duration; 2], computing: f64) -> Times {
        let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
        let waiting = start.saturating_duration_since(self.noticed);
        let rendering = start.elapsed().saturating_sub(loading + preview);
        Times {
            total: milliseconds(self.noticed.elapsed()),
            waiting: milliseconds(waiting),
            loading: milliseconds(loading),
            preview: milliseconds(preview),
            rendering: milliseconds(rendering),
            computing,
        }
    }

    /// Writes the small pictures, if there are to be any; gives the time that took.
    fn preview(&self, graph: &Graph, inputs: &Arc<dyn World>) -> Result<Duration, RunError> {
        if !self.preview {
            return Ok(Duration::ZERO);
        }
        let start = Instant::now();
        // All that happens here happens again in the run itself, and is told then.
        let nobody = |_: Event| {};
        let left = PREVIEW.saturating_sub(self.noticed.elapsed());
        let request = self.request(graph, &nobody);
        let paths = match self.engine.preview(&request, inputs, left) {
            Err(RunError::Files(diagnostics)) => {
                // The maps may be written all the same; if not, that is told in its turn.
                self.tell(Told::PreviewFailed(diagnostics));
                vec![]
            }
            paths => paths?,
        };
        // In this order: whoever asks for a stop meanwhile finds one of the two.
        self.switches.previews.store(false, Ordering::SeqCst);
        if self.switches.no_further.load(Ordering::SeqCst) {
            self.switches.stop();
        }
        if !paths.is_empty() {
            let milliseconds = self.noticed.elapsed().as_secs_f64() * 1e3;
            self.tell(Told::Previewed {
                paths,
                milliseconds,
            });
        }
        Ok(start.elapsed())
    }

    fn render(
        &self,
        graph: &Graph,
        inputs: &Arc<dyn World>,
        collector: &Collector,
    ) -> Result<(), RunError> {
        let listener = |event: Event| {
            collector.hear(&event);
            self.tell(Told::Run(event));
        };
        let request = self.request(graph, &listener);
        self.engine.render_reading(&request, inputs).map(|_| ())
    }

    /// Says something, unless the run was overtaken: the newest one speaks then.
    fn tell(&self, told: Told) {
        if !self.switches.cancel.is_cancelled() {
            (self.audience)(&self.followed.recipe, told);
        }
    }

    fn request<'r>(
        &self,
        graph: &'r Graph,
        listener: &'r dyn crate::engine::Listener,
    ) -> Render<'r> {
        Render {
            graph,
            folder: self.followed.folder.clone(),
            only: self.followed.only.clone(),
            pixels: self.followed.pixels,
            listener,
            cancel: self.switches.cancel.clone(),
        }
    }
}
