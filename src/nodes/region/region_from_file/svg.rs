//! Filled shapes of an SVG file (2, W3C 2018).

mod attributes;
mod shape;
mod viewport;

use super::pen::Pen;
use super::{Drawn, check_parts, refuse};
use crate::geometry::polygon::{Lattice, rings_of};
use crate::node::{Build, Failure, Inputs, counted};
use attributes::{length, line, property, transform};
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
    /// Width and height of what percentages are of.
    view: DVec2,
    /// The width and height that a `use` gives it.
    used_size: [Option<f64>; 2],
    is_even_odd: bool,
    is_filled: bool,
    is_visible: bool,
    /// Whether it is in one of the parts that are asked for.
    is_wanted: bool,
    uses: usize,
}

/// Most complaints that are told; what is left is counted.
const TOLD: usize = 12;

/// What was not understood or left out, each once.
#[derive(Debug, Default)]
struct Complaints {
    told: Vec<String>,
    more: usize,
}

impl Complaints {
    fn add(&mut self, complaint: String) {
        match self.told.len() {
            _ if self.told.contains(&complaint) => {}
            TOLD.. => self.more += 1,
            _ => self.told.push(complaint),
        }
    }
}

/// What is drawn so far.
struct Drawing<'a> {
    document: &'a Document<'a>,
    tolerance: f64,
    parts: &'a [String],
    drawn: Vec<Drawn>,
    complaints: Complaints,
    /// Shapes that have no fill.
    unfilled: usize,
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
    let mut drawing = Drawing {
        document: &document,
        tolerance: inputs.number("tolerance"),
        parts,
        drawn: vec![],
        complaints: Complaints::default(),
        unfilled: 0,
    };
    drawing.draw(root, build)?;
    drawing.finish(inputs)
}

impl<'a> Drawing<'a> {
    /// Draws all that is in an element.
    fn draw(&mut self, root: Node<'a, 'a>, build: &Build<'_>) -> Result<(), Failure> {
        let (place, view) = viewport::page(&root);
        let mut waiting = vec![Waiting {
            node: root,
            place,
            view,
            used_size: [None; 2],
            is_even_odd: false,
            is_filled: true,
            is_visible: true,
            is_wanted: self.parts.is_empty(),
            uses: 0,
        }];
        let mut count = 0;
        while let Some(mut next) = waiting.pop() {
            count += 1;
            if count > MOST {
                return Err(refuse(format!("the file draws more than {MOST} elements")));
            }
            build.go_on()?;
            if next.enter(self) {
                self.add(&next)?;
                waiting.extend(next.follow(self).into_iter().rev());
            }
        }
        Ok(())
    }

    /// What was drawn, after warnings; of a file without areas the first complaint says why.
    fn finish(self, inputs: &Inputs<'_>) -> Result<Vec<Drawn>, Failure> {
        let Complaints {
            told: mut complaints,
            more,
        } = self.complaints;
        if more > 0 {
            let more = counted(more, "more thing is", "more things are");
            complaints.push(format!("{more} not understood or left out"));
        }
        if self.unfilled > 0 {
            let shapes = counted(
                self.unfilled,
                "shape without a fill is",
                "shapes without a fill are",
            );
            complaints.push(format!(
                "{shapes} left out; those that `parts` names are taken"
            ));
        }
        if let (true, Some(first)) = (self.drawn.is_empty(), complaints.first()) {
            return Err(refuse(format!("the file has no areas: {first}")));
        }
        complaints
            .into_iter()
            .for_each(|complaint| inputs.warn(complaint));
        Ok(self.drawn)
    }

    /// Adds the polygons of an element, if it is a shape that is filled, or one that was asked for by its name.
    fn add(&mut self, it: &Waiting<'_>) -> Result<(), Failure> {
        if !shape::is_shape(&it.node) || !it.is_wanted || !it.is_visible {
            return Ok(());
        }
        if !it.is_filled && !it.is_named(self.parts) {
            self.unfilled += 1;
            return Ok(());
        }
        let name = self.name(&it.node);
        let rings = self.rings(it, &name);
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
        let filled = Lattice::around([low, high]).filled(&rings, it.is_even_odd);
        if rings_of(&filled).is_empty() {
            self.complaints
                .add(format!("{name} encloses no area; it is left out"));
        }
        self.drawn.extend(filled.into_iter().map(|polygon| Drawn {
            polygon,
            name: name.clone(),
        }));
        Ok(())
    }

    /// What to call an element.
    fn name(&self, node: &Node<'_, '_>) -> String {
        match node.attribute("id") {
            Some(id) => format!("`{id}`"),
            None => format!("the {} in line {}", node.tag_name().name(), line(node)),
        }
    }

