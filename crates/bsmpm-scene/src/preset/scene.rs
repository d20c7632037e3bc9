//! Collects the data of a case from which a preset (key `accuracy`) chooses the cell size and the step size, if the
//! case does not give them.

use super::Preset;
use super::rigid::{self, RigidExtent};
use crate::constants::{NEARLY_INCOMPRESSIBLE, STANDARD_GRAVITY};
use crate::record::{CaseTable, Field, ListRow};
use crate::schema::{
    BodyTable, Draft, LawName, MaterialTable, MotionKey, RigidTable, ShapeKey, SiteKey, TractionTable,
};
use crate::words::{AnalysisType, Purpose};
use bsmpm::material::Profile;
use bsmpm_shapes::polygon;

/// What steps follow from.
pub(super) const STEPS: &str = "[analysis], the cells, the stiffness and density of the soil and prescribed motions";

/// Keys without which neither cells nor steps can be chosen.
pub(super) const BASIS: &[&str] = &[
    "analysis.type",
    "analysis.end",
    "body",
    "boundary",
    "footing",
    "geometry",
    "grid.lower",
    "grid.upper",
    "material",
    "point_load",
    "prescribed",
    "rigid",
    "shaking",
    "traction",
];

/// Steps at most that are filled in: more are the author's to ask for.
const MOST_STEPS: f64 = 1e8;

/// Part of a cell that a strip may move in a quasi-static step: with more, soil at its ends yields so far at once that
/// secants stall, and Newton's method costs more than the steps saved.
const STRIP_ADVANCE: f64 = 0.1;

/// A case as far as it is written.
pub(super) struct PresetScene<'a> {
    pub draft: &'a Draft,
}

/// A strip, a loaded segment or a rigid body.
pub(super) struct GradedSegment<'a> {
    pub name: String,
    motion: Option<MotionKey<'a>>,
    /// m  of its width
    pub ends: [[f64; 2]; 2],
    rigid: Option<RigidExtent>,
}

impl GradedSegment<'_> {
    /// The axis that it lies along, if it does.
    pub(super) fn along(&self) -> Option<usize> {
        let [from, to] = self.ends;
        [0, 1].into_iter().find(|&axis| from[1 - axis] == to[1 - axis])
    }

    /// m  places along x and y at which a grid line is wanted: its ends, of a rigid body the corners at soil
    pub(super) fn lines(&self) -> [Vec<f64>; 2] {
        let along = self.along();
        [0, 1].map(|axis| match &self.rigid {
            Some(rigid) => rigid.lines.iter().map(|at| at[axis]).collect(),
            None if along == Some(axis) => self.ends.map(|end| end[axis]).to_vec(),
            None => Vec::new(),
        })
    }

    pub(super) fn is_rigid(&self) -> bool {
        self.rigid.is_some()
    }

    /// m  edge of cells of which two lie between soil on either side of it; without end where there is none
    pub(super) fn thinnest(&self) -> f64 {
        self.rigid.as_ref().map_or(f64::INFINITY, |rigid| 0.5 * rigid.thickness)
    }
}

impl<'a> PresetScene<'a> {
    pub(super) fn of(draft: &'a Draft) -> Self {
        Self { draft }
    }

