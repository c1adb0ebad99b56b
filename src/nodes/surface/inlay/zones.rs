//! Ground, gap and inlay as a profile of the distance to the outline.
//!
//! Cells that touch have no ground between them: beyond the border is the inlay of the next cell, so the profile is that of
//! the distance on both sides.

use super::KIND;
use crate::field::{Alternatives, Block, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::Inputs;
use crate::nodes::field::profile::{Ends, Piece, Profile};

/// How it is let in, all in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub(super) gap: f64,
    pub(super) level: f64,
    pub(super) depth: f64,
    pub(super) step: f64,
    pub(super) chamfer: f64,
    pub(super) ground_chamfer: f64,
}

impl Cut {
    pub(super) fn read(inputs: &Inputs<'_>) -> Cut {
        Cut {
            gap: inputs.number("gap"),
            level: inputs.number("level"),
            depth: inputs.number("depth"),
            step: inputs.number("step"),
            chamfer: inputs.number("chamfer"),
            ground_chamfer: inputs.number("ground_chamfer"),
        }
    }

    /// Width in mm of what is to be seen where outlines meet or bend.
    pub(super) fn detail(&self) -> f64 {
        0.5 * self.gap
    }

    /// The share of the sky that the bottom of the gap sees.
    fn openness(&self) -> f64 {
        let half = 0.5 * self.gap;
        match self.depth > 0.0 {
            true => half / (half * half + self.depth * self.depth).sqrt(),
            false => 1.0,
        }
    }

    /// The profile of cells that touch: that of the distance without its sign.
    fn mirrored(&self) -> (Vec<Piece<4>>, f64) {
        let (pieces, end) = self.profile();
        let mut inside: Vec<Piece<4>> = vec![];
        for mut piece in pieces {
            if piece.start <= 0.0 {
                inside.clear();
                for cubic in &mut piece.cubic {
                    cubic[0] -= cubic[1] * piece.start;
                }
                piece.start = 0.0;
            }
            inside.push(piece);
        }
        let ends = inside.iter().skip(1).map(|next| next.start).chain([end]);
        let turned = |(piece, end): (&Piece<4>, f64)| Piece {
            start: -end,
            cubic: piece
                .cubic
                .map(|[start, slope, ..]| [start + slope * (end - piece.start), -slope, 0.0, 0.0]),
        };
        let mut all: Vec<Piece<4>> = inside.iter().zip(ends).map(turned).collect();
        all.reverse();
        all.extend(inside);
        (all, end)
    }

    /// Shares of glue and of what is let in, what is added to the height, and what is left of the light.
    fn profile(&self) -> (Vec<Piece<4>>, f64) {
        let half = 0.5 * self.gap;
        let piece = |start: f64, values: [f64; 4], slope: f64| {
            let mut cubic = values.map(|value| [value, 0.0, 0.0, 0.0]);
            cubic[2][1] = slope;
            Piece { start, cubic }
        };
        let edge = half + self.chamfer;
        let pieces = [
            (-half - self.ground_chamfer, [0.0, 0.0, 0.0, 1.0], -1.0),
            (-half, [1.0, 0.0, 0.0, self.openness()], 0.0),
            (
                half,
                [0.0, 1.0, self.level + self.step - self.chamfer, 1.0],
                1.0,
            ),
            (edge, [0.0, 1.0, self.level + self.step, 1.0], 0.0),
        ];
        let mut all: Vec<Piece<4>> = vec![];
        for (start, values, slope) in pieces {
            // A piece without width is none.
            all.retain(|before| before.start < start);
            all.push(piece(start, values, slope));
        }
        if all[0].start == -half {
            // What lies before the first piece has the value at its start.
            all.insert(0, piece(-half - 1.0, [0.0, 0.0, 0.0, 1.0], 0.0));
        }
        (all, edge + 1.0)
    }
}

/// The zones around an outline. Columns in: distance to it, id of the cell that touches it or -1, position along u. Columns out:
/// share of glue, share of what is let in, what is added to the height in mm, what is left of the light.
#[derive(Debug)]
pub(super) struct Zones {
    profile: Profile<4>,
    /// Where a cell touches the outline.
    mirrored: Profile<4>,
    /// Width in mm of what is to be seen.
    detail: f64,
}

impl Zones {
    pub(super) fn new(cut: &Cut) -> Zones {
        let [profile, mirrored] = [cut.profile(), cut.mirrored()]
            .map(|(pieces, end)| Profile::new(pieces, end, Ends::Stay));
        Zones {
            profile,
            mirrored,
            detail: cut.detail(),
        }
    }
}

