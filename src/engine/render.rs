//! Renders the outputs of a recipe: finds what is there already, and paints the rest.

use super::build::Built;
use super::event::{Event, Listener};
use super::paint::{Painter, Sheet};
use super::plan::Plan;
use super::store::Store;
use super::{Cancel, Engine, FlatPiece, RESULTS, RunError, files};
use crate::diagnostics::{Code, Diagnostic, nearest};
use crate::field::Target;
use crate::graph::{Graph, no_output};
use crate::key::{Key, KeyHasher};
use crate::output::{self, Encoder, Faults, MapRequest};
use crate::value::Maps;
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;
use std::time::Instant;

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
#[derive(Clone, Debug, Serialize, Deserialize)]
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
        self.threads.install(|| {
            let result = self.render_outputs(request);
            if matches!(result, Err(RunError::Cancelled)) {
                request.listener.hear(Event::Cancelled);
            }
            result
        })
    }

    fn render_outputs(&self, request: &Render<'_>) -> Result<Vec<RenderedMap>, RunError> {
        let wanted = chosen_outputs(request)?;
        let plan = self.plan(request.graph, &wanted)?;
        let protected = files::Protected::new(&*self.world, &plan, self.options.store.as_deref());
        let output = |index| Output {
            engine: self,
            request,
            plan: &plan,
            protected: &protected,
            index,
        };
        let outputs: Vec<Output<'_>> = wanted.into_iter().map(output).collect();
        let known: Vec<Option<Vec<WantedMap>>> = outputs.iter().map(Output::known_maps).collect();
        let pairs = || outputs.iter().zip(&known);
        let missing = pairs().filter(|(_, known)| known.is_none());
        let missing: Vec<NodeIndex> = missing.map(|(output, _)| output.index).collect();
        let rest = plan.part(&missing);
        let built = self.build(&rest, request.listener, &request.cancel)?;
        let names = pairs().flat_map(|(output, known)| output.file_names(known.as_deref(), &built));
        let names: Vec<_> = names.collect();
        files::refuse_shared(request.graph, names.iter().cloned())?;
        let paths: Vec<_> = names
            .iter()
            .map(|(index, name)| (*index, request.folder.join(name)))
            .collect();
        let paths = paths.iter().map(|(index, path)| (*index, path.as_path()));
        protected.refuse(&*self.world, request.graph, paths)?;
        let mut rendered = vec![];
        for (output, known) in outputs.iter().zip(known) {
            rendered.extend(match known {
                Some(maps) => output.announce(maps),
                None if built.has(output.index) => output.paint(&built)?,
                // An output that depends on a failed node does not keep the others from being rendered.
                None => vec![],
            });
        }
        built.complete()?;
        Ok(rendered)
    }
}

/// The outputs that the caller asks for.
fn chosen_outputs(request: &Render<'_>) -> Result<Vec<NodeIndex>, RunError> {
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
}

