//! Tests that a preset grades the cells around footings, loads and rigid bodies.

use super::{COLUMN, FOOTING, discretisation, valid};
use bsmpm::kinematics::PlaneStrain;
use bsmpm_scene::{Case, GridAxis, seed};

/// m  the breakpoints of an axis, in the case's coordinates
fn breakpoints(axis: &GridAxis) -> Vec<f64> {
    (0..=axis.cells()).map(|i| axis.lower() + axis.breakpoint(i)).collect()
}

fn edges(axis: &GridAxis) -> Vec<f64> {
    (0..axis.cells()).map(|i| axis.cell(i)).collect()
}

/// Breakpoints cover the grid, neighbours are as `most` to one at most, no cell is longer than `longest` (m).
fn assert_sound(case: &Case, corners: [[f64; 2]; 2], longest: f64, most: f64) {
    for (axis, [lower, upper]) in case
        .grid
        .axes
        .iter()
        .zip([0, 1].map(|k| [corners[0][k], corners[1][k]]))
    {
        let all = breakpoints(axis);
        let edges = edges(axis);
        assert!(
            all[0] == lower && all[all.len() - 1] == upper && all.is_sorted(),
            "{all:?}"
        );
        assert!((edges.iter().sum::<f64>() - (upper - lower)).abs() < 1e-12 * (upper - lower));
        let ratio = |pair: &[f64]| (pair[1] / pair[0]).max(pair[0] / pair[1]);
        assert!(edges.windows(2).all(|pair| ratio(pair) <= most), "{edges:?}");
        assert!(edges.iter().all(|edge| *edge <= longest), "{edges:?}");
    }
}

/// Whether each of the cells between two places is `edge` long (m), with grid lines at both places.
fn is_fine(axis: &GridAxis, [lower, upper]: [f64; 2], edge: f64) -> bool {
    let inside: Vec<f64> = breakpoints(axis)
        .into_iter()
        .filter(|at| (lower..=upper).contains(at))
        .collect();
    let ends = inside.first() == Some(&lower) && inside.last() == Some(&upper);
    ends && inside.windows(2).all(|pair| (pair[1] - pair[0] - edge).abs() < 1e-9)
}

#[test]
fn cells_are_small_around_a_strip_and_on_its_way_and_grow_away_from_it() {
    for (word, edge, reach, longest, growth) in [
        ("draft", 0.25, 0.25, 1.0, 1.5),
        ("standard", 0.125, 0.5, 0.5, 1.2),
        ("reference", 1.0 / 12.0, 1.0, 0.25, 1.1),
    ] {
        let case = valid(FOOTING, &[&format!("accuracy={word}")]);
        let x = &case.grid.axes[0];
        let y = &case.grid.axes[1];
        assert_sound(&case, [[0.0, 0.0], [10.0, 12.0]], 1.1 * longest, 1.15 * growth);
        // From the strip's axis to beyond its end; from below its last place to above its first, all breakpoints.
        assert!(
            is_fine(x, [0.0, 1.0], edge) && is_fine(x, [1.0, 1.0 + reach], edge),
            "{x:?}"
        );
        assert!(
            is_fine(y, [8.0 - reach, 10.0], edge) && is_fine(y, [10.0, 10.0 + reach], edge),
            "{y:?}"
        );
        assert!(x.longest() > 2.5 * edge && y.longest() > 2.5 * edge);
        assert!(case.warnings.is_empty(), "{:?}", case.warnings);
        // Sizes, places and reasons are reported.
        let reports: Vec<_> = case.notes.iter().filter(|note| note.key == "grid.knots").collect();
        let [all, zone, rest] = &reports[..] else {
            panic!("{reports:?}")
        };
        assert!(all.reason.contains("cells across the bodies (10 m)") && all.reason.contains(&growth.to_string()));
        assert!(zone.value.contains(&format!(
            "x = 0 to {}, y = {} to {}",
            1.0 + reach,
            8.0 - reach,
            10.0 + reach
        )));
        assert!(
            zone.reason.contains("across `footing` (2 m wide, half of it modelled)"),
            "{}",
            zone.reason
        );
        assert!(
            rest.value.starts_with("up to ") && rest.value.ends_with(" elsewhere"),
            "{}",
            rest.value
        );
        // Points fill the ground, whose volume does not depend on the cells; the estimate counts them.
        let seeds: Vec<f64> = seed::<PlaneStrain, 2>(&case, 0..x.cells())
            .map(|seed| seed.volume)
            .collect();
        assert_eq!(case.estimate(1).points, seeds.len() as u64);
        assert!((seeds.iter().sum::<f64>() - 100.0).abs() < 1e-9);
    }
}

