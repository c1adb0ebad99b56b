//! Where a moved, turned and scaled thing is: what the transform kinds have in common.
//!
//! The thing's point q appears at p = pivot + move + R S (q - pivot), with S the factors along its own axes and R
//! the turns about x, then y, then z. So the point p shows pivot + S^-1 R^T (p - pivot - move).

use crate::field::{Block, Field, Kernel, Sampling};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Input, Inputs};
use crate::value::{Domain, Type, Unit};
use glam::{DAffine3, DMat3, DVec3};

/// Raised when a result changes.
const VERSION: i64 = 1;

/// How far things move.
pub(in crate::nodes) const MOVE: Input = Input::new(
    "move",
    Type::Vector(Unit::Millimetre),
    "How far it moves along x, y and z.",
)
.default("(0, 0, 0)")
.range(-1e7, 1e7);

/// How far things turn.
pub(in crate::nodes) const TURN: Input = Input::new(
    "turn",
    Type::Vector(Unit::Degree),
    "How far it turns about x, then y, then z, against the clock seen from the axis's tip; flat pieces turn about z.",
)
.default("(0, 0, 0)")
.range(-36_000.0, 36_000.0);

/// How much things grow.
pub(in crate::nodes) const SCALE: Input = Input::new(
    "scale",
    Type::Vector(Unit::One),
    "How many times larger it becomes along its own axes; negative parts mirror it.",
)
.default("(1, 1, 1)")
.range(-1e4, 1e4);

/// What stays where it is.
pub(in crate::nodes) const PIVOT: Input = Input::new(
    "pivot",
    Type::Vector(Unit::Millimetre),
    "The point that turning and scaling leave where it is.",
)
.default("(0, 0, 0)")
.range(-1e7, 1e7);

/// Smallest factor: below it nothing would be left of a thing.
const SMALLEST: f64 = 1e-4;

/// A moved, turned and scaled domain.
#[derive(Clone, Copy, Debug)]
pub(in crate::nodes) struct Placement {
    domain: Domain,
    turn: DMat3,
    scale: DVec3,
    pivot: DVec3,
    moved: DVec3,
}

impl Placement {
    /// The placement that the inputs state, in a domain.
    ///
    /// # Errors
    /// Factors near 0, and on a flat piece what would lead out of it.
    pub(super) fn read(inputs: &Inputs<'_>, domain: Domain) -> Result<Placement, Failure> {
        let parts = ["move", "turn", "scale", "pivot"].map(|name| inputs.vector(name));
        Placement::of(parts, domain)
    }

    /// The placement by `move`, `turn`, `scale` and `pivot`, in this order.
    ///
    /// # Errors
    /// As [`Placement::read`].
    pub(in crate::nodes) fn of(
        [moved, turn, scale, pivot]: [DVec3; 4],
        domain: Domain,
    ) -> Result<Placement, Failure> {
        if scale.abs().min_element() < SMALLEST {
            let message = format!(
                "a part of `scale` is {}: nothing would be left",
                scale.abs().min_element()
            );
            let hint = format!("write 1 for axes that keep their size; the least is {SMALLEST}");
            return Err(Failure::of_input("scale", message).with_hint(hint));
        }
        if domain == Domain::Plane {
            for (input, leads_out, hint) in [
                ("move", moved.z != 0.0, "its third part has to be 0"),
                (
                    "turn",
                    turn.x != 0.0 || turn.y != 0.0,
                    "only its third part may differ from 0",
                ),
                ("scale", scale.z != 1.0, "its third part has to be 1"),
            ] {
                if leads_out {
                    let message = format!("`{input}` leads out of the flat piece");
                    return Err(Failure::of_input(input, message).with_hint(hint));
                }
            }
        }
        Ok(Placement {
            domain,
            turn: turned(turn),
            scale,
            pivot,
            moved,
        })
    }

    /// Where each point of the thing appears.
    pub(in crate::nodes) fn affine(&self) -> DAffine3 {
        let matrix = self.turn * DMat3::from_diagonal(self.scale);
        let translation = self.pivot + self.moved - matrix * self.pivot;
        DAffine3::from_mat3_translation(matrix, translation)
    }

