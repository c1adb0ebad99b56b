//! Columns of a board of wood, and of the normals of a rough ground.

/// A number from -0.5 to 0.5 for a cell of a lattice.
fn noise(x: u32, y: u32) -> f32 {
    let mixed = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77);
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
    ((mixed ^ mixed >> 13) & 0xffff) as f32 / 65535.0 - 0.5
}

fn columns(side: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> [Vec<f32>; 3] {
    let mut columns = [vec![], vec![], vec![]];
    for y in 0..side {
        for x in 0..side {
            let samples = columns.iter_mut().zip(pixel(x, y));
            samples.for_each(|(column, sample)| column.push(sample));
        }
    }
    columns
}

/// Red, green and blue of a plain-sawn board: rings across, fibres along, noise from point to point.
pub(crate) fn wood(side: usize) -> [Vec<f32>; 3] {
    columns(side, |x, y| {
        let [u, v] = [x, y].map(|at| at as f32 / side as f32);
        let ring = ((u + 0.04 * v * (1.0 - v)) * 40.0).fract();
        let [x, y] = [x as u32, y as u32];
        let light = 1.0 + 0.08 * noise(x, y / 64) + 0.03 * noise(x, y);
        [(0.62, 0.35), (0.4, 0.27), (0.21, 0.15)]
            .map(|(early, late)| (early - late * ring * ring * ring) * light)
    })
}

/// Eight octaves of values between the points of lattices, each half as high as the one before.
fn height(x: f32, y: f32) -> f32 {
    let octave = |octave: i32| {
        let scale = 2f32.powi(octave) / 512.0;
        let [x, y] = [x * scale, y * scale];
        let [left, top] = [x.floor(), y.floor()];
        let [u, v] = [x - left, y - top].map(|t| t * t * (3.0 - 2.0 * t));
        let [left, top] = [left as u32, top as u32];
        let across = |y| noise(left, y) * (1.0 - u) + noise(left + 1, y) * u;
        (across(top) * (1.0 - v) + across(top + 1) * v) / 2f32.powi(octave)
    };
    (0..8).map(octave).sum()
}

/// Normals of a ground that is rough at every scale.
pub(crate) fn normals(side: usize) -> [Vec<f32>; 3] {
    columns(side, |x, y| {
        let [x, y] = [x as f32, y as f32];
        let middle = height(x, y);
        let slope = [height(x + 1.0, y), height(x, y + 1.0)].map(|it| 40.0 * (middle - it));
        let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
        [slope[0], slope[1], 1.0].map(|part| part / length)
    })
}
