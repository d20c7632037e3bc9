//! Tests that pressures and other loads act where and when the case says.

use super::{FULL, set, valid};
use bsmpm::interactions::load::Load;
use bsmpm::kinematics::{PlaneStrain, Solid};
use bsmpm_scene::{LoadedLine, Push};

/// A load that takes much of the ground's height, where neither ties nor the background hold its surface.
#[test]
fn large_loads_on_little_background_are_warned_of() {
    let case = include_str!("../../../../cases/validation/large_consolidation.toml");
    let warned = |set: &[&str]| {
        let warnings = valid(case, set).warnings;
        warnings
            .iter()
            .filter(|warning| warning.contains(": solver.background: "))
            .cloned()
            .collect::<Vec<_>>()
    };
    let off = "solver.extension=off";
    let found = warned(&["solver.background=1e-4", off]);
    assert!(
        found.len() == 1 && found[0].contains("a load of 0.50") && found[0].contains("background = 0.01"),
        "{found:?}"
    );
    assert!(warned(&[]).is_empty());
    assert!(warned(&["solver.background=1e-4", off, "traction.0.stress=[0.0, \"-50 kPa\"]"]).is_empty());
}

/// A pressure: on the side where the body lies, by depth, on segments and on circles.
#[test]
fn a_pressure_finds_the_body_that_it_presses_on() {
    let with = |traction: &str| set(FULL, &[&format!("traction.0={{ ramp = 0.5, {traction} }}")]);
    let push = |traction: &str| with(traction).expect("a valid case").tractions[0].clone();
    let push = |traction: &str| (push(traction).line, push(traction).push, push(traction).largest());
    let side = |traction: &str| match push(traction).1 {
        Push::Pressure { side, .. } => side,
        Push::Stress(_) => panic!(),
    };
    assert_eq!(
        side("from = [0.0, 1.25], to = [1.0, 1.25], pressure = 1e3"),
        -1.0,
        "below, on the right of its way"
    );
    assert_eq!(side("from = [1.0, 1.25], to = [0.0, 1.25], pressure = 1e3"), 1.0);
    assert_eq!(
        side("circle = { centre = [0.5, 2.0], radius = 0.4 }, pressure = 1e3"),
        1.0,
        "a disc"
    );
    let hole = "circle = { centre = [2.75, 2.0], radius = 0.1 }, pressure = { value = 0.0, at_y = \"3 m\", per_metre \
    = \"10 kPa/m\" }";
    assert_eq!(side(hole), -1.0, "what surrounds it");
    let (line, _, largest) = push(hole);
    assert_eq!(
        line,
        LoadedLine::Circle {
            center: [2.75, 2.0],
            radius: 0.1
        }
    );
    assert!((largest - 11e3).abs() < 1e-9, "at its lowest place: {largest}");
    for (traction, reported) in [
        ("from = [0.0, 0.5], to = [1.0, 0.5], pressure = 1e3", "E0252"),
        (
            "circle = { centre = [9.0, 2.0], radius = 0.4 }, pressure = 1e3",
            "E0201",
        ),
        (
            "circle = { centre = [0.5, 2.0], radius = 0.9 }, pressure = 1e3",
            "E0401",
        ),
        (
            "from = [0.0, 1.25], to = [1.0, 1.25], pressure = 1e3, stress = [0, 1]",
            "E0016",
        ),
        (
            "from = [0.0, 1.25], circle = { centre = [0.5, 2.0], radius = 0.4 }, pressure = 1e3",
            "E0016",
        ),
        (
            "from = [0.0, 1.25], to = [1.0, 1.25]",
            "none of the keys stress, pressure",
        ),
        ("from = [0.0, 1.25], to = [1.0, 1.25], pressure = [0, 1]", "expected"),
    ] {
        let message = format!("{:?}", with(traction).expect_err("refused"));
        assert!(message.contains(reported), "{traction}: {message}");
    }
}

