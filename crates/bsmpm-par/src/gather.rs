//! Frames: all points by ascending id, so that a frame does not depend on the number of ranks, block by block on rank 0, so
//! that no rank holds more of them than its own and a block.

use bsmpm::material::{Material, Variable};
use bsmpm::points::Points;
use bsmpm_io::frame::{Field, FieldValues, Frame};
use bsmpm_io::vtu;
use mpi::collective::{CommunicatorCollectives, Root, SystemOperation};
use mpi::datatype::PartitionMut;
use mpi::topology::{Communicator, SimpleCommunicator};

/// Ids of a block: 2 MB of numbers on their way.
const BLOCK: u64 = 1 << 14;

/// When and where a frame is.
#[derive(Clone, Copy, Debug)]
pub struct FrameMoment {
    /// accepted steps
    pub step: u64,
    /// s, or pseudo-time
    pub time: f64,
    /// m  the grid's lower corner
    pub lower: [f64; 2],
}

/// What a point is in a frame besides its place, field by field.
#[derive(Clone, Copy, Debug)]
enum FieldSource<'a> {
    Displacement,
    Velocity,
    Stress,
    Pressure,
    /// Pa
    Projected(&'a [f64]),
    PlasticStrain,
    /// of the materials that have it
    State(Variable, &'a [Material]),
    Volume,
    Material,
    Id,
}

impl<'a> FieldSource<'a> {
    /// All of a scene, in the order of the files; the same on all ranks.
    fn all(dynamic: bool, projected: Option<&'a [f64]>, materials: &'a [Material]) -> Vec<Self> {
        let mut variables: Vec<Variable> = Vec::new();
        for variable in materials.iter().flat_map(|material| material.state()) {
            if variables.iter().all(|known| known.name != variable.name) {
                variables.push(*variable);
            }
        }
        let state = variables.into_iter().map(|variable| Self::State(variable, materials));
        let first = [Self::Displacement].into_iter().chain(dynamic.then_some(Self::Velocity));
        let first = first.chain([Self::Stress, Self::Pressure]).chain(projected.map(Self::Projected));
        let last = [Self::Volume, Self::Material, Self::Id];
        first.chain([Self::PlasticStrain]).chain(state).chain(last).collect()
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Stress => "stress",
            Self::Pressure => "pressure",
            Self::Projected(_) => "projected_pressure",
            Self::PlasticStrain => "plastic_strain",
            Self::State(variable, _) => variable.name,
            Self::Volume => "volume",
            Self::Material => "material",
            Self::Id => "id",
        }
    }

    fn components(&self) -> usize {
        match self {
            Self::Displacement | Self::Velocity => 3,
            Self::Stress => 6,
            _ => 1,
        }
    }

    /// Its numbers of point `p`.
    fn put(&self, points: &Points<2>, p: usize, row: &mut Vec<f64>) {
        let sigma = || points.sigma.at(p).0;
        match self {
            Self::Displacement => row.extend([points.u[p][0], points.u[p][1], 0.0]),
            Self::Velocity => {
                let v = points.motion.as_ref().map_or([0.0; 2], |motion| motion.v[p].into());
                row.extend([v[0], v[1], 0.0]);
            }
            Self::Stress => row.extend(sigma()),
            Self::Pressure => row.push(-(sigma()[0] + sigma()[1] + sigma()[2]) / 3.0),
            Self::Projected(pressure) => row.push(pressure[p]),
            Self::PlasticStrain => row.push(points.eps_p[p]),
            Self::State(variable, materials) => {
                let state = materials[usize::from(points.material[p])].state();
                let place = state.iter().position(|own| own.name == variable.name);
                row.push(place.map_or(0.0, |place| points.state_of(p)[place]));
            }
            Self::Volume => row.push(points.volume[p] * points.F.at(p).determinant()),
            Self::Material => row.push(f64::from(points.material[p])),
            Self::Id => row.push(points.id[p] as f64),
        }
    }

    /// The field of the rows, in which its numbers begin at `at`.
    fn field(&self, rows: &[&[f64]], at: usize) -> Field {
        let (name, components) = (self.name(), self.components());
        let values = match self {
            Self::Material => FieldValues::U16(rows.iter().map(|row| row[at] as u16).collect()),
            Self::Id => FieldValues::U64(rows.iter().map(|row| row[at] as u64).collect()),
            _ => {
                return Field::real(
                    name,
                    components,
                    rows.iter().flat_map(|row| &row[at..at + components]).copied().collect(),
                );
            }
        };
        Field { name: name.into(), components, values }
    }
}

