//! Places C0 lines (repeated breakpoints) at ends of footings and loads, and at edges of rigid bodies.

use super::{BESIDE, BEYOND, FoundLine, NAMES, grid_line};
use crate::case::{Case, LoadedLine, MotionPath, Rigid, RigidShape, RigidSolid, Site};
use crate::validate::place::{flat, is_in, over, ring};

/// A strip or a loaded segment.
struct Segment<'a> {
    name: String,
    table: (&'static str, usize),
    ends: [[f64; 3]; 2],
    path: Option<&'a MotionPath>,
}

/// Parts of the shortest cell that count as no motion along a grid line.
const AT_REST: f64 = 1e-3;

/// Whether a path stays at a grid line across an axis.
fn stays(case: &Case, path: &MotionPath, axis: usize) -> bool {
    let least = AT_REST * case.grid.axes[axis].shortest();
    path.rows.iter().all(|(_, moved)| moved[axis].abs() <= least)
}

impl<'a> Segment<'a> {
    /// A strip, the one with a number in a table; `None` unless it lies along a segment.
    fn of_strip(name: String, table: &'static str, number: usize, site: Site, path: &'a MotionPath) -> Option<Self> {
        Some(Self {
            name,
            table: (table, number),
            ends: site.ends()?.map(flat),
            path: Some(path),
        })
    }

    /// Whether it stays where it is along an axis.
    fn stays(&self, case: &Case, axis: usize) -> bool {
        self.path.is_none_or(|path| stays(case, path, axis))
    }

    /// How far it goes, m.
    fn goes(&self) -> f64 {
        let rows = self.path.iter().flat_map(|path| &path.rows);
        rows.map(|(_, moved)| moved[0].hypot(moved[1]).hypot(moved[2]))
            .fold(0.0, f64::max)
    }
}

/// Where a face normal to an axis ends along another axis: an edge of it, in a plane a corner.
struct FaceEnd {
    normal: usize,
    along: usize,
    /// m  lower and upper end of the edge, alike in a plane
    edge: [[f64; 3]; 2],
    /// m  from the opposite edge to this one
    outward: f64,
}

impl FaceEnd {
    /// The four edges of a face normal to an axis, given by its lower and upper corner.
    fn of_face(normal: usize, lower: [f64; 3], upper: [f64; 3]) -> Vec<Self> {
        let mut ends = Vec::new();
        for along in (0..3).filter(|axis| *axis != normal) {
            let length = upper[along] - lower[along];
            for (at, outward) in [(lower[along], -length), (upper[along], length)] {
                let edge = [lower, upper].map(|corner| replaced(corner, along, at));
                ends.push(Self {
                    normal,
                    along,
                    edge,
                    outward,
                });
            }
        }
        ends
    }

    fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|axis| 0.5 * (self.edge[0][axis] + self.edge[1][axis]))
    }

    /// Whether soil lies beyond some place of it.
    fn has_soil_beyond(&self, case: &Case) -> bool {
        let shift = self.outward.signum() * BEYOND * case.grid.axes[self.along].shortest();
        over(self.edge).any(|at| has_material(case, replaced(at, self.along, at[self.along] + shift), self.normal))
    }
}

/// A place with another coordinate along an axis.
pub(super) fn replaced(mut place: [f64; 3], axis: usize, coordinate: f64) -> [f64; 3] {
    place[axis] = coordinate;
    place
}

fn all_segments(case: &Case) -> Vec<Segment<'_>> {
    let mut all = Vec::new();
    if let Some(of) = &case.footing {
        all.extend(Segment::of_strip("footing".into(), "footing", 0, of.site, &of.path));
    }
    for (number, of) in case.prescribed.iter().enumerate() {
        let name = format!("prescribed.{number}");
        all.extend(Segment::of_strip(name, "prescribed", number, of.site, &of.path));
    }
    for (number, traction) in case.tractions.iter().enumerate() {
        all.extend(traction.ends().map(|ends| Segment {
            name: format!("traction.{number}"),
            table: ("traction", number),
            ends: ends.map(flat),
            path: None,
        }));
    }
    all
}

