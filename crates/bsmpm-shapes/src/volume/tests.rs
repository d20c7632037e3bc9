//! Compares volumes of material points with closed forms.

use super::*;
use crate::raster::Raster;
use crate::solid::Section;
use crate::surface::Surface;
use std::f64::consts::PI;

fn axes() -> Vec<GridAxis> {
    vec![
        GridAxis::Uniform {
            lower: -3.0,
            cell: 0.25,
            cells: 24,
        },
        GridAxis::Graded(vec![-1.0, -0.8, -0.5, -0.1, 0.2, 0.4, 0.7, 1.1, 1.6, 2.2, 3.0]),
        GridAxis::Uniform {
            lower: 0.0,
            cell: 0.3,
            cells: 12,
        },
    ]
}

/// The points of a shape, after every slab was held against the tally; and the volume.
fn points(whole: SolidShape, cut: Vec<SolidShape>, n: usize) -> (Vec<CellPlace<3>>, Volume) {
    let axes = axes();
    let volume = Volume::new(whole, cut, &axes, n).unwrap();
    let tally = volume.tally();
    let slabs: Vec<_> = (0..axes[0].cells()).map(|i| volume.slab(&axes, n, i)).collect();
    for (i, slab) in slabs.iter().enumerate() {
        let counted = match i.checked_sub(tally.occupied[0].start) {
            Some(number) if i < tally.occupied[0].end => tally.before[number + 1] - tally.before[number],
            _ => 0,
        };
        assert_eq!(slab.len() as u64, counted, "slab {i}");
    }
    let all: Vec<_> = slabs.into_iter().flatten().collect();
    for place in &all {
        assert!(place.area > 0.0, "{place:?}");
        let at = [0, 1, 2].map(|axis| place.x[axis] + axes[axis].lower());
        assert!(volume.contains(at), "{at:?} is outside");
    }
    (all, volume)
}

