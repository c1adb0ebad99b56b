//! Where cells are to be: in a region, in a rectangle, or in a rectangle that repeats.

use crate::node::{Failure, Input, Inputs};
use crate::value::{Polygon, Region, Type, Unit};
use glam::DVec2;
use std::sync::Arc;

/// The region that is divided.
pub(super) const REGION: Input = Input::new(
    "region",
    Type::Region,
    "What is divided; or state a `size` or a `period` instead.",
)
.optional();

/// The rectangle that is divided.
pub(super) const SIZE: Input = Input::new(
    "size",
    Type::Pair(Unit::Millimetre),
    "Width and height of the rectangle that is divided, from the origin on; instead of a `region`.",
)
.optional()
.range(1e-3, 1e8);

/// The rectangle that is divided and repeats.
pub(super) const PERIOD: Input = Input::new(
    "period",
    Type::Pair(Unit::Millimetre),
    "Width and height after which the cells repeat, for seamless textures; instead of a `region` or a `size`.",
)
.optional()
.range(1e-3, 1e8);

/// Where cells are to be.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// What is divided; of a periodic ground one period from the origin on.
    pub(super) region: Arc<Region>,
    /// Width and height after which it repeats.
    pub(super) period: Option<DVec2>,
}

impl Ground {
    /// The ground that the inputs `region`, `size` and `period` state.
    ///
    /// # Errors
    /// Unless exactly one of them is stated.
    pub(super) fn read(inputs: &Inputs<'_>) -> Result<Ground, Failure> {
        let stated = ["region", "size", "period"].map(|name| inputs.get(name).is_some());
        let pair = |name| DVec2::from_array(inputs.pair(name));
        match stated {
            [true, false, false] => Ok(Ground {
                region: Arc::clone(inputs.region("region")),
                period: None,
            }),
            [false, true, false] => Ok(Ground {
                region: Arc::new(rectangle(pair("size"))),
                period: None,
            }),
            [false, false, true] => Ok(Ground {
                region: Arc::new(rectangle(pair("period"))),
                period: Some(pair("period")),
            }),
            [false, false, false] => {
                let failure = Failure::new("nothing says what is divided");
                Err(failure.with_hint("link a `region`, or state a `size` or a `period`"))
            }
            [is_region, ..] => {
                let message = "more than one of `region`, `size` and `period` is stated";
                let input = if is_region { "region" } else { "size" };
                Err(Failure::of_input(input, message).with_hint("keep one of them"))
            }
        }
    }
}

/// The rectangle from the origin to `size`.
fn rectangle(size: DVec2) -> Region {
    let corners = [
        DVec2::ZERO,
        DVec2::new(size.x, 0.0),
        size,
        DVec2::new(0.0, size.y),
    ];
    Region {
        polygons: vec![Polygon {
            outline: corners.to_vec(),
            holes: vec![],
        }],
    }
}
