//! Tests where C0 lines are placed.

use bsmpm::kinematics::PlaneStrain;
use bsmpm_scene::{Case, Line, model};

const LAYERS: &str = r#"
    geometry = "plane-strain"
    [analysis]
    type = "quasi-static"
    steps = 4
    [grid]
    lower = [0.0, 0.0]
    upper = [8.0, 6.0]
    cell  = 0.5
    degree = "quadratic"
    [material.soft]
    model = "tresca"
    young = 1e6
    poisson = 0.3
    cohesion = 1e3
    density = 2000.0
    [material.stiff]
    model = "elastic"
    young = 1e7
    poisson = 0.3
    density = 2000.0
    [[body]]
    material = "soft"
    box = { lower = [0.0, 0.0], upper = [8.0, 2.0] }
    points_per_cell = 2
    [[body]]
    material = "stiff"
    box = { lower = [0.0, 2.0], upper = [8.0, 4.0] }
    points_per_cell = 2
    [gravity]
    acceleration = [0.0, -9.81]
    [boundary]
    bottom = "fixed"
    left = "roller"
    right = "roller"
    [stabilisation]
    method = "consistent-f-bar"
"#;
const STRIP: &str =
    "[footing]\nfrom = [3.0, 4.0]\nto = [5.0, 4.0]\ndisplacement = [0.0, -0.1]\ninterface = \"rough\"\n";

fn case(text: &str) -> Case {
    Case::from_text("case.toml", text, &[]).unwrap_or_else(|errors| panic!("{errors:#?}\n{text}"))
}

/// Lines along x and y by breakpoint, and the notes and warnings about them.
fn lines(text: &str) -> ([Vec<usize>; 2], Vec<String>, Vec<String>) {
    let case = case(text);
    let notes = case
        .notes
        .iter()
        .filter(|note| note.key == "grid.c0_lines" && note.value.contains('='));
    let notes = notes.map(|note| format!("{} ({})", note.value, note.reason)).collect();
    let order = case.grid.order;
    let breakpoint = |line: &Line| {
        assert_eq!(line.multiplicity, order);
        line.breakpoint
    };
    (
        [0, 1].map(|axis: usize| case.grid.lines[axis].iter().map(breakpoint).collect()),
        notes,
        case.warnings,
    )
}

#[test]
fn layers_of_unlike_stiffness_or_density_meet_on_a_line() {
    let (found, notes, warnings) = lines(LAYERS);
    assert_eq!(found, [vec![], vec![4]]);
    assert_eq!(notes, ["y = 2 m (strains jump at the interface of `soft` and `stiff`)"]);
    assert!(warnings.is_empty(), "{warnings:?}");
    let alike = LAYERS.replace("young = 1e7", "young = 1e6");
    assert_eq!(
        lines(&alike).0,
        [vec![], vec![]],
        "strength alone makes no jump of strain"
    );
    let heavy = alike.replacen("density = 2000.0", "density = 1000.0", 1);
    assert_eq!(lines(&heavy).0, [vec![], vec![4]]);
    let block = LAYERS.replace("[0.0, 2.0], upper = [8.0, 4.0]", "[2.0, 2.0], upper = [4.0, 4.0]");
    assert_eq!(lines(&block).0, [vec![], vec![4]], "beside the block there is nothing");
    let apart = LAYERS.replace(
        "lower = [0.0, 2.0], upper = [8.0, 4.0]",
        "lower = [0.0, 2.5], upper = [8.0, 4.0]",
    );
    assert_eq!(lines(&apart).0, [vec![], vec![]], "they do not touch");
    let linear = LAYERS.replace("quadratic", "linear");
    assert_eq!(lines(&linear).0, [vec![], vec![]], "every line of a linear grid is one");
}