impl Kernel for Zones {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("zones of inlay").whole(i64::from(KIND.version));
        self.profile.add_to_key(key);
        self.mirrored.add_to_key(key);
        key.number(self.detail);
    }

    fn width(&self) -> usize {
        4
    }

    fn reads_spread(&self, column: usize) -> bool {
        column == 0
    }

    fn has_kinks(&self, column: usize) -> bool {
        column == 0
    }

    fn sampling(&self) -> Sampling {
        // Where another cell or another edge is nearer, the distance has a kink.
        self.profile.sampling()
    }

    fn widest(&self) -> Option<(usize, f32)> {
        (self.detail > 0.0).then_some((2, self.detail as f32))
    }

    fn nanoseconds(&self) -> f32 {
        15.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let (border, beyond) = (block.inputs[0], block.inputs[1].values);
        for (index, value) in border.values.iter().enumerate() {
            let spread = border.spread.map(|along| f64::from(along[index]));
            let profile = match beyond[index] < 0.0 {
                true => &self.profile,
                false => &self.mirrored,
            };
            let means = profile.mean(f64::from(*value), spread);
            for (output, mean) in block.outputs.iter_mut().zip(means) {
                output[index] = mean as f32;
            }
        }
    }
}

/// What is at a point, by the shares of glue and of what is let in: 0 the ground, 1 the glue, 2 what is let in, or more than
/// one of them.
#[derive(Debug)]
pub(super) struct Seen;

impl Kernel for Seen {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("seen of inlay").whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let shares = block.inputs[0].values.iter().zip(block.inputs[1].values);
        for (output, (glue, inlaid)) in block.outputs[0].iter_mut().zip(shares) {
            *output = match (*glue, *inlaid) {
                (0.0, 0.0) => 0.0,
                (1.0, 0.0) => 1.0,
                (0.0, 1.0) => 2.0,
                _ => Alternatives::ALL,
            };
        }
    }
}

/// Columns in: what is seen; shares of glue and of what is let in; those of the ground, of the glue, and of what is let in; index
/// of the cell; position along u.
///
/// Where another cell begins within a pixel, which of them shows and what it is go together, so their means do not do.
#[derive(Debug)]
pub(super) struct Joined {
    /// Columns of each.
    pub(super) width: usize,
    /// Width in mm of what is to be seen.
    pub(super) detail: f64,
}

impl Kernel for Joined {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("joined by inlay")
            .whole(i64::from(KIND.version))
            .whole(self.width as i64)
            .number(self.detail);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereEven {
            column: 3 + 3 * self.width,
            absolute: 0.5,
        }
    }

    fn widest(&self) -> Option<(usize, f32)> {
        (self.detail > 0.0).then_some((4 + 3 * self.width, self.detail as f32))
    }

    fn alternatives(&self) -> Option<Alternatives> {
        Some(Alternatives {
            choice: 0,
            first: 3,
            width: self.width,
        })
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [seen, glue_share, share] = [0, 1, 2].map(|column| block.inputs[column].values);
        for (part, output) in block.outputs.iter_mut().enumerate() {
            let each = [0, 1, 2].map(|which| block.inputs[3 + which * self.width + part].values);
            for (index, output) in output.iter_mut().enumerate() {
                *output = match seen[index] {
                    Alternatives::ALL => {
                        let [ground, glue, inlaid] = each.map(|column| column[index]);
                        let (of_glue, of_inlaid) = (glue_share[index], share[index]);
                        ground * (1.0 - of_glue - of_inlaid) + glue * of_glue + inlaid * of_inlaid
                    }
                    which => each[which as usize][index],
                };
            }
        }
    }
}

/// The sum of two columns.
#[derive(Debug)]
pub(super) struct Sum;

/// The product of two columns.
#[derive(Debug)]
pub(super) struct Product;

macro_rules! of_two_columns {
    ($kernel:ty, $name:literal, $combine:expr) => {
        impl Kernel for $kernel {
            fn add_to_key(&self, key: &mut KeyHasher) {
                key.text($name).whole(i64::from(KIND.version));
            }

            fn width(&self) -> usize {
                1
            }

            fn evaluate(&self, block: &mut Block<'_>) {
                let combine: fn(f32, f32) -> f32 = $combine;
                let columns = block.inputs[0].values.iter().zip(block.inputs[1].values);
                for (output, (a, b)) in block.outputs[0].iter_mut().zip(columns) {
                    *output = combine(*a, *b);
                }
            }
        }
    };
}

of_two_columns!(Sum, "height of inlay", |a, b| a + b);
of_two_columns!(Product, "light of inlay", |a, b| a * b);