/// A plate at the axis is half of what it is across, as one at a plane of symmetry is; a ring has its own width.
#[test]
fn a_circular_plate_has_the_cells_of_a_strip_as_wide() {
    let plate = valid(FOOTING, &["accuracy=draft", "geometry=axisymmetric"]);
    let strip = valid(FOOTING, &["accuracy=draft"]);
    assert!(
        plate.grid == strip.grid && discretisation(&plate) == discretisation(&strip),
        "{:?}",
        plate.grid
    );
    assert!(
        is_fine(&plate.grid.axes[0], [0.0, 1.25], 0.25) && plate.warnings.is_empty(),
        "{:?}",
        plate.warnings
    );
    let ring = valid(
        FOOTING,
        &["accuracy=draft", "geometry=axisymmetric", "footing.from=[0.5, 10.0]"],
    );
    assert!(
        is_fine(&ring.grid.axes[0], [0.5, 1.0], 0.0625),
        "{:?}",
        ring.grid.axes[0]
    );
}

/// A rigid punch has the cells of a strip as wide; a pipe those around it and its way, a thin plate in the ground two
/// across, a wall that turns those where its end comes to.
#[test]
fn rigid_bodies_have_small_cells_around_the_edges_that_soil_lies_at() {
    let of = |rigid: &str, hole: &str| {
        let (ground, rest) = FOOTING.split_once("[footing]").unwrap();
        let rest = rest
            .split_once("[boundary]")
            .unwrap()
            .1
            .split_once("[[history]]")
            .unwrap()
            .0;
        let text = format!("{ground}[boundary]{rest}");
        let cut = format!("body.0.subtract=[{hole}]");
        valid(
            &text,
            &[
                "accuracy=draft",
                &format!("rigid=[{{ name = \"body\", {rigid} }}]"),
                &cut,
            ],
        )
    };
    let punch = of(
        "polygon = [[-1, 10], [1, 10], [1, 11], [-1, 11]], displacement = [0.0, -2.0]",
        "",
    );
    let strip = valid(FOOTING, &["accuracy=draft"]);
    assert!(
        is_fine(&punch.grid.axes[0], [0.0, 1.25], 0.25),
        "{:?}",
        punch.grid.axes[0]
    );
    assert!(
        is_fine(&punch.grid.axes[1], [7.75, 10.0], 0.25),
        "{:?}",
        punch.grid.axes[1]
    );
    let steps = |case: &Case| (case.analysis.end / case.analysis.dt).round();
    assert_eq!(steps(&punch), steps(&strip));
    assert!(punch.warnings.is_empty(), "{:?}", punch.warnings);
    let circle = "circle = { centre = [5, 5], radius = 0.8 }";
    let pipe = of(
        &format!("{circle}, displacement = [0.0, 1.0]"),
        &format!("{{ {circle} }}"),
    );
    assert!(
        is_fine(&pipe.grid.axes[0], [4.0, 6.0], 0.2) && is_fine(&pipe.grid.axes[1], [4.0, 7.0], 0.2),
        "{:?}",
        pipe.grid
    );
    let plate = "polygon = [[4, 5], [6, 5], [6, 5.2], [4, 5.2]]";
    let plate = of(plate, &format!("{{ {plate} }}"));
    assert!(
        is_fine(&plate.grid.axes[1], [5.0, 5.2], 0.1),
        "{:?}",
        plate.grid.axes[1]
    );
    // By a right angle about its lower end: 2 m to the left.
    let wall = "polygon = [[5, 7], [5.5, 7], [5.5, 9], [5, 9]]";
    let hole = format!("{{ {wall} }}");
    let turns = of(
        &format!("{wall}, about = [5, 7], rotation = [[0.5, 0], [1.0, 90]]"),
        &hole,
    );
    let still = of(wall, &hole);
    let cells = |case: &Case| case.grid.axes[0].cells();
    assert!(
        cells(&turns) > cells(&still) && steps(&turns) > 100.0 && steps(&still) == 10.0,
        "{}",
        steps(&turns)
    );
}