#[test]
fn an_interface_inside_cells_is_warned_of() {
    let inside = LAYERS
        .replace("[8.0, 2.0]", "[8.0, 2.2]")
        .replace("lower = [0.0, 2.0]", "lower = [0.0, 2.2]");
    let (found, _, warnings) = lines(&inside);
    assert_eq!(found, [vec![], vec![]]);
    assert!(warnings.len() == 1 && warnings[0].starts_with("W0222"), "{warnings:?}");
    let sloping = LAYERS
        .replace(
            "box = { lower = [0.0, 0.0], upper = [8.0, 2.0] }",
            "polygon = [[0, 0], [8, 0], [8, 3], [0, 2]]",
        )
        .replace(
            "box = { lower = [0.0, 2.0], upper = [8.0, 4.0] }",
            "polygon = [[0, 2], [8, 3], [8, 4], [0, 4]]",
        );
    assert!(lines(&sloping).2.iter().any(|warning| warning.starts_with("W0222")));
    assert!(lines(&sloping.replace("young = 1e7", "young = 1.2e6")).2.is_empty());
    // Without automatic lines the same is reported of the line that there might be.
    let none = LAYERS.replace("degree = \"quadratic\"", "degree = \"quadratic\"\nc0_lines = \"none\"");
    let (found, _, warnings) = lines(&none);
    assert_eq!(found, [vec![], vec![]]);
    assert!(
        warnings
            .iter()
            .any(|warning| warning.starts_with("W0216") && warning.contains("y = 2 m")),
        "{warnings:?}"
    );
}

#[test]
fn bodies_of_a_solid_meet_on_planes_of_the_grid_or_are_warned_of() {
    let solid = |boxes: [&str; 2]| {
        let [soft, stiff] = boxes;
        let text = LAYERS
            .replace("plane-strain", "solid")
            .replace(
                "lower = [0.0, 0.0]\n    upper = [8.0, 6.0]",
                "lower = [0, 0, 0]\n    upper = [8, 2, 6]",
            )
            .replace("box = { lower = [0.0, 0.0], upper = [8.0, 2.0] }", soft)
            .replace("box = { lower = [0.0, 2.0], upper = [8.0, 4.0] }", stiff)
            .replace("[0.0, -9.81]", "[0, 0, -9.81]")
            .replace(
                "right = \"roller\"",
                "right = \"roller\"\n    front = \"roller\"\n    back = \"roller\"",
            );
        let case = case(&text);
        let lines = |axis: usize| {
            case.grid.lines[axis]
                .iter()
                .map(|line| line.breakpoint)
                .collect::<Vec<_>>()
        };
        let inside = case
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0222") || warning.starts_with("W0223"));
        ([0, 1, 2].map(lines), inside)
    };
    let lower = "box = { lower = [0, 0, 0], upper = [8, 2, 2] }";
    let above = "box = { lower = [0, 0, 2], upper = [8, 2, 4] }";
    assert_eq!(solid([lower, above]), ([vec![], vec![], vec![4]], false));
    // A block beside a step of the ground meets it from the side, too.
    let step =
        "extrude = { polygon = [[0, 0], [8, 0], [8, 2], [4, 2], [4, 4], [0, 4]], along = \"y\", from = 0, to = 2 }";
    let beside = "box = { lower = [4, 0, 2], upper = [6, 1, 3] }";
    assert_eq!(solid([step, beside]), ([vec![8], vec![], vec![4]], false));
    // On a slope of 1 : 1 through crossings of grid lines, around a pile, and by a foot of one cell.
    let [under, over] = ["[0, 0], [6, 0], [6, 6]", "[0, 0], [6, 6], [0, 6]"]
        .map(|at| format!("extrude = {{ polygon = [{at}], along = \"y\", from = 0, to = 2 }}"));
    assert_eq!(solid([&under, &over]), ([vec![], vec![], vec![]], true));
    let pile = "extrude = { circle = { centre = [4, 1], radius = 1 }, along = \"z\", from = 2, to = 4 }";
    let around = format!("box = {{ lower = [0, 0, 0], upper = [8, 2, 4] }}\n    subtract = [{{ {pile} }}]");
    assert_eq!(solid([&around, pile]), ([vec![], vec![], vec![4]], true));
    let foot = "extrude = { polygon = [[0, 3], [4.5, 3], [4.5, 2], [5, 2], [5, 3], [8, 3], [8, 4], [0, 4]], \
                along = \"y\", from = 0, to = 2 }";
    assert_eq!(solid([lower, foot]), ([vec![], vec![], vec![4]], false));
    let between = lower.replace("8, 2, 2]", "8, 2, 2.2]");
    assert_eq!(
        solid([&between, &above.replace("[0, 0, 2]", "[0, 0, 2.2]")]),
        ([vec![], vec![], vec![]], true)
    );
    assert_eq!(
        solid([lower, &above.replace("[0, 0, 2]", "[0, 0, 2.5]")]),
        ([vec![], vec![], vec![]], false)
    );
    // A narrow gap, across which nothing is found to meet.
    assert_eq!(
        solid([lower, &above.replace("[0, 0, 2]", "[0, 0, 2.2]")]),
        ([vec![], vec![], vec![]], true)
    );
}

