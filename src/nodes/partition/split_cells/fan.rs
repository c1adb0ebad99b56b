//! Setts in segmental arcs: lanes of equal arcs, one course behind the other.
//!
//! All courses of a lane are copies of one arc, moved along the lane; joints point to the middle of the arc's circle and
//! are moved by half a sett from course to course. Edges along the arcs are exact arcs, but where a cell is cut at an outline
//! they are chords, also those of the cell beyond.

use super::super::division::Plot;
use super::ground::{Laid, Tile, Window};
use crate::geometry::polygon::Edges;
use crate::node::Failure;
use glam::DVec2;

/// Chords instead of an arc.
const CHORDS: i32 = 6;

/// The arc of a lane.
struct Arc {
    radius: f64,
    /// Half of its angle.
    half: f64,
    /// From course to course.
    pitch: f64,
    /// Setts in a whole course.
    setts: i64,
}

/// Lays setts of a size over the window, in lanes with arcs that rise by a share of the lane's width.
///
/// # Errors
/// If courses are so wide that a joint, which points to the middle of its arc, does not meet the next one.
pub(super) fn lay(
    window: &Window,
    sett: DVec2,
    lane: f64,
    rise: f64,
    plot: &Plot,
) -> Result<Laid, Failure> {
    let lanes = window.steps(0, lane, 1);
    let courses = window.steps(1, sett.y, 2);
    let sagitta = rise * lanes.step;
    let radius = 0.5 * (0.25 * lanes.step * lanes.step / sagitta + sagitta);
    let half = libm::asin(0.5 * lanes.step / radius);
    if courses.step * libm::sin(half) >= radius {
        let message = format!(
            "courses are {:.3} mm wide, which is more than the arcs of lanes of {:.3} mm have room for",
            courses.step, lanes.step
        );
        return Err(Failure::of_input("width", message)
            .with_hint("state a smaller `width` of a sett, or a wider `lane`"));
    }
    let arc = Arc {
        radius,
        half,
        pitch: courses.step,
        setts: (2.0 * half * radius / sett.x).round().max(2.0) as i64,
    };
    let more = match window.period {
        Some(_) => 0,
        None => (sagitta / courses.step).ceil() as i64,
    };
    let border = Border::new(window, plot);
    let mut tiles = vec![];
    for lane in lanes.first..lanes.end {
        for course in courses.first - more..courses.end {
            let origin = DVec2::new((lane as f64 + 0.5) * lanes.step, course as f64 * arc.pitch);
            for index in 0..arc.count(course) {
                let values = vec![
                    ("row", course as f64),
                    ("column", (lane * arc.setts + index) as f64),
                    ("length", arc.length(course, index)),
                ];
                tiles.extend(arc.tile(window, &border, origin, course, index, values));
            }
        }
    }
    Ok(Laid::over(tiles, [lanes.stretch, courses.stretch]))
}

impl Arc {
    /// Setts in a course: every other one begins and ends with half a sett.
    fn count(&self, course: i64) -> i64 {
        self.setts + course.rem_euclid(2)
    }

    /// The angle of a course's joint, from the middle, at its lower arc.
    fn joint(&self, course: i64, index: i64) -> f64 {
        let half = 0.5 * course.rem_euclid(2) as f64;
        let share = (index as f64 - half).clamp(0.0, self.setts as f64) / self.setts as f64;
        self.half * (2.0 * share - 1.0)
    }

    /// Where a joint meets the upper arc of its course, as an angle there.
    fn upper(&self, angle: f64) -> f64 {
        if angle.abs() >= self.half {
            return angle;
        }
        // The ray from the lower circle's middle meets the circle that is moved up by the pitch.
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let along = self.pitch * cos
            + (self.radius * self.radius - self.pitch * self.pitch * sin * sin).sqrt();
        libm::atan2(along * sin, along * cos - self.pitch).clamp(-self.half, self.half)
    }

    /// The point of the arc at an angle, seen from its middle.
    fn at(&self, angle: f64) -> DVec2 {
        let top = self.radius * (libm::cos(angle) - libm::cos(self.half));
        DVec2::new(self.radius * libm::sin(angle), top)
    }

    fn length(&self, course: i64, index: i64) -> f64 {
        self.radius * (self.joint(course, index + 1) - self.joint(course, index))
    }

