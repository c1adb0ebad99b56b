//! Renders the outputs of a recipe: finds what is there already, and paints the rest.

use super::build::Built;
use super::event::{Event, Listener, tell_store_failed};
use super::known::{KnownMap, KnownOutput, OutputRecord, repeat_warnings};
use super::plan::Plan;
use super::progress::Meter;
use super::store::{Family, Store, ToldOnce};
use super::verify::Verification;
use super::write::Written;
use super::{Cancel, Engine, FlatPiece, RunError, files};
use crate::diagnostics::{Code, Diagnostic, nearest};
use crate::graph::{Graph, no_output};
use crate::key::Key;
use crate::world::World;
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What to render, and who is told.
pub struct Render<'a> {
    /// The checked recipe.
    pub graph: &'a Graph,
    /// The folder that the maps go to.
    pub folder: PathBuf,
    /// Only these outputs; empty for all.
    pub only: Vec<String>,
    /// Width and height in pixels, instead of what the outputs state.
    pub pixels: Option<[u32; 2]>,
    /// Hears what happens.
    pub listener: &'a dyn Listener,
    /// Stops the run.
    pub cancel: Cancel,
}

/// A map that is now in its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderedMap {
    /// The output it belongs to.
    pub output: String,
    /// Its channel.
    pub channel: String,
    /// Its file.
    pub path: PathBuf,
}

/// A map that an output asks for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct WantedMap {
    pub(super) channel: String,
    pub(super) file_name: String,
    pub(super) key: Key,
}

impl Engine {
    /// Renders outputs of a recipe into files; gives the maps in the order of the recipe.
    ///
    /// # Errors
    /// What is wrong with nodes or files, which limit was reached, or that the run was cancelled. Maps
    /// that were finished before stay in place; of others nothing is left.
    pub fn render(&self, request: &Render<'_>) -> Result<Vec<RenderedMap>, RunError> {
        self.render_reading(request, &self.world)
    }

    /// As [`Engine::render`], but reads the files that the recipe names from `inputs`, such as a
    /// [`Traced`](crate::world::Traced) world.
    ///
    /// # Errors
    /// As [`Engine::render`].
    pub fn render_reading(
        &self,
        request: &Render<'_>,
        inputs: &Arc<dyn World>,
    ) -> Result<Vec<RenderedMap>, RunError> {
        let _in_use = self.store.as_ref().map(Store::begin);
        let listener = ToldOnce::new(request.listener);
        let request = &listener.request(request);
        let run = self.until(&request.cancel, inputs);
        self.threads
            .install(|| run.ended(run.render_outputs(request), request.listener))
    }

    /// How a run has ended: whatever a cancelled one says is wrong comes of that.
    pub(super) fn ended<T>(
        &self,
        result: Result<T, RunError>,
        listener: &dyn Listener,
    ) -> Result<T, RunError> {
        if result.is_err() && self.cancel.is_cancelled() {
            listener.hear(Event::Cancelled);
            return Err(RunError::Cancelled);
        }
        result
    }

    fn render_outputs(&self, request: &Render<'_>) -> Result<Vec<RenderedMap>, RunError> {
        let wanted = chosen_outputs(request)?;
        self.world.sweep(&request.folder);
        let plan = self.plan(request.graph, &wanted)?;
        let protected = files::Protected::new(&*self.world, &plan, self.options.store.as_deref());
        let outputs = self.outputs(request, &plan, &protected, &wanted);
        let known: Vec<Option<KnownOutput>> = outputs.iter().map(Output::known).collect();
        let missing = outputs.iter().zip(&known).filter(|(_, it)| it.is_none());
        let missing: Vec<NodeIndex> = missing.map(|(output, _)| output.index).collect();
        let rest = plan.part(&missing);
        let built = self.build(&rest, request.listener)?;
        repeat_warnings(known.iter().flatten(), request, &plan, &built);
        let known = known.into_iter().map(|known| Some(known?.maps));
        let known: Vec<Option<Vec<KnownMap>>> = known.collect();
        let names = outputs.iter().zip(&known);
        let names: Vec<(NodeIndex, String)> = names
            .flat_map(|(output, known)| output.file_names(known.as_deref(), &built))
            .collect();
        files::refuse_shared(request.graph, names.iter().cloned())?;
        let paths: Vec<_> = names
            .iter()
            .map(|(index, name)| (*index, request.folder.join(name)))
            .collect();
        let paths = paths.iter().map(|(index, path)| (*index, path.as_path()));
        protected.refuse(&*self.world, request.graph, paths)?;
        let meter = Meter::new(request.listener);
        for (output, known) in outputs.iter().zip(&known) {
            output.expect(known.as_deref(), &built, &meter)?;
        }
        let mut rendered = vec![];
        for (output, known) in outputs.iter().zip(&known) {
            let maps = output.make(known.as_deref(), &built, &meter)?;
            meter.count().finish(maps.len());
            rendered.push(maps);
        }
        self.tell_stale(request, &outputs, &rendered, &names);
        let rendered = rendered.concat();
        self.judge(&built, &outputs, request.listener)?;
        self.remember_run(request, &plan);
        Ok(rendered)
    }

