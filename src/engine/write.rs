//! Writes the maps of an output that are missing.

use super::event::Event;
use super::paint::{Painter, Sheet};
use super::progress::Meter;
use super::render::{Output, WantedMap};
use super::{FlatPiece, RunError};
use crate::field::{ColumnCache, Field, Program, RunContext, Target};
use crate::output::{self, Encoder, Faults, MapRequest};
use crate::value::Maps;
use rayon::prelude::*;
use std::io;

impl Output<'_> {
    /// Paints maps and puts them in their places; gives what is wrong with the samples of each.
    pub(super) fn write_maps(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        missing: &[&WantedMap],
        meter: &Meter<'_>,
    ) -> Result<Vec<Faults>, RunError> {
        let field = |map: &&WantedMap| self.field(maps, &map.channel).0;
        let fields: Vec<Field> = missing.iter().map(field).collect();
        let cancel = &self.engine.cancel;
        let program = Program::compile_until(&fields, cancel).ok_or(RunError::Cancelled)?;
        self.check_program(&program)?;
        let sheets: io::Result<Vec<Sheet>> = missing
            .iter()
            .map(|map| self.sheet(maps, target, map))
            .collect();
        let mut sheets = sheets.map_err(|error| RunError::not_written(&error))?;
        let (context, columns) = (self.engine.context(), self.verified_columns());
        let columns = columns.as_ref().map(|it| it as &dyn ColumnCache);
        let painter = Painter {
            output: self.name(),
            program: &program,
            target,
            options: &self.engine.options,
            context: RunContext {
                cache: columns.or(context.cache),
                ..context
            },
            listener: self.request.listener,
            cancel,
            meter,
        };
        painter.paint(&mut sheets)?;
        let faults = sheets.iter().map(|sheet| sheet.faults).collect();
        self.finish(sheets, missing)?;
        Ok(faults)
    }

    /// Puts the maps in their places, all at the same time, since the disk takes its time over each.
    fn finish(&self, sheets: Vec<Sheet>, maps: &[&WantedMap]) -> Result<(), RunError> {
        let finish = |sheet: Sheet| (sheet.faults, sheet.writer.finish());
        let finished: Vec<(Faults, io::Result<()>)> = sheets.into_par_iter().map(finish).collect();
        let mut result = Ok(());
        for ((faults, written), map) in finished.into_iter().zip(maps) {
            match written {
                Ok(()) => self.request.listener.hear(Event::MapWritten {
                    output: self.name().to_owned(),
                    channel: map.channel.clone(),
                    path: self.path(map),
                    not_finite: faults.non_finite,
                    clamped: faults.clamped,
                }),
                Err(error) => result = result.and(Err(RunError::not_written(&error))),
            }
        }
        result
    }

    fn sheet(&self, maps: &Maps, target: &FlatPiece, map: &WantedMap) -> io::Result<Sheet> {
        let (_, kind) = self.field(maps, &map.channel);
        let request = MapRequest {
            pixels: target.pixels(),
            size_mm: maps.size,
            kind,
            format: maps.format,
            key: map.key,
            channel: map.channel.clone(),
        };
        let range = maps.ranges.get(&map.channel).copied();
        let (world, cancel) = (&*self.engine.world, &self.engine.cancel);
        let create = if self.engine.options.durable {
            output::create_durable
        } else {
            output::create_until
        };
        Ok(Sheet {
            encoder: Encoder::new(kind, maps.format, range),
            writer: create(world, &self.path(map), &request, cancel)?,
            faults: Faults::default(),
        })
    }
}
