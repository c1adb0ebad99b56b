//! Growth time in double precision, term by term: the reference that the kernel is tested against.

use super::line::TrunkLine;
use super::straight::{StraightTrunk, Way};
use crate::geometry::spline::TrunkCurve;
use crate::node::Failure;
use crate::value::{RingSeries, Skeleton, Thickness};
use glam::DVec3;
use std::sync::Arc;

/// The fastest thickening of a branch in mm/year.
const FASTEST: f64 = 1e5;

/// How a tree grows along its skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowthSettings {
    /// Speed v_e in mm/year at which branches grow longer, and the trunk unless its rings are known.
    pub elongation: f64,
    /// Speed v_h in mm/year at which the trunk grows thicker, unless its rings are known.
    pub thickening: f64,
    /// Exponent k of the blend between trunk and branches; 2 is eq. (18).
    pub sharpness: f64,
    /// How far branches reach; `None` is for ever.
    pub reach: Option<Reach>,
}

/// How far the influence of a branch reaches. It fades out from half of the reach on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Distance along the axis in mm.
    pub along: f64,
    /// Distance from the axis in mm.
    pub across: f64,
}

/// A branch with all that its growth depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowingBranch {
    /// The point b1 of the trunk's curve where it starts, in mm.
    pub start: DVec3,
    /// Unit vector along the axis.
    pub direction: DVec3,
    /// T_alpha in years: when the trunk's tip passed the start.
    pub start_time: f64,
    /// Speed v_b in mm/year at which it grows thicker.
    pub thickening: f64,
}

/// A tree that is ready to be asked for growth times.
#[derive(Clone, Debug, PartialEq)]
pub struct GrowthModel {
    /// The trunk.
    pub trunk: TrunkLine,
    /// The branches in the order of the skeleton.
    pub branches: Vec<GrowingBranch>,
    /// How it grows.
    pub settings: GrowthSettings,
    /// How tall and thick the trunk was in each year, instead of its speeds.
    pub rings: Option<Arc<RingSeries>>,
}

/// The parts of the time at which growth along a branch reached a point, in years.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BranchTerms {
    /// T_alpha: from the ground to the start of the branch.
    pub alpha: f64,
    /// T_beta: along the branch to the foot of the point, eq. (14).
    pub beta: f64,
    /// T_gamma: from the axis to the point, eq. (15).
    pub gamma: f64,
    /// What the reach leaves of the influence, from 0 to 1: it acts as if T_2 were divided by it.
    pub fade: f64,
}

impl BranchTerms {
    /// T_2 in years, eq. (17).
    pub fn time(&self) -> f64 {
        self.alpha + self.beta + self.gamma
    }
}

/// When a point grew, and what made it so.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// T_1 in years: the time by growth of the trunk alone, eq. (13).
    pub trunk: f64,
    /// For every branch its terms; `None` behind its start and beyond its reach.
    pub branches: Vec<Option<BranchTerms>>,
    /// T in years.
    pub time: f64,
    /// Share of the branches in T: S / (1 + S) with `S = sum (f_i T_1 / T_i)^k`.
    pub branch: f64,
}

/// When the wood at `point` grew, eqs. (9)-(18) of Momoi & Takatera 2014.
///
/// Builds the model anew for each point; to ask for many, keep a [`GrowthModel`].
///
/// # Errors
/// A skeleton that is none, or a branch whose thickness cannot be reached.
pub fn growth_time(
    skeleton: &Skeleton,
    settings: GrowthSettings,
    point: DVec3,
) -> Result<Terms, Failure> {
    Ok(GrowthModel::new(skeleton, settings)?.terms(point))
}

impl GrowthModel {
    /// A tree with a curved trunk that grows by speeds; finds how fast each branch thickens.
    ///
    /// # Errors
    /// Nodes that make no curve, a branch that starts beyond the ends of the trunk, a direction of length
    /// 0, a thickness that is not positive or cannot be reached.
    pub fn new(skeleton: &Skeleton, settings: GrowthSettings) -> Result<GrowthModel, Failure> {
        GrowthModel::with_rings(skeleton, settings, None)
    }