fn off(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

fn total(points: &[CellPlace<3>]) -> f64 {
    points.iter().map(|place| place.area).sum()
}

#[test]
fn prisms_and_boxes_have_their_exact_volume() {
    for along in 0..3 {
        let outline = Section::circle([1.3, 1.4], 0.93);
        let (found, volume) = points(
            SolidShape::Prism {
                outline,
                along,
                ends: [0.33, 2.77],
            },
            Vec::new(),
            2,
        );
        let exact = PI * 0.93_f64.powi(2) * 2.44;
        assert!(
            off(total(&found), exact) < 1e-13 && off(volume.volume(), exact) < 1e-13,
            "along {along}"
        );
    }
    let (found, _) = points(
        SolidShape::Box {
            corners: [[0.1, 0.2, 0.3], [2.05, 1.9, 2.2]],
        },
        Vec::new(),
        3,
    );
    assert!(
        off(total(&found), 1.95 * 1.7 * 1.9) < 1e-12,
        "off by {:e}",
        off(total(&found), 1.95 * 1.7 * 1.9)
    );
}

#[test]
fn what_goes_through_is_cut_out_exactly() {
    let whole = SolidShape::Box {
        corners: [[0.1, 0.2, 0.3], [2.1, 2.2, 2.3]],
    };
    let hole = SolidShape::Prism {
        outline: Section::circle([1.1, 1.2], 0.5),
        along: 1,
        ends: [0.0, 3.0],
    };
    let (found, volume) = points(whole, vec![hole], 2);
    let exact = 8.0 - 2.0 * PI * 0.25;
    assert!(off(total(&found), exact) < 1e-12 && off(volume.volume(), exact) < 1e-12);
}

#[test]
fn spheres_and_turned_outlines_are_scaled_to_their_volume() {
    let (found, _) = points(
        SolidShape::Sphere {
            center: [2.0, 1.5, 1.6],
            radius: 1.2,
        },
        Vec::new(),
        2,
    );
    assert!(off(total(&found), 4.0 / 3.0 * PI * 1.2_f64.powi(3)) < 1e-12);
    let centroid = [0, 1, 2].map(|axis| found.iter().map(|at| at.area * at.x[axis]).sum::<f64>() / total(&found));
    for (axis, exact) in [2.0, 1.5, 1.6].into_iter().enumerate() {
        assert!((centroid[axis] - exact).abs() < 1e-3, "centroid {centroid:?}");
    }
    let frustum = Section::polygon(&[[0.0, 0.2], [1.3, 0.2], [0.4, 2.9], [0.0, 2.9]]);
    let (found, _) = points(
        SolidShape::Revolved {
            outline: frustum,
            about: [2.0, 1.5],
        },
        Vec::new(),
        2,
    );
    let exact = PI * 2.7 / 3.0 * (1.3_f64.powi(2) + 1.3 * 0.4 + 0.4_f64.powi(2));
    assert!(off(total(&found), exact) < 1e-12);
}

/// An octahedron: its volume is 4/3 of its radius cubed.
#[test]
fn surfaces_of_triangles_are_scaled_to_their_volume() {
    let center = [2.0, 1.5, 1.6];
    let radius = 1.2;
    let tip = |axis: usize, sign: f64| {
        let mut at = center;
        at[axis] += sign * radius;
        at
    };
    let signs = (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0_f64 } else { 1.0 }));
    let rows = signs.map(|[s, t, u]| {
        let tips = [tip(0, s), tip(1, t), tip(2, u)];
        let [a, b, c] = if s * t * u > 0.0 {
            tips
        } else {
            [tips[0], tips[2], tips[1]]
        };
        [a, b, c].concat().try_into().unwrap()
    });
    let surface = Surface::new(rows).unwrap();
    let (found, _) = points(SolidShape::Surface(Box::new(surface)), Vec::new(), 2);
    assert!(off(total(&found), 4.0 / 3.0 * radius.powi(3)) < 1e-12);
    for (axis, exact) in center.into_iter().enumerate() {
        let centroid = found.iter().map(|at| at.area * at.x[axis]).sum::<f64>() / total(&found);
        assert!((centroid - exact).abs() < 1e-3, "centroid along {axis}: {centroid}");
    }
}

/// Of what is cut out anyhow lines tell the volume: a ball inside a block, a pit with three sides, a ring, a ball that
/// bites into another, a turned cuboid of triangles, whose walls stand upright; and a ball inside ground with a dike.
#[test]
fn what_is_cut_out_anyhow_has_its_volume_to_a_hundred_thousandth() {
    let block = || SolidShape::Box {
        corners: [[0.1, 0.2, 0.3], [2.6, 2.7, 2.8]],
    };
    let ball = |y: f64| SolidShape::Sphere {
        center: [1.3, y, 1.6],
        radius: 0.9,
    };
    let of_ball = 4.0 / 3.0 * PI * 0.9_f64.powi(3);
    let pit = Section::polygon(&[[0.5, 0.7], [2.1, 1.1], [1.3, 2.3]]);
    let pit = SolidShape::Prism {
        outline: pit,
        along: 2,
        ends: [0.7, 3.0],
    };
    let ring = SolidShape::Revolved {
        outline: Section::circle([0.8, 1.5], 0.3),
        about: [1.4, 1.5],
    };
    let whole = 2.5_f64.powi(3);
    let lens = PI / 12.0 * (4.0 * 0.9 + 0.8) * (2.0 * 0.9 - 0.8_f64).powi(2);
    let at = |k: usize| {
        let [u, v, w] = [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 });
        [1.3 + 0.6 * u - 0.2 * v, 1.4 + 0.3 * u + 0.4 * v, 1.5 + 0.6 * w]
    };
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let turned = Surface::new(halves.map(|corners| corners.map(at).concat().try_into().unwrap())).unwrap();
    let post = |k: usize| {
        [
            0.1 + 0.01 * (k / 2) as f64,
            [0.2, 2.7][k % 2],
            if k / 2 == 223 { 2.44 } else { 2.13 },
        ]
    };
    let ground = Raster::new(&(0..2 * 251).map(post).collect::<Vec<_>>(), 0.31).unwrap();
    let of_ground = ground.volume();
    let cases = [
        (
            SolidShape::Terrain(Box::new(ground)),
            SolidShape::Sphere {
                center: [0.8, 1.5, 1.2],
                radius: 0.5,
            },
            of_ground - PI / 6.0,
        ),
        (block(), ball(1.5), whole - of_ball),
        (block(), pit, whole - 1.12 * 2.1),
        (block(), ring, whole - 2.0 * PI * PI * 0.8 * 0.09),
        (ball(1.2), ball(2.0), of_ball - lens),
        (
            block(),
            SolidShape::Surface(Box::new(turned)),
            whole - 8.0 * (0.6 * 0.4 + 0.2 * 0.3) * 0.6,
        ),
    ];
    for (number, (whole, cut, exact)) in cases.into_iter().enumerate() {
        let (found, volume) = points(whole, vec![cut], 2);
        assert!(
            off(total(&found), exact) < 1e-5,
            "{number}: off by {:e}",
            off(total(&found), exact)
        );
        assert!(off(volume.volume(), total(&found)) < 1e-13);
    }
}