/// Of what a stage takes away or places, a pressure minds only what is there while it acts.
#[test]
fn a_pressure_acts_on_what_stages_leave_free() {
    let ground = "geometry = 'plane-strain'\nanalysis = { type = 'quasi-static', steps = 4 }\n\
                  grid = { lower = [0, 0], upper = [4, 4], cell = 0.5, degree = 'quadratic' }\n\
                  material.soil = { model = 'elastic', young = 1e6, poisson = 0.3 }\nboundary = { bottom = 'fixed' }\n\
                  [[body]]\nmaterial = 'soil'\nbox = { lower = [0, 0], upper = [4, 2] }\npoints_per_cell = 2\n\
                  [[body]]\nname = 'fill'\nmaterial = 'soil'\nbox = { lower = [0, 2], upper = [4, 3] }\npoints_per_cell = 2\n\
                  [[traction]]\nname = 'air'\nfrom = [0, 2]\nto = [4, 2]\npressure = 10.0\n[[stage]]\nat = 0.5\n";
    for (stage, acts) in [
        ("remove = ['fill']\nactivate = ['air']", true),
        ("add = ['fill']\ndeactivate = ['air']", true),
        ("remove = ['fill']", false),
        ("add = ['fill']", false),
    ] {
        let case = bsmpm_scene::Case::from_text("case.toml", &format!("{ground}{stage}\n"), &[]);
        match case {
            Ok(case) => {
                let Push::Pressure { side, .. } = case.tractions[0].push else {
                    panic!()
                };
                assert!(acts && side == -1.0, "below it: {stage}");
            }
            Err(errors) => assert!(
                !acts && format!("{errors:?}").contains("a free surface"),
                "{stage}: {errors:?}"
            ),
        }
    }
}

/// From below, on a plate of a fifth of a cell's length, in flat cells and within one: the side was the wrong one where
/// neither a quarter of x's cells nor of y's lay in it.
#[test]
fn a_pressure_finds_a_body_that_is_thinner_than_cells_are_long() {
    let plate = "geometry = '3d'\nanalysis = { type = 'quasi-static', steps = 1 }\n\
                 grid = { lower = [0, 0, 0], upper = [4, 2, 2], cell = [1, 1, 0.1], degree = 'quadratic' }\n\
                 material.rubber = { model = 'elastic', young = 1e6, poisson = 0.3 }\nboundary = { left = 'fixed' }\n\
                 [[body]]\nmaterial = 'rubber'\nbox = { lower = [0, 0, 0.5], upper = [4, 2, 0.7] }\npoints_per_cell = 2\n\
                 [[traction]]\nrectangle = { lower = [0, 0, 0.5], upper = [4, 2, 0.5] }\npressure = 10.0\n";
    for set in [&[] as &[&str], &["grid.cell=1.0"]] {
        let Push::Pressure { side, .. } = valid(plate, set).tractions[0].push else {
            panic!()
        };
        assert_eq!(side, 1.0, "above it, {set:?}");
    }
}

/// What acts at every row is what the row says, along each axis, and a steady direction takes one load of the physics.
#[test]
fn loads_by_rows_of_forces_are_these_forces() {
    let built = |sets: &[&str]| {
        let case = set(FULL, sets).expect("a valid case");
        let idle = case.idle_before(0.0).loads.len();
        let loads = bsmpm_scene::model::model::<PlaneStrain, 2>(&case)
            .expect("a model")
            .boundary
            .loads;
        assert_eq!(loads.len(), idle);
        loads
    };
    let at = |load: &bsmpm::interactions::load::Load<2>, row: usize| load.traction[0] * load.amplitude[row].1;
    let traction = |path: &str| format!("traction.0={{ from = [1.0, 0.25], to = [1.0, 1.25], {path} }}");
    let rows = [[0.0, 300.0], [-2e3, 1e3], [500.0, 0.0]];
    let turning = traction("stress_path = [[0.1, 0, 300], [0.2, \"-2 kPa\", \"1 kPa\"], [0.3, 500, 0]]");
    let loads = built(&[&turning]);
    assert_eq!(loads.len(), 3, "along x, the point load, along y");
    for (row, wanted) in rows.iter().enumerate() {
        assert_eq!((at(&loads[0], row) + at(&loads[2], row)).as_slice(), wanted);
    }
    let push = "point_load.0={ at = [3.5, 1.25], force_path = [[0.1, 0, \"-3 kN/m\"], [0.2, 0, 750]] }";
    let level = "traction.0={ from = [0, 1.25], to = [1, 1.25], pressure_path = [[0.1, 0], [0.2, \"-4 kPa\"]] }";
    let loads = built(&[level, push]);
    assert_eq!(loads.len(), 2, "of steady directions");
    assert_eq!([0, 1].map(|row| at(&loads[0], row).norm()), [0.0, 4e3]);
    assert_eq!([0, 1].map(|row| at(&loads[1], row)[1]), [-3e3, 750.0]);
}

