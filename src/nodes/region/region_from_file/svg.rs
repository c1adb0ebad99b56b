//! Filled shapes of an SVG file (2, W3C 2018).

mod attributes;

use super::pen::Pen;
use super::{Drawn, check_parts, path, refuse};
use crate::geometry::polygon::{Lattice, rings_of};
use crate::node::{Build, Failure, Inputs};
use attributes::{number, page, property, transform};
use glam::{DAffine2, DVec2};
use roxmltree::{Document, Node, ParsingOptions};

/// How many times `use` may lead on.
const DEEPEST: usize = 16;

/// Most elements that are drawn.
const MOST: usize = 1_000_000;

/// Elements whose contents are not drawn where they stand.
const UNSEEN: [&str; 8] = [
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "pattern",
    "marker",
    "metadata",
    "foreignObject",
];

/// An element that waits to be drawn.
#[derive(Clone, Copy)]
struct Waiting<'a> {
    node: Node<'a, 'a>,
    /// From its coordinates to mm on the page, upwards.
    place: DAffine2,
    is_even_odd: bool,
    /// Whether it is in one of the parts that are asked for.
    is_wanted: bool,
    uses: usize,
}

/// The filled shapes of the elements that belong to `parts`, in mm on the page.
pub(super) fn read(
    text: &str,
    parts: &[String],
    inputs: &Inputs<'_>,
    build: &Build<'_>,
) -> Result<Vec<Drawn>, Failure> {
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: MOST as u32,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| refuse(format!("the file is no SVG: {error}")))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let message = format!("the file is no SVG: it is a `{}`", root.tag_name().name());
        return Err(refuse(message).with_hint("GeoJSON (RFC 7946) and SVG are read"));
    }
    let ids = || {
        document
            .descendants()
            .filter_map(|node| node.attribute("id"))
    };
    check_parts(
        parts,
        |part| ids().any(|id| id == part),
        ids().map(str::to_owned).collect(),
    )?;
    let mut waiting = vec![Waiting {
        node: root,
        place: page(&root),
        is_even_odd: false,
        is_wanted: parts.is_empty(),
        uses: 0,
    }];
    let (mut drawn, mut count) = (vec![], 0);
    while let Some(mut next) = waiting.pop() {
        count += 1;
        if count > MOST {
            return Err(refuse(format!("the file draws more than {MOST} elements")));
        }
        build.go_on()?;
        if !next.enter(parts) {
            continue;
        }
        next.draw(&document, inputs, &mut drawn)?;
        let follow = next.follow(&document);
        waiting.extend(follow.into_iter().rev());
    }
    Ok(drawn)
}

impl<'a> Waiting<'a> {
    /// Takes on what its attributes say; whether it is seen.
    fn enter(&mut self, parts: &[String]) -> bool {
        let node = self.node;
        if !node.is_element()
            || UNSEEN.contains(&node.tag_name().name())
            || property(&node, "display") == Some("none")
        {
            return false;
        }
        self.is_wanted |= node
            .attribute("id")
            .is_some_and(|id| parts.iter().any(|part| part == id));
        self.is_even_odd = match property(&node, "fill-rule") {
            Some("evenodd") => true,
            Some("nonzero") => false,
            _ => self.is_even_odd,
        };
        if let Some(text) = node.attribute("transform") {
            self.place *= transform(text);
        }
        let is_moved = node.tag_name().name() == "use"
            || node.tag_name().name() == "svg" && self.uses + node.ancestors().count() > 2;
        if is_moved {
            self.place *=
                DAffine2::from_translation(DVec2::new(number(&node, "x"), number(&node, "y")));
        }
        true
    }

