//! Packs the boxes of charts into the square, at one scale: on shelves, the highest first.

use glam::DVec2;

/// Least distance between charts, and to the border, in parts of the square's side; many charts have less.
const GUTTER: f64 = 1.0 / 96.0;

/// Where boxes are on the square.
pub(super) struct Packed {
    /// Length on the square of one mm.
    pub(super) scale: f64,
    /// The lower left corner of each box.
    pub(super) corners: Vec<DVec2>,
}

/// Packs boxes, each given by its lowest and highest corner in mm.
pub(super) fn pack(boxes: &[[DVec2; 2]]) -> Packed {
    let sizes: Vec<DVec2> = boxes.iter().map(|[low, high]| *high - *low).collect();
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|a, b| sizes[*b].y.total_cmp(&sizes[*a].y).then(a.cmp(b)));
    // So many gutters in a row take a quarter of it, at most.
    let gutter = GUTTER.min(0.25 / (sizes.len() as f64).sqrt().ceil().max(1.0));
    let area: f64 = sizes.iter().map(|size| size.x * size.y).sum();
    let widest = sizes
        .iter()
        .fold(0.0f64, |most, it| most.max(it.max_element()));
    let mut side = area.sqrt().max(widest).max(f64::MIN_POSITIVE);
    loop {
        if let Some(corners) = shelves(&sizes, &order, side, gutter * side) {
            return Packed {
                scale: 1.0 / side,
                corners: corners.into_iter().map(|corner| corner / side).collect(),
            };
        }
        side *= 1.02;
    }
}

/// The corners of the boxes in a square; `None` if it is too small.
fn shelves(sizes: &[DVec2], order: &[usize], side: f64, gutter: f64) -> Option<Vec<DVec2>> {
    let mut corners = vec![DVec2::ZERO; sizes.len()];
    let (mut x, mut y, mut height) = (gutter, gutter, 0.0f64);
    for index in order {
        let size = sizes[*index];
        if x + size.x + gutter > side && x > gutter {
            (x, y, height) = (gutter, y + height + gutter, 0.0);
        }
        if x + size.x + gutter > side || y + size.y + gutter > side {
            return None;
        }
        corners[*index] = DVec2::new(x, y);
        x += size.x + gutter;
        height = height.max(size.y);
    }
    Some(corners)
}
