//! Growth time of a 2048 x 2048 picture: the library's way against a loop written by hand.
//!
//! `cargo bench --bench growth` prints nanoseconds per pixel on one thread. Ratios are medians of
//! pairs measured one right after the other, so they hold on a busy machine as well.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};
use fearless_simd_macros::simd;
use glam::DVec3;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use yosegi::field::{Field, PixelGrid, Program, RunContext, Samples, Scratch, Target};
use yosegi::key::{Key, KeyHasher};
use yosegi::nodes::wood::growth::{GrowthKernel, GrowthModel, GrowthSettings, Reach};
use yosegi::value::{Branch, Domain, Skeleton, Tangents, Thickness};

const SIZE: u32 = 2048;
const TILE: u32 = 128;
const PAIRS: usize = 5;
const HEIGHT: f64 = 2400.0;

/// A plane on which x, y and z all vary along rows and columns.
struct Plane;

impl Target for Plane {
    fn key(&self) -> Key {
        KeyHasher::new("bench plane", 1).finish()
    }

    fn pixels(&self) -> [u32; 2] {
        [SIZE, SIZE]
    }

    fn write_row(&self, x: f64, y: f64, step: f64, row: [&mut [f32]; 3]) {
        let scale = 1.0 / f64::from(SIZE);
        let right = DVec3::new(380.0, 60.0, 400.0) * scale;
        let down = DVec3::new(-20.0, 180.0, 1800.0) * scale;
        let origin = DVec3::new(-180.0, -120.0, 100.0) + right * x + down * y;
        for (axis, row) in row.into_iter().enumerate() {
            let (origin, step) = (origin[axis], step * right[axis]);
            for (index, value) in (0i32..).zip(row) {
                *value = (origin + f64::from(index) * step) as f32;
            }
        }
    }
}

fn model(nodes: usize, branches: usize, reach: Option<Reach>, sharpness: f64) -> GrowthModel {
    grown(&skeleton(nodes, branches), reach, sharpness)
}

fn grown(skeleton: &Skeleton, reach: Option<Reach>, sharpness: f64) -> GrowthModel {
    let settings = GrowthSettings {
        elongation: 420.0,
        thickening: 2.4,
        sharpness,
        reach,
    };
    GrowthModel::new(skeleton, settings).expect("the bench's tree is sound")
}

fn skeleton(nodes: usize, branches: usize) -> Skeleton {
    let node = |index: usize| {
        let share = index as f64 / (nodes - 1) as f64;
        DVec3::new(
            40.0 * libm::sin(7.0 * share),
            30.0 * libm::cos(5.0 * share),
            HEIGHT * share,
        )
    };
    let branch = |index: usize| {
        let share = (index as f64 + 0.5) / branches as f64;
        let azimuth = 2.1 * index as f64;
        Branch {
            height: HEIGHT * share,
            direction: DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.5).normalize(),
            thickness: Thickness::Speed(0.5),
        }
    };
    Skeleton {
        trunk: (0..nodes).map(node).collect(),
        tangents: Tangents::Natural,
        branches: (0..branches).map(branch).collect(),
    }
}

/// A tree with 100 branches in every 2400 mm of its height.
fn tall(times: usize, reach: Option<Reach>) -> GrowthModel {
    let mut skeleton = skeleton(64, 100);
    let (trunk, branches) = (skeleton.trunk.clone(), skeleton.branches.clone());
    for floor in (1..times).map(|floor| HEIGHT * floor as f64) {
        // The first node of a floor would lie on the last one of the floor below.
        let above = |node: &DVec3| *node + DVec3::Z * floor;
        skeleton.trunk.extend(trunk[1..].iter().map(above));
        let above = |branch: &Branch| Branch {
            height: branch.height + floor,
            ..*branch
        };
        skeleton.branches.extend(branches.iter().map(above));
    }
    grown(&skeleton, reach, 2.0)
}

fn tiles() -> impl Iterator<Item = [u32; 2]> {
    let corners = move || (0..SIZE).step_by(TILE as usize);
    corners().flat_map(move |y| corners().map(move |x| [x, y]))
}

/// Nanoseconds per pixel of what `work` does for all tiles.
fn time(mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e9 / f64::from(SIZE * SIZE)
}

/// The library's way: the field compiled into a program, run tile by tile.
struct Library {
    program: Program,
    scratch: Scratch,
    level: Level,
}

impl Library {
    fn new(model: &GrowthModel, level: Level) -> Library {
        let kernel = Arc::new(GrowthKernel::new(model.clone()));
        let position = Field::position(Domain::Solid);
        Library::of(
            &Field::kernel(&Arc::from("bench"), kernel, vec![position]),
            level,
        )
    }

    fn of(field: &Field, level: Level) -> Library {
        let program = Program::compile(std::slice::from_ref(field));
        Library {
            program,
            scratch: Scratch::default(),
            level,
        }
    }

    fn run(&mut self) {
        let context = RunContext {
            level: self.level,
            cache: None,
            filtering: true,
        };
        for corner in tiles() {
            let grid = PixelGrid::tile(corner, [TILE, TILE], 0);
            let samples = Samples::Grid {
                target: &Plane,
                grid,
            };
            self.program.run(&samples, &mut self.scratch, &context);
            black_box(self.program.output(&self.scratch, 0, 0));
        }
    }
}

