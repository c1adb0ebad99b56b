//! How noise repeats: a whole number of cells of every octave in a period.

use crate::node::{Failure, Inputs};

/// How far `size` may be from a whole part of the period; it is made to fit.
const TOLERANCE: f64 = 0.01;

/// Beyond, whole coordinates of cells are not exact.
const MOST_CELLS: f64 = 4_194_304.0;

/// Cells of the first octave in a period along x, y and z: 0 where there is no period.
pub(super) fn cells(inputs: &Inputs<'_>) -> Result<[f64; 3], Failure> {
    let (period, size) = (inputs.vector("period"), inputs.vector("size"));
    let mut cells = [0.0; 3];
    for ((axis, name), cells) in ["x", "y", "z"].into_iter().enumerate().zip(&mut cells) {
        if period[axis] > 0.0 {
            *cells = whole_cells(name, period[axis], size[axis])?;
        }
    }
    if cells != [0.0; 3] {
        keeps_to_cells(inputs, cells)?;
    }
    Ok(cells)
}

/// The number of cells of `size` mm in a period, if it is near a whole one.
fn whole_cells(axis: &str, period: f64, size: f64) -> Result<f64, Failure> {
    let cells = period / size;
    let whole = cells.round().max(1.0);
    if (cells / whole - 1.0).abs() <= TOLERANCE {
        return Ok(whole);
    }
    let fitting = [whole, cells.floor().max(1.0), cells.floor() + 1.0]
        .map(|whole| format!("{:.4}", period / whole));
    let fitting = if fitting[1] == fitting[2] {
        &fitting[..1]
    } else {
        &fitting[1..]
    };
    Err(Failure::of_input(
        "period",
        format!("a period of {period} mm along {axis} holds {cells:.2} features of {size} mm, expected a whole number"),
    )
    .with_hint(format!("let the size along {axis} be {} mm", fitting.join(" or "))))
}

/// Checks that finer octaves repeat with the first one, and that their cells can be counted.
fn keeps_to_cells(inputs: &Inputs<'_>, cells: [f64; 3]) -> Result<(), Failure> {
    let (octaves, lacunarity) = (inputs.whole("octaves"), inputs.number("lacunarity"));
    if octaves > 1 && lacunarity.fract() != 0.0 {
        return Err(Failure::of_input(
            "lacunarity",
            format!("octaves repeat only if each is a whole number of times finer, not {lacunarity} times"),
        )
        .with_hint("let the lacunarity be 2 or 3, or leave the period out"));
    }
    let finest = lacunarity.powi(octaves as i32 - 1);
    let most = cells.into_iter().fold(0.0, f64::max) * finest;
    if most > MOST_CELLS {
        return Err(Failure::of_input(
            "octaves",
            format!("the finest octave has {most:.0} features in a period, expected at most {MOST_CELLS}"),
        )
        .with_hint("take fewer octaves, or a larger size"));
    }
    Ok(())
}