#[test]
fn strips_and_loads_end_on_lines_where_the_surface_goes_on() {
    let alike = LAYERS.replace("young = 1e7", "young = 1e6");
    let strip = format!("{alike}{STRIP}");
    let (found, notes, warnings) = lines(&strip);
    assert_eq!(found, [vec![6, 10], vec![]]);
    assert!(
        notes.iter().all(|note| note.contains("the end of `footing`")),
        "{notes:?}"
    );
    assert!(warnings.is_empty(), "{warnings:?}");
    // Half of it at the axis of symmetry, and a strip over the whole surface.
    assert_eq!(
        lines(&strip.replace("from = [3.0, 4.0]", "from = [0.0, 4.0]")).0,
        [vec![10], vec![]]
    );
    let over_all = strip
        .replace("[3.0, 4.0]", "[0.0, 4.0]")
        .replace("[5.0, 4.0]", "[8.0, 4.0]");
    assert_eq!(lines(&over_all).0, [vec![], vec![]]);
    let reports = |text: &str, says: &str| {
        let (found, _, warnings) = lines(text);
        assert!(
            warnings.iter().any(|warning| warning.contains(says)),
            "{says}: {warnings:?}"
        );
        found
    };
    let inside = strip.replace("to = [5.0, 4.0]", "to = [5.2, 4.0]");
    assert_eq!(
        reports(&inside, "W0225: the end of `footing` at x = 5.2 m"),
        [vec![6], vec![]]
    );
    let narrow = strip
        .replace("from = [3.0, 4.0]", "from = [4.7, 4.0]")
        .replace("[5.0, 4.0]", "[4.9, 4.0]");
    let errors = Case::from_text("case.toml", &narrow, &[]).expect_err("it is narrower than a cell");
    assert!(
        errors
            .iter()
            .any(|e| e.key == "footing.to" && e.message.contains("shorter than a cell (0.5 m)")),
        "{errors:?}"
    );
    let sliding = strip.replace("[0.0, -0.1]", "[0.3, -0.1]");
    assert_eq!(reports(&sliding, "W0226"), [vec![], vec![]]);
    let load = "[[traction]]\nfrom = [2.0, 4.0]\nto = [4.0, 4.0]\nstress = [0.0, -1e3]\nramp = 1.0\n";
    assert_eq!(lines(&format!("{alike}{load}")).0, [vec![4, 8], vec![]]);
}