impl Output<'_> {
    pub(super) fn name(&self) -> &str {
        &self.request.graph.nodes[self.index].name
    }

    /// What the output is before anything has run.
    fn plan_key(&self) -> Key {
        let mut key = KeyHasher::new("output", RESULTS);
        key.key(self.plan.keys[&self.index]).text(self.name());
        key.whole(i64::from(self.engine.options.filtering));
        self.request.pixels.iter().flatten().for_each(|side| {
            key.whole(i64::from(*side));
        });
        key.finish()
    }

    /// The maps, if the store knows them all and they are in place or can be put there.
    fn known_maps(&self) -> Option<Vec<WantedMap>> {
        let store = self.engine.store.as_ref()?;
        let bytes = store.get("plan", &self.plan_key())?;
        let maps: Vec<WantedMap> = postcard::from_bytes(&bytes).ok()?;
        let is_allowed =
            |map: &WantedMap| self.protected.allows(&*self.engine.world, &self.path(map));
        if !maps.iter().all(is_allowed) {
            return None;
        }
        let events: Option<Vec<Event>> = maps.iter().map(|map| self.in_place(store, map)).collect();
        events?
            .into_iter()
            .for_each(|event| self.request.listener.hear(event));
        Some(maps)
    }

    fn path(&self, map: &WantedMap) -> PathBuf {
        self.request.folder.join(&map.file_name)
    }

    /// That the file is there as it should be, restored from the store if need be.
    fn in_place(&self, store: &Store, map: &WantedMap) -> Option<Event> {
        let record = store.map(&map.key)?;
        let path = self.path(map);
        let (output, channel) = (self.name().to_owned(), map.channel.clone());
        let [not_finite, clamped] = record.faults;
        if store.matches(&record, &map.key, &path) {
            return Some(Event::MapUpToDate {
                output,
                channel,
                path,
                not_finite,
                clamped,
            });
        }
        store.restore(&record, &path).then_some(Event::MapRestored {
            output,
            channel,
            path,
            not_finite,
            clamped,
        })
    }

    /// Paints what is not in place.
    fn paint(&self, built: &Built) -> Result<Vec<RenderedMap>, RunError> {
        let start = Instant::now();
        let maps = self.maps(built);
        let pixels = self.request.pixels.unwrap_or(maps.pixels);
        self.check_size(pixels)?;
        let target = FlatPiece::new(pixels, maps.size);
        let wanted = self.wanted_maps(maps, &target);
        let missing: Vec<&WantedMap> = wanted.iter().filter(|map| !self.found(map)).collect();
        let faults = if missing.is_empty() {
            vec![]
        } else {
            self.write_maps(maps, &target, &missing)?
        };
        self.remember(&wanted, missing.into_iter().zip(faults));
        let (output, milliseconds) = (self.name().to_owned(), start.elapsed().as_secs_f64() * 1e3);
        self.request.listener.hear(Event::OutputDone {
            output,
            milliseconds,
        });
        Ok(self.announce(wanted))
    }

    /// Whether the map is in place; says so.
    fn found(&self, map: &WantedMap) -> bool {
        let store = self.engine.store.as_ref();
        let event = store.and_then(|store| self.in_place(store, map));
        let found = event.is_some();
        event
            .into_iter()
            .for_each(|event| self.request.listener.hear(event));
        found
    }

    fn write_maps(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        missing: &[&WantedMap],
    ) -> Result<Vec<Faults>, RunError> {
        let sheets: io::Result<Vec<Sheet>> = missing
            .iter()
            .map(|map| self.sheet(maps, target, map))
            .collect();
        let mut sheets = sheets.map_err(|error| RunError::not_written(&error))?;
        let painter = Painter {
            output: self.name(),
            target,
            options: &self.engine.options,
            context: self.engine.context(),
            listener: self.request.listener,
            cancel: &self.request.cancel,
        };
        painter.paint(&mut sheets)?;
        let faults = sheets.iter().map(|sheet| sheet.faults).collect();
        for (sheet, map) in sheets.into_iter().zip(missing) {
            sheet
                .writer
                .finish()
                .map_err(|error| RunError::not_written(&error))?;
            self.request.listener.hear(Event::MapWritten {
                output: self.name().to_owned(),
                channel: map.channel.clone(),
                path: self.path(map),
                not_finite: sheet.faults.non_finite,
                clamped: sheet.faults.clamped,
            });
        }
        Ok(faults)
    }

    fn sheet(&self, maps: &Maps, target: &FlatPiece, map: &WantedMap) -> io::Result<Sheet> {
        let (field, kind) = self.field(maps, &map.channel);
        let request = MapRequest {
            pixels: target.pixels(),
            size_mm: maps.size,
            kind,
            format: maps.format,
            key: map.key,
            channel: map.channel.clone(),
        };
        let range = maps.ranges.get(&map.channel).copied();
        Ok(Sheet {
            field,
            encoder: Encoder::new(kind, maps.format, range),
            writer: output::create(&*self.engine.world, &self.path(map), &request)?,
            faults: Faults::default(),
        })
    }

    /// Tells the store what was written, and which maps the plan leads to.
    fn remember<'m>(
        &self,
        wanted: &[WantedMap],
        mut written: impl Iterator<Item = (&'m WantedMap, Faults)>,
    ) {
        let Some(store) = &self.engine.store else {
            return;
        };
        let stored = written
            .try_for_each(|(map, faults)| {
                let faults = [faults.non_finite, faults.clamped];
                store.put_map(&map.key, &self.path(map), faults)
            })
            .and_then(|()| postcard::to_stdvec(wanted).map_err(io::Error::other))
            .and_then(|bytes| store.put("plan", &self.plan_key(), &bytes));
        if let Err(error) = stored {
            self.request.listener.hear(Event::StoreFailed {
                reason: error.to_string(),
            });
        }
    }

    fn announce(&self, maps: Vec<WantedMap>) -> Vec<RenderedMap> {
        let rendered = |map: WantedMap| RenderedMap {
            output: self.name().to_owned(),
            path: self.path(&map),
            channel: map.channel,
        };
        maps.into_iter().map(rendered).collect()
    }
}
