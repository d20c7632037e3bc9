//! Tests that footings and the initial stress arrive, and that doubtful places of reported forces have warnings.

use super::{FULL, STATIC, doubts, set, valid};
use bsmpm::material::Profile;
use bsmpm_scene::{ActiveLoads, Base, Face, Initial, Push, Site};

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