    /// All corners on the line between a course and the one below it.
    fn angles(&self, course: i64, from: f64, to: f64) -> Vec<f64> {
        let own = (0..=self.count(course)).map(|index| self.joint(course, index));
        let below =
            (0..=self.count(course - 1)).map(|index| self.upper(self.joint(course - 1, index)));
        let mut angles: Vec<f64> = own
            .chain(below)
            .filter(|angle| *angle >= from && *angle <= to)
            .collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|next, kept| (*next - *kept).abs() < 1e-9);
        angles
    }

    /// A sett, unless it is far from the window.
    fn tile(
        &self,
        window: &Window,
        border: &Border,
        origin: DVec2,
        course: i64,
        index: i64,
        values: Vec<(&'static str, f64)>,
    ) -> Option<Tile> {
        let joints = [self.joint(course, index), self.joint(course, index + 1)];
        let tops = joints.map(|angle| self.upper(angle));
        let lower = self.angles(course, joints[0], joints[1]);
        let mut upper = self.angles(course + 1, tops[0], tops[1]);
        upper.reverse();
        let above = origin + DVec2::new(0.0, self.pitch);
        let bounds = self.bounds(origin, joints, tops);
        if !window.is_near(bounds[0], bounds[1]) {
            return None;
        }
        let mut tile = Tile {
            corners: vec![],
            bulges: vec![],
            along: self.at(joints[1]) - self.at(joints[0]),
            values,
        };
        tile.along = tile.along.normalize();
        self.line(border, origin, &lower, &mut tile);
        self.line(border, above, &upper, &mut tile);
        Some(tile)
    }

    /// A box around a sett.
    fn bounds(&self, origin: DVec2, joints: [f64; 2], tops: [f64; 2]) -> [DVec2; 2] {
        let above = origin + DVec2::new(0.0, self.pitch);
        let mut corners = vec![above + self.at(0.0_f64.clamp(tops[0], tops[1]))];
        corners.extend(joints.map(|angle| origin + self.at(angle)));
        corners.extend(tops.map(|angle| above + self.at(angle)));
        let [first, rest @ ..] = &corners[..] else {
            return [origin; 2];
        };
        rest.iter()
            .fold([*first; 2], |[low, high], at| [low.min(*at), high.max(*at)])
    }

    /// Adds the corners of an arc line, as arcs or as chords.
    fn line(&self, border: &Border, origin: DVec2, angles: &[f64], tile: &mut Tile) {
        for pair in angles.windows(2) {
            let ends = [pair[0], pair[1]].map(|angle| origin + self.at(angle));
            let reach = 2.0
                * (self.pitch
                    + self.radius * (pair[1] - pair[0]).abs()
                    + 2.0 * self.half * self.radius / self.setts as f64);
            if border.is_near(ends, reach) {
                for chord in 0..CHORDS {
                    let share = f64::from(chord) / f64::from(CHORDS);
                    // The same point from either side.
                    let [low, high, share] = if pair[0] < pair[1] {
                        [pair[0], pair[1], share]
                    } else {
                        [pair[1], pair[0], 1.0 - share]
                    };
                    tile.corners
                        .push(origin + self.at(low + (high - low) * share));
                    tile.bulges.push(0.0);
                }
            } else {
                // Angles are from the top clockwise, so rising ones make an arc that turns right.
                tile.corners.push(ends[0]);
                tile.bulges.push(-libm::tan(0.25 * (pair[1] - pair[0])));
            }
        }
        if let Some(last) = angles.last() {
            tile.corners.push(origin + self.at(*last));
            tile.bulges.push(0.0);
        }
    }
}

/// The outline that cells are cut at.
struct Border {
    edges: Option<Edges>,
}

impl Border {
    fn new(window: &Window, plot: &Plot) -> Border {
        let seen = |ring: &[DVec2]| ring.iter().map(|at| window.axes().seen(*at)).collect();
        let rings: Vec<Vec<DVec2>> = plot.region.rings().map(seen).collect();
        let edges = plot
            .period
            .is_none()
            .then(|| Edges::new(rings.iter().map(|ring| &ring[..])));
        Border { edges }
    }

    /// Whether a cell with an edge between these points may be cut.
    fn is_near(&self, [a, b]: [DVec2; 2], reach: f64) -> bool {
        let around = [a.min(b) - reach, a.max(b) + reach];
        self.edges
            .as_ref()
            .is_some_and(|edges| edges.come_near(around))
    }
}
