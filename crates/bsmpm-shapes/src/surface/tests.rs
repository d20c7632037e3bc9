//! Compares what surfaces enclose with closed forms, and refuses those that enclose nothing.

use super::*;

/// A cuboid's twelve triangles, outwards.
fn cuboid(lower: [f64; 3], upper: [f64; 3]) -> Vec<[f64; 9]> {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { lower[axis] } else { upper[axis] });
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves
        .map(|half| half.map(corner).concat().try_into().unwrap())
        .collect()
}

fn turned(rows: Vec<[f64; 9]>) -> Vec<[f64; 9]> {
    rows.into_iter()
        .map(|[a, b, c, d, e, f, g, h, i]| [a, b, c, g, h, i, d, e, f])
        .collect()
}

fn surface(rows: Vec<[f64; 9]>) -> Result<Surface, SurfaceError> {
    Surface::new(rows.into_iter())
}

#[test]
fn what_a_cuboid_with_a_cavity_encloses_is_exact() {
    let shell = cuboid([1.0, 2.0, 3.0], [4.0, 4.0, 7.0]);
    let cavity = turned(cuboid([2.0, 2.5, 4.0], [3.0, 3.5, 5.0]));
    for rows in [
        [shell.clone(), cavity.clone()].concat(),
        turned([shell, cavity].concat()),
    ] {
        let found = surface(rows).unwrap();
        assert!((found.volume() - 23.0).abs() < 1e-12);
        assert_eq!(found.bounds(), [[1.0, 2.0, 3.0], [4.0, 4.0, 7.0]]);
        // On the diagonals of the faces, on edges below (inside) and above (outside), and beside.
        assert_eq!(found.vertical([2.5, 3.0]), [[3.0, 4.0], [5.0, 7.0]]);
        assert_eq!(found.vertical([1.5, 3.9]), [[3.0, 7.0]]);
        assert_eq!(found.vertical([1.0, 2.0]), [[3.0, 7.0]]);
        assert!(found.vertical([4.0, 3.0]).is_empty() && found.vertical([0.9, 3.0]).is_empty());
        let moved = found.moved([1.0, -1.0, 0.5]);
        assert_eq!(moved.vertical([3.5, 2.0]), [[3.5, 4.5], [5.5, 7.5]]);
    }
}

#[test]
fn lines_through_corners_and_edges_of_any_surface_enter_as_often_as_they_leave() {
    // A bumpy sphere whose corners have no round numbers.
    let around_it = 24;
    let up = 12;
    let at = |i: usize, j: usize| {
        let phi = std::f64::consts::TAU * (i % around_it) as f64 / around_it as f64;
        let theta = std::f64::consts::PI * j as f64 / up as f64;
        let r = if j.is_multiple_of(up) {
            1.3
        } else {
            1.0 + 0.3 * (3.0 * phi).sin() * theta.sin().powi(2)
        };
        let flat = if j.is_multiple_of(up) { 0.0 } else { r * theta.sin() };
        [flat * phi.cos(), flat * phi.sin(), r * theta.cos()]
    };
    let quads = (0..around_it).flat_map(|i| (0..up).map(move |j| [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]));
    let halves = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let rows = halves
        .map(|half| half.map(|(i, j)| at(i, j)).concat().try_into().unwrap())
        .collect();
    let found = surface(rows).unwrap();
    let corners: Vec<[f64; 3]> = found.triangles.iter().flatten().copied().collect();
    let middles = found.triangles.iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let middles = middles.map(|[a, b]| [0, 1].map(|axis| 0.5 * (a[axis] + b[axis])));
    for place in corners.iter().map(|at| [at[0], at[1]]).chain(middles) {
        let crossings = found.crossings(place);
        assert_eq!(crossings.iter().map(|(_, turns)| turns).sum::<i32>(), 0, "{place:?}");
        assert!(crossings.len().is_multiple_of(2));
    }
}