    /// The points of the thing that appear at each point.
    pub(super) fn position(&self, build: &Build<'_>) -> Field {
        let inverse = DMat3::from_diagonal(self.scale.recip()) * self.turn.transpose();
        let affine = Affine {
            matrix: inverse,
            offset: self.pivot - inverse * (self.pivot + self.moved),
        };
        build.kernel(affine, vec![Field::position(self.domain)])
    }

    /// Directions along the thing, turned with it; their length stays.
    pub(super) fn directions(&self, build: &Build<'_>, field: Field) -> Field {
        self.vectors(build, field, self.turn * DMat3::from_diagonal(self.scale))
    }

    /// Directions at right angles to the thing's surfaces, turned with it; their length stays.
    pub(super) fn normals(&self, build: &Build<'_>, field: Field) -> Field {
        self.vectors(
            build,
            field,
            self.turn * DMat3::from_diagonal(self.scale.recip()),
        )
    }

    fn vectors(&self, build: &Build<'_>, field: Field, matrix: DMat3) -> Field {
        let factors = self.scale.abs();
        let is_even = factors.max_element() == factors.min_element();
        let kernel = Directions { matrix, is_even };
        build.kernel(kernel, vec![field])
    }
}

/// The rotation about x, then y, then z by degrees; whole quarter turns are exact.
fn turned(degrees: DVec3) -> DMat3 {
    let [x, y, z] = degrees.to_array().map(|degrees| {
        let quarters = degrees / 90.0;
        match (quarters == quarters.round(), quarters.rem_euclid(4.0) as u8) {
            (true, 0) => [0.0, 1.0],
            (true, 1) => [1.0, 0.0],
            (true, 2) => [0.0, -1.0],
            (true, _) => [-1.0, 0.0],
            _ => [
                libm::sin(degrees.to_radians()),
                libm::cos(degrees.to_radians()),
            ],
        }
    });
    let about_x = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, x[1], x[0], 0.0, -x[0], x[1]]);
    let about_y = DMat3::from_cols_array(&[y[1], 0.0, -y[0], 0.0, 1.0, 0.0, y[0], 0.0, y[1]]);
    let about_z = DMat3::from_cols_array(&[z[1], z[0], 0.0, -z[0], z[1], 0.0, 0.0, 0.0, 1.0]);
    about_z * about_y * about_x
}

/// Three columns times a matrix, plus an offset.
#[derive(Debug)]
struct Affine {
    matrix: DMat3,
    offset: DVec3,
}

impl Kernel for Affine {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("transform").whole(VERSION);
        let parts = self.matrix.to_cols_array();
        parts
            .iter()
            .chain(&self.offset.to_array())
            .for_each(|part| {
                key.number(*part);
            });
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        each(block, |vector| self.matrix * vector + self.offset);
    }
}

/// Three columns times a matrix, as long as before.
#[derive(Debug)]
struct Directions {
    matrix: DMat3,
    /// Whether the matrix changes all lengths alike.
    is_even: bool,
}

impl Kernel for Directions {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("transform directions").whole(VERSION);
        self.matrix.to_cols_array().iter().for_each(|part| {
            key.number(*part);
        });
    }

    fn width(&self) -> usize {
        3
    }

    fn sampling(&self) -> Sampling {
        match self.is_even {
            true => Sampling::Filtered,
            false => Sampling::Supersampled,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        each(block, |vector| {
            let moved = self.matrix * vector;
            let length = moved.length();
            let scale = if length > 0.0 {
                vector.length() / length
            } else {
                0.0
            };
            moved * scale
        });
    }
}

fn each(block: &mut Block<'_>, f: impl Fn(DVec3) -> DVec3) {
    for index in 0..block.inputs[0].values.len() {
        let part = |axis: usize| f64::from(block.inputs[axis].values[index]);
        let result = f(DVec3::new(part(0), part(1), part(2)));
        for (output, part) in block.outputs.iter_mut().zip(result.to_array()) {
            output[index] = part as f32;
        }
    }
}
