//! Numbers that say how cells lie.

use crate::value::Partition;
use glam::DVec2;

/// The numbers of a summary, by name; those that need neighbours are left out if there are none.
pub(super) fn of(cells: &Partition) -> Vec<(String, f64)> {
    let count = cells.len() as f64;
    let total: f64 = cells.areas.iter().sum();
    let mean = total / count;
    let square = cells.areas.iter().map(|area| (area - mean) * (area - mean));
    let deviation = (square.sum::<f64>() / count).sqrt();
    let mut numbers = vec![
        ("cells".to_owned(), count),
        ("area_mm2".to_owned(), total),
        ("mean_area_mm2".to_owned(), mean),
        ("area_variation".to_owned(), deviation / mean),
    ];
    numbers.extend(sides(cells));
    let bonds: Vec<Vec<DVec2>> = (0..cells.len()).map(|cell| bonds(cells, cell)).collect();
    numbers.extend(order(&bonds, 4).map(|order| ("psi4".to_owned(), order)));
    numbers.extend(order(&bonds, 6).map(|order| ("psi6".to_owned(), order)));
    numbers.extend(distances(&bonds, total / count));
    numbers
}

/// The share of cells with each number of neighbours.
fn sides(cells: &Partition) -> Vec<(String, f64)> {
    let counts: Vec<usize> = (0..cells.len())
        .map(|cell| cells.neighbours_of(cell).len())
        .collect();
    let most = counts.iter().copied().max().unwrap_or_default();
    let share = |sides: usize| {
        counts.iter().filter(|count| **count == sides).count() as f64 / counts.len() as f64
    };
    let shares = (0..=most).map(|sides| (format!("neighbours_{sides}"), share(sides)));
    shares.filter(|(_, share)| *share > 0.0).collect()
}

/// From the centre of a cell to those of its neighbours, where they are nearest.
fn bonds(cells: &Partition, cell: usize) -> Vec<DVec2> {
    let neighbours = cells.neighbours_of(cell).into_iter();
    let way = |other: u32| {
        let way = cells.centres[other as usize] - cells.centres[cell];
        cells
            .period
            .map_or(way, |period| way - (way / period).round() * period)
    };
    neighbours
        .map(way)
        .filter(|way| *way != DVec2::ZERO)
        .collect()
}

/// The mean bond order of cells with at least two neighbours (Nelson & Halperin 1979).
fn order(bonds: &[Vec<DVec2>], fold: i32) -> Option<f64> {
    let of_cell = |bonds: &Vec<DVec2>| {
        let sum = bonds.iter().fold(DVec2::ZERO, |sum, way| {
            let angle = f64::from(fold) * libm::atan2(way.y, way.x);
            sum + DVec2::new(libm::cos(angle), libm::sin(angle))
        });
        sum.length() / bonds.len() as f64
    };
    let orders: Vec<f64> = bonds
        .iter()
        .filter(|bonds| bonds.len() > 1)
        .map(of_cell)
        .collect();
    mean(&orders)
}

fn mean(numbers: &[f64]) -> Option<f64> {
    (!numbers.is_empty()).then(|| numbers.iter().sum::<f64>() / numbers.len() as f64)
}

/// The distance to the nearest neighbour over that of random centres, and over the mean distance to neighbours.
fn distances(bonds: &[Vec<DVec2>], mean_area: f64) -> Vec<(String, f64)> {
    let lengths = |bonds: &Vec<DVec2>| bonds.iter().map(|way| way.length()).collect::<Vec<_>>();
    let all: Vec<Vec<f64>> = bonds
        .iter()
        .map(lengths)
        .filter(|lengths| !lengths.is_empty())
        .collect();
    let nearest: Vec<f64> = all
        .iter()
        .map(|it| it.iter().copied().fold(f64::INFINITY, f64::min))
        .collect();
    let (Some(nearest), Some(of_all)) = (mean(&nearest), mean(&all.concat())) else {
        return vec![];
    };
    vec![
        ("mean_spacing_mm".to_owned(), of_all),
        (
            "nearest_ratio".to_owned(),
            nearest / (0.5 * mean_area.sqrt()),
        ),
        ("nearest_over_mean_spacing".to_owned(), nearest / of_all),
    ]
}