#[test]
fn knots_may_be_repeated_by_hand() {
    let knots = "knots = { x = [0, 2, 2, 4, 6, 8], y = [0, 1, 2, 3, 4, 4, 5, 6] }";
    let text = LAYERS
        .replace("lower = [0.0, 0.0]\n    upper = [8.0, 6.0]\n    cell  = 0.5", knots)
        .replace("young = 1e7", "young = 1e6");
    let case = case(&text);
    let line = |breakpoint| Line {
        breakpoint,
        multiplicity: 2,
    };
    assert_eq!(case.grid.lines, [vec![line(1)], vec![line(4)], Vec::new()]);
    let model = model::model::<PlaneStrain, 2>(&case).unwrap();
    assert_eq!(
        model.grid.axes().each_ref().map(|axis| axis.functions()),
        [4 + 1 + 2, 6 + 1 + 2]
    );
    // The points of a slab are those of its cells with a length: columns 1 and 3 of 5 hold none and a cell's.
    let count = |columns| model::points::<PlaneStrain, 2>(&case, columns, |_| true).len();
    assert_eq!([count(0..1), count(1..2), count(2..3), count(0..5)], [16, 0, 16, 64]);
    assert_eq!(case.points_by_column(), [16, 0, 16, 16, 16]);
}

#[test]
fn where_water_fills_ground_that_moves_through_lines_there_is_a_warning() {
    let wet = LAYERS
        .replace("young = 1e7", "young = 1e6")
        .replace("type = \"quasi-static\"", "type = \"consolidation\"\n    end = 1.0")
        .replace(
            "density = 2000.0",
            "density = 2000.0\n    drainage = \"undrained\"\n    porosity = 0.4",
        );
    let loses = |text: &str| lines(text).2.iter().any(|warning| warning.starts_with("W0219"));
    let strip = format!("{wet}{STRIP}");
    assert_eq!(lines(&strip).0, [vec![6, 10], vec![]]);
    assert!(!loses(&strip), "0.2 of a cell");
    let has_friction = |text: &str| lines(text).2.iter().any(|warning| warning.starts_with("W0218"));
    let law = ["model = \"tresca\"", "cohesion = 1e3"];
    let friction = |angle: u32| {
        let mohr = strip.replace(law[0], "model = \"mohr-coulomb\"");
        mohr.replace(law[1], &format!("cohesion = 1e3\n    friction_angle = {angle}"))
    };
    assert!(has_friction(&friction(25)) && !has_friction(&friction(0)) && !has_friction(&strip));
    assert!(!has_friction(&friction(25).replace(STRIP, "")), "no line");
    let deeper = strip.replace("[0.0, -0.1]", "[0.0, -0.4]");
    assert!(loses(&deeper));
    let by_hand = "knots = { x = [0, 2, 2, 4, 6, 8], y = [0, 1, 2, 3, 4, 5, 6] }";
    assert!(loses(&wet.replace(
        "lower = [0.0, 0.0]\n    upper = [8.0, 6.0]\n    cell  = 0.5",
        by_hand
    )));
    let load = "[[traction]]\nfrom = [2.0, 4.0]\nto = [4.0, 4.0]\nstress = [0.0, -1e3]\nramp = 1.0\n";
    let (found, _, warnings) = lines(&format!("{wet}{load}"));
    assert_eq!(found, [vec![], vec![]]);
    assert!(
        warnings.iter().any(|warning| warning.starts_with("W0217")),
        "{warnings:?}"
    );
}

/// Where one of two soils lets much less water through, and meets the other inside a cell, or none at all.
#[test]
fn what_is_tight_beside_what_is_not_is_warned_of() {
    let layers = |height: f64, tight: &str| {
        format!(
            "title = \"t\"\ngeometry = \"plane-strain\"\n[analysis]\ntype = \"consolidation\"\nend = \"1 s\"\nsteps = 4\n\
             [grid]\nlower = [0, 0]\nupper = [1, 4]\ncell = 0.5\ndegree = \"quadratic\"\n\
             [material.sand]\nmodel = \"elastic\"\nyoung = \"1 MPa\"\npoisson = 0.2\ndrainage = \"coupled\"\nporosity = 0.4\n\
             permeability = 1e-5\n\
             [material.clay]\nmodel = \"elastic\"\nyoung = \"1 MPa\"\npoisson = 0.2\nporosity = 0.4\n{tight}\n\
             [[body]]\nmaterial = \"sand\"\nbox = {{ lower = [0, 0], upper = [1, {height}] }}\npoints_per_cell = 2\n\
             [[body]]\nmaterial = \"clay\"\nbox = {{ lower = [0, {height}], upper = [1, 3] }}\npoints_per_cell = 2\n\
             [boundary]\nbottom = \"fixed\"\n[[drain]]\nname = \"base\"\nface = \"bottom\"\n"
        )
    };
    let reports = |height: f64, tight: &str| {
        let (_, _, warnings) = lines(&layers(height, tight));
        warnings
            .into_iter()
            .find(|warning| warning.contains("`sand` and `clay` meet"))
    };
    let coupled = |permeability: f64| format!("drainage = \"coupled\"\npermeability = {permeability:e}");
    assert!(reports(2.2, &coupled(1e-7)).is_some_and(|warning| warning.contains("a permeability ratio of 100,")));
    assert_eq!(reports(2.0, &coupled(1e-7)), None);
    assert_eq!(reports(2.2, &coupled(5e-6)), None);
    assert!(reports(2.0, "drainage = \"undrained\"").is_some_and(|warning| warning.starts_with("W0533")));
}