/// What is small follows each strip or load and its way, not the shortest of them.
#[test]
fn every_strip_and_load_has_small_cells_of_its_own() {
    let load = "traction.0={ from = [6.0, 10.0], to = [6.5, 10.0], stress = [0.0, -100.0], ramp = 1.0 }";
    let case = valid(FOOTING, &[load]);
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        is_fine(x, [0.0, 1.5], 0.125) && is_fine(x, [6.0, 6.5], 0.03125),
        "{x:?}"
    );
    assert!(is_fine(y, [9.875, 10.0], 0.03125), "{y:?}");
    assert_sound(&case, [[0.0, 0.0], [10.0, 12.0]], 0.55, 1.5);
    let reports = |case: &Case| case.notes.iter().filter(|note| note.key == "grid.knots").count();
    assert_eq!(reports(&case), 4);
    // A strip between two others' rollers is no half, and a wide one asks for no smaller cells than the bodies do.
    let wide = valid(FOOTING, &["footing.to=[10.0, 10.0]"]);
    assert_eq!((reports(&wide), wide.grid.axes[0].cells()), (0, 20));
    let whole = valid(FOOTING, &["footing.from=[4.0, 10.0]", "footing.to=[6.0, 10.0]"]);
    assert!(
        is_fine(&whole.grid.axes[0], [3.5, 6.5], 0.125),
        "{:?}",
        whole.grid.axes[0]
    );
    // A wall beside the soil, and its way until the end.
    let wall = "footing={ from = [5.0, 8.0], to = [5.0, 10.0], path = [[0.5, -1.0, 0.0], [1.5, 1.0, 0.0]] }";
    let pushed = valid(FOOTING, &[wall]);
    assert!(is_fine(&pushed.grid.axes[0], [3.5, 5.0], 0.125) && is_fine(&pushed.grid.axes[0], [5.0, 5.5], 0.125));
    assert!(
        is_fine(&pushed.grid.axes[1], [7.5, 8.0], 0.125),
        "{:?}",
        pushed.grid.axes[1]
    );
    // By hand, cells stay as they are.
    let by_hand = valid(FOOTING, &["grid.cell=0.5"]);
    assert_eq!((reports(&by_hand), edges(&by_hand.grid.axes[0])), (0, vec![0.5; 20]));
}

#[test]
fn cells_are_moved_to_where_strips_end_and_materials_meet() {
    // Equal cells of 1 m from 0: the strip, from 1.2 to 9.3 m, is wide enough for them.
    let aside = "footing.from=[1.2, 5.0]";
    let moved = valid(FOOTING, &["accuracy=draft", aside, "footing.to=[9.3, 5.0]"]);
    let x = &moved.grid.axes[0];
    let is_line = |wanted: f64| (0..=x.cells()).any(|i| (x.breakpoint(i) - wanted).abs() < 1e-12);
    assert!(is_line(1.2) && is_line(9.3));
    let cells: Vec<f64> = (0..x.cells()).map(|i| x.cell(i)).collect();
    assert!(cells.iter().all(|cell| (0.5..=1.5).contains(cell)), "{cells:?}");
    assert_eq!(moved.grid.lines[0].len(), 2);
    assert!(moved.warnings.is_empty(), "{:?}", moved.warnings);
    // By hand, nothing is moved, and it is reported.
    let by_hand = valid(
        FOOTING,
        &["accuracy=draft", aside, "footing.to=[9.3, 5.0]", "grid.cell=1.0"],
    );
    assert!(
        by_hand
            .warnings
            .iter()
            .any(|warning| warning.contains("is not on a grid line")),
        "{:?}",
        by_hand.warnings
    );
}

/// Softening goes by the edge of equal squares: a preset neither grades its cells nor makes them oblong.
#[test]
fn cells_of_what_softens_in_bands_of_a_given_width_are_equal_squares() {
    let soft = |name: &str| {
        format!(
            "material.{name}={{ model = \"mohr-coulomb-softening\", young = 1e7, poisson = 0.3, unit_weight = 2e4, \
             friction_angle = 0, cohesion = 1e4, residual_friction_angle = 0, residual_cohesion = 5e3, softening_strain = 0.5, \
             band_width = 0.1 }}"
        )
    };
    let oblong = |case: &Case| case.grid.axes[0].longest().max(case.grid.axes[1].longest()) / case.grid.shortest();
    // Whole along both axes: 10 m and 4.3 m in 23 and 10 cells would be 0.4348 by 0.43 m.
    let flat = [
        "accuracy=draft",
        "body.0.box.upper=[10.0, 4.3]",
        "grid.upper=[10.0, 4.3]",
        "boundary.top=roller",
    ];
    assert!(oblong(&valid(COLUMN, &flat)) > 1.01);
    let case = valid(COLUMN, &[&flat[..], &[&soft("rods")]].concat());
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        oblong(&case) <= 1.01 && (0.2..0.44).contains(&x.longest()),
        "{x:?} {y:?}"
    );
    assert!(
        (x.length() - 10.0).abs() < 1e-12 && (y.length() - 4.3).abs() < 1e-12,
        "{x:?} {y:?}"
    );
    // As small everywhere as a strip wants them, with lines at its end and on the ground.
    let case = valid(FOOTING, &["accuracy=draft", &soft("clay")]);
    let x = &case.grid.axes[0];
    let y = &case.grid.axes[1];
    assert!(
        is_fine(x, [0.0, 10.0], 0.25) && is_fine(y, [0.0, 10.0], 0.25),
        "{x:?} {y:?}"
    );
    // A strip whose end is on no line of the cells that it wants: of smaller ones one has it.
    let case = valid(FOOTING, &["accuracy=draft", &soft("clay"), "footing.to=[1.2, 10.0]"]);
    let x = &case.grid.axes[0];
    assert!(x.longest() < 0.3 && oblong(&case) < 1.0 + 1e-9, "{x:?}");
    assert!((0..=x.cells()).any(|i| (x.breakpoint(i) - 1.2).abs() < 1e-9), "{x:?}");
}