    /// Names the files that the outputs with maps have left behind.
    fn tell_stale(
        &self,
        request: &Render<'_>,
        outputs: &[Output<'_>],
        rendered: &[Vec<RenderedMap>],
        names: &[(NodeIndex, String)],
    ) {
        // A folder that cannot be listed has nothing to warn of.
        let folder = self.world.list(&request.folder).unwrap_or_default();
        let written = names.iter().map(|(_, name)| name.as_str()).collect();
        for (output, maps) in outputs.iter().zip(rendered) {
            if !maps.is_empty() {
                output.tell_stale(&folder, &written);
            }
        }
    }

    /// Records what has run, for [`Engine::why`].
    fn remember_run(&self, request: &Render<'_>, plan: &Plan<'_>) {
        if let Err(error) = self.record_run(plan, request.pixels) {
            tell_store_failed(request.listener, &self.cancel, &error);
        }
    }

    /// Outputs of a run.
    pub(super) fn outputs<'a>(
        &'a self,
        request: &'a Render<'a>,
        plan: &'a Plan<'a>,
        protected: &'a files::Protected,
        wanted: &[NodeIndex],
    ) -> Vec<Output<'a>> {
        let output = |index: &NodeIndex| Output {
            engine: self,
            request,
            plan,
            protected,
            index: *index,
            verification: self.options.verify.then(Verification::default),
        };
        wanted.iter().map(output).collect()
    }
}

/// The outputs that the caller asks for.
pub(super) fn chosen_outputs(request: &Render<'_>) -> Result<Vec<NodeIndex>, RunError> {
    let graph = request.graph;
    if graph.outputs.is_empty() {
        return Err(RunError::Request(vec![no_output(graph)]));
    }
    if request.only.is_empty() {
        return Ok(graph.outputs.clone());
    }
    let name_of = |index: &NodeIndex| &*graph.nodes[*index].name;
    for name in &request.only {
        if !graph.outputs.iter().any(|index| name_of(index) == name) {
            let names: Vec<&str> = graph.outputs.iter().map(name_of).collect();
            return Err(RunError::Request(vec![
                Diagnostic::error(Code::NoOutput, format!("the recipe has no output `{name}`"))
                    .nearest(nearest(name, names.iter().copied()))
                    .hint(format!("its outputs are {}", names.join(", "))),
            ]));
        }
    }
    let is_wanted = |index: &NodeIndex| request.only.iter().any(|name| name == name_of(index));
    Ok(graph.outputs.iter().copied().filter(is_wanted).collect())
}

/// One output of a run.
pub(super) struct Output<'a> {
    pub(super) engine: &'a Engine,
    pub(super) request: &'a Render<'a>,
    pub(super) plan: &'a Plan<'a>,
    pub(super) protected: &'a files::Protected,
    pub(super) index: NodeIndex,
    /// Compares what is painted with what the store has, if that is asked for.
    pub(super) verification: Option<Verification>,
}