/// A line where an edge that soil lies at ends and the surface goes on, of a body that stays over it; inside a cell a
/// warning.
#[test]
fn rigid_bodies_have_lines_at_the_corners_that_stay() {
    let one = LAYERS.replace("\"stiff\"\n    box", "\"soft\"\n    box");
    let punch = |left: f64, more: &str| {
        format!(
            "{one}[[rigid]]\nname = \"punch\"\npolygon = [[{left}, 4], [5, 4], [5, 5], [{left}, 5]]\n{more}\n\
             [[history]]\nquantity = \"rigid-force\"\nrigid = \"punch\"\n"
        )
    };
    let down = "displacement = [0.0, -0.1]";
    let (found, notes, _) = lines(&punch(3.0, down));
    assert_eq!(found, [vec![6, 10], vec![]], "{notes:?}");
    assert!(notes[0].contains("the corner of rigid body `punch`"), "{notes:?}");
    // At the end of the ground nothing goes on.
    assert_eq!(lines(&punch(-1.0, down)).0, [vec![10], vec![]]);
    let (found, _, warnings) = lines(&punch(3.2, down));
    assert_eq!(found, [vec![10], vec![]]);
    let reports = |warnings: &[String]| {
        warnings
            .iter()
            .any(|warning| warning.contains("corner of rigid body `punch` at x = 3.2 m"))
    };
    assert!(reports(&warnings), "{warnings:?}");
    // A wedge has no edge there, and is widest there all the same; above the ground it parts nothing.
    let wedge = |top: f64| {
        let low = top - 1.0;
        let shape = format!("[[3, {top}], [4, {low}], [5, {top}]]");
        let hole = if top > 4.0 {
            "[[3, 4], [3.5, 3.5], [4.5, 3.5], [5, 4]]".to_owned()
        } else {
            shape.clone()
        };
        let ground = format!("subtract = [{{ polygon = {hole} }}]\n    points_per_cell");
        let ground = one.replace("points_per_cell", &ground);
        lines(&format!(
            "{ground}[[rigid]]\nname = \"wedge\"\npolygon = {shape}\n{down}\n"
        ))
    };
    assert_eq!(wedge(4.0).0, [vec![6, 10], vec![]]);
    assert_eq!(wedge(5.0).0, [vec![], vec![]]);
    for moved in [
        "displacement = [0.1, 0.0]",
        "free = [\"x\", \"y\", \"rotation\"]\nforce = [0, -10]",
    ] {
        let (found, _, warnings) = lines(&punch(3.2, moved));
        assert!(
            found == [vec![], vec![]] && !reports(&warnings),
            "{found:?} {warnings:?}"
        );
    }
}

