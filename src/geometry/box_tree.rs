//! A tree of boxes on the plane: finds what lies nearest to a point.

use glam::DVec2;

/// Items in a leaf, at most.
const LEAF: usize = 4;

/// Nodes made between two questions whether to go on.
const AT_ONCE: usize = 1024;

/// Items by their boxes.
#[derive(Debug)]
pub(crate) struct BoxTree {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// A box with all that is in it: items, or two nodes, the first of which comes next.
#[derive(Debug)]
struct Node {
    low: DVec2,
    high: DVec2,
    /// Where its items begin and end.
    items: [usize; 2],
    /// Its second node; `None` in a leaf.
    second: Option<usize>,
}

impl Node {
    fn distance_squared(&self, point: DVec2) -> f64 {
        point.distance_squared(point.clamp(self.low, self.high))
    }
}

impl BoxTree {
    /// A tree over items, given by their lowest and highest corners. `go_on` is asked now and then.
    ///
    /// # Errors
    /// What `go_on` says.
    pub(crate) fn new<E>(
        boxes: &[[DVec2; 2]],
        go_on: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<BoxTree, E> {
        let mut tree = BoxTree {
            nodes: vec![],
            items: (0..boxes.len() as u32).collect(),
        };
        // Ranges of items that wait for their node, with the node that they are the second of.
        let mut waiting = vec![([0, boxes.len()], None)];
        while let Some((range, parent)) = waiting.pop() {
            let index = tree.nodes.len();
            if index.is_multiple_of(AT_ONCE) {
                go_on()?;
            }
            if let Some(parent) = parent {
                let parent: &mut Node = &mut tree.nodes[parent];
                parent.second = Some(index);
            }
            let node = tree.node(boxes, range);
            let extent = node.high - node.low;
            tree.nodes.push(node);
            if range[1] - range[0] > LEAF {
                let middle = tree.divide(boxes, range, extent.y > extent.x);
                waiting.push(([middle, range[1]], Some(index)));
                waiting.push(([range[0], middle], None));
            }
        }
        Ok(tree)
    }

    fn node(&self, boxes: &[[DVec2; 2]], items: [usize; 2]) -> Node {
        let mut node = Node {
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
            items,
            second: None,
        };
        for item in &self.items[items[0]..items[1]] {
            let [low, high] = boxes[*item as usize];
            node.low = node.low.min(low);
            node.high = node.high.max(high);
        }
        node
    }

    /// Puts the items with lower centres first; gives where the others begin.
    fn divide(&mut self, boxes: &[[DVec2; 2]], [from, to]: [usize; 2], by_height: bool) -> usize {
        let centre = |item: &u32| {
            let [low, high] = boxes[*item as usize];
            let sum = low + high;
            if by_height { sum.y } else { sum.x }
        };
        let middle = (to - from) / 2;
        self.items[from..to].select_nth_unstable_by(middle, |a, b| {
            centre(a).total_cmp(&centre(b)).then(a.cmp(b))
        });
        from + middle
    }

    /// Shows the items of all leaves whose box touches a box; some of them may not touch it themselves.
    pub(crate) fn visit(&self, [low, high]: [DVec2; 2], show: &mut dyn FnMut(u32)) {
        let mut waiting = Waiting::new(0);
        while let Some(index) = waiting.pop() {
            let Some(node) = self.nodes.get(index) else {
                continue;
            };
            let touches = node.low.cmple(high).all() && node.high.cmpge(low).all();
            match node.second {
                _ if !touches => {}
                Some(second) => [second, index + 1]
                    .into_iter()
                    .for_each(|child| waiting.push(child)),
                None => self.items[node.items[0]..node.items[1]]
                    .iter()
                    .for_each(|item| show(*item)),
            }
        }
    }

    /// The nearest item, the first of equally near ones; `distance_squared` gives how far each is from the point.
    pub(crate) fn nearest(
        &self,
        point: DVec2,
        distance_squared: impl Fn(u32) -> f64,
    ) -> Option<u32> {
        self.nearest_within(point, f64::INFINITY, distance_squared)
    }

    /// [`BoxTree::nearest`] of the items whose squared distance is less than `most`.
    pub(crate) fn nearest_within(
        &self,
        point: DVec2,
        most: f64,
        distance_squared: impl Fn(u32) -> f64,
    ) -> Option<u32> {
        let mut best = (most, u32::MAX);
        self.search(point, |limit, item| {
            if let Some(item) = item {
                let distance = distance_squared(item);
                if distance < best.0 || (distance == best.0 && item < best.1 && best.1 != u32::MAX)
                {
                    best = (distance, item);
                }
            }
            limit <= best.0
        });
        (best.1 != u32::MAX).then_some(best.1)
    }

    /// As [`BoxTree::nearest`], and the square of the distance of the next.
    pub(crate) fn nearest_two(
        &self,
        point: DVec2,
        distance_squared: impl Fn(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let (mut best, mut next) = ((f64::INFINITY, u32::MAX), f64::INFINITY);
        self.search(point, |limit, item| {
            if let Some(item) = item {
                let distance = distance_squared(item);
                if distance < best.0 || (distance == best.0 && item < best.1) {
                    next = best.0;
                    best = (distance, item);
                } else if distance < next {
                    next = distance;
                }
            }
            limit <= next
        });
        (best.1 != u32::MAX).then_some((best.1, next))
    }

    /// Shows items, near ones first on the whole: `show` is asked with the square of a distance, and none or one item,
    /// whether it wants what is so far away.
    fn search(&self, point: DVec2, mut show: impl FnMut(f64, Option<u32>) -> bool) {
        let Some(root) = self.nodes.first() else {
            return;
        };
        let mut waiting = Waiting::new((0, root.distance_squared(point)));
        while let Some((index, distance)) = waiting.pop() {
            if !show(distance, None) {
                continue;
            }
            let node = &self.nodes[index];
            let Some(second) = node.second else {
                for item in &self.items[node.items[0]..node.items[1]] {
                    show(distance, Some(*item));
                }
                continue;
            };
            let mut both =
                [index + 1, second].map(|child| (child, self.nodes[child].distance_squared(point)));
            // The nearer one is looked at first, and so waits last.
            if both[0].1 <= both[1].1 {
                both.swap(0, 1);
            }
            both.into_iter().for_each(|child| waiting.push(child));
        }
    }
}

/// Levels of a tree, at most: each halves its items.
const DEEPEST: usize = 40;

/// Nodes that wait to be looked at: of each level one at most, and two of the last.
struct Waiting<T> {
    nodes: [T; DEEPEST],
    count: usize,
}

impl<T: Copy> Waiting<T> {
    fn new(first: T) -> Waiting<T> {
        Waiting {
            nodes: [first; DEEPEST],
            count: 1,
        }
    }

    fn push(&mut self, node: T) {
        self.nodes[self.count] = node;
        self.count += 1;
    }

    fn pop(&mut self) -> Option<T> {
        self.count = self.count.checked_sub(1)?;
        Some(self.nodes[self.count])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_is_the_one_that_a_search_through_all_finds() {
        let point = |i: u32, stride: u32| f64::from(i * stride % 1009) / 1009.0;
        let boxes: Vec<[DVec2; 2]> = (0..300)
            .map(|i| {
                let low = DVec2::new(point(i, 617), point(i, 331));
                [low, low + 0.05 * DVec2::new(point(i, 97), point(i, 29))]
            })
            .collect();
        let new = |boxes: &[[DVec2; 2]]| BoxTree::new(boxes, &mut || Ok::<(), ()>(())).unwrap();
        let tree = new(&boxes);
        for at in 0..2000 {
            let point = 1.4 * DVec2::new(point(at, 7), point(at, 401)) - 0.2;
            let distance = |item: u32| {
                let [low, high] = boxes[item as usize];
                point.distance_squared(point.clamp(low, high))
            };
            let all = (0..300).map(|item| (distance(item), item));
            let expected = all.reduce(|best, next| if next.0 < best.0 { next } else { best });
            assert_eq!(tree.nearest(point, distance), expected.map(|it| it.1));
        }
        assert_eq!(new(&[]).nearest(DVec2::ZERO, |_| 0.0), None);
    }
}
