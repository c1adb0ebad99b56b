//! Finds where the rings of a pith-to-bark bar begin: the edges from dark late wood to light early wood.

use crate::colour;

/// Width of the windows before and behind an edge whose brightness is compared, in mean ring widths.
const WINDOW: f64 = 1.0 / 8.0;

/// Smallest distance of edges from each other and from the ends, in mean ring widths.
const SPACING: f64 = 1.0 / 3.0;

/// Smallest step that counts as an edge: about 3 % of the luminance.
const FAINTEST: f64 = 0.03;

/// The starts of `rings` rings in pixels from the start of a line: 0, and the strongest edges from dark to
/// light. What is nearer to an end than a third of the mean ring is taken as part of the end.
///
/// # Errors
/// How many rings there are, if they are fewer.
pub(super) fn starts(profile: &[[f64; 3]], rings: usize) -> Result<Vec<f64>, usize> {
    let mean_width = profile.len() as f64 / rings as f64;
    let strengths = strengths(profile, ((mean_width * WINDOW).round() as usize).max(1));
    let spacing = (mean_width * SPACING).max(1.0);
    let mut edges = edges(&strengths, spacing);
    // Strong edges first; what is equally strong in the order of the line.
    edges.sort_by(|a, b| strengths[*b].total_cmp(&strengths[*a]));
    let mut starts = vec![0.0];
    let mut taken = vec![false; strengths.len()];
    for edge in edges {
        if starts.len() == rings {
            break;
        }
        if !taken[edge] {
            starts.push(edge as f64);
            let reach = spacing.ceil() as usize - 1;
            taken[edge.saturating_sub(reach)..(edge + reach + 1).min(strengths.len())].fill(true);
        }
    }
    starts.sort_by(f64::total_cmp);
    if starts.len() == rings {
        Ok(starts)
    } else {
        Err(starts.len())
    }
}

/// How much brighter the window behind each border of pixels is than the one before it, as the difference
/// of mean logarithms: shadows and lamps do not change it.
fn strengths(profile: &[[f64; 3]], window: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    for colour in profile {
        let luminance = colour::luminance(colour.map(|part| part as f32));
        sums.push(sums[sums.len() - 1] + libm::log(f64::from(luminance).max(1e-4)));
    }
    let last = profile.len();
    let mean = |from: usize, to: usize| (sums[to] - sums[from]) / (to - from).max(1) as f64;
    (0..=last)
        .map(|at| mean(at, (at + window).min(last)) - mean(at.saturating_sub(window), at))
        .collect()
}

/// Borders of pixels where the step is strongest among its neighbours.
fn edges(strengths: &[f64], spacing: f64) -> Vec<usize> {
    let last = strengths.len() - 1;
    (1..last)
        .filter(|at| (*at as f64) >= spacing && ((last - at) as f64) >= spacing)
        .filter(|at| strengths[*at] >= FAINTEST)
        .filter(|at| strengths[*at] >= strengths[at - 1] && strengths[*at] > strengths[at + 1])
        .collect()
}
