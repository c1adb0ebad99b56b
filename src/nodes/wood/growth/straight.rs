//! The straight skeleton of the older model: which part of it counts for a point, and how far that is.
//!
//! Momoi & Takatera 2014, section 2. Only the two segments at the nearest node N count. A point is in the
//! influence area of a segment if its foot is on the segment's side of N. With the directions u1 of the segment
//! that ends at N and u2 of the one that starts there, `a = -(P - N) u1` and `b = (P - N) u2`:
//!
//! - a >= 0 > b or b >= 0 > a: one influence area, the foot is on that segment's line;
//! - both at least 0: the blend area inside a bend, `T = B(w) T_1 + (1 - B(w)) T_2` with `w = a / (a + b)` and
//!   `B = 3 w^2 - 2 w^3` (the paper prints no function; this one meets both neighbours);
//! - both below 0: outside a bend, the foot is N itself.
//!
//! Where the plane that halves a segment crosses a blend area, the nearest node changes and T jumps: that is the
//! model's published defect, and it is kept.

use glam::DVec3;

/// A trunk of straight segments.
#[derive(Clone, Debug, PartialEq)]
pub struct StraightTrunk {
    nodes: Vec<DVec3>,
    /// Length of the way from the ground to each node, in mm.
    paths: Vec<f64>,
}

/// The part of a straight skeleton that counts for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// The influence area of the segment with this index, from the ground up.
    Segment(usize),
    /// The blend area at the node with this index.
    Blend(usize),
    /// Outside the bend at the node with this index.
    Node(usize),
}

/// A way along the skeleton and from there to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// D_a: along the skeleton, in mm.
    pub along: f64,
    /// D_b: from the skeleton to the point, in mm.
    pub across: f64,
}

/// Where a point is, seen from a straight trunk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// What counts.
    pub region: Region,
    /// The ways by the segment below and by the one above; both are the same outside blend areas.
    pub ways: [Way; 2],
    /// B(w), the share of the first way.
    pub share: f64,
}

impl StraightTrunk {
    /// The trunk through nodes, of which there are at least two and none the same as the one before.
    pub fn through(nodes: &[DVec3]) -> StraightTrunk {
        let first = nodes[0].z.max(0.0);
        let mut path = first;
        let steps = nodes.windows(2).map(|ends| {
            path += ends[0].distance(ends[1]);
            path
        });
        StraightTrunk {
            paths: std::iter::once(first).chain(steps).collect(),
            nodes: nodes.to_vec(),
        }
    }

    /// The nodes, from the ground up.
    pub fn nodes(&self) -> &[DVec3] {
        &self.nodes
    }

    /// Length in mm of the way to each node from the ground; a trunk that starts below it grew from its first node.
    pub fn paths(&self) -> &[f64] {
        &self.paths
    }

    /// The unit vectors along the segments that end and start at a node; the first and the last have one only.
    pub fn directions(&self, node: usize) -> [Option<DVec3>; 2] {
        let direction =
            |from: usize, to: usize| Some((self.nodes.get(to)? - self.nodes[from]).normalize());
        let before = node.checked_sub(1);
        [
            before.and_then(|before| direction(before, node)),
            direction(node, node + 1),
        ]
    }

    /// Its point at a height in mm between its ends, and the length of the way there.
    pub fn at(&self, height: f64) -> (DVec3, f64) {
        let above = self.nodes.partition_point(|node| node.z <= height);
        let above = above.clamp(1, self.nodes.len() - 1);
        let (low, high) = (self.nodes[above - 1], self.nodes[above]);
        let share = (height - low.z) / (high.z - low.z);
        let path = self.paths[above - 1];
        (
            low.lerp(high, share),
            path + share * (self.paths[above] - path),
        )
    }

    /// What counts for a point (mm), and how far it is.
    pub fn see(&self, point: DVec3) -> Seen {
        let distance = |node: &DVec3| node.distance_squared(point);
        let nearer = |best: usize, node: usize| {
            if distance(&self.nodes[node]) < distance(&self.nodes[best]) {
                node
            } else {
                best
            }
        };
        let nearest = (0..self.nodes.len()).fold(0, nearer);
        let from_node = point - self.nodes[nearest];
        let [before, after] = self.directions(nearest);
        // How far the feet are from the node, into each segment.
        let below = before.map_or(-1.0, |direction| -from_node.dot(direction));
        let above = after.map_or(-1.0, |direction| from_node.dot(direction));
        let path = self.paths[nearest];
        let way = |direction: Option<DVec3>, along: f64| Way {
            along: path + along,
            across: (from_node - direction.unwrap_or_default() * along).length(),
        };
        let (first, second) = (way(before, -below), way(after, above));
        let (region, ways, share) = match (below >= 0.0, above >= 0.0) {
            (true, true) => {
                let sum = below + above;
                let w = if sum > 0.0 { below / sum } else { 0.5 };
                (
                    Region::Blend(nearest),
                    [first, second],
                    w * w * (3.0 - 2.0 * w),
                )
            }
            (true, false) => (Region::Segment(nearest - 1), [first; 2], 1.0),
            (false, true) => (Region::Segment(nearest), [second; 2], 1.0),
            (false, false) => (Region::Node(nearest), [way(None, 0.0); 2], 1.0),
        };
        Seen {
            region,
            ways,
            share,
        }
    }
}
