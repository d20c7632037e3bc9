//! Validates free-field boundaries.

use super::physics::reached;
use crate::case::{Case, Geometry, LoadedLine, Rigid, RigidShape, Site, Support};
use crate::report::Report;
use crate::schema::{Draft, SupportTable};
use crate::surfaces::outline;
use crate::words::Side;

/// The free field is columns of what lies at them, on the base, which nothing else holds or loads.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let Some(boundary) = draft.boundary.value() else {
        return;
    };
    for (axis, upper) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        // An axisymmetric case has none: `axisymmetric.rs` says so.
        if case.boundary[axis][upper] != Support::FreeField || case.geometry == Geometry::Axisymmetric {
            continue;
        }
        let face = boundary.face(Side::ALL[axis][upper]);
        if axis == 1 {
            let message = "E0244: a free field is available at the left and right face only. Use \"absorbing\" here.";
            face.error(message, report);
            continue;
        }
        if case.shaking.iter().all(|(_, ground)| *ground == [0.0; 3]) {
            let message = "E0245: the case has no [shaking], or its acceleration is zero, so the free field does not \
                 move. Add [shaking] with an acceleration, or use \"absorbing\".";
            face.error(message, report);
        }
        if !matches!(case.boundary[1][0], Support::Fixed | Support::Absorbing) || case.boundary[1][1] != Support::Free {
            let message = "E0246: a free field needs a supported bottom and a free top. Set boundary.bottom = \
                 \"fixed\" or \"absorbing\", and boundary.top = \"free\".";
            face.error(message, report);
        }
        if !reached(case, axis, upper == 1) {
            let message = "E0247: no body reaches this face, so the free field has no soil. Extend a body to this \
                 face.";
            face.error(message, report);
        }
        let (lower, higher) = column(case, upper == 1);
        let column = Column { lower, higher };
        let mut bodies = case
            .bodies
            .iter()
            .filter(|body| column.meets(body.bounds()[0][0], body.bounds()[1][0]));
        if bodies.any(|body| body.velocity.is_some_and(|v| v != [0.0; 3]) || body.spin.is_some()) {
            let message = "E0248: a body at this face has an initial velocity or spin, but the outermost cells here \
                 represent the free field, which moves with [shaking] alone. Delete the velocity or spin.";
            face.error(message, report);
        }
        if let Some(what) = acts_in(case, &column) {
            let message = format!(
                "E0248: {what} acts on the outermost cells at this face. They represent the free field, so only \
                 [shaking] may act on them. Keep {what} more than a cell away from this face at all times."
            );
            face.error(message, report);
        }
    }
}

/// From and to along x, m, the cells at a side.
pub(super) fn column(case: &Case, upper: bool) -> (f64, f64) {
    let of = &case.grid.axes[0];
    let lower = case.grid.lower()[0];
    let cells = of.cells();
    let cell = if upper { cells - 1 } else { 0 };
    (lower + of.breakpoint(cell), lower + of.breakpoint(cell + 1))
}

/// The cells at a side, from `lower` to `higher` along x, m.
struct Column {
    lower: f64,
    higher: f64,
}

impl Column {
    /// Whether something between two places along x (m), in any order, has a part in it.
    fn meets(&self, from: f64, to: f64) -> bool {
        from.min(to) < self.higher && from.max(to) > self.lower
    }

    /// Whether a line that is loaded has a part in it.
    fn meets_line(&self, line: &LoadedLine) -> bool {
        match line {
            LoadedLine::Segment { from, to } => self.meets(from[0], to[0]),
            LoadedLine::Circle { center, radius } => self.meets(center[0] - radius, center[0] + radius),
            LoadedLine::Plate(plate) => self.meets(plate.lower[0], plate.upper[0]),
            LoadedLine::Triangles(all) => all
                .iter()
                .any(|[a, b, c]| self.meets(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]))),
        }
    }

    /// Whether what is held has a part in it.
    fn meets_site(&self, site: &Site) -> bool {
        match site {
            Site::Face(face) => face.axis == 1,
            Site::Segment { from, to } => self.meets(from[0], to[0]),
            Site::Plate(plate) => self.meets(plate.lower[0], plate.upper[0]),
        }
    }
}

/// Whether a rigid body is in the column at some time of the way that it is given.
fn comes_into(rigid: &Rigid, column: &Column) -> bool {
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
    let way = std::iter::once(0.0).chain(rigid.path.rows.iter().map(|(_, moved)| moved[0]));
    let way: Vec<f64> = way.collect();
    let mut pieces = way.iter().zip(way.iter().skip(1).chain(way.last()));
    pieces.any(|(from, to)| column.meets(left + from.min(*to), right + from.max(*to)))
}

/// What holds or loads material in the column.
fn acts_in(case: &Case, column: &Column) -> Option<&'static str> {
    let acting = [
        (
            "the footing",
            case.footing
                .iter()
                .filter_map(|footing| footing.site.ends())
                .any(|[from, to]| column.meets(from[0], to[0])),
        ),
        (
            "a prescribed motion",
            case.prescribed.iter().any(|motion| column.meets_site(&motion.site)),
        ),
        (
            "a traction",
            case.tractions.iter().any(|traction| column.meets_line(&traction.line)),
        ),
        ("a rigid body", case.rigid.iter().any(|rigid| comes_into(rigid, column))),
        (
            "a point load",
            case.point_loads.iter().any(|load| column.meets(load.at[0], load.at[0])),
        ),
    ];
    acting.into_iter().find(|(_, acts)| *acts).map(|(what, _)| what)
}
