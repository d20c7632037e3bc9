//! C0 lines at the ends of strips and loaded segments, at the edges of plates, and at corners of rigid bodies.

use super::{BESIDE, BEYOND, FoundLine, NAMES, grid_line};
use crate::case::{Case, LoadedLine, MotionPath, Rigid, RigidShape, Site};
use crate::validate::place::is_in;

/// A strip or a loaded segment.
struct Segment<'a> {
    name: String,
    table: (&'static str, usize),
    ends: [[f64; 3]; 2],
    path: Option<&'a MotionPath>,
}

impl Segment<'_> {
    /// Whether it stays where it is along an axis.
    fn stays(&self, axis: usize) -> bool {
        self.path.is_none_or(|path| path.rows.iter().all(|(_, moved)| moved[axis] == 0.0))
    }

    /// How far it goes, m.
    fn goes(&self) -> f64 {
        let rows = self.path.iter().flat_map(|path| &path.rows);
        rows.map(|(_, moved)| moved[0].hypot(moved[1]).hypot(moved[2])).fold(0.0, f64::max)
    }
}

/// A place of a plane.
fn flat([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

fn all_segments(case: &Case) -> Vec<Segment<'_>> {
    let footing = case.footing.iter().filter_map(|footing| {
        let (table, path) = (("footing", 0), Some(&footing.path));
        footing.site.ends().map(|ends| Segment { name: "footing".into(), table, ends: ends.map(flat), path })
    });
    let prescribed = case.prescribed.iter().enumerate().filter_map(|(number, prescribed)| {
        let (table, path) = (("prescribed", number), Some(&prescribed.path));
        prescribed.site.ends().map(|ends| Segment {
            name: format!("prescribed.{number}"),
            table,
            ends: ends.map(flat),
            path,
        })
    });
    let tractions = case.tractions.iter().enumerate().filter_map(|(number, traction)| {
        let ends = traction.ends()?.map(flat);
        Some(Segment { name: format!("traction.{number}"), table: ("traction", number), ends, path: None })
    });
    footing.chain(prescribed).chain(tractions).collect()
}

/// Edges of rectangular plates and loads of a solid beyond which the surface goes on; of a disc what it holds too much
/// is told.
pub(super) fn plates(case: &Case, found: &mut FoundLine) {
    let footing = case.footing.iter().map(|footing| (("footing", 0), footing.site, Some(&footing.path)));
    let prescribed = case.prescribed.iter().enumerate();
    let prescribed = prescribed.map(|(number, of)| (("prescribed", number), of.site, Some(&of.path)));
    let strips = footing.chain(prescribed).filter_map(|(table, site, path)| match site {
        Site::Plate(plate) => Some((table, plate, path)),
        Site::Segment { .. } | Site::Face(_) => None,
    });
    let tractions = case.tractions.iter().enumerate().filter_map(|(number, traction)| match traction.line {
        LoadedLine::Plate(plate) => Some((("traction", number), plate, None)),
        LoadedLine::Segment { .. } | LoadedLine::Circle { .. } | LoadedLine::Triangles(_) => None,
    });
    for (table, plate, path) in strips.chain(tractions) {
        let name = if table.0 == "footing" { "footing".into() } else { format!("{}.{}", table.0, table.1) };
        if plate.round {
            let told = format!(
                "{name}: the rim of a disc lies inside cells: it holds what the splines reach, up to a cell more than its \
                 radius, and its force is high by as much; compare two cell sizes"
            );
            path.into_iter().for_each(|_| drop(found.doubts.insert(name.clone(), told.clone())));
            continue;
        }
        let edge = Segment { name, table, ends: [plate.lower, plate.upper], path };
        for along in (0..3).filter(|axis| *axis != plate.normal()) {
            let length = plate.upper[along] - plate.lower[along];
            for (at, outward) in [(plate.lower[along], -length), (plate.upper[along], length)] {
                let mut place = plate.middle();
                place[along] = at;
                end(case, &edge, (along, plate.normal()), (place, outward), found);
            }
        }
    }
}

/// Ends of strips and loaded segments beyond which the surface goes on, and walls with material on both sides.
pub(super) fn segments(case: &Case, found: &mut FoundLine) {
    for segment in all_segments(case) {
        let Some(along) = [0, 1].into_iter().find(|&axis| segment.ends[0][1 - axis] == segment.ends[1][1 - axis])
        else {
            continue;
        };
        for (at, other) in [(segment.ends[0], segment.ends[1]), (segment.ends[1], segment.ends[0])] {
            end(case, &segment, (along, 1 - along), (at, at[along] - other[along]), found);
        }
        wall(case, &segment, 1 - along, found);
    }
}

/// Corners at which edges of rigid bodies along an axis end that soil lies at, and the widest ones of what pushes soil,
/// beyond which it goes on: of bodies that stay at the grid lines there.
pub(super) fn corners(case: &Case, found: &mut FoundLine) {
    for rigid in case.rigid.iter().filter(|rigid| rigid.rotation.is_empty() && !rigid.free[2]) {
        let RigidShape::Polygon(corners) = &rigid.shape else { continue };
        let moves = |axis: usize| rigid.free[axis] || rigid.path.rows.iter().any(|(_, moved)| moved[axis] != 0.0);
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let Some(along) = [0, 1].into_iter().find(|axis| from[1 - axis] == to[1 - axis]) else { continue };
            let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
            if !moves(along) && has_material(case, flat(middle), 1 - along) {
                corner(case, rigid, along, (*from, from[along] - to[along]), found);
                corner(case, rigid, along, (*to, to[along] - from[along]), found);
            }
        }
        for along in [0, 1].into_iter().filter(|along| !moves(*along) && moves(1 - along)) {
            for outward in [-1.0, 1.0] {
                widest(case, rigid, (corners, along, outward), found);
            }
        }
    }
}