    /// Number of steps for cells whose shorter edge is `chosen` (m), unless the case gives its own, and why.
    pub(super) fn steps(&self, preset: &Preset, chosen: Option<f64>) -> Option<(u64, String)> {
        let analysis = self.draft.analysis.value()?;
        let cell = self.shortest().or(chosen)?;
        let (steps, why) = match analysis.r#type.get()? {
            AnalysisType::Dynamic => {
                let crossed = preset.crossed;
                let way = analysis.end.get()? * self.shear_wave()?;
                (
                    way / (crossed * cell),
                    format!("a shear wave travels {crossed} cells in a step"),
                )
            }
            AnalysisType::QuasiStatic | AnalysisType::InTime => {
                let moved = self
                    .moved(preset)
                    .map(|(way, advance)| (way / (advance * cell), advance));
                let most = moved.reduce(|a, b| if b.0 > a.0 { b } else { a });
                let (steps, advance) = most.unwrap_or((0.0, 0.0));
                if steps > preset.steps {
                    (
                        steps,
                        format!("prescribed motions advance at most {advance} cells in a step"),
                    )
                } else {
                    (preset.steps, "the least number of this preset".to_owned())
                }
            }
            // Water needs first steps that suit its own pace, which no rule knows.
            AnalysisType::Consolidation => return None,
        };
        let (steps, why) = match self
            .interval()
            .map(|interval| self.end() / interval)
            .filter(|rows| *rows > steps)
        {
            Some(rows) => (rows, "one step for each row of [shaking] or of a load".to_owned()),
            None => (steps, why),
        };
        // Rounding makes no step more.
        let steps = (steps * (1.0 - 1e-9)).ceil().max(1.0);
        (steps <= MOST_STEPS).then_some((steps as u64, why))
    }

    /// What there is to lock, if any.
    pub(super) fn locks(&self) -> Option<&'static str> {
        if self
            .materials()
            .filter_map(|material| material.model.get())
            .any(LawName::is_plastic)
        {
            return Some("prevents volumetric locking of plastic material");
        }
        let mut poissons = self.materials().filter_map(|material| material.poisson.get());
        poissons
            .any(|poisson| poisson > NEARLY_INCOMPRESSIBLE)
            .then_some("prevents volumetric locking of nearly incompressible material")
    }

    /// Whether a material of the bodies dilates as it yields.
    pub(super) fn dilates(&self) -> bool {
        self.materials()
            .any(|material| material.dilation_angle.profile_or_zero().value > 0.0)
    }

    pub(super) fn is_consolidation(&self) -> bool {
        self.draft.analysis.value().and_then(|analysis| analysis.r#type.get()) == Some(AnalysisType::Consolidation)
    }

    /// Whether displacements are divided until they are small against cells.
    pub(super) fn seeks_limit_load(&self) -> bool {
        self.draft.analysis.value().and_then(|analysis| analysis.purpose.get()) == Some(Purpose::LimitLoad)
    }

    /// m  corners of the rectangle around all bodies, whatever is cut out of them
    pub(super) fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let corners: Option<Vec<[[f64; 2]; 2]>> = self.draft.body.items().iter().map(around).collect();
        let corners = corners?.concat();
        (!corners.is_empty()).then(|| polygon::bounds(&corners))
    }

    /// Strips, loaded segments, and rigid bodies that are not free.
    pub(super) fn segments(&self) -> impl Iterator<Item = GradedSegment<'a>> + '_ {
        let draft = self.draft;
        let strips = draft
            .strips()
            .map(|strip| (strip.location, strip.site, Some(strip.motion)));
        let loads = draft.traction.items().iter();
        let loads = loads.map(|load| (load.location(), load.site(), None));
        let strips = strips.chain(loads).filter_map(|(location, site, motion)| {
            Some(GradedSegment {
                name: location.path.clone(),
                motion,
                ends: site.ends()?,
                rigid: None,
            })
        });
        let bodies: Vec<[[f64; 2]; 2]> = draft.body.items().iter().filter_map(around).collect();
        let rigid = draft.rigid.items().iter().filter(|rigid| !rigid.free.is_given());
        let rigid = rigid.filter_map(move |rigid| {
            let motion = Some(rigid.motion());
            let extent = RigidExtent::of(rigid, &self.ways(motion), &bodies)?;
            Some(GradedSegment {
                name: rigid.location().path.clone(),
                motion,
                ends: extent.ends,
                rigid: Some(extent),
            })
        });
        strips.chain(rigid)
    }

    /// m  shortest edge of the cells that the case gives, if it does
    pub(super) fn shortest(&self) -> Option<f64> {
        let grid = self.draft.grid.value()?;
        if let Some(cell) = grid.cell.value() {
            return cell.iter().copied().reduce(f64::min);
        }
        let knots = grid.knots.value()?;
        let axes = [&knots.x, &knots.y].into_iter().filter_map(Field::value);
        axes.flat_map(|axis| axis.windows(2).map(|pair| pair[1] - pair[0]))
            .reduce(f64::min)
            .filter(|edge| *edge > 0.0)
    }

    /// m  how far each strip, face or rigid body would come in the whole run at its fastest; part of a cell that it may
    /// in a step
    fn moved(&self, preset: &Preset) -> impl Iterator<Item = (f64, f64)> {
        let end = self.end();
        let of_faces = preset.advance;
        let strips = self.draft.strips().map(move |strip| {
            let is_face = matches!(strip.site, SiteKey::Face(_));
            let advance = if is_face { of_faces } else { STRIP_ADVANCE };
            (distance(strip.motion, end), advance)
        });
        let rigid = self.draft.rigid.items().iter();
        strips.chain(rigid.map(move |rigid| (distance(rigid.motion(), end) + turned(rigid, end), STRIP_ADVANCE)))
    }

    /// m  where what is moved as prescribed comes to in the run, at every change of its speed
    fn ways(&self, motion: Option<MotionKey<'_>>) -> Vec<[f64; 2]> {
        let end = self.end();
        let mut moved = vec![[0.0; 2]];
        match motion.filter(|_| !self.seeks_limit_load()) {
            Some(MotionKey::Path(key)) => {
                for pair in rows(key)
                    .windows(2)
                    .filter(|pair| pair[0].0 < end && pair[1].0 > pair[0].0)
                {
                    let part = ((end - pair[0].0) / (pair[1].0 - pair[0].0)).min(1.0);
                    moved.push([0, 1].map(|k| pair[0].1[k] + part * (pair[1].1[k] - pair[0].1[k])));
                }
            }
            Some(MotionKey::Velocity(key)) => moved.extend(key.pair().map(|velocity| velocity.map(|v| v * end))),
            Some(MotionKey::Displacement(key)) => moved.extend(key.pair()),
            None => {}
        }
        moved
    }

    /// m  where the ends of a strip, or the edges of a rigid body at soil, come to in the run
    pub(super) fn places(&self, segment: &GradedSegment<'_>) -> Vec<[f64; 2]> {
        let (ends, swing) = match &segment.rigid {
            Some(rigid) => (&rigid.corners[..], rigid.swing),
            None => (&segment.ends[..], 0.0),
        };
        let ways = self.ways(segment.motion);
        let ways = ways
            .iter()
            .flat_map(|way| [-swing, swing].map(|by| way.map(|at| at + by)));
        ways.flat_map(|way| ends.iter().map(move |at| [at[0] + way[0], at[1] + way[1]]))
            .collect()
    }

    /// s  the shortest time between two rows of the ground's acceleration or of a load
    fn interval(&self) -> Option<f64> {
        let tractions = self.draft.traction.items().iter();
        let tractions = tractions.flat_map(TractionTable::courses);
        let loads = self.draft.point_load.items().iter();
        let loads = loads.flat_map(|load| [&load.amplitude, &load.force_path]);
        let shaking = self.draft.shaking.value().map(|shaking| &shaking.acceleration);
        let courses = tractions.chain(loads).chain(shaking);
        let pairs = courses.flat_map(|key| key.items().windows(2));
        let intervals = pairs.map(|pair| pair[1].numbers[0] - pair[0].numbers[0]);
        intervals.filter(|interval| *interval > 0.0).reduce(f64::min)
    }

    /// m  ends of the straight sides of all bodies
    pub(super) fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        self.draft.body.items().iter().flat_map(sides)
    }

    /// s  the end, or what it is of pseudo-time
    fn end(&self) -> f64 {
        self.draft
            .analysis
            .value()
            .and_then(|analysis| analysis.end.get())
            .unwrap_or(1.0)
    }

    /// Materials that bodies are made of.
    pub(super) fn materials(&self) -> impl Iterator<Item = &MaterialTable> {
        let bodies = self.draft.body.items();
        self.draft
            .material
            .items()
            .iter()
            .filter(move |(name, _)| bodies.iter().any(|body| body.material.text() == Some(name.as_str())))
            .map(|(_, material)| material)
    }

    /// m/s  fastest shear wave in the bodies' materials, at the stiffest height
    fn shear_wave(&self) -> Option<f64> {
        let [lower, upper] = self.bounds()?;
        self.materials()
            .filter_map(|material| shear_wave(material, [lower[1], upper[1]]))
            .filter(|speed| speed.is_finite())
            .reduce(f64::max)
    }
}

