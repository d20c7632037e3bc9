//! Tests that doubtful drains and heads have warnings, and that drainage follows the ground.

use super::{SEEPING, valid};
use bsmpm::field::pore_water::flow::Motion;

/// A drain above the water table is a pond where the ground takes in what a step brings.
#[test]
fn drains_that_feed_the_ground_are_warned_of() {
    let warned = |base: &str, set: &[&str]| {
        let common = ["gravity={ acceleration = [0, -9.81] }", "water.level=0.2"];
        let warnings = valid(base, &[&common[..], set].concat()).warnings;
        warnings
            .iter()
            .filter(|warning| warning.contains("W0552"))
            .cloned()
            .collect::<Vec<_>>()
    };
    let full = SEEPING.replace("retention        = { alpha = 2.0, n = 1.5, residual = 0.1 }", "");
    let permeable = "material.clay.permeability=1e-5";
    let quick = "analysis.dt_max=3600";
    let found = warned(&full, &[permeable]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0552: drain.4: ") && found[0].contains("51.8 cells"),
        "{found:?}"
    );
    assert!(warned(&full, &[]).is_empty() && warned(&full, &[permeable, quick]).is_empty());
    // Its suction is lost in short steps, too.
    let found = warned(SEEPING, &[permeable, quick, "analysis.end=72000"]);
    assert!(
        found.len() == 1 && found[0].contains("7 cells high during the analysis"),
        "{found:?}"
    );
    assert!(warned(SEEPING, &[permeable, "water.level=1.0"]).is_empty());
}

/// Permeable ground that no drain lies on, of its own or of what it touches.
#[test]
fn ground_that_its_water_cannot_leave_is_warned_of() {
    let case = include_str!("../../../../cases/validation/terzaghi.toml");
    let wide = [
        "grid.upper=[0.5, 1.0]",
        "drain.0={ name = \"top\", from = [0.0, 1.0], to = [0.1, 1.0] }",
    ];
    let column = |k: usize, [left, right]: [f64; 2], material: &str| {
        let shape = format!("box = {{ lower = [{left}, 0.0], upper = [{right}, 1.0] }}, points_per_cell = 3");
        format!("body.{k}={{ material = \"{material}\", {shape} }}")
    };
    let warned = |set: &[&str]| {
        let warnings = valid(case, set).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.contains("W0530"))
            .collect::<Vec<_>>()
    };
    assert!(warned(&[]).is_empty());
    assert!(warned(&["drain=[]"])[0].contains("no drain lies at body.0,"));
    let apart = column(1, [0.3, 0.4], "clay");
    let found = warned(&[&wide[..], &[&apart]].concat());
    assert!(
        found.len() == 1 && found[0].contains("no drain lies at body.1,"),
        "{found:?}"
    );
    let beside = [column(1, [0.3, 0.4], "clay"), column(2, [0.1, 0.3], "clay")];
    assert!(warned(&[&wide[..], &[&beside[0], &beside[1]]].concat()).is_empty());
    let tight =
        "material.tight={ model = \"elastic\", young = 1e6, poisson = 0.0, drainage = \"undrained\", porosity = 0.5 }";
    let behind = [tight, &column(1, [0.3, 0.4], "clay"), &column(2, [0.1, 0.3], "tight")];
    let found = warned(&[&wide[..], &behind].concat());
    assert!(
        found.len() == 1 && found[0].contains("no drain lies at body.1,"),
        "{found:?}"
    );
}

/// Ground that no water can flow through fails without drainage, unless the case says otherwise.
#[test]
fn strength_falls_as_the_ground_can_drain() {
    let at_rest = |set: &[&str]| {
        let common = ["strength_reduction={ factor = 1.2, stage = \"end\" }"];
        valid(SEEPING, &[&common[..], set].concat())
            .flow
            .map(|flow| flow.at_rest)
    };
    assert_eq!(at_rest(&[]), Some(Motion::Held));
    assert_eq!(
        at_rest(&["strength_reduction.drainage=undrained"]),
        Some(Motion::Undrained)
    );
    let tight = ["drain=[]", "inflow=[]", "history=[]", "body.*.material=tight"];
    assert_eq!(at_rest(&tight), Some(Motion::Undrained));
    assert_eq!(
        at_rest(&[&tight[..], &["strength_reduction.drainage=drained"]].concat()),
        Some(Motion::Held)
    );
}

/// Water that a head lets stand above the surface does not press on it.
#[test]
fn heads_above_the_surface_are_warned_of() {
    let text = SEEPING.replace("surface  = true", "from = [3.0, 2.0]\nto = [4.0, 2.0]");
    let text = text
        .replace("[2.0, 1.0]", "[2.0, 2.0]")
        .replace("[3.0, 1.0]", "[3.0, 2.0]");
    let warned = |set: &[&str]| {
        let warnings = valid(&text, set).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.contains("W0554"))
            .collect::<Vec<_>>()
    };
    let found = warned(&[]);
    assert!(
        found.len() == 1 && found[0].starts_with("W0554: drain.1: the head is up to 1.000 m above"),
        "{found:?}"
    );
    assert!(warned(&["drain.1.head_path=[[0, 1.0], [\"30 d\", 2.0]]"]).is_empty());
    let gravity = "gravity={ acceleration = [0, -9.81] }";
    assert!(
        warned(&[gravity, "water.level=3.0"]).is_empty(),
        "still water stands there"
    );
    let well = ["drain.1.from=[3.0, 0.2]", "drain.1.to=[3.0, 1.5]"];
    assert!(warned(&well).is_empty(), "a well inside the ground");
}