/// Edges of rectangular plates and loads of a solid beyond which the surface goes on; of a disc there is
/// a warning.
pub(super) fn plates(case: &Case, found: &mut FoundLine) {
    let footing = case
        .footing
        .iter()
        .map(|footing| (("footing", 0), footing.site, Some(&footing.path)));
    let prescribed = case.prescribed.iter().enumerate();
    let prescribed = prescribed.map(|(number, of)| (("prescribed", number), of.site, Some(&of.path)));
    let strips = footing.chain(prescribed).filter_map(|(table, site, path)| match site {
        Site::Plate(plate) => Some((table, plate, path)),
        Site::Segment { .. } | Site::Face(_) => None,
    });
    let tractions = case
        .tractions
        .iter()
        .enumerate()
        .filter_map(|(number, traction)| match traction.line {
            LoadedLine::Plate(plate) => Some((("traction", number), plate, None)),
            LoadedLine::Segment { .. } | LoadedLine::Circle { .. } | LoadedLine::Triangles(_) => None,
        });
    for (table, plate, path) in strips.chain(tractions) {
        let name = if table.0 == "footing" {
            "footing".into()
        } else {
            format!("{}.{}", table.0, table.1)
        };
        if plate.round {
            path.into_iter().for_each(|_| doubt_rim(&format!("`{name}`"), found));
            continue;
        }
        let segment = Segment {
            name,
            table,
            ends: [plate.lower, plate.upper],
            path,
        };
        for of in FaceEnd::of_face(plate.normal(), plate.lower, plate.upper) {
            end(case, &segment, of.along, of.normal, of.middle(), of.outward, found);
        }
    }
}

/// Warns that a round rim follows no grid line.
fn doubt_rim(name: &str, found: &mut FoundLine) {
    let doubt = format!(
        "W0224: the edge of {name} is round, so no grid line follows it. Soil up to a cell beyond the edge is loaded, \
         too, and the force is too large. Compare runs with two cell sizes."
    );
    found.doubts.insert(name.to_owned(), doubt);
}

/// Ends of strips and loaded segments beyond which the surface goes on, and walls with material on both sides.
pub(super) fn segments(case: &Case, found: &mut FoundLine) {
    for segment in all_segments(case) {
        let Some(along) = [0, 1]
            .into_iter()
            .find(|&axis| segment.ends[0][1 - axis] == segment.ends[1][1 - axis])
        else {
            continue;
        };
        for (at, other) in [(segment.ends[0], segment.ends[1]), (segment.ends[1], segment.ends[0])] {
            end(case, &segment, along, 1 - along, at, at[along] - other[along], found);
        }
        wall(case, &segment, 1 - along, found);
    }
}

/// Edges (in a plane, corners) of faces of rigid bodies that touch soil, where soil continues beyond the edge and the
/// body stays at the grid line there.
pub(super) fn corners(case: &Case, found: &mut FoundLine) {
    for rigid in case
        .rigid
        .iter()
        .filter(|rigid| rigid.rotation.is_empty() && !rigid.free[2])
    {
        match &rigid.shape {
            RigidShape::Polygon(corners) => polygon(case, rigid, corners, found),
            RigidShape::InSpace(RigidSolid::Box { lower, upper }) => cuboid(case, rigid, *lower, *upper, found),
            RigidShape::InSpace(RigidSolid::Revolved { about, corners }) => rims(case, rigid, *about, corners, found),
            RigidShape::Circle { .. } | RigidShape::InSpace(RigidSolid::Sphere { .. } | RigidSolid::Terrain(_)) => {}
        }
    }
}

/// Whether a body that does not turn leaves the grid lines across an axis.
fn moves(case: &Case, rigid: &Rigid, axis: usize) -> bool {
    rigid.free[axis] || !stays(case, &rigid.path, axis)
}

/// Whether a body moves along an axis at all.
fn pushes(rigid: &Rigid, axis: usize) -> bool {
    rigid.free[axis] || rigid.path.rows.iter().any(|(_, moved)| moved[axis] != 0.0)
}