/// The lines through the corners that are outermost along an axis, of edges that lead there and that soil lies at.
fn widest(case: &Case, rigid: &Rigid, (corners, along, outward): (&[[f64; 2]], usize, f64), found: &mut FoundLine) {
    let out = |corner: &[f64; 2]| outward * corner[along];
    let most = corners.iter().map(out).fold(f64::NEG_INFINITY, f64::max);
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        if (out(from) == most) != (out(to) == most) && has_material(case, flat(middle), 1 - along) {
            corner(case, rigid, along, (if out(from) == most { *from } else { *to }, outward), found);
        }
    }
}

/// The line through a corner; `outward` leads along the edge that ends there.
fn corner(case: &Case, rigid: &Rigid, along: usize, (at, outward): ([f64; 2], f64), found: &mut FoundLine) {
    let (axis, mut beyond) = (&case.grid.axes[along], at);
    beyond[along] += outward.signum() * BEYOND * axis.shortest();
    if !has_material(case, flat(beyond), 1 - along) {
        return;
    }
    let name = &rigid.name;
    match grid_line(case, along, at[along] - axis.lower()) {
        Some(line) if line == 0 || line == axis.cells() => {}
        Some(line) => {
            let reason = format!("a corner of rigid `{name}`, where strains are singular");
            found.lines.entry((along, line)).or_insert(reason);
        }
        None => {
            let told = format!(
                "rigid `{name}`: its corner at {} = {} lies inside a cell: it pushes what the splines reach, up to a cell more \
                 than its width, and its force is high by as much (on clay by 19 % in place of 7, eight cells wide); put a \
                 grid line there, by grid.cell or [grid.knots]",
                NAMES[along], at[along]
            );
            found.doubts.entry(format!("rigid {name}")).or_insert(told);
        }
    }
}

/// The line through one end of a segment along an axis, normal to another one; `outward` is the way from the other end.
fn end(
    case: &Case,
    segment: &Segment<'_>,
    (along, normal): (usize, usize),
    (at, outward): ([f64; 3], f64),
    found: &mut FoundLine,
) {
    let (axis, name) = (&case.grid.axes[along], &segment.name);
    let mut beyond = at;
    beyond[along] += outward.signum() * BEYOND * axis.shortest();
    if !has_material(case, beyond, normal) {
        return;
    }
    let reason = format!("an end of {name}, where strains are singular");
    let cell = axis.cell(axis.first_cell(|i| axis.breakpoint(i + 1) >= at[along] - axis.lower()).min(axis.cells() - 1));
    match grid_line(case, along, at[along] - axis.lower()) {
        Some(line) if line == 0 || line == axis.cells() => {}
        Some(line) if segment.stays(along) => {
            found.lines.entry((along, line)).or_insert(reason);
            if segment.path.is_some() {
                let far = found.held.entry((along, line)).or_default();
                *far = far.max(segment.goes());
            }
        }
        _ if segment.path.is_none() => {}
        Some(_) => {
            let told = format!(
                "{name}: it moves along itself, and its ends leave the grid lines on which they would be sharp: it holds what \
                 the splines reach, up to a cell more than its length, and its force is high by as much"
            );
            found.doubts.entry(name.clone()).or_insert(told);
        }
        None if outward.abs() < cell => {
            let message = format!(
                "the strip is {} m long and ends inside a cell of {cell} m: it would hold that cell and its neighbours; take \
                 smaller cells, or a grid line at {} = {}",
                outward.abs(),
                NAMES[along],
                at[along]
            );
            found.narrow.push((segment.table.0, segment.table.1, message));
        }
        None => {
            let told = format!(
                "{name}: the end at {} = {} lies inside a cell: the strip holds what the splines reach, up to a cell more than \
                 its length, and its force is high by as much; put a grid line there, by grid.cell or [grid.knots]",
                NAMES[along], at[along]
            );
            found.doubts.entry(name.clone()).or_insert(told);
        }
    }
}

/// The line along a segment that stays on it, with material on both sides.
fn wall(case: &Case, segment: &Segment<'_>, normal: usize, found: &mut FoundLine) {
    let axis = &case.grid.axes[normal];
    let place = segment.ends[0][normal];
    if segment.path.is_none() || !segment.stays(normal) {
        return;
    }
    let Some(line) = grid_line(case, normal, place - axis.lower()).filter(|line| (1..axis.cells()).contains(line))
    else {
        return;
    };
    let [from, to] = segment.ends;
    let beside = |shift: f64| {
        let mut middle = [0, 1, 2].map(|k| 0.5 * (from[k] + to[k]));
        middle[normal] += shift * BEYOND * axis.shortest();
        case.bodies.iter().any(|body| is_in(body, &case.grid, middle))
    };
    if beside(-1.0) && beside(1.0) {
        let reason = format!("{} holds material on both sides of it", segment.name);
        found.lines.entry((normal, line)).or_insert(reason);
    }
}

/// Whether a body is at a place on its surface, on one side or the other.
fn has_material(case: &Case, at: [f64; 3], normal: usize) -> bool {
    let aside = BESIDE * case.grid.axes[normal].shortest();
    [-aside, aside].into_iter().any(|shift| {
        let mut place = at;
        place[normal] += shift;
        case.bodies.iter().any(|body| is_in(body, &case.grid, place))
    })
}
