//! Writes the maps of an output that are missing.

use super::event::{Event, Spot};
use super::paint::{Painter, Sheet};
use super::progress::Meter;
use super::render::{Output, WantedMap};
use super::store::MapRecord;
use super::wanted::Files;
use super::{FlatPiece, RunError};
use crate::field::{ColumnCache, Field, Program, RunContext, Target};
use crate::output::{self, Contents, Encoder, Faults, MapRequest, MapWriter, Placing};
use crate::value::{Maps, Table};
use rayon::prelude::*;
use std::io::{self, Write};
use std::path::Path;

/// What is known of a map that is in its place.
#[derive(Clone)]
pub(super) struct Written {
    /// What is wrong with its samples.
    pub(super) faults: Faults,
    /// Where the first sample is that is not finite.
    pub(super) first_not_finite: Option<Spot>,
    /// Its hash and size, if there is a store to remember them.
    pub(super) contents: Contents,
}

impl Written {
    /// What the store may remember; `None` if nothing was noted for it.
    pub(super) fn record(&self) -> Option<MapRecord> {
        let (file, bytes) = *self.contents.get()?;
        Some(MapRecord {
            faults: [self.faults.non_finite, self.faults.clamped],
            file,
            bytes,
            first_not_finite: self.first_not_finite,
        })
    }
}

impl Output<'_> {
    /// Writes files and puts them in their places; gives what is known of each then.
    pub(super) fn write(
        &self,
        files: Files<'_>,
        missing: &[&WantedMap],
        meter: &Meter<'_>,
    ) -> Result<Vec<Written>, RunError> {
        match files {
            Files::Maps(maps) => self.write_maps(maps, &self.target(maps), missing, meter),
            Files::Table(table) => {
                let write = |map: &&WantedMap| self.write_table(table, map);
                missing.iter().map(write).collect()
            }
        }
    }

    fn write_table(&self, table: &Table, map: &WantedMap) -> Result<Written, RunError> {
        let (path, contents) = (self.path(map), Contents::default());
        let write = || {
            let file = self.engine.world.create(&path)?;
            let mut file = self.placing(&contents).of(file);
            file.write_all(table.text.as_bytes())?;
            file.commit()
        };
        let written = write().map_err(|error| RunError::not_written(&output::about(&path, &error)));
        written.inspect(|()| {
            self.request.listener.hear(Event::MapWritten {
                output: self.name().to_owned(),
                channel: map.channel.clone(),
                path: path.clone(),
                not_finite: 0,
                first_not_finite: None,
                clamped: 0,
            });
        })?;
        Ok(Written {
            faults: Faults::default(),
            first_not_finite: None,
            contents,
        })
    }

    /// Paints maps and puts them in their places; gives what is known of each then.
    fn write_maps(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        missing: &[&WantedMap],
        meter: &Meter<'_>,
    ) -> Result<Vec<Written>, RunError> {
        let field = |map: &&WantedMap| self.field(maps, &map.channel).0;
        let fields: Vec<Field> = missing.iter().map(field).collect();
        let cancel = &self.engine.cancel;
        let program = Program::compile_until(&fields, maps.material.charts(), cancel)
            .ok_or(RunError::Cancelled)?;
        self.check_program(&program)?;
        let contents: Vec<Contents> = missing.iter().map(|_| Contents::default()).collect();
        let sheets: io::Result<Vec<Sheet>> = missing
            .iter()
            .zip(&contents)
            .map(|(map, contents)| self.sheet(maps, target, map, contents))
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
        let wrong = |sheet: &Sheet| (sheet.faults, sheet.first_not_finite);
        let wrong: Vec<_> = sheets.iter().map(wrong).collect();
        self.finish(sheets, missing)?;
        let written = wrong.into_iter().zip(contents);
        Ok(written
            .map(|((faults, first_not_finite), contents)| Written {
                faults,
                first_not_finite,
                contents,
            })
            .collect())
    }

    /// Puts the maps in their places, all at the same time, since the disk takes its time over each.
    fn finish(&self, sheets: Vec<Sheet>, maps: &[&WantedMap]) -> Result<(), RunError> {
        let finish = |sheet: Sheet| {
            let wrong = (sheet.faults, sheet.first_not_finite);
            (wrong, sheet.writer.finish())
        };
        let finished: Vec<_> = sheets.into_par_iter().map(finish).collect();
        let mut result = Ok(());
        for (((faults, first_not_finite), written), map) in finished.into_iter().zip(maps) {
            match written {
                Ok(()) => self.request.listener.hear(Event::MapWritten {
                    output: self.name().to_owned(),
                    channel: map.channel.clone(),
                    path: self.path(map),
                    not_finite: faults.non_finite,
                    first_not_finite,
                    clamped: faults.clamped,
                }),
                Err(error) => result = result.and(Err(RunError::not_written(&error))),
            }
        }
        result
    }

    fn sheet(
        &self,
        maps: &Maps,
        target: &FlatPiece,
        map: &WantedMap,
        contents: &Contents,
    ) -> io::Result<Sheet> {
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
        Ok(Sheet {
            encoder: Encoder::new(kind, maps.format, range),
            writer: self.writer(&self.path(map), &request, contents)?,
            faults: Faults::default(),
            first_not_finite: None,
        })
    }

    fn writer(
        &self,
        path: &Path,
        request: &MapRequest,
        contents: &Contents,
    ) -> io::Result<Box<dyn MapWriter>> {
        let engine = &self.engine;
        let placing = self.placing(contents);
        output::create_placing(&*engine.world, path, request, &engine.cancel, placing)
    }

    fn placing(&self, contents: &Contents) -> Placing {
        Placing {
            durable: self.engine.options.durable,
            contents: self
                .engine
                .store
                .is_some()
                .then(|| Contents::clone(contents)),
        }
    }
}