/// Corners at the ends of edges along an axis, and the widest ones of what pushes soil.
fn polygon(case: &Case, rigid: &Rigid, corners: &[[f64; 2]], found: &mut FoundLine) {
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let Some(along) = [0, 1].into_iter().find(|axis| from[1 - axis] == to[1 - axis]) else {
            continue;
        };
        let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        if !moves(case, rigid, along) && has_material(case, flat(middle), 1 - along) {
            corner(case, rigid, &in_plane(along, *from, from[along] - to[along]), found);
            corner(case, rigid, &in_plane(along, *to, to[along] - from[along]), found);
        }
    }
    for along in [0, 1]
        .into_iter()
        .filter(|along| !moves(case, rigid, *along) && pushes(rigid, 1 - along))
    {
        for outward in [-1.0, 1.0] {
            widest(case, rigid, corners, along, outward, found);
        }
    }
}

/// A corner of a plane at which a face along an axis ends.
fn in_plane(along: usize, at: [f64; 2], outward: f64) -> FaceEnd {
    FaceEnd {
        normal: 1 - along,
        along,
        edge: [flat(at); 2],
        outward,
    }
}

/// The lines through the corners that are outermost along an axis, of edges that lead there and that soil lies at.
fn widest(case: &Case, rigid: &Rigid, corners: &[[f64; 2]], along: usize, outward: f64, found: &mut FoundLine) {
    let most = corners
        .iter()
        .map(|corner| outward * corner[along])
        .fold(f64::NEG_INFINITY, f64::max);
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let is_outermost = [from, to].map(|corner| outward * corner[along] == most);
        if is_outermost[0] != is_outermost[1] && has_material(case, flat(middle), 1 - along) {
            let at = if is_outermost[0] { *from } else { *to };
            corner(case, rigid, &in_plane(along, at, outward), found);
        }
    }
}

/// Edges of the faces of a box that soil lies at. The box may reach beyond the grid, as half of it does at a plane of
/// symmetry.
fn cuboid(case: &Case, rigid: &Rigid, lower: [f64; 3], upper: [f64; 3], found: &mut FoundLine) {
    let first: [f64; 3] = std::array::from_fn(|axis| lower[axis].max(case.grid.lower()[axis]));
    let last: [f64; 3] = std::array::from_fn(|axis| upper[axis].min(case.grid.upper()[axis]));
    for normal in 0..3 {
        if (0..3).any(|axis| axis != normal && first[axis] >= last[axis]) {
            continue;
        }
        for at in [lower[normal], upper[normal]] {
            let [lower, upper] = [first, last].map(|corner| replaced(corner, normal, at));
            if !over([lower, upper]).any(|place| has_material(case, place, normal)) {
                continue;
            }
            let ends = FaceEnd::of_face(normal, lower, upper);
            for of in ends.iter().filter(|of| !moves(case, rigid, of.along)) {
                corner(case, rigid, of, found);
            }
        }
    }
}

/// Rims of flat faces that a body of revolution pushes along its axis, where soil lies on both sides of them.
fn rims(case: &Case, rigid: &Rigid, about: [f64; 2], corners: &[[f64; 2]], found: &mut FoundLine) {
    if !pushes(rigid, 2) {
        return;
    }
    let cell = case.grid.shortest();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    for (from, to) in edges.filter(|(from, to)| from[1] == to[1]) {
        let radius = from[0].max(to[0]);
        let has_soil = [-1.0, 1.0].iter().all(|shift| {
            let mut places = ring(about, radius + shift * BEYOND * cell);
            places.any(|[x, y]| has_material(case, [x, y, from[1]], 2))
        });
        if has_soil {
            doubt_rim(&format!("rigid body `{}`", rigid.name), found);
        }
    }
}

/// Warns that the end of something lies inside a cell.
fn inside_cell(name: &str, end: &str, axis: usize, at: f64) -> String {
    format!(
        "W0225: the {end} of {name} at {} = {at} m is not on a grid line. Soil up to a cell beyond it is loaded, too, \
         so the force is too large. Put a grid line there (grid.cell or grid.knots).",
        NAMES[axis]
    )
}