/// Stress by depth on an upright surface, 1 m high, in a few pieces: its resultant to round-off, its moment about the
/// foot to the midpoint rule's error, growth times piece^2 times height/12.
#[test]
fn stress_that_grows_with_depth_has_the_resultant_of_a_trapezium() {
    let value = [-2e3, 1e3];
    let growth = [-8e3, 500.0];
    let traction = "traction.0={ from = [1.0, 0.25], to = [1.0, 1.25], ramp = 0.5, \
                    stress = { value = [-2e3, \"1 kPa\"], at_y = 1.25, per_metre = [\"-8 kPa/m\", 500] } }";
    let case = set(FULL, &[traction]).expect("a valid case");
    let load = bsmpm_scene::model::model::<PlaneStrain, 2>(&case)
        .expect("a model")
        .boundary
        .loads
        .remove(0);
    assert!(!load.follows && load.points.len() > 1, "{}", load.points.len());
    let pieces = || load.points.iter().zip(&load.traction);
    for axis in 0..2 {
        let force: f64 = pieces().map(|(point, stress)| point.area * stress[axis]).sum();
        assert!(
            (force / (value[axis] + growth[axis] / 2.0) - 1.0).abs() < 1e-12,
            "{force}"
        );
        let moment: f64 = pieces()
            .map(|(point, stress)| point.area * stress[axis] * (point.x[1] - 0.25))
            .sum();
        let within: f64 = pieces()
            .map(|(point, _)| growth[axis] * point.area.powi(3) / 12.0)
            .sum();
        assert!(
            (moment - within - value[axis] / 2.0 - growth[axis] / 6.0).abs() < 1e-9,
            "{moment} {within}"
        );
    }
    let foot = [value[0] + growth[0], value[1] + growth[1]];
    assert!((case.tractions[0].largest() - foot[0].hypot(foot[1])).abs() < 1e-9);
}

/// The same of a cube's side, under water and in shear: the height is z, wherever the grid begins along y.
#[test]
fn loads_by_depth_in_a_solid_have_the_resultants_of_a_trapezium() {
    let cube = r#"
        geometry = "3d"
        analysis = { type = "quasi-static", steps = 1 }
        grid = { lower = [0, -10, 1], upper = [1.5, -9, 2.5], cell = 0.25, degree = "quadratic" }
        boundary = { bottom = "fixed" }
        [material.soil]
        model = "elastic"
        young = "1 MPa"
        poisson = 0.3
        [[body]]
        material = "soil"
        box = { lower = [0, -10, 1], upper = [1, -9, 2] }
        points_per_cell = 2
        [[traction]]
        rectangle = { lower = [1, -10, 1], upper = [1, -9, 2] }
    "#;
    let load = |push: &str| {
        let case = valid(&format!("{cube}\n{push}"), &[]);
        bsmpm_scene::model::model::<Solid, 3>(&case)
            .expect("a model")
            .boundary
            .loads
            .remove(0)
    };
    let sums = |load: &Load<3>, axis: usize| {
        let pieces = || load.points.iter().zip(&load.traction);
        let force: f64 = pieces().map(|(point, stress)| point.area * stress[axis]).sum();
        let moment: f64 = pieces()
            .map(|(point, stress)| point.area * stress[axis] * point.x[2])
            .sum();
        let edge = load.points[0].area.sqrt();
        (force, moment, edge * edge / 12.0)
    };
    let water = load("pressure = { value = 0.0, at_y = 2.0, per_metre = \"10 kPa/m\" }");
    let shear = load("stress = { value = [0.0, -2e3, 0.0], at_y = 2.0, per_metre = [0.0, \"-1 kPa/m\", \"3 kPa/m\"] }");
    for (load, axis, value, growth) in [
        (&water, 0, 0.0, -1e4),
        (&shear, 0, 0.0, 0.0),
        (&shear, 1, -2e3, -1e3),
        (&shear, 2, 0.0, 3e3),
    ] {
        let (force, moment, of_piece) = sums(load, axis);
        assert!((force - value - growth / 2.0).abs() < 1e-9, "{axis}: {force}");
        // Of the midpoint rule growth times piece^2/12 is missing.
        let expected = value / 2.0 + growth / 6.0 + growth * of_piece;
        assert!((moment - expected).abs() < 1e-9, "{axis}: {moment} for {expected}");
    }
    assert!(water.follows && !shear.follows && water.points.len() > 1);
}

