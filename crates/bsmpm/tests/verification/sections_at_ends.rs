//! Tests that section forces at supports and loads agree with statics.

use super::sections::{DENSITY, G, cut, weighed};
use crate::support::scene::{Scene, axis, hencky};
use bsmpm::boundary::{Support, SurfacePoint};
use bsmpm::interactions::load::Load;
use bsmpm::kinematics::{PlaneStrain, Solid};
use bsmpm::model::Regime;
use bsmpm::observe::{Section, SectionForces, section_forces};
use bsmpm::tensor::Vector;

/// Places of sections by the cell: in what holds, inside of the first cell and of the next ones, on lines of the grid.
const CELLS: [f64; 8] = [0.0, 0.08, 0.4, 0.5, 0.6, 1.0, 1.5, 2.3];

/// The cantilever of six by one: normal force, shear and moment from the clamp on.
#[test]
fn forces_of_a_beam_at_its_clamp_are_those_of_statics() {
    for (h, tolerance) in [(0.5, 5e-3), (0.25, 2e-3)] {
        let cells = [6.0, 1.0].map(|length: f64| (length / h) as usize);
        let scene = weighed::<PlaneStrain, 2>(h, cells, 2, Support::fixed(0, false));
        let floor = 2.0 * h;
        let mut largest = [0.0_f64; 3];
        for x in CELLS.map(|cells| cells * h) {
            let found = cut(&scene, [[[x, floor - 0.3], [x, floor + 1.3]]]);
            let beyond = 6.0 - x;
            let weight = DENSITY * G;
            let shear = weight * beyond;
            let moment = 0.5 * weight * beyond * beyond;
            let off = [found.normal, found.shear[0] + shear, (found.bending[0] - moment) / 3.0].map(|off| off / shear);
            println!(
                "h {h} x {x}: N {:.1e}, Q {:.1e} of Q, M {:.1e} of that at the clamp",
                off[0], off[1], off[2]
            );
            largest = std::array::from_fn(|k| largest[k].max(off[k].abs()));
        }
        println!("h {h}: {largest:?}");
        assert!(largest.iter().all(|off| *off < tolerance));
    }
}

/// The column, from its base to its top, cut from either side.
#[test]
fn the_normal_force_at_the_base_and_the_top_of_a_column_is_the_weight_above() {
    let plane = weighed::<PlaneStrain, 2>(0.25, [4, 12], 2, Support::fixed(1, false));
    let solid = weighed::<Solid, 3>(0.25, [2, 2, 12], 2, Support::fixed(2, false));
    let levels = CELLS.map(|cells| 0.25 * cells);
    let mut largest = 0.0_f64;
    for z in levels.into_iter().chain(levels.map(|level| 3.0 - level)) {
        let weight = DENSITY * G * (3.0 - z);
        let flat = [[1.2, -0.2], [-0.2, 1.2]].map(|[from, to]| cut(&plane, [[[from, z], [to, z]]]));
        let space = [[-0.1, 0.6], [0.6, -0.1]].map(|[from, to]| {
            cut(
                &solid,
                [[[-0.2, 0.25, z], [0.7, 0.25, z]], [[0.25, from, z], [0.25, to, z]]],
            )
        });
        for (found, area) in [(flat[0], 1.0), (flat[1], 1.0), (space[0], 0.25), (space[1], 0.25)] {
            let off = (found.normal + weight * area) / (3.0 * DENSITY * G * area);
            largest = largest.max(off.abs());
            let others = [found.shear, found.bending].concat().into_iter().chain([found.torsion]);
            assert!(
                others.into_iter().all(|other| other.abs() < 1e-4 * 3.0 * DENSITY * G),
                "z {z}: {found:?}"
            );
        }
        println!(
            "z {z}: N off by {:.1e} N, in space {:.1e} N",
            flat[0].normal + weight,
            4.0 * space[0].normal + weight
        );
    }
    println!("{largest:.1e} of the whole weight");
    assert!(largest < 2e-4);
    // Above the material there is nothing.
    let above = Section {
        lines: vec![[[1.2, 3.1], [-0.2, 3.1]].map(Vector::from)],
        round: false,
    };
    let found = section_forces::<PlaneStrain, 2>(&plane.model.grid, &plane.points, &above, &plane.halo());
    assert_eq!(found, SectionForces::default());
}

/// A block of 2 m by 2 m without weight: on a fixed base under a pressure that grows from 30 kPa at the left to 50 kPa,
/// and between planes of symmetry under 40 kPa; at all levels, up to the load.
#[test]
fn forces_at_planes_of_symmetry_and_under_a_surcharge_are_those_of_the_load() {
    let h = 0.25;
    let sides = [Support::roller(0, false), Support::roller(1, false)];
    let base = vec![Support::fixed(1, false)];
    for (order, supports, slope) in [
        (1, base.clone(), 10e3),
        (2, base.clone(), 10e3),
        (3, base, 10e3),
        (2, sides.into(), 0.0),
    ] {
        let place = |k: i32| [(f64::from(k) + 0.5) / 16.0, 2.0].into();
        let points: Vec<SurfacePoint<2>> = (0..32).map(|k| SurfacePoint::at(place(k), 1.0 / 16.0)).collect();
        let pressure = |at: &SurfacePoint<2>| Vector::<2>::new(0.0, -40e3 - slope * (at.x[0] - 1.0));
        let load = Load {
            traction: points.iter().map(pressure).collect(),
            ..Load::dead(points, Vector::zeros(), 1.0)
        };
        let grid = [12; 2].map(|cells| axis(h, cells, order));
        let scene = Scene::<PlaneStrain, 2>::new(grid, hencky(1e9, 0.3), Regime::QuasiStatic);
        let scene = scene.body([0..8, 0..8], 2, 0.0, |x| x * 0.0).load(load);
        let (scene, _) = supports.into_iter().fold(scene, Scene::support).solved(1.0, 1.0);
        let force = 80e3;
        let moment = slope * 8.0 / 12.0;
        let mut largest = [0.0_f64; 3];
        for y in CELLS
            .into_iter()
            .chain(CELLS.map(|cells| 8.0 - cells))
            .map(|cells| cells * h)
        {
            // Beyond it is below: t points to the right, where the pressure is higher.
            let found = cut(&scene, [[[0.0, y], [2.0, y]]]);
            let off = [found.normal + force, found.shear[0], found.bending[0] + moment].map(|off| off / force);
            println!(
                "y {y}: N {:.1e}, Q {:.1e}, M {:.1e} of N; M {:.1}",
                off[0], off[1], off[2], found.bending[0]
            );
            largest = std::array::from_fn(|k| largest[k].max(off[k].abs()));
        }
        println!("order {order}, slope {slope}: {largest:?}");
        assert!(largest.iter().all(|off| *off < 1e-3));
    }
}