/// The line through a corner or an edge of a rigid body.
fn corner(case: &Case, rigid: &Rigid, of: &FaceEnd, found: &mut FoundLine) {
    if !of.has_soil_beyond(case) {
        return;
    }
    let axis = &case.grid.axes[of.along];
    let at = of.edge[0][of.along];
    let name = &rigid.name;
    let what = if case.grid.dims() == 2 { "corner" } else { "edge" };
    match grid_line(case, of.along, at - axis.lower()) {
        Some(line) if line == 0 || line == axis.cells() => {}
        Some(line) => {
            let reason = format!("strains are singular at the {what} of rigid body `{name}`");
            found.lines.entry((of.along, line)).or_insert(reason);
        }
        None => {
            let doubt = inside_cell(&format!("rigid body `{name}`"), what, of.along, at);
            found.inside.push(format!("rigid body `{name}`"));
            found.doubts.entry(format!("rigid {name}")).or_insert(doubt);
        }
    }
}

/// The line through one end of a segment along an axis, normal to another one; `outward` is the way from the other end.
fn end(
    case: &Case,
    segment: &Segment<'_>,
    along: usize,
    normal: usize,
    at: [f64; 3],
    outward: f64,
    found: &mut FoundLine,
) {
    let axis = &case.grid.axes[along];
    let name = &segment.name;
    let mut beyond = at;
    beyond[along] += outward.signum() * BEYOND * axis.shortest();
    if !has_material(case, beyond, normal) {
        return;
    }
    let reason = format!("strains are singular at the end of `{name}`");
    let cell = axis.cell(
        axis.first_cell(|i| axis.breakpoint(i + 1) >= at[along] - axis.lower())
            .min(axis.cells() - 1),
    );
    match grid_line(case, along, at[along] - axis.lower()) {
        Some(line) if line == 0 || line == axis.cells() => {}
        Some(line) if segment.stays(case, along) => {
            found.lines.entry((along, line)).or_insert(reason);
            if segment.path.is_some() {
                let far = found.held.entry((along, line)).or_default();
                *far = far.max(segment.goes());
            }
        }
        _ if segment.path.is_none() => {}
        Some(_) => {
            let doubt = format!(
                "W0226: `{name}` moves along its own length, so its ends leave the grid lines. Soil up to a cell \
                 beyond the ends is loaded, too, and the force is too large. Use smaller cells."
            );
            found.doubts.entry(name.clone()).or_insert(doubt);
        }
        None if outward.abs() < cell => {
            let message = format!(
                "E0235: the segment of {} m is shorter than a cell ({cell} m) and ends inside it, so it would move or \
                 fix the whole cell. Use smaller cells, or put a grid line at {} = {} m.",
                outward.abs(),
                NAMES[along],
                at[along]
            );
            found.narrow.push((segment.table.0, segment.table.1, message));
        }
        None => {
            found.inside.push(name.clone());
            found
                .doubts
                .entry(name.clone())
                .or_insert_with(|| inside_cell(&format!("`{name}`"), "end", along, at[along]));
        }
    }
}

/// The line along a segment that stays on it, with material on both sides.
fn wall(case: &Case, segment: &Segment<'_>, normal: usize, found: &mut FoundLine) {
    let axis = &case.grid.axes[normal];
    let place = segment.ends[0][normal];
    if segment.path.is_none() || !segment.stays(case, normal) {
        return;
    }
    let Some(line) = grid_line(case, normal, place - axis.lower()).filter(|line| (1..axis.cells()).contains(line))
    else {
        return;
    };
    let [from, to] = segment.ends;
    let has_soil = [-1.0, 1.0].iter().all(|shift| {
        let mut middle = [0, 1, 2].map(|k| 0.5 * (from[k] + to[k]));
        middle[normal] += shift * BEYOND * axis.shortest();
        case.bodies.iter().any(|body| is_in(body, &case.grid, middle))
    });
    if has_soil {
        let reason = format!("`{}` restrains the soil on both sides", segment.name);
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
