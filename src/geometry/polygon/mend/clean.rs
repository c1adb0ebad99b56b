//! Rings without repeated corners and without lines that turn back on themselves.

use super::{Wrong, doubled_area};
use glam::DVec2;

/// Takes out repeated corners, and lines that turn back on themselves; what was wrong, and where.
pub(super) fn clean(ring: &mut Vec<DVec2>, near: f64) -> Vec<(Wrong, DVec2)> {
    let mut faults = vec![];
    let mut kept: Vec<DVec2> = Vec::with_capacity(ring.len());
    for corner in ring.iter() {
        let wrong = match kept[..] {
            [.., last] if last.distance(*corner) <= near => Some(Wrong::Repeated),
            [.., before, last] if turns_back(before, last, *corner, near) => Some(Wrong::Spike),
            _ => None,
        };
        faults.extend(wrong.map(|wrong| (wrong, *corner)));
        match wrong {
            None => kept.push(*corner),
            Some(Wrong::Repeated) => {}
            Some(_) => leave_spike(&mut kept, *corner, near),
        }
    }
    close(&mut kept, near, &mut faults);
    *ring = kept;
    faults
}

/// As [`clean`], where the last corner meets the first.
fn close(kept: &mut Vec<DVec2>, near: f64, faults: &mut Vec<(Wrong, DVec2)>) {
    while let [first, second, .., before, last] = kept[..] {
        if first.distance(last) <= near {
            // Behind a spike its two feet lie on each other.
            if !matches!(faults.last(), Some((Wrong::Spike, _))) {
                faults.push((Wrong::Repeated, last));
            }
            kept.pop();
        } else if turns_back(before, last, first, near) {
            faults.push((Wrong::Spike, last));
            kept.pop();
        } else if turns_back(last, first, second, near) {
            faults.push((Wrong::Spike, first));
            kept.remove(0);
        } else {
            break;
        }
    }
}

/// Goes on from where a spike leaves the line.
fn leave_spike(kept: &mut Vec<DVec2>, corner: DVec2, near: f64) {
    kept.pop();
    while let [.., before, last] = kept[..] {
        if !turns_back(before, last, corner, near) {
            break;
        }
        kept.pop();
    }
    if kept.last().is_none_or(|last| last.distance(corner) > near) {
        kept.push(corner);
    }
}

/// Whether the way from `before` over `last` goes back onto itself at `next`.
fn turns_back(before: DVec2, last: DVec2, next: DVec2, near: f64) -> bool {
    let (there, back) = (last - before, next - last);
    let off = there.perp_dot(back).abs();
    there.dot(back) < 0.0 && off <= near * there.length().max(back.length())
}

/// Whether a ring encloses no more than a strip so wide around half of it.
pub(super) fn is_thin(ring: &[DVec2], thin: f64) -> bool {
    let next = ring.iter().cycle().skip(1);
    let length: f64 = ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
    2.0 * doubled_area(ring).abs() <= thin * length
}
