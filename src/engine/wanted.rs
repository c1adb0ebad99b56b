//! What an output asks for: its maps, their fields, files and keys, and whether they are too large.

use super::build::Built;
use super::known::KnownMap;
use super::render::{Output, WantedMap};
use super::{FlatPiece, RESULTS, RunError, files};
use crate::diagnostics::{Code, Diagnostic};
use crate::field::{Field, Program, Target};
use crate::key::KeyHasher;
use crate::nodes::output::normal_from_height;
use crate::output::{LARGEST_BMP, MapKind, bmp_bytes};
use crate::value::{FileType, Maps, Table, Value};
use petgraph::graph::NodeIndex;
use std::sync::Arc;

/// Most bytes that the columns of a tile may take in each thread.
const TILE_BYTES: usize = 1 << 30;

/// Most operations that the programs of an output may have, those for single pixels included.
const OPERATIONS: usize = 4_000_000;

/// What an output asks for.
#[derive(Clone, Copy)]
pub(super) enum Files<'a> {
    Maps(&'a Maps),
    Table(&'a Table),
}

impl Output<'_> {
    pub(super) fn files<'b>(&self, built: &'b Built) -> Files<'b> {
        match &built.values(self.index)[0] {
            Value::Maps(maps) => Files::Maps(maps),
            Value::Table(table) => Files::Table(table),
            _ => unreachable!("checking the recipe lets only maps and tables be outputs"),
        }
    }

    /// The files that the output writes or has written, with its own index.
    pub(super) fn file_names(
        &self,
        known: Option<&[KnownMap]>,
        built: &Built,
    ) -> Vec<(NodeIndex, String)> {
        let names: Vec<String> = match known {
            Some(maps) => maps.iter().map(|it| it.map.file_name.clone()).collect(),
            None if !built.has(self.index) => vec![],
            None => match self.files(built) {
                Files::Maps(maps) => {
                    let name =
                        |channel: &String| files::file_name(self.name(), channel, maps.format);
                    maps.channels.iter().map(name).collect()
                }
                Files::Table(_) => vec![files::table_name(self.name())],
            },
        };
        names.into_iter().map(|name| (self.index, name)).collect()
    }

    /// Refuses maps that are larger than the run or their format allows.
    pub(super) fn check_size(&self, files: Files<'_>) -> Result<(), RunError> {
        let Files::Maps(maps) = files else {
            return Ok(());
        };
        let [width, height] = self.pixels(maps);
        let (found, limit) = (
            u64::from(width) * u64::from(height),
            self.engine.options.largest_output,
        );
        if found <= limit {
            return self.check_bmp(maps, [width, height]);
        }
        let message = format!("the maps would have {width} x {height} = {found} pixels");
        let hint = format!("lower the resolution, or allow it with `--max-pixels {found}`");
        Err(self.too_much(message, limit, found, "pixels", hint))
    }

    /// Refuses programs that no machine would get through.
    pub(super) fn check_program(&self, program: &Program) -> Result<(), RunError> {
        let bytes = program.tile_bytes(self.engine.options.tile as usize);
        let operations = program.most_operations();
        if bytes > TILE_BYTES {
            let message = format!(
                "each tile needs {} pixels around it, since many nodes look at their neighbours",
                program.margin()
            );
            let hint = "shorten the chains of thresholds, `min` and `max`, or use `--tile`";
            return Err(self.too_much(message, TILE_BYTES as u64, bytes as u64, "bytes", hint));
        }
        if operations > OPERATIONS {
            let message =
                "the maps depend on too many nodes of which single pixels may be supersampled";
            let hint = "shorten the chains of thresholds, `min` and `max`";
            let (limit, found) = (OPERATIONS as u64, operations as u64);
            return Err(self.too_much(message, limit, found, "operations", hint));
        }
        Ok(())
    }

    fn too_much(
        &self,
        message: impl Into<String>,
        limit: u64,
        found: u64,
        of: &str,
        hint: impl Into<String>,
    ) -> RunError {
        let node = &self.request.graph.nodes[self.index];
        RunError::Limit(vec![
            Diagnostic::error(Code::TooMuch, message)
                .at(&node.origin.source, node.span.clone(), "this output")
                .in_node(&*node.name)
                .expected(format!("at most {limit} {of}"), format!("{found} {of}"))
                .hint(hint),
        ])
    }

    fn check_bmp(&self, maps: &Maps, pixels: [u32; 2]) -> Result<(), RunError> {
        if maps.format.file_type() != FileType::Bmp {
            return Ok(());
        }
        let sizes = maps.channels.iter().map(|channel| {
            let (_, kind) = self.field(maps, channel);
            (bmp_bytes(pixels, kind), channel)
        });
        let Some((found, channel)) = sizes.max() else {
            return Ok(());
        };
        if found <= LARGEST_BMP {
            return Ok(());
        }
        let node = &self.request.graph.nodes[self.index];
        let format = node.kind.input("format");
        let span = format.map_or(&node.span, |(index, _)| &node.inputs[index].span);
        let [width, height] = pixels;
        let message = format!(
            "a BMP of `{channel}` with {width} x {height} pixels would have {found} bytes; the largest has \
             {LARGEST_BMP}"
        );
        Err(RunError::Limit(vec![
            Diagnostic::error(Code::TooMuch, message)
                .at(&self.request.graph.source, span.clone(), "this format")
                .in_node(&*node.name)
                .expected(
                    format!("at most {LARGEST_BMP} bytes"),
                    format!("{found} bytes"),
                )
                .hint("lower the resolution, or write PNG or TIFF"),
        ]))
    }

    /// Width and height in pixels, as the run or the recipe states them.
    pub(super) fn pixels(&self, maps: &Maps) -> [u32; 2] {
        self.request.pixels.unwrap_or(maps.pixels)
    }

    /// How many files there are, and how many pixels each has; a table counts as one.
    pub(super) fn work(&self, files: Files<'_>) -> (usize, [u32; 2]) {
        match files {
            Files::Maps(maps) => (maps.channels.len(), self.pixels(maps)),
            Files::Table(_) => (1, [1, 1]),
        }
    }

    /// Name and key of each file.
    pub(super) fn wanted(&self, files: Files<'_>) -> Vec<WantedMap> {
        match files {
            Files::Maps(maps) => self.wanted_maps(maps, &self.target(maps)),
            Files::Table(table) => {
                let key = KeyHasher::new("table", RESULTS).text(&table.text).finish();
                vec![WantedMap {
                    channel: files::TABLE.to_owned(),
                    file_name: files::table_name(self.name()),
                    key,
                }]
            }
        }
    }

    /// Where maps are sampled.
    pub(super) fn target(&self, maps: &Maps) -> FlatPiece {
        FlatPiece::new(self.pixels(maps), maps.size)
    }

    fn wanted_maps(&self, maps: &Maps, target: &FlatPiece) -> Vec<WantedMap> {
        let describe = |channel: &String| {
            let (field, kind) = self.field(maps, channel);
            let mut key = KeyHasher::new("map", RESULTS);
            key.key(field.key())
                .key(target.key())
                .text(maps.format.name())
                .text(channel);
            maps.material.charts().iter().for_each(|chart| {
                key.text("chart").key(chart.key());
            });
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
            WantedMap {
                channel: channel.clone(),
                file_name: files::file_name(self.name(), channel, maps.format),
                key: key.finish(),
            }
        };
        maps.channels.iter().map(describe).collect()
    }

    /// The field of a channel, and what its samples are.
    pub(super) fn field(&self, maps: &Maps, channel: &str) -> (Field, MapKind) {
        if channel == "normal" {
            let node: Arc<str> = self.name().into();
            return (normal_from_height(&node, &maps.material), MapKind::Normal);
        }
        let field = maps.material.channels[channel].clone();
        let kind = if field.width() == 3 {
            MapKind::Colour
        } else {
            MapKind::Number
        };
        (field, kind)
    }
}