/// The frame of the present state, on its way to rank 0.
pub struct Gathering<'a> {
    world: &'a SimpleCommunicator,
    points: &'a Points<2>,
    sources: Vec<FieldSource<'a>>,
    moment: FrameMoment,
    by_id: Vec<u32>, // this rank's points, those that have gone first
    gone: usize,
    ids: std::ops::Range<u64>, // of the next block, and the end of them all
    total: usize,
}

impl<'a> Gathering<'a> {
    /// The points of all ranks with what their materials carry, and with their projected pressures (Pa) if these are wanted.
    /// Collective.
    pub fn new(
        world: &'a SimpleCommunicator,
        (points, materials): (&'a Points<2>, &'a [Material]),
        projected: Option<&'a [f64]>,
        moment: FrameMoment,
    ) -> Self {
        let mut by_id: Vec<u32> = (0..points.len() as u32).collect();
        by_id.sort_unstable_by_key(|&p| points.id[p as usize]);
        let own = by_id.last().map_or(0, |&p| points.id[p as usize] + 1);
        let (mut end, mut total) = (0_u64, 0_u64);
        world.all_reduce_into(&own, &mut end, SystemOperation::max());
        world.all_reduce_into(&(points.len() as u64), &mut total, SystemOperation::sum());
        let sources = FieldSource::all(points.motion.is_some(), projected, materials);
        Self { world, points, sources, moment, by_id, gone: 0, ids: 0..end, total: total as usize }
    }

    /// The frame without its points.
    pub fn head(&self) -> Frame {
        self.frame(&[])
    }

    /// Number of points of all ranks.
    pub fn points(&self) -> usize {
        self.total
    }

    /// The next block on rank 0, empty elsewhere; `None` on all ranks after the last one. Collective.
    pub fn block(&mut self) -> Option<Frame> {
        if self.ids.is_empty() {
            return None;
        }
        let end = self.ids.start.saturating_add(BLOCK).min(self.ids.end);
        let own = self.pack(end);
        self.ids.start = end;
        let root = self.world.process_at_rank(0);
        let count = own.len() as i32; // a block's are far fewer
        if self.world.rank() != 0 {
            root.gather_into(&count);
            root.gather_varcount_into(&own[..]);
            return Some(self.head());
        }
        let mut counts = vec![0_i32; self.world.size().unsigned_abs() as usize];
        root.gather_into_root(&count, &mut counts[..]);
        let starts: Vec<i32> = counts.iter().scan(0, |at, count| Some(std::mem::replace(at, *at + count))).collect();
        let mut all = vec![0.0; counts.iter().map(|&count| count as usize).sum()];
        root.gather_varcount_into_root(&own[..], &mut PartitionMut::new(&mut all[..], &counts[..], &starts[..]));
        let mut rows: Vec<&[f64]> = all.chunks_exact(width(&self.sources)).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Some(self.frame(&rows))
    }

    /// This rank's points up to the id `end`, which have not gone before: id, place, and the fields of each.
    fn pack(&mut self, end: u64) -> Vec<f64> {
        let (points, rest) = (self.points, &self.by_id[self.gone..]);
        let count = rest.partition_point(|&p| points.id[p as usize] < end);
        let mut rows = Vec::with_capacity(count * width(&self.sources));
        for p in rest[..count].iter().map(|&p| p as usize) {
            rows.extend([points.id[p] as f64, points.x[p][0], points.x[p][1]]);
            self.sources.iter().for_each(|source| source.put(points, p, &mut rows));
        }
        self.gone += count;
        rows
    }

    fn frame(&self, rows: &[&[f64]]) -> Frame {
        unpack(rows, self.moment, &self.sources)
    }
}

/// Numbers of a point before its fields: id, x, y.
const HEAD: usize = 3;

/// Numbers of a point on its way to rank 0.
fn width(sources: &[FieldSource<'_>]) -> usize {
    HEAD + sources.iter().map(FieldSource::components).sum::<usize>()
}

/// Bytes that a point takes in a frame's file.
pub fn point_bytes(dynamic: bool, projected: bool, materials: &[Material]) -> u64 {
    let sources = FieldSource::all(dynamic, projected.then_some(&[]), materials);
    vtu::point_bytes(&unpack(&[], FrameMoment { step: 0, time: 0.0, lower: [0.0; 2] }, &sources))
}

fn unpack(rows: &[&[f64]], FrameMoment { step, time, lower }: FrameMoment, sources: &[FieldSource<'_>]) -> Frame {
    let mut at = HEAD;
    let field = |source: &FieldSource<'_>| {
        at += source.components();
        source.field(rows, at - source.components())
    };
    let fields = sources.iter().map(field).collect();
    let position = rows.iter().map(|row| [lower[0] + row[1], lower[1] + row[2], 0.0]).collect();
    Frame { step, time, position, fields }
}
