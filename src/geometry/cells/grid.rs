//! A grid over boxes: which of them may be at a point.

use glam::DVec2;

/// Boxes by the squares of a grid that they reach into.
#[derive(Debug)]
pub(super) struct Grid {
    low: DVec2,
    /// Squares for each mm.
    scale: f64,
    columns: usize,
    rows: usize,
    /// Where the items of each square begin, and behind them the number of items.
    starts: Vec<u32>,
    items: Vec<u32>,
}

/// Squares for each cell, at most, and items for each.
const SQUARES: f64 = 2.0;
const ITEMS: usize = 24;

impl Grid {
    /// A grid over boxes from low to high corners, for `cells` cells.
    pub(super) fn new(boxes: &[[DVec2; 2]], cells: usize) -> Grid {
        let low = boxes.iter().fold(DVec2::INFINITY, |low, it| low.min(it[0]));
        let high = boxes
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, it| high.max(it[1]));
        let size = (high - low).max(DVec2::splat(1e-9));
        let mut squares = SQUARES * cells as f64;
        loop {
            let scale = (squares / (size.x * size.y)).sqrt();
            let columns = ((size.x * scale).ceil() as usize).clamp(1, 1 << 24);
            let rows = ((size.y * scale).ceil() as usize).clamp(1, 1 << 24);
            let grid = Grid {
                low,
                scale,
                columns,
                rows,
                starts: vec![],
                items: vec![],
            };
            // Slanted slivers reach into very many squares.
            let items: usize = boxes.iter().map(|it| grid.squares(it).count()).sum();
            if squares <= 1.0 || (items <= ITEMS * boxes.len().max(8) && columns * rows <= 1 << 28)
            {
                return grid.filled(boxes);
            }
            squares *= 0.25;
        }
    }

    /// The items that may be at a point.
    pub(super) fn at(&self, point: DVec2) -> &[u32] {
        let place = (point - self.low) * self.scale;
        let is_outside = !(place.x >= 0.0 && place.y >= 0.0);
        let [column, row] = [place.x as usize, place.y as usize];
        if is_outside || column > self.columns || row > self.rows {
            return &[];
        }
        let square = row.min(self.rows - 1) * self.columns + column.min(self.columns - 1);
        &self.items[self.starts[square] as usize..self.starts[square + 1] as usize]
    }

    fn filled(mut self, boxes: &[[DVec2; 2]]) -> Grid {
        let mut starts = vec![0_u32; self.columns * self.rows + 1];
        for item in boxes {
            self.squares(item)
                .for_each(|square| starts[square + 1] += 1);
        }
        for square in 1..starts.len() {
            starts[square] += starts[square - 1];
        }
        let mut next = starts.clone();
        let mut items = vec![0; starts[starts.len() - 1] as usize];
        for (index, item) in boxes.iter().enumerate() {
            for square in self.squares(item) {
                items[next[square] as usize] = index as u32;
                next[square] += 1;
            }
        }
        (self.starts, self.items) = (starts, items);
        self
    }

    /// The squares that a box reaches into.
    fn squares(&self, [low, high]: &[DVec2; 2]) -> impl Iterator<Item = usize> + use<> {
        let place = |point: DVec2| ((point - self.low) * self.scale).max(DVec2::ZERO);
        let (first, last) = (place(*low), place(*high));
        let within = |place: f64, count: usize| (place as usize).min(count - 1);
        let columns = within(first.x, self.columns)..=within(last.x, self.columns);
        let rows = within(first.y, self.rows)..=within(last.y, self.rows);
        let width = self.columns;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}
