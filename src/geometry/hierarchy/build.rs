//! Builds hierarchies: boxes are divided where the surface area heuristic costs least (Wald 2007, binned).

use super::{Child, Hierarchy, Node, WIDTH};
use glam::DVec3;

/// Bins along each axis.
const BINS: usize = 16;

/// Triangles that are not divided any more.
const LEAF: usize = 4;

/// Depth from which on boxes are divided into equal numbers: then no hierarchy is deeper than rays can go.
const DEEP: usize = 16;

/// Where boxes lie that hold nothing.
const NOWHERE: f32 = 3e38;

/// How much larger boxes are than what they hold, as a part of the largest coordinate: more than what
/// rounding to single precision takes off.
const PADDING: f64 = 1e-6;

/// A box in double precision that grows.
#[derive(Clone, Copy)]
struct Growing {
    low: DVec3,
    high: DVec3,
}

impl Growing {
    const EMPTY: Growing = Growing {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    fn add(&mut self, low: DVec3, high: DVec3) {
        self.low = self.low.min(low);
        self.high = self.high.max(high);
    }

    fn area(&self) -> f64 {
        let side = (self.high - self.low).max(DVec3::ZERO);
        side.x * side.y + side.y * side.z + side.z * side.x
    }
}

/// A triangle on its way into a box.
#[derive(Clone, Copy)]
struct Item {
    low: DVec3,
    high: DVec3,
    index: u32,
}

impl Item {
    fn centre(&self) -> DVec3 {
        (self.low + self.high) * 0.5
    }
}

/// A range of items, with the box around them.
#[derive(Clone, Copy)]
struct Part {
    start: usize,
    end: usize,
    bounds: Growing,
}

impl Part {
    fn new(items: &[Item], start: usize, end: usize) -> Part {
        let bounds = around(&items[start..end]);
        Part { start, end, bounds }
    }

    fn count(&self) -> usize {
        self.end - self.start
    }