/// A smooth box of a solid that is pushed down has lines along both axes that it stays at, also where it reaches beyond
/// a plane of symmetry; inside a cell a warning. The rim of a cylinder is warned of.
#[test]
fn rigid_boxes_of_a_solid_have_lines_at_the_edges_that_stay() {
    let of = |shape: &str, more: &str| {
        let text = LAYERS
            .replace("plane-strain", "solid")
            .replace(
                "lower = [0.0, 0.0]\n    upper = [8.0, 6.0]",
                "lower = [0, 0, 0]\n    upper = [8, 4, 6]",
            )
            .replace(
                "box = { lower = [0.0, 0.0], upper = [8.0, 2.0] }",
                "box = { lower = [0, 0, 0], upper = [8, 4, 2] }",
            )
            .replace(
                "\"stiff\"\n    box = { lower = [0.0, 2.0], upper = [8.0, 4.0] }",
                "\"soft\"\n    box = { lower = [0, 0, 2], upper = [8, 4, 4] }",
            )
            .replace("[0.0, -9.81]", "[0, 0, -9.81]")
            .replace(
                "right = \"roller\"",
                "right = \"roller\"\n    front = \"roller\"\n    back = \"roller\"",
            );
        let case = case(&format!("{text}[[rigid]]\nname = \"punch\"\n{shape}\n{more}\n"));
        let breakpoints = |axis: usize| {
            case.grid.lines[axis]
                .iter()
                .map(|line| line.breakpoint)
                .collect::<Vec<_>>()
        };
        let notes = case
            .notes
            .iter()
            .filter(|note| note.key == "grid.c0_lines" && note.value.contains('='));
        let reported = notes.map(|note| note.reason.clone());
        ([0, 1, 2].map(breakpoints), reported.collect::<Vec<_>>(), case.warnings)
    };
    let at = |x: f64, y: f64, z: f64| {
        format!(
            "box = {{ lower = [{x}, {y}, {z}], upper = [{}, {}, {}] }}",
            x + 2.0,
            y + 2.0,
            z + 2.0
        )
    };
    let down = "displacement = [0, 0, -0.1]";
    let (found, notes, warnings) = of(&at(3.0, 1.0, 4.0), down);
    assert_eq!(found, [vec![6, 10], vec![2, 6], vec![]]);
    assert!(notes[0].contains("the edge of rigid body `punch`"), "{notes:?}");
    assert!(
        !warnings.iter().any(|warning| warning.contains("punch")),
        "{warnings:?}"
    );
    // A quarter of it in the corner of two planes of symmetry, half of it at one; above the ground it parts nothing.
    assert_eq!(of(&at(-1.0, -1.0, 4.0), down).0, [vec![2], vec![2], vec![]]);
    assert_eq!(of(&at(3.0, 3.0, 4.0), down).0, [vec![6, 10], vec![6], vec![]]);
    assert_eq!(of(&at(3.0, 1.0, 4.5), down).0, [vec![], vec![], vec![]]);
    // A strip has no ends where the ground has none, and what is pushed sideways, too, none along that.
    let strip = "box = { lower = [3, -9, 4], upper = [5, 9, 6] }";
    assert_eq!(of(strip, down).0, [vec![6, 10], vec![], vec![]]);
    assert_eq!(
        of(&at(3.0, 1.0, 4.0), "displacement = [0.1, 0, -0.1]").0,
        [vec![], vec![2, 6], vec![]]
    );
    // Inside cells.
    let (found, _, warnings) = of(&at(3.2, 1.0, 4.0), down);
    assert_eq!(found, [vec![], vec![2, 6], vec![]]);
    assert!(
        warnings
            .iter()
            .any(|warning| warning.contains("edge of rigid body `punch` at x = 3.2 m")),
        "{warnings:?}"
    );
    let round = |motion: &str| {
        let shape = "revolve = { about = [4, 2], polygon = [[0, 4], [1, 4], [1, 6], [0, 6]] }";
        let (found, _, warnings) = of(shape, motion);
        assert_eq!(found, [vec![], vec![], vec![]]);
        warnings
            .iter()
            .any(|warning| warning.starts_with("W0224: the edge of rigid body `punch`"))
    };
    assert!(round(down) && !round("displacement = [0.1, 0, 0]"));
}