/// m/s  shear wave in a material, as fast as it is between two heights
pub(super) fn shear_wave(material: &MaterialTable, heights: [f64; 2]) -> Option<f64> {
    let density = material
        .density
        .get()
        .or_else(|| Some(material.unit_weight.get()? / STANDARD_GRAVITY))?;
    let young = stiffest(material.young.profile()?, heights);
    Some((young / (2.0 * (1.0 + material.poisson.get()?)) / density).sqrt())
}

/// m  how far the corner of a rigid body that is farthest from its reference point would turn in the whole run at its
/// fastest
fn turned(rigid: &RigidTable, end: f64) -> f64 {
    let turns = rigid.rotation.items();
    let all: Vec<(f64, f64)> = std::iter::once((0.0, 0.0))
        .chain(turns.iter().map(|row| (row.numbers[0], row.numbers[1])))
        .collect();
    let pairs = all.windows(2).filter(|pair| pair[0].0 < end && pair[1].0 > pair[0].0);
    let fastest = pairs
        .map(|pair| (pair[1].1 - pair[0].1).abs() / (pair[1].0 - pair[0].0))
        .fold(0.0, f64::max);
    fastest * end * rigid::radius(rigid).unwrap_or(0.0)
}

/// m  ends of the straight sides of a body
fn sides(body: &BodyTable) -> Vec<([f64; 2], [f64; 2])> {
    let corners = match body.shape() {
        ShapeKey::Circle(_) => Vec::new(),
        shape => shape.corners().unwrap_or_default(),
    };
    (0..corners.len())
        .map(|k| (corners[k], corners[(k + 1) % corners.len()]))
        .collect()
}