impl Output<'_> {
    pub(super) fn name(&self) -> &str {
        &self.request.graph.nodes[self.index].name
    }

    /// Counts the output's maps, and refuses those that are too large.
    pub(super) fn expect(
        &self,
        known: Option<&[KnownMap]>,
        built: &Built,
        meter: &Meter<'_>,
    ) -> Result<(), RunError> {
        if let Some(known) = known {
            meter.count().expect(known.len(), 0, [0, 0]);
        } else if built.has(self.index) {
            let maps = self.maps(built);
            let (count, pixels) = (maps.channels.len(), self.pixels(maps));
            self.check_size(maps)?;
            meter.count().expect(count, count, pixels);
        }
        Ok(())
    }

    /// Puts the output's maps in their places; none if it depends on a failed node, which does not keep
    /// the other outputs from being rendered.
    fn make(
        &self,
        known: Option<&[KnownMap]>,
        built: &Built,
        meter: &Meter<'_>,
    ) -> Result<Vec<RenderedMap>, RunError> {
        let Some(known) = known else {
            return if built.has(self.index) {
                self.paint(built, meter, &[])
            } else {
                Ok(vec![])
            };
        };
        let (placed, lost): (Vec<&KnownMap>, Vec<&KnownMap>) =
            known.iter().partition(|known| self.put_in_place(known));
        if lost.is_empty() {
            return Ok(self.announce(placed.into_iter().map(|known| &known.map)));
        }
        // The store has lost a map since it was asked: the output has to be made after all.
        let alone = self.plan.part(&[self.index]);
        let built = self.engine.build(&alone, self.request.listener)?;
        built.complete()?;
        let told: Vec<&str> = placed.iter().map(|known| &*known.map.channel).collect();
        let maps = self.maps(&built);
        self.check_size(maps)?;
        let painted = maps.channels.len();
        meter.count().expect(0, painted, self.pixels(maps));
        self.paint(&built, meter, &told)
    }

    /// Paints what is not in place; of the channels in `told` that was said already.
    fn paint(
        &self,
        built: &Built,
        meter: &Meter<'_>,
        told: &[&str],
    ) -> Result<Vec<RenderedMap>, RunError> {
        let start = Instant::now();
        let maps = self.maps(built);
        let pixels = self.pixels(maps);
        let target = FlatPiece::of(maps, pixels);
        let wanted = self.wanted_maps(maps, &target);
        let is_there = |map: &WantedMap| told.contains(&&*map.channel) || self.found(map);
        let missing: Vec<&WantedMap> = wanted.iter().filter(|map| !is_there(map)).collect();
        let share = [missing.len(), wanted.len() - missing.len()];
        meter.count().begin(self.name(), share, pixels);
        let written = if missing.is_empty() {
            vec![]
        } else {
            self.write_maps(maps, &target, &missing, meter)?
        };
        self.remember(&wanted, built, missing.into_iter().zip(written));
        let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
        self.request.listener.hear(Event::OutputDone {
            output: self.name().to_owned(),
            milliseconds: milliseconds(start.elapsed()),
            computing: milliseconds(meter.count().computing()),
        });
        Ok(self.announce(&wanted))
    }

    /// Whether the map is in place or can be put there; says so.
    fn found(&self, map: &WantedMap) -> bool {
        let known = match self.verification {
            Some(_) => None,
            None => self.known_map(map),
        };
        known.is_some_and(|known| self.put_in_place(&known))
    }

    /// Tells the store what was written, and which maps the plan leads to.
    fn remember<'m>(
        &self,
        wanted: &[WantedMap],
        built: &Built,
        mut written: impl Iterator<Item = (&'m WantedMap, Written)> + Clone,
    ) {
        let Some(store) = &self.engine.store else {
            return;
        };
        let record = OutputRecord {
            maps: wanted.to_vec(),
            warnings: self.warnings(built),
        };
        self.verify(&record, written.clone());
        let stored = written
            .try_for_each(|(map, written)| match written.record() {
                Some(record) => store.put_map(&map.key, &self.path(map), &record),
                None => Ok(()),
            })
            .and_then(|()| postcard::to_stdvec(&record).map_err(io::Error::other))
            .and_then(|bytes| store.put(Family::Plan, &self.plan_key(), &bytes));
        if let Err(error) = stored {
            tell_store_failed(self.request.listener, &self.engine.cancel, &error);
        }
    }

    fn announce<'m>(&self, maps: impl IntoIterator<Item = &'m WantedMap>) -> Vec<RenderedMap> {
        let rendered = |map: &WantedMap| RenderedMap {
            output: self.name().to_owned(),
            path: self.path(map),
            channel: map.channel.clone(),
        };
        maps.into_iter().map(rendered).collect()
    }
}
