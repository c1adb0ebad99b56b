//! Pages and viewports: from the coordinates of a drawing to those around it (2, chapter 8).

use super::super::path;
use super::attributes::pixels;
use glam::{DAffine2, DVec2};
use roxmltree::Node;

/// Millimetres of a CSS pixel.
const PIXEL: f64 = 25.4 / 96.0;

/// From the coordinates of the file to mm on its page, upwards, and what percentages are of.
pub(super) fn page(root: &Node<'_, '_>) -> (DAffine2, DVec2) {
    let lengths = ["width", "height"].map(|name| {
        let length = pixels(root.attribute(name)?, None)?;
        (length > 0.0).then_some(length)
    });
    let view = view_box(root).map(|[_, size]| size);
    // The page is as large as it says, or else as its one length or its box makes it.
    let size = match (lengths, view) {
        ([Some(width), Some(height)], _) => DVec2::new(width, height),
        ([Some(width), None], Some(view)) => view * (width / view.x),
        ([None, Some(height)], Some(view)) => view * (height / view.y),
        ([width, height], None) => {
            DVec2::new(width.unwrap_or_default(), height.unwrap_or_default())
        }
        ([None, None], Some(view)) => view,
    };
    let flip = DAffine2::from_cols_array(&[PIXEL, 0.0, 0.0, -PIXEL, 0.0, PIXEL * size.y]);
    let (place, view) = within(root, DVec2::ZERO, size);
    (flip * place, view)
}

/// From the coordinates within an element to those around it, where it lies `at` and has a size; and what percentages
/// in it are of.
pub(super) fn within(node: &Node<'_, '_>, at: DVec2, size: DVec2) -> (DAffine2, DVec2) {
    let Some([corner, view]) = view_box(node) else {
        return (DAffine2::from_translation(at), size);
    };
    let scales = size / view;
    let ratio = node.attribute("preserveAspectRatio").unwrap_or_default();
    let scale = match ratio {
        _ if ratio.trim_start().starts_with("none") => scales,
        _ if ratio.contains("slice") => DVec2::splat(scales.max_element()),
        _ => DVec2::splat(scales.min_element()),
    };
    let share = |low: &str, high: &str| match ratio {
        _ if ratio.contains(low) => 0.0,
        _ if ratio.contains(high) => 1.0,
        _ => 0.5,
    };
    let shares = DVec2::new(share("xMin", "xMax"), share("YMin", "YMax"));
    let aside = at + shares * (size - view * scale);
    let place = DAffine2::from_translation(aside)
        * DAffine2::from_scale(scale)
        * DAffine2::from_translation(-corner);
    (place, view)
}

/// Corner and size of a `viewBox`.
fn view_box(node: &Node<'_, '_>) -> Option<[DVec2; 2]> {
    match path::numbers(node.attribute("viewBox")?)[..] {
        [x, y, width, height] if width > 0.0 && height > 0.0 => {
            Some([DVec2::new(x, y), DVec2::new(width, height)])
        }
        _ => None,
    }
}