/// m  corners of a body's rectangle
pub(crate) fn around(body: &BodyTable) -> Option<[[f64; 2]; 2]> {
    body.shape().corners().map(|corners| polygon::bounds(&corners))
}

/// s, m  Times and displacements of a path, from none at the start on.
fn rows(path: &Field<Vec<ListRow>>) -> Vec<(f64, [f64; 2])> {
    let rows = path.items().iter();
    let rows = rows.map(|row| (row.numbers[0], [row.numbers[1], row.numbers[2]]));
    std::iter::once((0.0, [0.0; 2])).chain(rows).collect()
}

/// m  how far a motion would lead in the whole run at its fastest
fn distance(motion: MotionKey<'_>, end: f64) -> f64 {
    match motion {
        MotionKey::Displacement(key) => key.pair().map_or(0.0, norm),
        MotionKey::Velocity(key) => key.pair().map_or(0.0, norm) * end,
        MotionKey::Path(key) => path_speed(key, end) * end,
    }
}

/// m/s  the fastest that a path leads between two of its rows, of which the first is before `end` (s)
fn path_speed(path: &Field<Vec<ListRow>>, end: f64) -> f64 {
    let places = rows(path);
    let speeds = places.windows(2).map(|pair| {
        let [from, to] = [pair[0], pair[1]];
        let t = to.0 - from.0;
        let way = [0, 1].map(|k| to.1[k] - from.1[k]);
        if t > 0.0 && from.0 < end { norm(way) / t } else { 0.0 }
    });
    speeds.fold(0.0, f64::max)
}

/// Length of a vector.
fn norm([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Pa  the largest value of a profile between two heights
fn stiffest(profile: Profile, heights: [f64; 2]) -> f64 {
    let [lower, upper] = heights.map(|y| profile.value + profile.per_metre * (profile.at - y));
    lower.max(upper)
}
