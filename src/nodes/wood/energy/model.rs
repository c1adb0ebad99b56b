//! Virtual energy in double precision, term by term: the reference that the kernel is tested against.

use super::Axis;
use super::wave::{self, Wave};
use glam::DVec3;

/// To which trunk an energy is compared, to find the radius it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// V1: a line without ends. Without branches and burls the radius is the distance from the axis.
    Endless,
    /// V2: the trunk as a rod, at its middle. Rings are strict surfaces of equal energy.
    Middle,
    /// V3: the trunk as a rod, at the point's own height. On a straight bare trunk as V1.
    Local,
}

/// A straight line of charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// Where it starts, in mm.
    pub start: DVec3,
    /// Unit vector along it.
    pub direction: DVec3,
    /// Its length in mm.
    pub length: f64,
    /// Its charge per length; the trunk has 1.
    pub charge: f64,
}

impl Rod {
    /// A rod between two points.
    pub fn between(start: DVec3, end: DVec3, charge: f64) -> Rod {
        Rod {
            start,
            direction: (end - start).normalize_or(DVec3::Z),
            length: start.distance(end),
            charge,
        }
    }

    /// Its energy at a point: `lambda (asinh((L - s) / r) + asinh(s / r))`.
    ///
    /// As the logarithm of a quotient it would lose all digits far away and near the axis.
    pub fn energy(&self, point: DVec3) -> f64 {
        let from_start = point - self.start;
        let along = from_start.dot(self.direction);
        let across = (from_start - self.direction * along).length();
        let across = across.max(LEAST_DISTANCE);
        self.charge * (libm::asinh((self.length - along) / across) + libm::asinh(along / across))
    }
}

/// A point charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burl {
    /// Where it is, in mm.
    pub centre: DVec3,
    /// Its charge in mm, the trunk having 1 per mm: alone it has the energy 1 at that distance.
    pub charge: f64,
}

impl Burl {
    /// Its energy at a point: `q / |P - c|`.
    pub fn energy(&self, point: DVec3) -> f64 {
        self.charge / point.distance(self.centre).max(LEAST_DISTANCE)
    }
}

/// Nearer than this to a charge, in mm, energies rise no more.
pub(super) const LEAST_DISTANCE: f64 = 1e-5;

/// A tree of charges that is ready to be asked.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyModel {
    /// The centre line of the trunk.
    pub axis: Axis,
    /// To which trunk energies are compared.
    pub reference: Reference,
    /// The trunk as rods, from the ground up.
    pub trunk: Vec<Rod>,
    /// The branches.
    pub branches: Vec<Rod>,
    /// The burls.
    pub burls: Vec<Burl>,
    /// The waves in the rings.
    pub waves: Vec<Wave>,
}

/// The energies at a point, and what they stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyTerms {
    /// Energy of the trunk: of a line without ends, `-2 ln r`, r in mm, or of its rods.
    pub trunk: f64,
    /// Energy of all branches.
    pub branches: f64,
    /// Energy of all burls.
    pub burls: f64,
    /// The radius in mm of the ring that has this energy on a trunk without branches and burls.
    pub radius: f64,
    /// What the waves add to the radius of rings here, in mm.
    pub wave: f64,
}

impl EnergyTerms {
    /// The whole energy.
    pub fn energy(&self) -> f64 {
        self.trunk + self.branches + self.burls
    }
}

impl EnergyModel {
    /// A model without branches, burls and waves.
    pub fn bare(axis: Axis, reference: Reference) -> EnergyModel {
        let points = axis.points();
        let rods = points.windows(2);
        EnergyModel {
            trunk: rods
                .map(|ends| Rod::between(ends[0], ends[1], 1.0))
                .collect(),
            axis,
            reference,
            branches: vec![],
            burls: vec![],
            waves: vec![],
        }
    }

    /// Length of the trunk in mm.
    pub fn length(&self) -> f64 {
        self.trunk.iter().map(|rod| rod.length).sum()
    }

    /// The energies at `point` (mm).
    pub fn terms(&self, point: DVec3) -> EnergyTerms {
        let offset = self.axis.offset(point);
        let distance = offset.length();
        let branches = self.branches.iter().map(|rod| rod.energy(point)).sum();
        let burls = self.burls.iter().map(|burl| burl.energy(point)).sum();
        let trunk = match self.reference {
            Reference::Endless => -2.0 * libm::log(distance.max(LEAST_DISTANCE)),
            _ => self.trunk.iter().map(|rod| rod.energy(point)).sum(),
        };
        let radius = match self.reference {
            Reference::Endless => distance * libm::exp(-0.5 * (branches + burls)),
            Reference::Middle => self.middle_radius(trunk + branches + burls),
            Reference::Local => self.local_radius(trunk + branches + burls, point.z),
        };
        let angle = libm::atan2(offset.y, offset.x);
        let waves = self.waves.iter().map(|wave| wave.at(point.z, angle));
        EnergyTerms {
            trunk,
            branches,
            burls,
            radius,
            wave: waves.sum::<f64>() * wave::share(radius, self.largest_wave()),
        }
    }

    /// The sum of the amplitudes of all waves in mm.
    pub fn largest_wave(&self) -> f64 {
        self.waves.iter().map(|wave| wave.amplitude.abs()).sum()
    }

    /// `(L / 2) / sinh(E / 2)`: where the middle of the bare rod has this energy.
    fn middle_radius(&self, energy: f64) -> f64 {
        0.5 * self.length() / libm::sinh(0.5 * energy)
    }

    /// The half axis of the spheroid of this energy, made smaller as it is at this height; 0 beyond its tips.
    fn local_radius(&self, energy: f64, height: f64) -> f64 {
        let [low, high] = self.axis.heights();
        // From -1 to 1 along the trunk, in half lengths of the spheroid.
        let along = (2.0 * (height - low) / (high - low) - 1.0) * libm::tanh(0.5 * energy);
        self.middle_radius(energy) * (1.0 - along * along).max(0.0).sqrt()
    }
}