/// The same arithmetic for evenly spaced nodes, with nothing around it.
struct Hand {
    /// c0 to c3 of x, then of y, for every segment.
    segments: Vec<[f32; 8]>,
    spacing: f32,
    speeds: [f32; 2],
    branches: Vec<HandBranch>,
    columns: [Vec<f32>; 5],
}

struct HandBranch {
    start: [f32; 3],
    rest: [f32; 3],
    direction: [f32; 3],
    speed: f32,
    speed_time: f32,
    speed_ratio: f32,
}

impl Hand {
    fn new(model: &GrowthModel) -> Hand {
        let pieces = model.curve.pieces();
        let segment = |piece: &yosegi::geometry::spline::Piece| {
            let [a, b, c, d] = piece.coefficients;
            [a.x, b.x, c.x, d.x, a.y, b.y, c.y, d.y].map(|c| c as f32)
        };
        let elongation = model.settings.elongation;
        let branch = |branch: &yosegi::nodes::wood::growth::GrowingBranch| HandBranch {
            start: branch.start.as_vec3().to_array(),
            rest: (branch.start - branch.start.as_vec3().as_dvec3())
                .as_vec3()
                .to_array(),
            direction: branch.direction.as_vec3().to_array(),
            speed: branch.thickening as f32,
            speed_time: (branch.thickening * branch.start_time) as f32,
            speed_ratio: (branch.thickening / elongation) as f32,
        };
        Hand {
            segments: pieces[1..pieces.len() - 1].iter().map(segment).collect(),
            spacing: (HEIGHT / (pieces.len() - 2) as f64) as f32,
            speeds: [elongation, model.settings.thickening].map(|speed| (1.0 / speed) as f32),
            branches: model.branches.iter().map(branch).collect(),
            columns: std::array::from_fn(|_| vec![0.0; (TILE * TILE) as usize]),
        }
    }

    fn run(&mut self, level: Level) {
        for [x, y] in tiles() {
            let [px, py, pz, times, shares] = &mut self.columns;
            let rows = px
                .chunks_mut(TILE as usize)
                .zip(py.chunks_mut(TILE as usize));
            for (row, ((px, py), pz)) in rows.zip(pz.chunks_mut(TILE as usize)).enumerate() {
                let centre = [f64::from(x) + 0.5, f64::from(y) + row as f64 + 0.5];
                Plane.write_row(centre[0], centre[1], 1.0, [px, py, pz]);
            }
            let scene = (
                &self.segments[..],
                self.spacing,
                self.speeds,
                &self.branches[..],
            );
            dispatch!(level, simd => by_hand(simd, scene, [px, py, pz], times, shares));
            black_box(&times);
        }
    }
}

type Scene<'a> = (&'a [[f32; 8]], f32, [f32; 2], &'a [HandBranch]);

#[simd]
fn by_hand<S: Simd>(
    simd: S,
    scene: Scene<'_>,
    [x, y, z]: [&[f32]; 3],
    times: &mut [f32],
    shares: &mut [f32],
) {
    let runs = times.chunks_mut(128).zip(shares.chunks_mut(128));
    let columns = x.chunks(128).zip(y.chunks(128)).zip(z.chunks(128));
    for (((x, y), z), (times, shares)) in columns.zip(runs) {
        trunk_by_hand(simd, scene, [x, y, z], times);
        shares.fill(0.0);
        for branch in scene.3 {
            branch_by_hand(simd, branch, [x, y, z], times, shares);
        }
        let lanes = S::f32s::LEN;
        for (time, share) in times
            .chunks_exact_mut(lanes)
            .zip(shares.chunks_exact_mut(lanes))
        {
            let sum = S::f32s::from_slice(simd, share);
            let inverse = S::f32s::splat(simd, 1.0) / (sum + 1.0);
            (S::f32s::from_slice(simd, time) * inverse.sqrt()).store_slice(time);
            (sum * inverse).store_slice(share);
        }
    }
}

#[simd]
fn trunk_by_hand<S: Simd>(
    simd: S,
    (segments, spacing, [along, across], _): Scene<'_>,
    [x, y, z]: [&[f32]; 3],
    times: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let columns = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    for (((x, y), z), times) in columns.zip(times.chunks_exact_mut(lanes)) {
        let x = S::f32s::from_slice(simd, x);
        let y = S::f32s::from_slice(simd, y);
        let z = S::f32s::from_slice(simd, z);
        let indices = (z * (1.0 / spacing)).to_int::<S::i32s>();
        let h = z - indices.to_float::<S::f32s>() * spacing;
        let first = indices[0];
        let segment = |index: i32| &segments[(index as usize).min(segments.len() - 1)];
        let mut gathered = [[0.0; 16]; 8];
        let c: [S::f32s; 8] = if indices.simd_eq(first).all_true() {
            let segment = segment(first);
            std::array::from_fn(|part| S::f32s::splat(simd, segment[part]))
        } else {
            for lane in 0..lanes {
                let segment = segment(indices[lane]);
                (0..8).for_each(|part| gathered[part][lane] = segment[part]);
            }
            std::array::from_fn(|part| S::f32s::from_slice(simd, &gathered[part][..lanes]))
        };
        let dx = (x - c[0]) - h * (h * (h * c[3] + c[2]) + c[1]);
        let dy = (y - c[4]) - h * (h * (h * c[7] + c[6]) + c[5]);
        (z * along + (dx * dx + dy * dy).sqrt() * across).store_slice(times);
    }
}