/// Two cuboids, turned about a vertical, of which one stands at a part of the other's wall, in single precision.
#[test]
fn shells_that_touch_but_for_rounding_are_one_body_and_those_that_overlap_are_none() {
    for (k, overlap) in (0..400).flat_map(|k| [0.0, 1e-3].map(|overlap| (k, overlap))) {
        let angle = 0.0157 * f64::from(k) + 0.01;
        let thick = if k % 2 == 0 { 0.05 } else { 0.5 };
        let (sin, cos) = angle.sin_cos();
        let placed = |row: [f64; 9]| {
            let corner = |k: usize| {
                let [x, y, z] = [row[3 * k], row[3 * k + 1], row[3 * k + 2]];
                [10.3 + cos * x - sin * y, 7.7 + sin * x + cos * y, z].map(|at| f64::from(at as f32))
            };
            [0, 1, 2].map(corner).concat().try_into().unwrap()
        };
        let wall = cuboid([0.0; 3], [3.0, thick, 1.0]);
        let beside = cuboid([0.7, thick - overlap, 0.0], [1.9, thick + 0.3, 1.0]);
        let found = surface([wall, beside].concat().into_iter().map(placed).collect());
        assert_eq!(found.is_ok(), overlap == 0.0, "{k}: {:?}", found.err());
    }
}

#[test]
fn two_cuboids_that_share_lines_are_reported_apart_from_two_that_overlap() {
    let spans =
        [[0.0, 1.0], [0.0, 2.0], [0.0, 3.0], [1.0, 2.0], [1.0, 3.0], [2.0, 3.0]].map(|ends| ends.map(|x| x / 3.0));
    let one = [[1.0, 2.0], [0.0, 2.0], [1.0, 3.0]].map(|ends: [f64; 2]| ends.map(|x| x / 3.0));
    for number in 0..216 {
        let other = [number % 6, number / 6 % 6, number / 36].map(|k| spans[k]);
        let overlap = (0..3).all(|axis| one[axis][0] < other[axis][1] && other[axis][0] < one[axis][1]);
        let rows = [one, other]
            .map(|spans| cuboid(spans.map(|ends| ends[0]), spans.map(|ends| ends[1])))
            .concat();
        assert_eq!(surface(rows).is_err(), overlap, "{other:?}");
    }
}

#[test]
fn what_is_no_closed_surface_is_refused() {
    let refuses = |rows: Vec<[f64; 9]>, expected: SurfaceError| assert_eq!(surface(rows), Err(expected));
    let crosses = |rows: Vec<[f64; 9]>| {
        let error = surface(rows).unwrap_err();
        assert!(matches!(error, SurfaceError::SelfIntersection { .. }), "{error}");
    };
    let block = cuboid([0.0; 3], [1.0; 3]);
    refuses(Vec::new(), SurfaceError::NoTriangle);
    let is_open = |rows: Vec<[f64; 9]>| {
        let error = surface(rows).unwrap_err();
        assert!(matches!(error, SurfaceError::Open { edges: 3, .. }), "{error}");
    };
    is_open(block[1..].to_vec());
    let mut one_turned = block.clone();
    one_turned[..1].clone_from_slice(&turned(block[..1].to_vec()));
    is_open(one_turned);
    refuses([block.clone(), turned(block.clone())].concat(), SurfaceError::NoVolume);
    crosses([block.clone(), cuboid([0.5; 3], [1.5; 3])].concat());
    crosses([block.clone(), turned(cuboid([2.0; 3], [2.5; 3]))].concat());
    // Blocks with sides in common that overlap by little, and bars across each other, with sides in common and not.
    crosses([block.clone(), cuboid([0.99, 0.0, 0.0], [1.99, 1.0, 1.0])].concat());
    crosses([block.clone(), cuboid([0.3, 0.2, 0.99], [0.4, 0.5, 2.0])].concat());
    let bar = cuboid([0.0, 1.45, 0.0], [30.0, 1.5, 1.0]);
    for top in [1.0, 2.0] {
        crosses([bar.clone(), cuboid([14.9, 0.0, 0.0], [15.1, 3.0, top])].concat());
    }
    crosses([bar, cuboid([14.9, 0.0, 0.4], [15.1, 3.0, 0.6])].concat());
    // Blocks that only touch are fine.
    let both = surface([block, cuboid([0.0, 0.0, 1.0], [1.0, 1.0, 2.0])].concat()).unwrap();
    assert!((both.volume() - 2.0).abs() < 1e-12);
}
