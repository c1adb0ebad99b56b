//! Small pictures of outputs, first coarse and then finer, for eyes that do not want to wait.

use super::event::Event;
use super::files;
use super::paint::{Painter, Sheet};
use super::progress::Meter;
use super::render::{Output, Render, chosen_outputs};
use super::wanted::Files;
use super::{Engine, FlatPiece, RunError};
use crate::field::{Program, Target};
use crate::key::{Key, KeyHasher};
use crate::output::{self, Encoder, Faults, MapKind, MapRequest};
use crate::value::{MapFormat, Maps};
use crate::world::World;
use petgraph::graph::NodeIndex;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest side of the first picture, in pixels.
const COARSEST: u32 = 32;

/// Longest side of the last one.
const FINEST: u32 = 512;

/// How much longer a picture of twice the side may take than the one before.
const GROWTH: u32 = 5;

impl Engine {
    /// Writes small pictures of those outputs that are not known yet, or that have one of another state, as `NAME.preview.png` in the request's
    /// folder: each replaced by finer ones as long as these are likely to be done within `time`. They show
    /// the base colour, or the first channel of what has none. Gives the files.
    ///
    /// # Errors
    /// As [`Engine::render`]; outputs that depend on a failed node have no picture.
    pub fn preview(
        &self,
        request: &Render<'_>,
        inputs: &Arc<dyn World>,
        time: Duration,
    ) -> Result<Vec<PathBuf>, RunError> {
        let end = Instant::now() + time;
        let run = self.until(&request.cancel, inputs);
        self.threads
            .install(|| run.ended(run.preview_outputs(request, end), request.listener))
    }

    fn preview_outputs(
        &self,
        request: &Render<'_>,
        end: Instant,
    ) -> Result<Vec<PathBuf>, RunError> {
        let wanted = chosen_outputs(request)?;
        let plan = self.plan(request.graph, &wanted)?;
        let protected = files::Protected::new(&*self.world, &plan, self.options.store.as_deref());
        let outputs = self.outputs(request, &plan, &protected, &wanted);
        let is_new = |output: &&Output<'_>| output.known().is_none() || output.has_other_preview();
        let missing: Vec<&Output<'_>> = outputs.iter().filter(is_new).collect();
        let indices: Vec<NodeIndex> = missing.iter().map(|output| output.index).collect();
        let built = self.build(&plan.part(&indices), request.listener)?;
        let there = missing.into_iter().filter(|output| built.has(output.index));
        // A table has no picture.
        let maps = there.filter_map(|output| match output.files(&built) {
            Files::Maps(maps) => Some((output, maps)),
            Files::Table(_) => None,
        });
        let there: Vec<(&Output<'_>, &Maps)> = maps.collect();
        let paths = there
            .iter()
            .map(|(output, _)| (output.index, output.preview_path()));
        let paths: Vec<(NodeIndex, PathBuf)> = paths.collect();
        let borrowed = paths.iter().map(|(index, path)| (*index, path.as_path()));
        protected.refuse(&*self.world, request.graph, borrowed)?;
        for (done, (output, maps)) in there.iter().enumerate() {
            // Each output has its share of the time that is left.
            let left = end.saturating_duration_since(Instant::now());
            let share = left / u32::try_from(there.len() - done).unwrap_or(u32::MAX);
            output.preview(maps, Instant::now() + share)?;
        }
        Ok(paths.into_iter().map(|(_, path)| path).collect())
    }
}

impl Output<'_> {
    fn preview_path(&self) -> PathBuf {
        let name = format!("{}.preview.png", self.name());
        self.request.folder.join(name)
    }

    /// What a small picture of the output as it is planned carries.
    fn preview_key(&self) -> Key {
        KeyHasher::new("preview", 1).key(self.plan_key()).finish()
    }

    /// Whether there is a small picture, but of another state of the recipe.
    fn has_other_preview(&self) -> bool {
        let key = output::read_key(&*self.engine.world, &self.preview_path());
        key.is_some_and(|key| key != self.preview_key())
    }

    /// Writes pictures until the next one would likely be late.
    fn preview(&self, maps: &Maps, end: Instant) -> Result<(), RunError> {
        let channel = match maps
            .channels
            .iter()
            .find(|channel| *channel == "base_color")
        {
            Some(channel) => channel,
            None => &maps.channels[0],
        };
        let (field, kind) = self.field(maps, channel);
        let program = Program::compile_in_charts(&[field], maps.material.charts());
        self.check_program(&program)?;
        let full = self.pixels(maps);
        let mut side = COARSEST;
        loop {
            let start = Instant::now();
            let target = FlatPiece::of(maps, scaled(full, side));
            self.write_preview(maps, &target, &program, (channel, kind))?;
            let is_whole = side >= FINEST.min(full[0].max(full[1]));
            if is_whole || Instant::now() + GROWTH * start.elapsed() > end {
                return Ok(());
            }
            side *= 2;
        }
    }

    fn write_preview(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        program: &Program,
        (channel, kind): (&str, MapKind),
    ) -> Result<(), RunError> {
        let not_written = |error| RunError::not_written(&error);
        let request = MapRequest {
            pixels: target.pixels(),
            size_mm: maps.size,
            kind,
            format: MapFormat::Png8,
            key: self.preview_key(),
            channel: channel.to_owned(),
        };
        let range = maps.ranges.get(channel).copied();
        let (world, cancel) = (&*self.engine.world, &self.engine.cancel);
        let writer = output::create_until(world, &self.preview_path(), &request, cancel);
        let mut sheets = [Sheet {
            encoder: Encoder::new(kind, request.format, range),
            writer: writer.map_err(not_written)?,
            faults: Faults::default(),
            first_not_finite: None,
        }];
        // Of the picture itself all is told that has to be told.
        let nobody = |_: Event| {};
        let painter = Painter {
            output: self.name(),
            program,
            target,
            options: &self.engine.options,
            context: self.engine.context(),
            listener: &nobody,
            cancel: &self.request.cancel,
            meter: &Meter::new(&nobody),
        };
        painter.paint(&mut sheets)?;
        sheets
            .into_iter()
            .try_for_each(|sheet| sheet.writer.finish())
            .map_err(not_written)
    }
}

/// The size in pixels of a picture whose longer side has at most `side`, in the proportions of `full`.
fn scaled(full: [u32; 2], side: u32) -> [u32; 2] {
    let longest = full[0].max(full[1]);
    if longest <= side {
        return full;
    }
    let part = |length: u32| u64::from(length) * u64::from(side) / u64::from(longest);
    full.map(|length| u32::try_from(part(length)).unwrap_or(side).max(1))
}