#[simd]
fn branch_by_hand<S: Simd>(
    simd: S,
    branch: &HandBranch,
    [x, y, z]: [&[f32]; 3],
    trunk: &[f32],
    sums: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let columns = x
        .chunks_exact(lanes)
        .zip(y.chunks_exact(lanes))
        .zip(z.chunks_exact(lanes));
    let results = trunk.chunks_exact(lanes).zip(sums.chunks_exact_mut(lanes));
    for (((x, y), z), (trunk, sums)) in columns.zip(results) {
        let x = S::f32s::from_slice(simd, x) - branch.start[0] - branch.rest[0];
        let y = S::f32s::from_slice(simd, y) - branch.start[1] - branch.rest[1];
        let z = S::f32s::from_slice(simd, z) - branch.start[2] - branch.rest[2];
        let [ux, uy, uz] = branch.direction;
        let s = x * ux + y * uy + z * uz;
        let ahead = s.simd_gt(1e-9);
        if ahead.all_false() {
            continue;
        }
        let (fx, fy, fz) = (x - s * ux, y - s * uy, z - s * uz);
        let across2 = fx * fx + fy * fy + fz * fz;
        let across = (across2 * (across2 + s * s)).sqrt();
        let time = s * (s * branch.speed_ratio + branch.speed_time) + across;
        let ratio = S::f32s::from_slice(simd, trunk) * (s * branch.speed) / time;
        let ratio = ahead.select(ratio, S::f32s::splat(simd, 0.0));
        (S::f32s::from_slice(simd, sums) + ratio * ratio).store_slice(sums);
    }
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Prints a row of medians of pairs: A, B and A / B.
fn compare(name: &str, mut a: impl FnMut(), mut b: impl FnMut()) {
    a();
    b();
    let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| [time(&mut a), time(&mut b)]).collect();
    let of = |part: fn(&[f64; 2]) -> f64| median(pairs.iter().map(part).collect());
    let [first, second, ratio] = [of(|p| p[0]), of(|p| p[1]), of(|p| p[0] / p[1])];
    println!("{name:<46} {first:>7.2} {second:>7.2} {ratio:>7.2}");
}

fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    let mut levels = vec![("baseline", Level::baseline())];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(|avx2| ("avx2", Level::Avx2(avx2))));
        levels.extend(
            best.as_avx512()
                .map(|avx512| ("avx512", Level::Avx512(avx512))),
        );
    }
    levels
}

fn main() {
    println!("{SIZE} x {SIZE}, tiles of {TILE}, one thread; ns/pixel, medians of {PAIRS} pairs\n");
    println!("{:<46} {:>7} {:>7} {:>7}", "A against B", "A", "B", "A / B");
    let plain = model(64, 3, None, 2.0);
    for (name, level) in levels() {
        let (mut library, mut hand) = (Library::new(&plain, level), Hand::new(&plain));
        compare(
            &format!("library against hand, 64 nodes, {name}"),
            || library.run(),
            || hand.run(level),
        );
    }
    let best = Level::new();
    let mut positions = Library::of(&Field::position(Domain::Solid), best);
    let mut library = Library::new(&plain, best);
    compare(
        "positions alone against library",
        || positions.run(),
        || library.run(),
    );
    if std::env::args().any(|argument| argument == "--short") {
        return;
    }
    for nodes in [64, 1024, 10_000] {
        let mut ten = Library::new(&model(10, 3, None, 2.0), best);
        let mut many = Library::new(&model(nodes, 3, None, 2.0), best);
        compare(
            &format!("{nodes} nodes against 10"),
            || many.run(),
            || ten.run(),
        );
    }
    let reach = Some(Reach {
        along: 150.0,
        across: 25.0,
    });
    for branches in [1000, 10_000] {
        // A taller tree: the picture shows as many branches as before.
        let mut hundred = Library::new(&tall(1, reach), best);
        let mut many = Library::new(&tall(branches / 100, reach), best);
        let name = format!("{branches} branches against 100, equally dense");
        compare(&name, || many.run(), || hundred.run());
    }
    let mut sparse = Library::new(&model(64, 100, reach, 2.0), best);
    let mut dense = Library::new(&model(64, 1000, reach, 2.0), best);
    compare(
        "1000 branches against 100, ten times as dense",
        || dense.run(),
        || sparse.run(),
    );
    for sharpness in [4.0, 3.3] {
        let mut two = Library::new(&plain, best);
        let mut other = Library::new(&model(64, 3, None, sharpness), best);
        compare(
            &format!("sharpness {sharpness} against 2"),
            || other.run(),
            || two.run(),
        );
    }
}
