//! The basic shapes and paths (2, chapters 9 and 10).

use super::super::path;
use super::super::pen::Pen;
use super::Complaints;
use super::attributes::length;
use glam::DVec2;
use roxmltree::Node;

/// Whether an element is a shape.
pub(super) fn is_shape(node: &Node<'_, '_>) -> bool {
    let shapes = ["path", "polygon", "polyline", "rect", "circle", "ellipse"];
    shapes.contains(&node.tag_name().name())
}

/// Draws a shape; percentages are of `view`.
///
/// # Errors
/// The character of a path where its first mistake is; what is before it is drawn.
pub(super) fn trace(
    node: &Node<'_, '_>,
    view: DVec2,
    pen: &mut Pen,
    complaints: &mut Complaints,
) -> Result<(), usize> {
    let mut of = |name: &str, whole: f64| length(node, name, whole, complaints);
    let mut pair = |x: &str, y: &str| {
        DVec2::new(
            of(x, view.x).unwrap_or_default(),
            of(y, view.y).unwrap_or_default(),
        )
    };
    match node.tag_name().name() {
        "path" => path::draw(node.attribute("d").unwrap_or_default(), pen)?,
        "rect" => {
            let (low, size) = (pair("x", "y"), pair("width", "height"));
            // One radius stands for both.
            let radii = ["rx", "ry"].map(|name| node.attribute(name).is_some());
            let radius = match radii {
                [true, false] => DVec2::splat(pair("rx", "ry").x),
                [false, true] => DVec2::splat(pair("rx", "ry").y),
                _ => pair("rx", "ry"),
            };
            if size.min_element() > 0.0 {
                pen.rectangle(low, low + size, radius.max(DVec2::ZERO));
            }
        }
        "circle" | "ellipse" => {
            let centre = pair("cx", "cy");
            let radius = match node.tag_name().name() {
                "circle" => {
                    let whole = view.length() * std::f64::consts::FRAC_1_SQRT_2;
                    DVec2::splat(of("r", whole).unwrap_or_default())
                }
                _ => pair("rx", "ry"),
            };
            if radius.min_element() > 0.0 {
                pen.ellipse(centre, radius);
            }
        }
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