    /// What rays have to do with it, roughly.
    fn cost(&self) -> f64 {
        self.bounds.area() * self.count() as f64
    }
}

impl Hierarchy {
    /// The hierarchy over the triangles with these corners.
    pub(crate) fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Hierarchy {
        let corners: Vec<[DVec3; 3]> = triangles.collect();
        let item = |(index, [a, b, c]): (usize, &[DVec3; 3])| Item {
            low: a.min(*b).min(*c),
            high: a.max(*b).max(*c),
            index: index as u32,
        };
        let mut items: Vec<Item> = corners.iter().enumerate().map(item).collect();
        let whole = around(&items);
        let largest = whole.low.abs().max(whole.high.abs()).max_element();
        let padding = PADDING * if largest.is_finite() { largest } else { 0.0 };
        let nodes = divide(&mut items, padding);
        let edges = |item: &Item| {
            let [a, b, c] = corners[item.index as usize];
            [a, b - a, c - a]
        };
        Hierarchy {
            nodes,
            bounds: [whole.low - padding, whole.high + padding]
                .map(|corner| corner.as_vec3().to_array()),
            triangles: items.iter().map(edges).collect(),
            order: items.iter().map(|item| item.index).collect(),
        }
    }
}

fn around(items: &[Item]) -> Growing {
    let mut bounds = Growing::EMPTY;
    items
        .iter()
        .for_each(|item| bounds.add(item.low, item.high));
    bounds
}

/// Puts the items in order and gives the nodes over them, the first over all.
fn divide(items: &mut [Item], padding: f64) -> Vec<Node> {
    let mut nodes = vec![empty()];
    let mut pending = vec![(0, Part::new(items, 0, items.len()), 0)];
    while let Some((node, part, depth)) = pending.pop() {
        let parts = quarters(items, part, depth >= DEEP);
        for (lane, part) in parts
            .iter()
            .enumerate()
            .filter(|(_, part)| part.count() > 0)
        {
            let child = if part.count() <= LEAF {
                Child::leaf(part.start, part.count())
            } else {
                nodes.push(empty());
                pending.push((nodes.len() - 1, *part, depth + 1));
                Child::node(nodes.len() - 1)
            };
            set(&mut nodes[node], lane, part, child, padding);
        }
    }
    nodes
}

fn empty() -> Node {
    Node {
        low: [[NOWHERE; WIDTH]; 3],
        high: [[NOWHERE; WIDTH]; 3],
        children: [Child::leaf(0, 0); WIDTH],
    }
}

fn set(node: &mut Node, lane: usize, part: &Part, child: Child, padding: f64) {
    for axis in 0..3 {
        node.low[axis][lane] = (part.bounds.low[axis] - padding) as f32;
        node.high[axis][lane] = (part.bounds.high[axis] + padding) as f32;
    }
    node.children[lane] = child;
}

/// A part in up to four: the costliest one is divided until there are four or all are small.
fn quarters(items: &mut [Item], part: Part, evenly: bool) -> Vec<Part> {
    let mut parts = vec![part];
    while parts.len() < WIDTH {
        let large = parts
            .iter()
            .enumerate()
            .filter(|(_, part)| part.count() > LEAF);
        let Some((index, _)) = large.max_by(|(_, a), (_, b)| match evenly {
            true => a.count().cmp(&b.count()),
            false => a.cost().total_cmp(&b.cost()),
        }) else {
            break;
        };
        let Part { start, end, .. } = parts.swap_remove(index);
        let half = match evenly {
            true => (end - start) / 2,
            false => split(&mut items[start..end]),
        };
        parts.push(Part::new(items, start, start + half));
        parts.push(Part::new(items, start + half, end));
    }
    parts
}

/// Moves items so that those of one half come first; gives their number, neither none nor all.
fn split(items: &mut [Item]) -> usize {
    let mut centres = Growing::EMPTY;
    items
        .iter()
        .for_each(|item| centres.add(item.centre(), item.centre()));
    let extent = centres.high - centres.low;
    let axis = match extent {
        it if it.x >= it.y && it.x >= it.z => 0,
        it if it.y >= it.z => 1,
        _ => 2,
    };
    let (low, scale) = (centres.low[axis], BINS as f64 / extent[axis]);
    if !scale.is_finite() {
        return items.len() / 2;
    }
    let bin = |item: &Item| (((item.centre()[axis] - low) * scale) as usize).min(BINS - 1);
    let cheapest = cheapest(items, &bin);
    let mut middle = 0;
    for index in 0..items.len() {
        if bin(&items[index]) < cheapest {
            items.swap(index, middle);
            middle += 1;
        }
    }
    middle
}

/// The bin before which to divide: the first and the last bin hold something, so neither half is empty.
fn cheapest(items: &[Item], bin: &impl Fn(&Item) -> usize) -> usize {
    let mut bins = [(Growing::EMPTY, 0usize); BINS];
    for item in items {
        let (bounds, count) = &mut bins[bin(item)];
        bounds.add(item.low, item.high);
        *count += 1;
    }
    let mut behind = [0.0; BINS];
    let (mut bounds, mut count) = (Growing::EMPTY, 0);
    for index in (1..BINS).rev() {
        bounds.add(bins[index].0.low, bins[index].0.high);
        count += bins[index].1;
        behind[index] = if count > 0 {
            bounds.area() * count as f64
        } else {
            0.0
        };
    }
    let (mut bounds, mut count) = (Growing::EMPTY, 0);
    let mut best = (f64::INFINITY, 1);
    for index in 1..BINS {
        bounds.add(bins[index - 1].0.low, bins[index - 1].0.high);
        count += bins[index - 1].1;
        let cost = bounds.area() * count as f64 + behind[index];
        if cost < best.0 {
            best = (cost, index);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::Ray;
    use super::*;

    /// Small triangles scattered in a cube, by a linear congruence.
    fn scattered(count: usize) -> Vec<[DVec3; 3]> {
        let mut state = 7u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut point = |scale: f64| DVec3::new(random(), random(), random()) * scale;
        (0..count)
            .map(|_| {
                let corner = point(100.0);
                [corner, corner + point(8.0), corner + point(8.0)]
            })
            .collect()
    }

    #[test]
    fn the_first_meeting_is_that_of_a_search_through_all() {
        let triangles = scattered(900);
        let hierarchy = Hierarchy::new(triangles.iter().copied());
        let single: Vec<Hierarchy> = triangles
            .iter()
            .map(|triangle| Hierarchy::new([*triangle].into_iter()))
            .collect();
        let mut met = 0;
        for (index, [from, towards, _]) in scattered(300).into_iter().enumerate() {
            let ray = Ray::new(from * 1.2 - 10.0, (towards - from).normalize());
            let all = single.iter().filter_map(|one| one.first(&ray, 0.5, 1e9));
            let expected = all
                .map(|meeting| meeting.distance)
                .fold(f64::INFINITY, f64::min);
            let found = hierarchy.first(&ray, 0.5, 1e9);
            let found = found.map_or(f64::INFINITY, |meeting| meeting.distance);
            assert_eq!(found, expected, "ray {index}");
            assert_eq!(hierarchy.any(&ray, 0.5, 1e9), expected.is_finite());
            assert!(!hierarchy.any(&ray, 0.5, expected.min(1e9) * 0.999_999_9));
            met += usize::from(expected.is_finite());
        }
        assert!((30..290).contains(&met), "{met}");
    }

    #[test]
    fn equal_triangles_and_rays_along_axes_do_no_harm() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let hierarchy = Hierarchy::new(std::iter::repeat_n(triangle, 50));
        let ray = Ray::new(DVec3::new(0.25, 0.25, 3.0), DVec3::NEG_Z);
        let meeting = hierarchy.first(&ray, 0.0, 10.0).unwrap();
        assert_eq!((meeting.distance, meeting.leaves), (3.0, false));
        assert_eq!(meeting.triangle, 0);
        let back = Ray::new(DVec3::new(0.25, 0.25, -3.0), DVec3::Z);
        assert!(hierarchy.first(&back, 0.0, 10.0).unwrap().leaves);
        assert!(hierarchy.first(&back, 0.0, 2.9).is_none());
        assert!(
            Hierarchy::new([].into_iter())
                .first(&ray, 0.0, 10.0)
                .is_none()
        );
    }
}