    /// The rings of a shape in mm on the page.
    fn rings(&mut self, it: &Waiting<'_>, name: &str) -> Vec<Vec<DVec2>> {
        let axes = it.place.matrix2;
        let scale = axes.x_axis.length().max(axes.y_axis.length());
        let mut pen = Pen::new(self.tolerance / scale.max(1e-12));
        let traced = shape::trace(&it.node, it.view, &mut pen, &mut self.complaints);
        if let Err(at) = traced {
            self.complaints.add(format!(
                "{name} has a mistake in its data at character {at}; it is drawn up to there"
            ));
        }
        pen.drawn(it.place)
    }
}

impl<'a> Waiting<'a> {
    /// Whether `parts` has its own name.
    fn is_named(&self, parts: &[String]) -> bool {
        let id = self.node.attribute("id");
        id.is_some_and(|id| parts.iter().any(|part| part == id))
    }

    /// Takes on what its attributes say; whether what is in it may be drawn.
    fn enter(&mut self, drawing: &mut Drawing<'_>) -> bool {
        let node = self.node;
        if !node.is_element()
            || UNSEEN.contains(&node.tag_name().name())
            || property(&node, "display") == Some("none")
        {
            return false;
        }
        if node.tag_name().name() == "style" {
            let complaint =
                "style sheets are not regarded; only attributes and `style` of elements are";
            drawing.complaints.add(complaint.to_owned());
            return false;
        }
        self.is_wanted |= self.is_named(drawing.parts);
        self.inherit();
        for name in ["clip-path", "mask"] {
            if property(&node, name).is_some_and(|value| value != "none") {
                drawing.complaints.add(format!(
                    "a `{name}` is not regarded; what it hides is taken too"
                ));
            }
        }
        self.place *= transform(&node, &mut drawing.complaints);
        match node.tag_name().name() {
            "use" => {
                let [x, y] = [("x", 0), ("y", 1)].map(|(name, axis)| {
                    length(&node, name, self.view[axis], &mut drawing.complaints)
                });
                let at = DVec2::new(x.unwrap_or_default(), y.unwrap_or_default());
                self.place *= DAffine2::from_translation(at);
            }
            "svg" if node.parent_element().is_some() => self.enter_viewport(drawing),
            _ => {}
        }
        true
    }

    /// Takes on properties that go on to what is within.
    fn inherit(&mut self) {
        let node = &self.node;
        self.is_even_odd = match property(node, "fill-rule") {
            Some("evenodd") => true,
            Some("nonzero") => false,
            _ => self.is_even_odd,
        };
        self.is_filled = match property(node, "fill") {
            Some("none" | "transparent") => false,
            None | Some("inherit") => self.is_filled,
            Some(_) => true,
        };
        self.is_visible = match property(node, "visibility") {
            Some("hidden" | "collapse") => false,
            Some("visible") => true,
            _ => self.is_visible,
        };
    }

    /// Goes into the coordinates of a `symbol`, or of an `svg` in another.
    fn enter_viewport(&mut self, drawing: &mut Drawing<'_>) {
        let used = std::mem::take(&mut self.used_size);
        let mut of = |name: &str, axis: usize| {
            length(&self.node, name, self.view[axis], &mut drawing.complaints)
        };
        let at = DVec2::new(
            of("x", 0).unwrap_or_default(),
            of("y", 1).unwrap_or_default(),
        );
        let [width, height] = [("width", 0), ("height", 1)].map(|(name, axis)| {
            used[axis]
                .or_else(|| of(name, axis))
                .unwrap_or(self.view[axis])
        });
        let (place, view) = viewport::within(&self.node, at, DVec2::new(width, height));
        (self.place, self.view) = (self.place * place, view);
    }

    /// What is drawn behind it: what is in it, or what it uses.
    fn follow(self, drawing: &mut Drawing<'a>) -> Vec<Waiting<'a>> {
        let node = self.node;
        if node.tag_name().name() != "use" {
            return self.children();
        }
        let href = node
            .attributes()
            .find(|attribute| attribute.name() == "href");
        let id = href.and_then(|href| href.value().strip_prefix('#'));
        let used = id.and_then(|id| {
            drawing
                .document
                .descendants()
                .find(|node| node.attribute("id") == Some(id))
        });
        let Some(used) = used.filter(|_| self.uses < DEEPEST) else {
            let what = href.map_or("nothing".to_owned(), |href| format!("`{}`", href.value()));
            drawing.complaints.add(format!(
                "{} uses {what}, which is left out",
                drawing.name(&node)
            ));
            return vec![];
        };
        let used_size = [("width", 0), ("height", 1)]
            .map(|(name, axis)| length(&node, name, self.view[axis], &mut drawing.complaints));
        let mut next = Waiting {
            node: used,
            uses: self.uses + 1,
            used_size,
            ..self
        };
        if used.tag_name().name() != "symbol" {
            return vec![next];
        }
        next.inherit();
        next.enter_viewport(drawing);
        next.children()
    }

    fn children(self) -> Vec<Waiting<'a>> {
        let used_size = [None; 2];
        let child = |node| Waiting {
            node,
            used_size,
            ..self
        };
        self.node.children().map(child).collect()
    }
}
