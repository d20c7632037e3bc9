//! Tests footings, loads and initial stress of valid cases.

use super::{FULL, STATIC, doubts, set, valid};
use bsmpm::boundary::Load;
use bsmpm::kinematics::{PlaneStrain, Solid};
use bsmpm::material::Profile;
use bsmpm_scene::{ActiveLoads, Base, Face, Initial, LoadedLine, Push, Site};

#[test]
fn strips_loads_and_initial_stress_arrive() {
    let case = valid(FULL, &["footing.interface=\"rough\""]);
    let footing = case.footing.unwrap();
    assert_eq!(
        (footing.site.ends(), footing.base),
        (Some([[1.0, 2.5], [2.0, 2.5]]), Base::Rough)
    );
    assert_eq!(footing.path.rows, [(1.0, [0.0, -0.1, 0.0])]);
    assert_eq!(valid(FULL, &[]).footing.unwrap().base, Base::Smooth);
    let bases: Vec<Base> = case.prescribed.iter().map(|prescribed| prescribed.base).collect();
    assert_eq!(bases, [Base::Smooth, Base::Rough]);
    assert_eq!(case.prescribed[0].site, Site::Face(Face { axis: 0, upper: true }));
    assert_eq!(case.prescribed[0].path.rows, [(1.0, [0.0, -0.01, 0.0])]);
    assert_eq!(case.prescribed[1].path.rows, [(0.5, [0.0, -0.1, 0.0]), (1.0, [0.0; 3])]);
    assert_eq!(
        (case.tractions[0].push, case.tractions[0].ramp),
        (Push::Stress([0.0, -2e4, 0.0].map(Profile::constant)), 0.5)
    );
    assert_eq!(
        (case.point_loads[0].at, case.point_loads[0].force),
        ([3.5, 1.25, 0.0], [0.0, -1e3, 0.0])
    );
    assert_eq!(case.initial, Some(Initial::AtRest(vec![0.5, 0.5, 0.5, 0.6])));
    let elastic = FULL
        .replace("k0          = 0.6\n", "")
        .replace("k0 = 0.5\n", "gravity = \"elastic\"\n");
    assert_eq!(valid(&elastic, &[]).initial, Some(Initial::Elastic));
    let own = FULL.replace("k0 = 0.5\n", "");
    assert!(set(&own, &[]).is_err(), "not all materials have their own");
    let k0 = ["material.sand.k0=0.4", "material.clay.k0=0.7", "material.block.k0=0"];
    assert_eq!(
        valid(&own, &k0).initial,
        Some(Initial::AtRest(vec![0.4, 0.7, 0.0, 0.6]))
    );
}

/// On the top of a block, beside it, and beneath what lies over it.
#[test]
fn what_lies_on_the_ground_has_no_part_in_the_stress_at_the_start() {
    let case = valid(
        FULL,
        &["prescribed.1.components={ friction_coefficient = 0.3, separates = true }"],
    );
    let rest: Vec<bool> = case.prescribed.iter().map(|of| of.rests).collect();
    assert!(
        case.footing.is_some_and(|footing| footing.rests) && rest == [false, true],
        "{rest:?}"
    );
    let beside = [
        "footing.from=[2, 2]",
        "footing.to=[2, 2.5]",
        "footing.displacement=[-0.1, 0]",
    ];
    assert!(!valid(FULL, &beside).footing.unwrap().rests);
    let above = ["footing.from=[1, 2]", "footing.to=[2, 2]"];
    assert!(!valid(FULL, &above).footing.unwrap().rests);
    let hangs = doubts(FULL, &["initial.equilibrium=plastic"]);
    assert!(
        hangs.iter().any(|warning| warning.starts_with("W0672: prescribed.1: ")),
        "{hangs:?}"
    );
}

