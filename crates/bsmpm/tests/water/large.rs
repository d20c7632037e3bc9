//! Tests of consolidation at large strains against solutions by the method of lines, extrapolated from 200 and 400
//! cells.

use super::{DENSITY, M, Plane, WEIGHT, column_of, geometric, run};
use bsmpm::field::pore_water::flow::{Course, DrainedFace, Given, PermeabilityLaw};
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::points::Points;
use bsmpm::stabilisation::Stabilisation;

/// N/m3  of water whose own weight does nothing to a column of the stiffness M
const LIGHT: f64 = 1.0;

const T: [f64; 7] = [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0];

/// Cells across: of one cell the points next to the surface go sideways under a load of half the stiffness, one side of
/// the cell's strains for the other's, of which F-bar's average sees nothing. From first steps of 1e-4 on such columns
/// end early.
const ACROSS: usize = 2;

/// A column whose top leaves the cells behind: drained by points of its surface.
fn settling(cells: usize, load: f64, law: PermeabilityLaw) -> Plane {
    let mut scene = column_of([ACROSS, cells], 0.999, load, law)
        .stabilised(Stabilisation::ConsistentFBar)
        .artificial_stiffness(Some(ArtificialStiffness { coefficient: 1e-2 }));
    (scene.model.criteria.energy, scene.model.criteria.force) = (1e-8, 1e-5);
    scene
}

/// Settlement of the surface over the height, and excess pressure at the base over M, of the table's times.
fn consolidated(mut scene: Plane, first: f64, steps: usize) -> Vec<[f64; 2]> {
    let mut times = geometric(first, 2.0, steps);
    times.extend(T);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let mut found = Vec::new();
    let mut iterations = 0;
    let mut steps = 0;
    let mut worst = 0.0_f64;
    run(&mut scene, times, |t, points, report| {
        (iterations, steps) = (iterations + report.iterations, steps + 1);
        let water = report.water.as_ref().expect("water flows");
        worst = worst.max((water.stored + water.crossed.out() - water.left).abs() / water.crossed.out().abs());
        if T.iter().any(|of| (of - t).abs() < 1e-9) {
            found.push([surface(points), base(points)]);
        }
    });
    println!("{iterations} iterations in {steps} steps, balance of the water {worst:.1e}");
    assert!(worst < 1e-12);
    found
}

/// From the volumes of the points, which fill the column.
fn surface(points: &Points<2>) -> f64 {
    let volume = |p: usize| points.volume[p] * points.F.at(p).determinant();
    let all = (0..points.len()).map(volume).sum::<f64>() / points.volume.iter().sum::<f64>();
    1.0 - all
}

fn base(points: &Points<2>) -> f64 {
    let lowest = (0..points.len())
        .min_by(|a, b| points.x[*a][1].total_cmp(&points.x[*b][1]))
        .expect("points");
    points.pore_pressure.as_ref().expect("water flows")[lowest] / M
}

/// Off by, at most: the settlement, of the last one; the pressure at the base, of `once`, that at the start over M.
fn compare(name: &str, once: f64, found: &[[f64; 2]], expected: &[[f64; 2]]) -> [f64; 2] {
    assert!(found.len() == T.len() && expected.len() == T.len());
    let last = expected[expected.len() - 1][0];
    let mut worst = [0.0_f64; 2];
    for ((t, found), expected) in T.iter().zip(found).zip(expected) {
        println!("{name} T {t}: {found:.5?} ({expected:?})");
        worst[0] = worst[0].max((found[0] - expected[0]).abs() / last);
        worst[1] = worst[1].max((found[1] - expected[1]).abs() / once);
    }
    println!("{name}: off by {worst:.4?} of the last settlement, of the pressure at once");
    worst
}

/// Independent solution by the method of lines: consolidation at large strain.
#[test]
fn a_load_of_half_the_stiffness_settles_as_the_method_of_lines_predicts() {
    let load = 0.5 * M;
    let of = |law| consolidated(settling(20, load, law), 5e-3, 135);
    let constant = [
        [0.07348, 0.5],
        [0.11619, 0.49616],
        [0.16429, 0.4396],
        [0.22932, 0.25553],
        [0.29163, 0.02082],
        [0.29649, 0.00018],
        [0.29653, 0.0],
    ];
    let kozeny = [
        [0.04422, 0.5],
        [0.06991, 0.49917],
        [0.09887, 0.48623],
        [0.1397, 0.4334],
        [0.21296, 0.27687],
        [0.26489, 0.12175],
        [0.29139, 0.02164],
    ];
    let found = [
        compare("constant", 0.5, &of(PermeabilityLaw::Constant), &constant),
        compare("Kozeny-Carman", 0.5, &of(PermeabilityLaw::KozenyCarman), &kozeny),
    ];
    assert!(found.as_flattened().iter().all(|off| *off < 0.02));
}

/// The water is so light that no level of it matters, and the ground's weight is that in it.
#[test]
fn weight_of_half_the_stiffness_settles_as_the_solution_by_lines() {
    let mut scene = settling(20, 0.0, PermeabilityLaw::Constant).gravity(0.5 * M / DENSITY, 0.0);
    let water = scene.model.water.as_mut().expect("water");
    water.unit_weight = LIGHT;
    let flow = water.flow.as_mut().expect("it flows");
    flow.soils[0]
        .as_mut()
        .and_then(|soil| soil.permeability.as_mut())
        .expect("a soil")
        .along *= LIGHT / WEIGHT;
    flow.drains[0].given = Given::Head(Course(vec![(0.0, 1.0)]));
    let expected = [
        [0.01, 0.41587],
        [0.02499, 0.36294],
        [0.04944, 0.29968],
        [0.09169, 0.2045],
        [0.15508, 0.04901],
        [0.17177, 0.00295],
        [0.17281, 0.00001],
    ];
    let off = compare("weight", 0.5, &consolidated(scene, 1e-4, 210), &expected);
    assert!(off.iter().all(|off| *off < 0.02));
}