    /// What is drawn behind it: what is in it, or what it uses.
    fn follow(self, document: &'a Document<'a>) -> Vec<Waiting<'a>> {
        let node = self.node;
        if node.tag_name().name() != "use" {
            return node
                .children()
                .map(|node| Waiting { node, ..self })
                .collect();
        }
        let href = node
            .attributes()
            .find(|attribute| attribute.name() == "href");
        let id = href.and_then(|href| href.value().strip_prefix('#'));
        let used = id.and_then(|id| {
            document
                .descendants()
                .find(|node| node.attribute("id") == Some(id))
        });
        let Some(used) = used.filter(|_| self.uses < DEEPEST) else {
            return vec![];
        };
        let uses = self.uses + 1;
        let of_symbol = used.children().map(|node| Waiting { node, uses, ..self });
        match used.tag_name().name() {
            "symbol" => of_symbol.collect(),
            _ => vec![Waiting {
                node: used,
                uses,
                ..self
            }],
        }
    }

    /// Adds the polygons of an element, if it is a shape.
    fn draw(
        &self,
        document: &Document<'_>,
        inputs: &Inputs<'_>,
        drawn: &mut Vec<Drawn>,
    ) -> Result<(), Failure> {
        let node = &self.node;
        let shape = node.tag_name().name();
        let is_shape =
            ["path", "polygon", "polyline", "rect", "circle", "ellipse"].contains(&shape);
        if !is_shape || !self.is_wanted {
            return Ok(());
        }
        let name = match node.attribute("id") {
            Some(id) => format!("`{id}`"),
            None => format!(
                "the {shape} in line {}",
                document.text_pos_at(node.range().start).row
            ),
        };
        let scale = self
            .place
            .matrix2
            .x_axis
            .length()
            .max(self.place.matrix2.y_axis.length());
        let mut pen = Pen::new(inputs.number("tolerance") / scale.max(1e-12));
        if let Err(at) = trace(node, &mut pen) {
            inputs.warn(format!(
                "{name} has a mistake in its data at character {at}; it is drawn up to there"
            ));
        }
        let rings = pen.drawn(self.place);
        let corners = || rings.iter().flatten().copied();
        let is_finite =
            corners().all(|corner| corner.is_finite() && corner.abs().max_element() < 1e12);
        if !is_finite {
            return Err(refuse(format!("{name} has corners that are too far off")));
        }
        let Some(first) = corners().next() else {
            return Ok(());
        };
        let (low, high) = corners().fold((first, first), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        let rings: Vec<&[DVec2]> = rings.iter().map(|ring| &ring[..]).collect();
        let filled = Lattice::around([low, high]).filled(&rings, self.is_even_odd);
        if rings_of(&filled).is_empty() {
            inputs.warn(format!("{name} encloses no area; it is left out"));
        }
        drawn.extend(filled.into_iter().map(|polygon| Drawn {
            polygon,
            name: name.clone(),
        }));
        Ok(())
    }
}

/// Draws a shape.
fn trace(node: &Node<'_, '_>, pen: &mut Pen) -> Result<(), usize> {
    let of = |name: &str| number(node, name);
    let pair = |x: &str, y: &str| DVec2::new(of(x), of(y));
    match node.tag_name().name() {
        "path" => path::draw(node.attribute("d").unwrap_or_default(), pen)?,
        "rect" => {
            let (low, size) = (pair("x", "y"), pair("width", "height").max(DVec2::ZERO));
            // One radius stands for both.
            let radius = |name: &str, other: &str| match node.attribute(name) {
                Some(_) => of(name),
                None => of(other),
            };
            pen.rectangle(
                low,
                low + size,
                DVec2::new(radius("rx", "ry"), radius("ry", "rx")).max(DVec2::ZERO),
            );
        }
        "circle" => pen.ellipse(pair("cx", "cy"), DVec2::splat(of("r"))),
        "ellipse" => pen.ellipse(pair("cx", "cy"), pair("rx", "ry")),
        _ => {
            let numbers = path::numbers(node.attribute("points").unwrap_or_default());
            let mut points = numbers
                .chunks_exact(2)
                .map(|pair| DVec2::new(pair[0], pair[1]));
            points
                .next()
                .into_iter()
                .for_each(|point| pen.move_to(point));
            points.for_each(|point| pen.line_to(point));
        }
    }
    Ok(())
}