#[test]
fn strips_hold_and_load_a_quasi_static_body() {
    let free = STATIC.replace("bottom = \"fixed\"\n", "");
    let errors = set(&free, &["traction.0={from=[0, 1], to=[2, 1], stress=[0, -1]}"]).unwrap_err();
    assert!(
        errors.len() == 1 && errors[0].message.contains("along x and y"),
        "{errors:?}"
    );
    let strip = |more: &str| format!("prescribed.0={{from=[0, 1], to=[2, 1], displacement=[0, -0.1]{more}}}");
    assert!(valid(&free, &[&strip("")]).warnings.is_empty());
    let errors = set(&free, &[&strip(", components=\"normal\"")]).unwrap_err();
    assert!(errors.len() == 1 && errors[0].message.contains("along x"), "{errors:?}");
    let face = "prescribed.0={face=\"bottom\", displacement=[0.1, 0]}";
    assert!(valid(&free, &[face]).warnings.is_empty());
    assert!(
        set(&free, &["prescribed.0={face=\"top\", displacement=[0, -0.1]}"]).is_err(),
        "no body reaches it"
    );
    let held = valid(
        &free,
        &[
            "footing={from=[0, 1], to=[2, 1], displacement=[0, -0.1]}",
            "boundary.left=roller",
        ],
    );
    assert!(held.warnings.is_empty(), "{:?}", held.warnings);
    for load in [
        "traction.0={from=[0, 1], to=[2, 1], stress=[0, -1]}",
        "point_load.0={at=[1, 1], force=[0, -1]}",
    ] {
        assert!(valid(STATIC, &[load]).warnings.is_empty(), "{load}");
    }
    assert!(
        !valid(STATIC, &["traction.0={from=[0, 1], to=[2, 1], stress=[0, 0]}"])
            .warnings
            .is_empty()
    );
}

#[test]
fn strips_and_loads_start_within_half_a_spacing_of_points() {
    // The block's points are 0.25 m apart: its top is at 2.5 m. A strip may start with a part of it beyond the body.
    let near = ["footing.from=[1.25, 2.62]", "footing.to=[1.75, 2.62]"];
    assert!(doubts(FULL, &near).is_empty());
    assert!(doubts(FULL, &["footing.from=[0.9, 2.5]", "footing.to=[2.3, 2.5]"]).is_empty());
    for corner in [
        "[0.95, 2.55]",
        "[1.0, 2.5]",
        "[2.0, 2.5]",
        "[2.05, 2.45]",
        "[1.5, 2.25]",
    ] {
        assert!(
            doubts(FULL, &[&format!("point_load.0.at={corner}")]).is_empty(),
            "{corner}"
        );
    }
    for far in ["[0.85, 2.5]", "[1.0, 2.63]", "[2.1, 2.6]"] {
        assert!(set(FULL, &[&format!("point_load.0.at={far}")]).is_err(), "{far}");
    }
}

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

