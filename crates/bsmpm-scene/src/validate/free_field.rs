//! Validates free-field boundaries.

use super::physics::reached;
use crate::case::{Body, Case, Geometry, LoadedLine, Rigid, RigidShape, Site, Support};
use crate::record::Record;
use crate::report::Report;
use crate::surfaces::outline;
use crate::words::{Side, Word};

/// The free field is columns of what lies at them, on the base, which nothing else holds or loads.
pub(super) fn check(case: &Case, record: &Record, report: &mut Report<'_>) {
    let Some(boundary) = record.record("boundary") else {
        return;
    };
    for (axis, upper) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        // An axisymmetric case has none: `axisymmetric.rs` says so.
        if case.boundary[axis][upper] != Support::FreeField || case.geometry == Geometry::Axisymmetric {
            continue;
        }
        let mut refuse = |message: String| boundary.error(Side::ALL[axis][upper].word(), message, report);
        if axis == 1 {
            refuse("E0244: a free field is available at the left and right face only. Use \"absorbing\" here.".into());
            continue;
        }
        if case.shaking.iter().all(|(_, ground)| *ground == [0.0; 3]) {
            refuse(
                "E0245: the case has no [shaking], or its acceleration is zero, so the free field does not move. Add \
                 [shaking] with an acceleration, or use \"absorbing\"."
                    .into(),
            );
        }
        if !matches!(case.boundary[1][0], Support::Fixed | Support::Absorbing) || case.boundary[1][1] != Support::Free {
            refuse(
                "E0246: a free field needs a supported bottom and a free top. Set boundary.bottom = \"fixed\" or \
                 \"absorbing\", and boundary.top = \"free\"."
                    .into(),
            );
        }
        if !reached(case, axis, upper == 1) {
            refuse(
                "E0247: no body reaches this face, so the free field has no soil. Extend a body to this face.".into(),
            );
        }
        let (lower, higher) = column(case, upper == 1);
        let in_column = |body: &Body| body.bounds()[0][0] < higher && body.bounds()[1][0] > lower;
        let moves = |body: &Body| body.velocity.is_some_and(|v| v != [0.0; 3]) || body.spin.is_some();
        if case.bodies.iter().any(|body| in_column(body) && moves(body)) {
            refuse(
                "E0248: a body at this face has an initial velocity or spin, but the outermost cells here represent \
                 the free field, which moves with [shaking] alone. Delete the velocity or spin."
                    .into(),
            );
        }
        if let Some(what) = acts_between(case, (lower, higher)) {
            refuse(format!(
                "E0248: {what} acts on the outermost cells at this face. They represent the free field, so only \
                 [shaking] may act on them. Keep {what} more than a cell away from this face at all times."
            ));
        }
    }
}

/// From and to along x, m, the cells at a side.
pub(super) fn column(case: &Case, upper: bool) -> (f64, f64) {
    let (of, lower) = (&case.grid.axes[0], case.grid.lower()[0]);
    let cells = of.cells();
    let cell = if upper { cells - 1 } else { 0 };
    (lower + of.breakpoint(cell), lower + of.breakpoint(cell + 1))
}

/// Whether a rigid body is between two places along x at some time of the way that it is given.
fn comes_between(rigid: &Rigid, (lower, higher): (f64, f64)) -> bool {
    let turns = rigid.free[2] || !rigid.rotation.is_empty();
    let [left, right] = match &rigid.shape {
        RigidShape::InSpace(_) => return false,
        shape if turns => {
            let reach = outline(shape, rigid.about).radius();
            [rigid.about[0] - reach, rigid.about[0] + reach]
        }
        RigidShape::Circle { center, radius } => [center[0] - radius, center[0] + radius],
        RigidShape::Polygon(corners) => {
            let ends = corners.iter().map(|corner| corner[0]);
            [
                ends.clone().fold(f64::INFINITY, f64::min),
                ends.fold(f64::NEG_INFINITY, f64::max),
            ]
        }
    };
    let way = || std::iter::once(0.0).chain(rigid.path.rows.iter().map(|(_, moved)| moved[0]));
    let pieces = way().zip(way().skip(1).chain(way().last()));
    pieces
        .into_iter()
        .any(|(from, to)| left + from.min(to) < higher && right + from.max(to) > lower)
}

/// What holds or loads material between two places along x.
fn acts_between(case: &Case, (lower, higher): (f64, f64)) -> Option<&'static str> {
    let within = |from: f64, to: f64| from.min(to) < higher && from.max(to) > lower;
    let line = |line: &LoadedLine| match line {
        LoadedLine::Segment { from, to } => within(from[0], to[0]),
        LoadedLine::Circle { center, radius } => within(center[0] - radius, center[0] + radius),
        LoadedLine::Plate(plate) => within(plate.lower[0], plate.upper[0]),
        LoadedLine::Triangles(all) => all
            .iter()
            .any(|[a, b, c]| within(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]))),
    };
    let site = |site: &Site| match site {
        Site::Face(face) => face.axis == 1,
        Site::Segment { from, to } => within(from[0], to[0]),
        Site::Plate(plate) => within(plate.lower[0], plate.upper[0]),
    };
    let acting = [
        (
            "the footing",
            case.footing
                .iter()
                .filter_map(|footing| footing.site.ends())
                .any(|[from, to]| within(from[0], to[0])),
        ),
        (
            "a prescribed motion",
            case.prescribed.iter().any(|motion| site(&motion.site)),
        ),
        ("a traction", case.tractions.iter().any(|traction| line(&traction.line))),
        (
            "a rigid body",
            case.rigid.iter().any(|rigid| comes_between(rigid, (lower, higher))),
        ),
        (
            "a point load",
            case.point_loads.iter().any(|load| within(load.at[0], load.at[0])),
        ),
    ];
    acting.into_iter().find(|(_, acts)| *acts).map(|(what, _)| what)
}