/// Parts beyond planes of symmetry may lie outside the grid.
#[test]
fn quarters_and_eighths_are_what_cuboids_leave() {
    let beyond = |axis: usize| {
        let mut upper = [9.0; 3];
        upper[axis] = 0.0;
        SolidShape::Box {
            corners: [[-9.0; 3], upper],
        }
    };
    let round = SolidShape::Prism {
        outline: Section::circle([0.0; 2], 1.3),
        along: 2,
        ends: [0.0, 2.0],
    };
    let (found, volume) = points(round, vec![beyond(0), beyond(1)], 2);
    assert!(off(total(&found), 0.25 * PI * 1.69 * 2.0) < 1e-12);
    assert_eq!(volume.bounds(), [[-3.0, -1.0, 0.0], [-1.7, 0.30000000000000004, 2.0]]);
    let sphere = SolidShape::Sphere {
        center: [0.0; 3],
        radius: 1.2,
    };
    let (found, volume) = points(sphere, (0..3).map(beyond).collect(), 2);
    assert!(
        off(total(&found), PI / 6.0 * 1.2_f64.powi(3)) < 1e-5,
        "{}",
        off(total(&found), PI / 6.0 * 1.2_f64.powi(3))
    );
    assert_eq!(volume.bounds()[0], [-3.0, -1.0, 0.0]);
    assert!(found.iter().all(|at| at.x.iter().all(|x| *x > 0.0)));
}

/// Factors of pipes with a wall of this thickness, in cells, at 20 places, each of a size of its own.
fn scales_of_pipes(wall: f64, n: usize) -> Vec<Result<f64, ShapeError>> {
    let axes = vec![
        GridAxis::Uniform {
            lower: 0.0,
            cell: 1.0,
            cells: 12
        };
        3
    ];
    let pipe = |k: usize| {
        let at = |step: f64| (k as f64 * step).fract();
        let inner = 3.0 + at(0.5698);
        let outer = inner + wall;
        let outline = Section::polygon(&[[inner, 2.2], [outer, 2.2], [outer, 5.7], [inner, 5.7]]);
        let about = [6.0 + at(0.618), 6.0 + at(0.7548)];
        Volume::new(SolidShape::Revolved { outline, about }, Vec::new(), &axes, n).map(|volume| volume.scale())
    };
    (0..20).map(pipe).collect()
}

