//! A small alphabet of strokes: the figures and letters that plots need.
//!
//! Letters stand on a grid: figures are 6 units tall and 4 wide, small letters 4 tall, tails reach 2 below the line
//! (own construction).

/// A stroke: points that are joined by straight lines, in units.
type Stroke = &'static [(i8, i8)];

/// The units from the line to the top of a figure.
pub(super) const TALL: f64 = 6.0;

/// The units between two letters.
const GAP: f64 = 2.0;

/// A letter's width in units and its strokes; letters that are not there are blank.
fn letter(letter: char) -> (f64, &'static [Stroke]) {
    match letter {
        '0' => (
            4.0,
            &[&[
                (1, 0),
                (3, 0),
                (4, 1),
                (4, 5),
                (3, 6),
                (1, 6),
                (0, 5),
                (0, 1),
                (1, 0),
            ]],
        ),
        '1' => (4.0, &[&[(1, 5), (2, 6), (2, 0)], &[(1, 0), (3, 0)]]),
        '2' => (
            4.0,
            &[&[(0, 5), (1, 6), (3, 6), (4, 5), (4, 4), (0, 0), (4, 0)]],
        ),
        '3' => (
            4.0,
            &[
                &[
                    (0, 5),
                    (1, 6),
                    (3, 6),
                    (4, 5),
                    (4, 4),
                    (3, 3),
                    (4, 2),
                    (4, 1),
                    (3, 0),
                    (1, 0),
                    (0, 1),
                ],
                &[(3, 3), (2, 3)],
            ],
        ),
        '4' => (4.0, &[&[(3, 0), (3, 6), (0, 2), (4, 2)]]),
        '5' => (
            4.0,
            &[&[
                (4, 6),
                (0, 6),
                (0, 3),
                (3, 3),
                (4, 2),
                (4, 1),
                (3, 0),
                (1, 0),
                (0, 1),
            ]],
        ),
        '6' => (
            4.0,
            &[&[
                (4, 5),
                (3, 6),
                (1, 6),
                (0, 5),
                (0, 1),
                (1, 0),
                (3, 0),
                (4, 1),
                (4, 2),
                (3, 3),
                (1, 3),
                (0, 2),
            ]],
        ),
        '7' => (4.0, &[&[(0, 6), (4, 6), (1, 0)]]),
        '8' => (
            4.0,
            &[&[
                (1, 3),
                (0, 4),
                (0, 5),
                (1, 6),
                (3, 6),
                (4, 5),
                (4, 4),
                (3, 3),
                (1, 3),
                (0, 2),
                (0, 1),
                (1, 0),
                (3, 0),
                (4, 1),
                (4, 2),
                (3, 3),
            ]],
        ),
        '9' => (
            4.0,
            &[&[
                (4, 4),
                (3, 3),
                (1, 3),
                (0, 4),
                (0, 5),
                (1, 6),
                (3, 6),
                (4, 5),
                (4, 1),
                (3, 0),
                (1, 0),
                (0, 1),
            ]],
        ),
        '.' => (0.0, &[&[(0, 0), (0, 0)]]),
        '-' => (3.0, &[&[(0, 3), (3, 3)]]),
        'a' => (
            3.0,
            &[&[
                (0, 4),
                (2, 4),
                (3, 3),
                (3, 0),
                (1, 0),
                (0, 1),
                (1, 2),
                (3, 2),
            ]],
        ),
        'd' => (
            3.0,
            &[&[(3, 6), (3, 0), (1, 0), (0, 1), (0, 3), (1, 4), (3, 4)]],
        ),
        'e' => (
            3.0,
            &[&[
                (0, 2),
                (3, 2),
                (3, 3),
                (2, 4),
                (1, 4),
                (0, 3),
                (0, 1),
                (1, 0),
                (3, 0),
            ]],
        ),
        'g' => (
            3.0,
            &[&[
                (3, 0),
                (1, 0),
                (0, 1),
                (0, 3),
                (1, 4),
                (3, 4),
                (3, -1),
                (2, -2),
                (0, -2),
            ]],
        ),
        'h' => (
            3.0,
            &[&[(0, 6), (0, 0)], &[(0, 3), (1, 4), (2, 4), (3, 3), (3, 0)]],
        ),
        'i' => (0.0, &[&[(0, 4), (0, 0)], &[(0, 6), (0, 6)]]),
        'm' => (
            4.0,
            &[
                &[(0, 0), (0, 4), (1, 4), (2, 3), (2, 0)],
                &[(2, 3), (3, 4), (4, 3), (4, 0)],
            ],
        ),
        'n' => (
            3.0,
            &[&[(0, 4), (0, 0)], &[(0, 3), (1, 4), (2, 4), (3, 3), (3, 0)]],
        ),
        'r' => (2.0, &[&[(0, 4), (0, 0)], &[(0, 3), (1, 4), (2, 4)]]),
        't' => (2.0, &[&[(1, 6), (1, 1), (2, 0)], &[(0, 4), (2, 4)]]),
        'w' => (4.0, &[&[(0, 4), (1, 0), (2, 3), (3, 0), (4, 4)]]),
        'y' => (
            3.0,
            &[
                &[(0, 4), (0, 1), (1, 0), (3, 0)],
                &[(3, 4), (3, -1), (2, -2), (0, -2)],
            ],
        ),
        _ => (1.5, &[]),
    }
}

/// The width of a text in units.
pub(super) fn width(text: &str) -> f64 {
    let advances: f64 = text.chars().map(|it| letter(it).0 + GAP).sum();
    (advances - GAP).max(0.0)
}

/// The lines of a text that begins at the origin, in units.
pub(super) fn lines(text: &str) -> Vec<[[f64; 2]; 2]> {
    let mut lines = vec![];
    let mut start = 0.0;
    for (wide, strokes) in text.chars().map(letter) {
        let point = |(x, y): (i8, i8)| [start + f64::from(x), f64::from(y)];
        for pair in strokes.iter().flat_map(|stroke| stroke.windows(2)) {
            lines.push([point(pair[0]), point(pair[1])]);
        }
        start += wide + GAP;
    }
    lines
}