    /// As [`GrowthModel::new`], with a trunk that grows by a ring series if there is one: at the height z, ring n
    /// reaches to `sqrt((S_n - S_m) / pi)` from its curve, m being the time at which the tree was as tall as z.
    ///
    /// # Errors
    /// As [`GrowthModel::new`].
    pub fn with_rings(
        skeleton: &Skeleton,
        settings: GrowthSettings,
        rings: Option<Arc<RingSeries>>,
    ) -> Result<GrowthModel, Failure> {
        let trunk = TrunkLine::Curved(curve(skeleton)?);
        GrowthModel::along(trunk, skeleton, settings, rings)
    }

    /// As [`GrowthModel::with_rings`], with a trunk of straight segments.
    ///
    /// # Errors
    /// As [`GrowthModel::new`]: a trunk that no curve can follow is none.
    pub fn straight(
        skeleton: &Skeleton,
        settings: GrowthSettings,
        rings: Option<Arc<RingSeries>>,
    ) -> Result<GrowthModel, Failure> {
        curve(skeleton)?;
        let trunk = TrunkLine::Straight(StraightTrunk::through(&skeleton.trunk));
        GrowthModel::along(trunk, skeleton, settings, rings)
    }

    fn along(
        trunk: TrunkLine,
        skeleton: &Skeleton,
        settings: GrowthSettings,
        rings: Option<Arc<RingSeries>>,
    ) -> Result<GrowthModel, Failure> {
        let mut model = GrowthModel {
            trunk,
            branches: vec![],
            settings,
            rings,
        };
        for (index, branch) in skeleton.branches.iter().enumerate() {
            let start = model.trunk.at(branch.height);
            let mut growing = GrowingBranch {
                start,
                direction: branch.direction.normalize_or_zero(),
                start_time: model.tip_time(model.trunk.way_to(branch.height)),
                thickening: 0.0,
            };
            let thickening = model
                .check(branch.height, &growing)
                .and_then(|()| model.branch_thickening(&growing, branch.thickness));
            growing.thickening = thickening.map_err(|reason| {
                Failure::of_input("skeleton", format!("branch {}: {reason}", index + 1))
            })?;
            model.branches.push(growing);
        }
        Ok(model)
    }

    /// T_1 in years, eqs. (9)-(13): cones about the trunk's curve; or eqs. (1)-(3) and the blend of the straight
    /// skeleton.
    pub fn trunk_time(&self, point: DVec3) -> f64 {
        match &self.trunk {
            TrunkLine::Curved(curve) => self.time_of(Way {
                along: point.z,
                across: (point - curve.at(point.z)).truncate().length(),
            }),
            TrunkLine::Straight(trunk) => {
                let seen = trunk.see(point);
                let [first, second] = seen.ways.map(|way| self.time_of(way));
                seen.share * first + (1.0 - seen.share) * second
            }
        }
    }

    /// When the trunk's tip had come this way in mm, in years.
    fn tip_time(&self, way: f64) -> f64 {
        match &self.rings {
            Some(rings) => rings.time_of_height(way),
            None => way / self.settings.elongation,
        }
    }

    /// How many years growth took along the trunk and from there to a point.
    fn time_of(&self, way: Way) -> f64 {
        match &self.rings {
            Some(rings) => rings.time_at(way.across, way.along),
            None => self.tip_time(way.along) + way.across / self.settings.thickening,
        }
    }

    /// When the wood at `point` (mm) grew, with all terms.
    ///
    /// `T = (sum (f_i / T_i)^k)^(-1/k)` over the trunk (`f = 1`) and all branches; for k = 2 and without
    /// a reach that is eq. (18) applied in turn. If the smallest T_i is 0 or less, it is T.
    pub fn terms(&self, point: DVec3) -> Terms {
        let trunk = self.trunk_time(point);
        let branches: Vec<_> = self
            .branches
            .iter()
            .map(|branch| self.branch_terms(branch, point))
            .collect();
        let times: Vec<(f64, f64)> = branches
            .iter()
            .flatten()
            .map(|terms| (terms.time(), terms.fade))
            .collect();
        let (time, branch) = blend(trunk, &times, self.settings.sharpness);
        Terms {
            trunk,
            branches,
            time,
            branch,
        }
    }