/// Measured at 2 points along an axis: 0.969 to 1.024 at a fifth of a cell, 0.48 to 1.85 at a hundredth.
#[test]
fn the_factor_shows_walls_that_lines_do_not_see() {
    let off = |wall: f64| {
        let scales = scales_of_pipes(wall, 2).into_iter().map(Result::unwrap);
        scales.map(|scale| (scale - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(off(1.0) < 0.02 && off(0.2) < 0.04, "{} {}", off(1.0), off(0.2));
    assert!(off(0.01) > 0.4, "{}", off(0.01));
    let unseen = scales_of_pipes(1e-7, 2);
    assert!(unseen.contains(&Err(ShapeError::TooThin)), "{unseen:?}");
}

/// However small it is: a sphere's box is where its lines are.
#[test]
fn the_factor_of_spheres_is_near_one() {
    let axes = vec![
        GridAxis::Uniform {
            lower: 0.0,
            cell: 1.0,
            cells: 12
        };
        3
    ];
    for (k, radius) in [0.05, 0.1, 0.3, 0.7, 1.5].into_iter().cycle().take(60).enumerate() {
        let at = |step: f64| 6.0 + (k as f64 * step).fract();
        let sphere = SolidShape::Sphere {
            center: [at(0.618), at(0.7548), at(0.5698)],
            radius,
        };
        let scale = Volume::new(sphere, Vec::new(), &axes, 2).unwrap().scale();
        assert!((0.94..1.01).contains(&scale), "radius {radius}: {scale}");
    }
}

/// A tube of a wall that is thinner than the points lie apart: layers of cells have equal volumes, each half way up.
#[test]
fn thin_walls_stand_upright() {
    let axes = vec![
        GridAxis::Uniform {
            lower: 0.0,
            cell: 0.5,
            cells: 8
        };
        3
    ];
    for wall in [0.2, 0.05] {
        let outline = Section::polygon(&[[0.9, 0.0], [0.9 + wall, 0.0], [0.9 + wall, 2.0], [0.9, 2.0]]);
        let tube = SolidShape::Revolved {
            outline,
            about: [2.0, 2.0],
        };
        let volume = Volume::new(tube, Vec::new(), &axes, 2).unwrap();
        let points: Vec<_> = (0..8).flat_map(|i| volume.slab(&axes, 2, i)).collect();
        for layer in 0..4 {
            let inside = |at: &&CellPlace<3>| (at.x[2] / 0.5).floor() as usize == layer;
            let (sum, moment) = points.iter().filter(inside).fold((0.0, 0.0), |(sum, moment), at| {
                (sum + at.area, moment + at.area * (at.x[2] - 0.5 * layer as f64 - 0.25))
            });
            assert!(off(sum, 0.25 * volume.volume()) < 1e-12, "layer {layer}: {sum}");
            assert!(moment.abs() < 1e-9 * sum, "layer {layer}: {moment}");
        }
        let alone = volume.tally().alone / volume.volume();
        assert!(
            if wall < 0.1 {
                (alone - 1.0).abs() < 1e-12
            } else {
                alone < 0.3
            },
            "{alone}"
        );
    }
}

/// What is symmetric about grid lines stays so, however its edges pass between lattice points.
#[test]
fn a_sphere_on_grid_lines_has_its_centroid_there() {
    let axes = vec![
        GridAxis::Uniform {
            lower: 0.0,
            cell: 0.5,
            cells: 8
        };
        3
    ];
    for radius in [0.3, 0.9, 1.0, 1.37] {
        let volume = Volume::new(
            SolidShape::Sphere {
                center: [2.0; 3],
                radius,
            },
            Vec::new(),
            &axes,
            2,
        )
        .unwrap();
        let points: Vec<_> = (0..8).flat_map(|i| volume.slab(&axes, 2, i)).collect();
        for axis in 0..3 {
            let centroid = points.iter().map(|at| at.area * at.x[axis]).sum::<f64>() / total(&points);
            assert!(
                (centroid - 2.0).abs() < 1e-12,
                "radius {radius}, axis {axis}: {centroid}"
            );
        }
    }
}