/// Ground between rollers on an absorbing base: what lasts sinks it, unless [initial] has found it or it comes back.
#[test]
fn what_lasts_where_only_absorbing_faces_hold_is_warned_of() {
    let base = r#"
        geometry = "plane-strain"
        analysis = { type = "dynamic", end = 1, dt = 0.01 }
        grid = { lower = [0, 0], upper = [4, 4], cell = 0.5, degree = "quadratic" }
        boundary = { left = "roller", right = "roller", bottom = "absorbing" }
        [material.soil]
        model = "elastic"
        young = "10 MPa"
        poisson = 0.3
        density = 2000
        [[body]]
        material = "soil"
        box = { lower = [0, 0], upper = [4, 3] }
        points_per_cell = 2
    "#;
    let reports = |set: &[&str], of: &str| {
        let warnings = valid(base, set).warnings;
        let found: Vec<_> = warnings
            .iter()
            .filter_map(|warning| warning.strip_prefix("W0231: "))
            .collect();
        assert!(
            found.len() <= 1 && found.iter().all(|warning| warning.starts_with(of)),
            "{found:?}"
        );
        !found.is_empty()
    };
    let strip = |push: &str| format!("traction.0={{ from = [0, 3], to = [2, 3], {push} }}");
    let lasting = strip("stress = [0, \"-20 kPa\"]");
    let shear = strip("stress = [1e3, 0], ramp = 0.1");
    let back = strip("stress = [0, -1e3], amplitude = [[0.1, 1], [0.2, 0]]");
    assert!(reports(&[&lasting], "traction.0") && !reports(&[&shear], "") && !reports(&[&back], ""));
    assert!(reports(&[&strip("pressure = 1e3")], "traction.0") && !reports(&[&lasting, "boundary.bottom=fixed"], ""));
    assert!(reports(
        &[&shear, "boundary.left=absorbing", "boundary.right=absorbing"],
        "traction.0"
    ));
    let whole = "centre = [2, 2], radius = 0.5";
    let half = "centre = [2, 3], radius = 0.5";
    let hole = "body.0.subtract=[{ circle = { centre = [2, 2], radius = 0.5 } }, { circle = { centre = [2, 3], radius \
    = 0.5 } }]";
    let round = |circle: &str| format!("traction.0={{ circle = {{ {circle} }}, pressure = 1e3, ramp = 0.1 }}");
    assert!(!reports(&[hole, &round(whole), "body.0.box.upper=[4, 4]"], ""));
    assert!(reports(&[hole, &round(half), "grid.upper=[4, 3]"], "traction.0"));
    let weight = ["gravity.acceleration=[0, -9.81]", "initial.gravity=\"elastic\""];
    assert!(
        !reports(&[&[&*lasting], &weight[..]].concat(), ""),
        "in the equilibrium of the start"
    );
    let grows = strip("stress = [0, -1e3], ramp = 0.1");
    assert!(reports(&[&[&*grows], &weight[..]].concat(), "traction.0"));
    assert!(reports(
        &["point_load.0={ at = [1, 3], force_path = [[0.1, 0, 5], [0.2, 0, 3]] }"],
        "point_load.0"
    ));
    let foot = |path: &str| format!("footing={{ from = [1, 3], to = [2, 3], path = {path} }}");
    assert!(reports(&[&foot("[[0.1, 0, -0.01]]")], "footing"));
    assert!(!reports(&[&foot("[[0.1, 0, -0.01], [0.2, 0, 0]]")], ""));
    let block = "name = \"block\", polygon = [[1, 3], [2, 3], [2, 4], [1, 4]]";
    assert!(reports(
        &[&format!("rigid.0={{ {block}, displacement = [0, -0.1] }}")],
        "rigid.0"
    ));
    assert!(reports(
        &[&format!(
            "rigid.0={{ {block}, mass = 10, free = [\"y\"], force = [0, -5] }}"
        )],
        "rigid.0"
    ));
}
