//! Tests that malformed cases are refused with line, key and reason.

mod axisymmetric;
mod flow;
mod initial;
mod layers;
mod loads;
mod matrix;
mod page;
mod rigid;
mod rows;
mod rubbing;
mod shapes;
mod solid;
mod stages;
mod texts;
mod water;

use bsmpm_scene::{Case, Error, Place};

const DYNAMIC: &str = include_str!("../full.toml");
const STATIC: &str = include_str!("static.toml");
const RUBBING: &str = include_str!("rubbing.toml");
const SEEPING: &str = include_str!("seeping.toml");
const ROUND: &str = include_str!("round.toml");
const SOLID: &str = include_str!("solid.toml");
const WET: &str = include_str!("wet.toml");
const WET_SOLID: &str = include_str!("wet_solid.toml");

/// One malformed case: `find` in the base becomes `put`, and the error of `key`, `moved` lines below, must have the
/// words `says`, or all of those that ` .. ` separates.
#[derive(Clone, Copy)]
pub struct Row {
    find: &'static str,
    put: &'static str,
    moved: isize,
    key: &'static str,
    says: &'static str,
}

const fn row(find: &'static str, put: &'static str, key: &'static str, says: &'static str) -> Row {
    Row {
        find,
        put,
        moved: 0,
        key,
        says,
    }
}

impl Row {
    const fn down(self, lines: isize) -> Self {
        Self { moved: lines, ..self }
    }

    const fn up(self, lines: isize) -> Self {
        Self { moved: -lines, ..self }
    }
}

fn verify(base: &str, row: &Row) -> Result<(), String> {
    let at = base
        .find(row.find)
        .ok_or(format!("`{}` is not in the base", row.find))?;
    let line = (1 + base[..at].matches('\n').count()).saturating_add_signed(row.moved);
    let text = base.replacen(row.find, row.put, 1);
    let errors = match Case::from_text("case.toml", &text, &[]) {
        Ok(_) => return Err(format!("`{}` is accepted", row.put)),
        Err(errors) => errors,
    };
    let fits = |error: &Error| {
        let placed = matches!(error.place, Place::Line { line: found, column } if found == line && column > 0);
        let message = error.to_string();
        placed && error.key == row.key && row.says.split(" .. ").all(|part| message.contains(part))
    };
    if errors.iter().any(fits) {
        return Ok(());
    }
    let found: String = errors.iter().map(|error| format!("\n   {error}")).collect();
    Err(format!(
        "`{}`: expected line {line}: {}: ..{}.., found{found}",
        row.put, row.key, row.says
    ))
}

fn verify_all(base: &str, rows: &[Row]) {
    let failed: Vec<String> = rows.iter().filter_map(|row| verify(base, row).err()).collect();
    assert!(
        failed.is_empty(),
        "{} of {} rows:\n{}",
        failed.len(),
        rows.len(),
        failed.join("\n")
    );
}

#[test]
fn the_bases_are_valid() {
    for base in [DYNAMIC, STATIC, RUBBING, SEEPING, ROUND, SOLID, WET, WET_SOLID] {
        Case::from_text("case.toml", base, &[]).unwrap_or_else(|errors| panic!("{errors:#?}"));
    }
}

#[test]
fn names_types_and_units() {
    verify_all(DYNAMIC, &rows::language());
}

#[test]
fn values_out_of_range() {
    verify_all(DYNAMIC, &rows::ranges());
}

#[test]
fn rules_between_keys() {
    verify_all(DYNAMIC, &rows::rules());
}

#[test]
fn what_two_groups_of_keys_forbid_is_reported_once() {
    let sphere = "sphere = { centre = [3, 1.5, 2.0]";
    let text = SOLID.replacen(
        sphere,
        &format!("disc = {{ centre = [0.4, 1.5, 1.0], radius = 0.3 }}\n{sphere}"),
        1,
    );
    let errors = Case::from_text("case.toml", &text, &[]).expect_err("a disc and a sphere");
    let reported = errors
        .iter()
        .filter(|error| error.code.as_deref() == Some("E0016"))
        .count();
    assert_eq!(reported, 1, "{errors:?}");
}

#[test]
fn quasi_static_cases() {
    verify_all(STATIC, rows::quasi_static::QUASI_STATIC);
}

#[test]
fn shapes() {
    verify_all(DYNAMIC, shapes::SHAPES);
}

#[test]
fn layers_and_strength_reduction() {
    verify_all(DYNAMIC, layers::LAYERS);
}

#[test]
fn rigid_bodies() {
    verify_all(DYNAMIC, rigid::RIGID);
}

#[test]
fn strips_and_loads() {
    verify_all(DYNAMIC, loads::STRIPS);
}

#[test]
fn initial_stress_and_histories() {
    verify_all(DYNAMIC, initial::INITIAL);
    verify_all(STATIC, loads::QUASI_STATIC);
    verify_all(RUBBING, rubbing::RUBBING);
}

#[test]
fn axisymmetric_cases() {
    verify_all(ROUND, axisymmetric::AXISYMMETRIC);
}

#[test]
fn water_that_flows() {
    verify_all(SEEPING, flow::FLOW);
    verify_all(STATIC, flow::WITHOUT_FLOW);
}

#[test]
fn still_water() {
    verify_all(WET, water::WATER);
    verify_all(DYNAMIC, water::SHAKEN);
    verify_all(WET, water::RATIO_AND_WATER);
    verify_all(STATIC, water::RATIO);
}

/// A horizontal part of gravity is the inertia of a pseudo-static analysis. In dynamics it inclines the grid, in which
/// water does not lie level.
#[test]
fn gravity_is_inclined_in_quasi_static_analyses_alone() {
    let inclined = WET.replace("[0.0, -9.81]", "[1.0, -9.81]");
    let case = Case::from_text("case.toml", &inclined, &[]).unwrap();
    assert!(
        case.notes.iter().any(|note| note.key == "gravity.acceleration"),
        "{:?}",
        case.notes
    );
    let dynamic = WET.replace(
        "type  = \"quasi-static\"\nend   = 1.0\nsteps = 4",
        "type  = \"dynamic\"\nend   = 1.0\ndt = 0.25",
    );
    let says = "E0523";
    verify_all(
        &dynamic,
        &[row("[0.0, -9.81]", "[1.0, -9.81]", "gravity.acceleration", says)],
    );
}

#[test]
fn three_dimensions() {
    verify_all(SOLID, &solid::solid());
    verify_all(WET_SOLID, solid::water::WET);
    verify_all(STATIC, solid::IN_A_PLANE);
}

#[test]
fn faces_that_absorb() {
    verify_all(DYNAMIC, rows::boundary::ABSORBING);
}

#[test]
fn what_is_reported_of_parts_lines_and_places() {
    verify_all(DYNAMIC, rows::histories::REPORTED);
    verify_all(STATIC, rows::histories::REPORTED_QUASI_STATIC);
}

#[test]
fn stages() {
    verify_all(DYNAMIC, stages::STAGES);
    verify_all(STATIC, stages::STAGES_OF_ONE);
}

#[test]
fn known_but_not_available_yet() {
    let later = |(find, put, key): &(&'static str, &'static str, &'static str)| row(find, put, key, "E0012");
    verify_all(DYNAMIC, &rows::output::LATER.iter().map(later).collect::<Vec<_>>());
}
