//! Sinusoids that are added to the radius of rings: curls, flutes and swirls.

use std::f64::consts::PI;

/// One sinusoid over height and angle: `a sin(2 pi z / l + m phi + psi)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude a in mm.
    pub amplitude: f64,
    /// Waves in a mm of height, 1 / l; 0 for flutes that run straight up.
    pub per_millimetre: f64,
    /// Waves in a turn about the axis, m.
    pub turns: i64,
    /// Phase psi in whole turns.
    pub phase: f64,
}

impl Wave {
    /// What it adds in mm to the radius of a ring, `angle` in radians about the axis.
    pub fn at(&self, height: f64, angle: f64) -> f64 {
        let turns = height * self.per_millimetre + self.phase;
        // The whole turns are taken off first: a sine of many turns is less exact.
        let turns = 2.0 * PI * (turns - turns.floor());
        self.amplitude * libm::sin(turns + self.turns as f64 * angle)
    }
}

/// The share of the waves that is left at `radius` mm from the pith, if their amplitudes add up to `most` mm.
///
/// A ring that is narrower than a wave is high cannot carry it: with the whole wave, radii near the pith would
/// come twice or be negative. Within 2 `most` it fades as t (2 - t), so that radii rise strictly outwards and
/// nothing bends suddenly (own construction).
pub(super) fn share(radius: f64, most: f64) -> f64 {
    if radius >= 2.0 * most {
        return 1.0;
    }
    let t = radius / (2.0 * most);
    t * (2.0 - t)
}