    fn branch_terms(&self, branch: &GrowingBranch, point: DVec3) -> Option<BranchTerms> {
        let from_start = point - branch.start;
        let along = from_start.dot(branch.direction);
        let across = (from_start - branch.direction * along).length();
        let fade = self.settings.reach.map_or(1.0, |reach| {
            fade(along, reach.along) * fade(across, reach.across)
        });
        (along > 0.0 && fade > 0.0).then(|| BranchTerms {
            alpha: branch.start_time,
            beta: along / self.settings.elongation,
            gamma: across * from_start.length() / (branch.thickening * along),
            fade,
        })
    }

    fn check(&self, height: f64, branch: &GrowingBranch) -> Result<(), String> {
        let [lowest, highest] = self.trunk.heights();
        if !(lowest..=highest).contains(&height) {
            return Err(format!(
                "expected a start between z = {lowest} and z = {highest} mm, found {height}"
            ));
        }
        if branch.direction == DVec3::ZERO {
            return Err("expected a direction, found a vector of length 0".into());
        }
        Ok(())
    }

    /// v_b in mm/year.
    ///
    /// A branch that is w thick to each side at the distance L along its axis has its border where T_2 =
    /// T_1, so `v_b = w sqrt(L^2 + w^2) / (L (T_1 - T_alpha - L / v_e))` from eqs. (14), (15) and (17). T_1 is
    /// taken on the axis, at the distance from the trunk's curve at which the branch ends.
    fn branch_thickening(
        &self,
        branch: &GrowingBranch,
        thickness: Thickness,
    ) -> Result<f64, String> {
        let speed = match thickness {
            Thickness::Speed(speed) => speed,
            Thickness::HalfWidth {
                distance,
                half_width,
            } => {
                let end_time = self.trunk_time(branch.start + branch.direction * distance);
                let left = end_time - branch.start_time - distance / self.settings.elongation;
                // Of two equal times rounding may leave a difference.
                if left <= 1e-9 * end_time.abs() {
                    return Err(format!(
                        "the trunk's wood is there {:.3} years before the branch is {distance} mm long",
                        -left
                    ));
                }
                half_width * (distance * distance + half_width * half_width).sqrt()
                    / (distance * left)
            }
        };
        if speed > 0.0 && speed <= FASTEST {
            Ok(speed)
        } else {
            Err(format!(
                "expected a thickening from 0 to {FASTEST} mm/year, found {speed}"
            ))
        }
    }
}

/// The curve through a skeleton's trunk.
fn curve(skeleton: &Skeleton) -> Result<TrunkCurve, Failure> {
    TrunkCurve::through(&skeleton.trunk, skeleton.tangents)
        .map_err(|error| Failure::of_input("skeleton", format!("trunk: {error}")))
}

/// T and the share of the branches in it, from T_1 and (T_i, f_i) of every branch.
fn blend(trunk: f64, branches: &[(f64, f64)], sharpness: f64) -> (f64, f64) {
    let least = branches
        .iter()
        .fold(trunk, |least, (time, _)| least.min(*time));
    if least <= 0.0 {
        return (least, if least < trunk { 1.0 } else { 0.0 });
    }
    let weight = |time: f64, fade: f64| libm::pow(fade * least / time, sharpness);
    let of_branches: f64 = branches
        .iter()
        .map(|(time, fade)| weight(*time, *fade))
        .sum();
    let total = weight(trunk, 1.0) + of_branches;
    (
        least * libm::pow(total, -1.0 / sharpness),
        of_branches / total,
    )
}

/// 1 up to half the reach, 0 from the reach on, with a continuous slope.
fn fade(distance: f64, reach: f64) -> f64 {
    let half = 0.5 * reach;
    let left = ((reach - distance) / half).clamp(0.0, 1.0);
    left * left * (3.0 - 2.0 * left)
}