/// k = k0 J^3/(1 - ln J): with it Hencky's law makes the volume follow Terzaghi's equation exactly, J = 1 - (1 - J_inf)
/// (1 - U), ln J_inf = -q/M. No soil has it: every row of points has its own permeability, that of its J before the
/// step.
#[test]
fn a_load_under_which_the_volume_follows_terzaghis_equation_settles_exactly_so() {
    let half = [
        [0.04732, 0.5],
        [0.074819, 0.49907],
        [0.10581, 0.48462],
        [0.149478, 0.42503],
        [0.226536, 0.24612],
        [0.276149, 0.08229],
        [0.294804, 0.00738],
    ];
    let fifth = [
        [0.024801, 0.2],
        [0.039215, 0.19951],
        [0.055458, 0.19203],
        [0.078345, 0.16265],
        [0.118733, 0.08593],
        [0.144737, 0.02674],
        [0.154514, 0.00233],
    ];
    for (load, expected) in [(0.5, half), (0.2, fifth)] {
        let off = compare("exact", load, &of_terzaghis_volume(load), &expected);
        assert!(off.iter().all(|off| *off < 0.02));
    }
}

/// The table under a load over M, with that permeability.
fn of_terzaghis_volume(load: f64) -> Vec<[f64; 2]> {
    let cells = 20;
    let mut scene = settling(cells, load * M, PermeabilityLaw::Constant);
    let rows = 3 * cells;
    let height = |p: usize, scene: &Plane| ((scene.points.height(p) * rows as f64) as usize).min(rows - 1);
    let own: Vec<u16> = (0..scene.points.len()).map(|p| height(p, &scene) as u16).collect();
    scene.points.material = own;
    scene.model.materials = vec![scene.model.materials[0].clone(); rows];
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    flow.soils[0].as_mut().expect("a soil").porosity = 0.9; // it has no part in the exact solution
    flow.soils = vec![flow.soils[0].clone(); rows];
    let first = flow.soils[0]
        .as_ref()
        .and_then(|soil| soil.permeability.as_ref())
        .expect("a soil")
        .along;
    let mut times = geometric(1e-4, 2.0, 250);
    times.extend(T);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let mut found = Vec::new();
    let mut t = 0.0;
    for next in times {
        let flow = scene
            .model
            .water
            .as_mut()
            .and_then(|water| water.flow.as_mut())
            .expect("it flows");
        for p in 0..scene.points.len() {
            let J = scene.points.F.at(p).determinant();
            let soil = flow.soils[usize::from(scene.points.material[p])].as_mut();
            soil.and_then(|soil| soil.permeability.as_mut()).expect("a soil").along =
                first * (J.powi(3) / (1.0 - J.ln()));
        }
        super::run_from(&mut scene, t, [next], |_, points, _| {
            if T.iter().any(|of| (of - next).abs() < 1e-9) {
                found.push([surface(points), base(points)]);
            }
        });
        t = next;
    }
    found
}

/// Steady flow upwards through a column that a load has pressed to 0.7 of its height, which the points of a cell no
/// longer fill evenly: ln(l)/l = -(q - p)/M, p linear in space, H = 1/int ds/l(p(s)), w = k p_base/(gamma_w H).
#[test]
fn what_flows_through_a_compressed_column_is_what_leaves_by_its_drain() {
    let load = 0.5;
    let base = 0.1;
    let stretch = |pressure: f64| {
        let mut low = 0.4;
        let mut high = 1.0_f64;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle.ln() / middle < pressure - load {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    let parts = 1000;
    let lengths = (0..parts).map(|k| 1.0 / stretch(base * (f64::from(k) + 0.5) / f64::from(parts)));
    let height = f64::from(parts) / lengths.sum::<f64>();
    let expected = WEIGHT / M * base * M / (WEIGHT * height);

    let mut scene = settling(20, load * M, PermeabilityLaw::Constant);
    let flow = scene
        .model
        .water
        .as_mut()
        .and_then(|water| water.flow.as_mut())
        .expect("it flows");
    let given = Given::Pressure(Course(vec![(0.0, base * M)]));
    flow.faces.push(DrainedFace {
        axis: 1,
        upper: false,
        given,
        acts: true,
    });
    let mut out = 0.0;
    let mut t = 0.0;
    run(&mut scene, geometric(5e-3, 4.0, 120), |now, _, report| {
        let crossed = &report.water.as_ref().expect("water flows").crossed;
        (out, t) = (crossed.drains[0] / (now - t), now);
    });
    let edge = 1.0 / (20.0 - 1.0 + 0.999);
    let width = ACROSS as f64 * edge;
    let water = PoreWater::of(&scene.model, &scene.points, t).expect("water");
    let fluxes = water
        .fluxes::<PlaneStrain>(&scene.model.grid, &scene.halo())
        .expect("all inside");
    let settled = surface(&scene.points);
    let off = |value: f64| value / expected - 1.0;
    let mut worst = 0.0_f64;
    let mut count = 0;
    for (x, flux) in scene.points.x.iter().zip(&fluxes) {
        // The cell of the surface has ground on one side only.
        if x[1] < height - 1.5 * edge {
            (worst, count) = (worst.max(off(flux[1]).abs()), count + 1);
        }
    }
    println!(
        "height {:.4} ({height:.4}), drain {:.4}, {count} points at most {worst:.4}",
        1.0 - settled,
        off(out / width)
    );
    assert!((1.0 - settled - height).abs() < 2e-3 && count > 100);
    assert!(off(out / width).abs() < 0.015 && worst < 0.02);
}
