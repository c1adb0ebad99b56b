//! Renders the outputs of a recipe: finds what is there already, and paints the rest.

use super::build::Built;
use super::event::{Event, Listener};
use super::paint::{Painter, Sheet};
use super::plan::Plan;
use super::store::Store;
use super::{Cancel, Engine, FlatPiece, RunError};
use crate::diagnostics::{Code, Diagnostic, nearest};
use crate::field::{Field, Target};
use crate::graph::{Graph, no_output};
use crate::key::{Key, KeyHasher};
use crate::nodes::output::normal_from_height;
use crate::output::{self, Encoder, Faults, MapKind, MapRequest};
use crate::value::{Maps, Value};
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
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
struct WantedMap {
    channel: String,
    file_name: String,
    key: Key,
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
        let mut rendered = vec![];
        let mut open = vec![];
        for index in wanted {
            let output = Output {
                engine: self,
                request,
                plan: &plan,
                index,
            };
            match output.known_maps() {
                Some(maps) => rendered.extend(output.announce(maps)),
                None => open.push(output),
            }
        }
        if !open.is_empty() {
            let missing: Vec<NodeIndex> = open.iter().map(|output| output.index).collect();
            let rest = self.plan(request.graph, &missing)?;
            let built = self.build(&rest, request.listener, &request.cancel)?;
            // An output that depends on a failed node does not keep the others from being rendered.
            for output in open.iter().filter(|output| built.has(output.index)) {
                rendered.extend(output.paint(&built)?);
            }
            built.complete()?;
        }
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
    let find = |name: &String| {
        let found = graph.outputs.iter().find(|index| name_of(index) == name);
        found.copied().ok_or_else(|| {
            let names: Vec<&str> = graph.outputs.iter().map(name_of).collect();
            let message = format!("the recipe has no output `{name}`");
            RunError::Request(vec![
                Diagnostic::error(Code::NoOutput, message)
                    .nearest(nearest(name, names.iter().copied()))
                    .hint(format!("its outputs are {}", names.join(", "))),
            ])
        })
    };
    request.only.iter().map(find).collect()
}

/// One output of a run.
struct Output<'a> {
    engine: &'a Engine,
    request: &'a Render<'a>,
    plan: &'a Plan<'a>,
    index: NodeIndex,
}

impl Output<'_> {
    fn name(&self) -> &str {
        &self.request.graph.nodes[self.index].name
    }

    /// What the output is before anything has run.
    fn plan_key(&self) -> Key {
        let mut key = KeyHasher::new("output", 1);
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
        maps.iter()
            .all(|map| self.in_place(store, map))
            .then_some(maps)
    }

    fn path(&self, map: &WantedMap) -> PathBuf {
        self.request.folder.join(&map.file_name)
    }

    /// Whether the file is there as it should be, restored from the store if need be.
    fn in_place(&self, store: &Store, map: &WantedMap) -> bool {
        let Some(record) = store.map(&map.key) else {
            return false;
        };
        let path = self.path(map);
        let (output, channel) = (self.name().to_owned(), map.channel.clone());
        if store.matches(&record, &map.key, &path) {
            self.request.listener.hear(Event::MapUpToDate {
                output,
                channel,
                path,
            });
            return true;
        }
        let restored = store.restore(&record, &path);
        if restored {
            self.request.listener.hear(Event::MapRestored {
                output,
                channel,
                path,
            });
        }
        restored
    }

    /// Paints what is not in place.
    fn paint(&self, built: &Built) -> Result<Vec<RenderedMap>, RunError> {
        let start = Instant::now();
        let Value::Maps(maps) = &built.values(self.index)[0] else {
            unreachable!("checking the recipe lets only maps be outputs")
        };
        let pixels = self.request.pixels.unwrap_or(maps.pixels);
        self.check_size(pixels)?;
        let target = FlatPiece::new(pixels, maps.size);
        let wanted = self.wanted_maps(maps, &target);
        let missing: Vec<&WantedMap> = wanted.iter().filter(|map| !self.found(map)).collect();
        if !missing.is_empty() {
            self.write_maps(maps, &target, &missing)?;
        }
        self.remember(&wanted, &missing);
        let (output, milliseconds) = (self.name().to_owned(), start.elapsed().as_secs_f64() * 1e3);
        self.request.listener.hear(Event::OutputDone {
            output,
            milliseconds,
        });
        Ok(self.announce(wanted))
    }

    fn found(&self, map: &WantedMap) -> bool {
        self.engine
            .store
            .as_ref()
            .is_some_and(|store| self.in_place(store, map))
    }

    fn check_size(&self, [width, height]: [u32; 2]) -> Result<(), RunError> {
        let (found, limit) = (
            u64::from(width) * u64::from(height),
            self.engine.options.largest_output,
        );
        if found <= limit {
            return Ok(());
        }
        let node = &self.request.graph.nodes[self.index];
        let message = format!("the maps would have {width} x {height} = {found} pixels");
        Err(RunError::Limit(vec![
            Diagnostic::error(Code::TooMuch, message)
                .at(&self.request.graph.source, node.span.clone(), "this output")
                .in_node(&*node.name)
                .expected(format!("at most {limit} pixels"), format!("{found} pixels"))
                .hint(format!(
                    "lower the resolution, or allow it with `--max-pixels {found}`"
                )),
        ]))
    }

    fn wanted_maps(&self, maps: &Maps, target: &FlatPiece) -> Vec<WantedMap> {
        let describe = |channel: &String| {
            let (field, kind) = self.field(maps, channel);
            let mut key = KeyHasher::new("map", 1);
            key.key(field.key())
                .key(target.key())
                .text(maps.format.name())
                .text(channel);
            key.whole(i64::from(self.engine.options.filtering));
            key.whole(kind.samples() as i64);
            maps.ranges
                .get(channel)
                .iter()
                .copied()
                .flatten()
                .for_each(|end| {
                    key.number(*end);
                });
            let extension = maps.format.extension();
            let file_name = format!("{}_{channel}.{extension}", self.name());
            WantedMap {
                channel: channel.clone(),
                file_name,
                key: key.finish(),
            }
        };
        maps.channels.iter().map(describe).collect()
    }

    /// The field of a channel, and what its samples are.
    fn field(&self, maps: &Maps, channel: &str) -> (Field, MapKind) {
        if channel == "normal" {
            let node: Arc<str> = self.name().into();
            return (
                normal_from_height(&node, &maps.material.channels["height"]),
                MapKind::Normal,
            );
        }
        let field = maps.material.channels[channel].clone();
        let kind = if field.width() == 3 {
            MapKind::Colour
        } else {
            MapKind::Number
        };
        (field, kind)
    }

    fn write_maps(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        missing: &[&WantedMap],
    ) -> Result<(), RunError> {
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
        Ok(())
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
    fn remember(&self, wanted: &[WantedMap], written: &[&WantedMap]) {
        let Some(store) = &self.engine.store else {
            return;
        };
        let stored = written
            .iter()
            .try_for_each(|map| store.put_map(&map.key, &self.path(map)))
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
