//! How stones are to be: the numbers of the inputs that hold for all of them.

use super::cage::Cut;
use crate::node::Inputs;

/// Numbers that hold for all stones, in mm and radians.
pub(super) struct Manner {
    /// `None` for setts.
    pub(super) cut: Option<Cut>,
    pub(super) height: f64,
    pub(super) unevenness: f64,
    pub(super) deformation: f64,
    pub(super) joint: f64,
    pub(super) joint_variation: f64,
    pub(super) rounding: f64,
    pub(super) corner_radius: f64,
    pub(super) crown: f64,
    pub(super) swell: f64,
    pub(super) tilt: f64,
}

impl Manner {
    pub(super) fn read(inputs: &Inputs<'_>) -> Manner {
        let cut = match inputs.choice("stone") {
            "prism" => Some(Cut::Prism),
            "round" => Some(Cut::Round),
            "corner" => Some(Cut::Corner(inputs.number("corner_ratio"))),
            _ => None,
        };
        Manner {
            cut,
            height: inputs.number("height"),
            unevenness: inputs.number("unevenness"),
            deformation: inputs.number("deformation"),
            joint: inputs.number("joint"),
            joint_variation: inputs.number("joint_variation"),
            rounding: inputs.number("rounding"),
            corner_radius: inputs.number("corner_radius"),
            crown: inputs.number("crown"),
            swell: inputs.number("swell"),
            tilt: inputs.number("tilt").to_radians(),
        }
    }
}