/// Half of a rigid body on half of the ground, and one that never comes to it.
#[test]
fn rigid_bodies_that_faces_cut_and_that_stay_outside_are_reported() {
    let with = |rigid: &str| {
        let text = format!(
            "geometry = 'plane-strain'\nanalysis = {{ type = 'quasi-static', steps = 4 }}\n\
             grid = {{ lower = [0, 0], upper = [4, 4], cell = 0.5, degree = 'quadratic' }}\n\
             material.soil = {{ model = 'elastic', young = 1e6, poisson = 0.3 }}\n\
             boundary = {{ bottom = 'fixed', left = 'roller' }}\n\
             [[body]]\nmaterial = 'soil'\nbox = {{ lower = [0, 0], upper = [4, 2] }}\npoints_per_cell = 2\n\
             [[rigid]]\nname = 'it'\n{rigid}\n"
        );
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
            .join("\n")
    };
    let push = "free = ['y']\nforce = [0, -1.0]";
    let cut = "W0419";
    let away = "W0417";
    for (rigid, reported) in [
        (format!("polygon = [[-1, 2], [1, 2], [1, 3], [-1, 3]]\n{push}"), cut),
        (format!("circle = {{ centre = [0, 3], radius = 1 }}\n{push}"), cut),
        ("polygon = [[5, 2], [6, 2], [6, 3], [5, 3]]".to_owned(), away),
        (format!("polygon = [[6, 2], [7, 2], [7, 3], [6, 3]]\n{push}"), away),
    ] {
        let found = with(&rigid);
        assert!(found.contains(reported), "{rigid}: {found}");
    }
    for rigid in [
        format!("polygon = [[0, 2], [1, 2], [1, 3], [0, 3]]\n{push}"),
        "polygon = [[-1, 2], [1, 2], [1, 3], [-1, 3]]\ndisplacement = [0, -0.1]".to_owned(),
        "polygon = [[5, 2], [6, 2], [6, 3], [5, 3]]\npath = [[1.0, -2.0, 0]]".to_owned(),
    ] {
        let found = with(&rigid);
        assert!(!found.contains(cut) && !found.contains(away), "{rigid}: {found}");
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
    let at = |load: &bsmpm::boundary::Load<2>, row: usize| load.traction[0] * load.amplitude[row].1;
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

/// A footing without a name is `footing` to stages as to histories; a ramp of no force is warned of.
#[test]
fn names_and_ramps_of_what_has_none() {
    let footing = "footing={ from = [0, 1], to = [2, 1], displacement = [0, -0.1] }";
    let named = "traction.0={ name = \"footing\", from = [0, 1], to = [2, 1], stress = [0, -1] }";
    let release = "stage=[{ at = 0.5, deactivate = [\"footing\"] }]";
    let released = |set: &[&str]| valid(STATIC, &[set, &[release]].concat()).stages[0].release.clone();
    assert_eq!(released(&[footing]), [("footing".to_owned(), ActiveLoads::Strip(0))]);
    assert_eq!(
        released(&[footing, named]),
        [("footing".to_owned(), ActiveLoads::Load(0))],
        "what was given the name"
    );
    let block = |more: &str| {
        let block = format!("rigid.0={{ name = \"block\", polygon = [[0, 1], [1, 1], [1, 3], [0, 3]], {more} }}");
        valid(STATIC, &[&block]).warnings.join(" ").contains("W0410")
    };
    assert!(block("amplitude = [[1, 1]]") && block("ramp = 0.5") && !block("friction_coefficient = 0.1"));
    assert!(!block("ramp = 0.5, free = [\"y\"], force = [0, -1]"));
}

/// What a rigid body does to the columns of the free field is seen along its way, too.
#[test]
fn rigid_bodies_stay_out_of_the_free_field_on_their_way() {
    let base = r#"
        geometry = "plane-strain"
        analysis = { type = "dynamic", end = 1, dt = 0.01 }
        grid = { lower = [0, 0], upper = [4, 4], cell = 0.5, degree = "quadratic" }
        boundary = { left = "free-field", right = "free-field", bottom = "fixed" }
        shaking = { acceleration = [[0, 0, 0], [1, 1, 0]] }
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
    let refused = |more: &str| {
        let block = format!("rigid.0={{ name = \"block\", polygon = [[1, 3], [2, 3], [2, 4], [1, 4]], {more} }}");
        let reported = set(base, &[&block])
            .err()
            .map(|errors| format!("{errors:?}"))
            .unwrap_or_default();
        let of = |side: &str| reported.contains(&format!("boundary.{side}")) && reported.contains("a rigid body acts");
        ["left", "right"].map(of)
    };
    assert_eq!(refused("friction_coefficient = 0.1"), [false; 2]);
    assert_eq!(refused("path = [[0.1, -0.6, 0], [0.2, 0, 0]]"), [true, false]);
    assert_eq!(refused("displacement = [1.6, 0]"), [false, true]);
    assert_eq!(refused("rotation = [[1, 90]], about = [3, 3.5]"), [false, true]);
}

/// A wall on a fixed base, and an inclined base that a plane of symmetry cuts: the nodes of the edge hold a part.
#[test]
fn forces_of_strips_that_share_an_edge_with_what_holds_are_warned_of() {
    let warned = |strip: &str, more: &[&str]| {
        let strip = format!("prescribed.0={{name=\"wall\", {strip}, displacement=[0.01, 0]}}");
        let force = "history.0={quantity=\"reaction\", of=\"wall\", name=\"wall\"}";
        let warnings = valid(STATIC, &[&[strip.as_str(), force], more].concat()).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.contains("missing in history"))
            .collect::<Vec<_>>()
    };
    let wall = "from=[0, 0], to=[0, 1]";
    let fixed = warned(wall, &[]);
    assert!(
        fixed.len() == 1 && fixed[0].contains("W0408: `prescribed.0` ends at the fixed boundary `bottom`"),
        "{fixed:?}"
    );
    assert!(warned(wall, &["boundary.bottom=roller", "boundary.right=roller"]).is_empty());
    let cone = [
        "boundary.left=roller",
        "body.0={material=\"soil\", polygon=[[0, 0], [2, 0], [2, 1], [0, 1.4]], points_per_cell=3}",
    ];
    let inclined = warned("from=[0, 1.4], to=[1, 1.2]", &cone);
    assert!(
        inclined.len() == 1
            && inclined[0].contains("W0407: `prescribed.0` is inclined and ends at roller boundary `left`"),
        "{inclined:?}"
    );
    assert!(warned("from=[0.5, 1.3], to=[1.5, 1.1]", &cone).is_empty());
}

/// A section has a part of what acts within two cells, but for what acts where the material ends or far to both sides.
#[test]
fn sections_beside_what_acts_are_warned_of() {
    let block = "geometry = 'plane-strain'\nanalysis = { type = 'quasi-static', steps = 4 }\n\
                 grid = { lower = [0, 0], upper = [8, 6], cell = 0.5, degree = 'quadratic' }\n\
                 material.soil = { model = 'elastic', young = 1e6, poisson = 0.3 }\nboundary = { bottom = 'fixed' }\n\
                 [[body]]\nmaterial = 'soil'\nbox = { lower = [0, 0], upper = [8, 4] }\npoints_per_cell = 2\n";
    let reports = |section: &str, acts: &str| {
        let case = format!("{block}[[history]]\nquantity = 'section-forces'\n{section}\n{acts}");
        let warnings = valid(&case, &[]).warnings;
        warnings.iter().filter(|warning| warning.contains("W0428")).count()
    };
    let strip = "[[prescribed]]\nfrom = [2, 2]\nto = [6, 2]\ndisplacement = [0, -0.1]";
    let level = |y: f64| format!("from = [0, {y}]\nto = [8, {y}]");
    let upright = |x: f64| format!("from = [{x}, 0]\nto = [{x}, 4]");
    assert_eq!(
        [1.0, 1.25, 2.0, 2.75, 3.0].map(|y| reports(&level(y), strip)),
        [0, 1, 1, 1, 0],
        "level, beside a strip"
    );
    assert_eq!(
        [1.0, 2.5, 4.0, 5.5, 7.0].map(|x| reports(&upright(x), strip)),
        [0, 1, 0, 1, 0],
        "upright, at its ends"
    );
    let footing = "[footing]\nfrom = [2, 4]\nto = [6, 4]\ndisplacement = [0, -0.1]";
    assert_eq!(
        [3.25, 3.75, 4.0].map(|y| reports(&level(y), footing)),
        [0, 0, 0],
        "where the material ends"
    );
    assert_eq!([2.5, 4.0].map(|x| reports(&upright(x), footing)), [1, 0], "upright");
    assert_eq!(reports("from = [2.5, 0]\nto = [2.5, 2]", footing), 0, "ends far below");
    let pipe = "[[rigid]]\nname = 'pipe'\ncircle = { centre = [4, 4.5], radius = 0.5 }\ndisplacement = [0, -0.1]";
    assert_eq!([reports(&upright(4.0), pipe), reports(&upright(6.0), pipe)], [1, 0]);
    assert_eq!(reports(&level(2.5), "[[point_load]]\nat = [4, 2]\nforce = [0, -1]"), 1);
}
