//! Gathers the material points of all ranks on rank 0, sorted by id, for a frame.

use bsmpm::material::{LayeredMaterial, Variable};
use bsmpm::observe::{self, invariants};
use bsmpm::points::{Column, ColumnInfo, Number, Points};
use bsmpm_io::frame::{Field, FieldValues, Frame};
use bsmpm_io::vtu;
use bsmpm_scene::observables::{FrameField, PointSample};
use mpi::collective::{CommunicatorCollectives, Root, SystemOperation};
use mpi::datatype::PartitionMut;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::collections::BTreeMap;

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
    pub lower: [f64; 3],
}

/// What a point is in a frame besides its place, field by field.
#[derive(Clone, Copy)]
enum FieldSource<'a, const D: usize> {
    /// a column of the points as it is, vectors with three components
    Column(&'static ColumnInfo, &'a dyn Column),
    Pressure,
    /// Pa
    Projected(&'a [f64]),
    /// of the materials that have it
    State(Variable, &'a [LayeredMaterial]),
    Volume,
    /// what the case asks for
    Asked(FrameField, PointSample<'a, D>),
}

impl<'a, const D: usize> FieldSource<'a, D> {
    /// All of a scene, in the order of the files; the same on all ranks: vectors and tensors, then numbers, then who a
    /// point is.
    fn all(sample: PointSample<'a, D>, projected: Option<&'a [f64]>, fields: &'a [FrameField]) -> Vec<Self> {
        let PointSample { points, materials, .. } = sample;
        let shown = Points::<D>::COLUMNS.iter().filter(|info| info.frame.is_some());
        let shown = shown.filter_map(|info| points.column(info.name).map(|column| (info, column)));
        let (real, whole): (Vec<_>, Vec<_>) = shown.partition(|(_, column)| column.number() == Number::F64);
        let (numbers, mut shaped): (Vec<_>, Vec<_>) = real.into_iter().partition(|(_, column)| column.width() == 1);
        shaped.sort_by_key(|(_, column)| column.width());
        let [shaped, numbers, whole] = [shaped, numbers, whole].map(|columns| {
            let columns = columns.into_iter();
            columns.map(|(info, column)| Self::Column(info, column))
        });
        let mut variables: Vec<Variable> = Vec::new();
        for variable in materials.iter().flat_map(|material| material.state()) {
            if variables.iter().all(|known| known.name != variable.name) {
                variables.push(*variable);
            }
        }
        let state = variables.into_iter().map(|variable| Self::State(variable, materials));
        let first = shaped.chain([Self::Pressure]).chain(projected.map(Self::Projected));
        let asked = fields.iter().map(|&field| Self::Asked(field, sample));
        let numbers = first.chain(numbers).chain(state).chain([Self::Volume]).chain(asked);
        numbers.chain(whole.rev()).collect()
    }

    /// Its name and unit.
    fn label(&self) -> (&'static str, &'static str) {
        match self {
            Self::Column(info, _) => (info.frame.unwrap_or(info.name), info.unit),
            Self::Pressure => ("pressure", "Pa"),
            Self::Projected(_) => ("projected_pressure", "Pa"),
            Self::State(variable, _) => (variable.name, variable.unit),
            Self::Volume => ("volume", "m^D"),
            Self::Asked(field, _) => (field.field(), field.unit()),
        }
    }

    fn components(&self) -> usize {
        match self {
            Self::Column(_, column) if column.width() == D => 3,
            Self::Column(_, column) => column.width(),
            Self::Asked(field, _) => field.components(),
            _ => 1,
        }
    }

    /// Its numbers of point `p`.
    fn put(&self, points: &Points<D>, p: usize, row: &mut Vec<f64>) {
        match self {
            Self::Column(info, _) if info.name == "u" => {
                row.extend(observe::in_space(&points.displacement(p)));
            }
            Self::Column(_, column) => {
                column.show(p, row);
                row.extend((column.width()..self.components()).map(|_| 0.0));
            }
            Self::Pressure => row.push(invariants::pressure(&points.sigma.at(p))),
            Self::Projected(pressure) => row.push(pressure[p]),
            Self::State(variable, materials) => {
                let state = materials[usize::from(points.material[p])].state();
                let place = state.iter().position(|own| own.name == variable.name);
                row.push(place.map_or(0.0, |place| points.state_of(p)[place]));
            }
            Self::Volume => row.push(points.volume[p] * points.F.at(p).determinant()),
            Self::Asked(field, sample) => field.put(sample, p, row),
        }
    }

    /// The field of the rows, in which its numbers begin at `at`.
    fn field(&self, rows: &[&[f64]], at: usize) -> Field {
        let name = self.label().0;
        let components = self.components();
        let number = match self {
            Self::Column(_, column) => column.number(),
            Self::Asked(FrameField::Body, _) => Number::U64,
            _ => Number::F64,
        };
        let mut numbers = Vec::with_capacity(rows.len() * components);
        rows.iter()
            .for_each(|row| numbers.extend_from_slice(&row[at..at + components]));
        let values = match number {
            Number::U16 => FieldValues::U16(numbers.into_iter().map(|number| number as u16).collect()),
            Number::U64 => FieldValues::U64(numbers.into_iter().map(|number| number as u64).collect()),
            Number::F64 => return Field::real(name, components, numbers),
        };
        Field {
            name: name.into(),
            components,
            values,
        }
    }
}

/// The frame of the present state, on its way to rank 0.
pub struct GatheredFrame<'a, const D: usize> {
    world: &'a SimpleCommunicator,
    points: &'a Points<D>,
    sources: Vec<FieldSource<'a, D>>,
    moment: FrameMoment,
    by_id: Vec<u32>, // this rank's points, those that have gone first
    gone: usize,
    ids: std::ops::Range<u64>, // of the next block, and the end of them all
    total: usize,
}

impl<'a, const D: usize> GatheredFrame<'a, D> {
    /// The points of all ranks with the fields that the case asks for, and with their projected pressures (Pa) if these
    /// are wanted.
    /// Collective.
    pub fn new(
        world: &'a SimpleCommunicator,
        sample: PointSample<'a, D>,
        fields: &'a [FrameField],
        projected: Option<&'a [f64]>,
        moment: FrameMoment,
    ) -> Self {
        let points = sample.points;
        let mut by_id: Vec<u32> = (0..points.len() as u32).collect();
        by_id.sort_unstable_by_key(|&p| points.id[p as usize]);
        let own = by_id.last().map_or(0, |&p| points.id[p as usize] + 1);
        let mut end = 0_u64;
        let mut total = 0_u64;
        world.all_reduce_into(&own, &mut end, SystemOperation::max());
        world.all_reduce_into(&(points.len() as u64), &mut total, SystemOperation::sum());
        let sources = FieldSource::all(sample, projected, fields);
        Self {
            world,
            points,
            sources,
            moment,
            by_id,
            gone: 0,
            ids: 0..end,
            total: total as usize,
        }
    }

    /// Units of the fields, by name.
    pub fn units(&self, volume: &str) -> BTreeMap<String, String> {
        self.sources
            .iter()
            .map(FieldSource::label)
            .map(|(name, unit)| (name.into(), unit.replace("m^D", volume)))
            .collect()
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
        let starts: Vec<i32> = counts
            .iter()
            .scan(0, |at, count| Some(std::mem::replace(at, *at + count)))
            .collect();
        let mut all = vec![0.0; counts.iter().map(|&count| count as usize).sum()];
        root.gather_varcount_into_root(&own[..], &mut PartitionMut::new(&mut all[..], &counts[..], &starts[..]));
        let mut rows: Vec<&[f64]> = all.chunks_exact(width(&self.sources)).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Some(self.frame(&rows))
    }

    /// This rank's points up to the id `end`, which have not gone before: id, place, and the fields of each.
    fn pack(&mut self, end: u64) -> Vec<f64> {
        let points = self.points;
        let rest = &self.by_id[self.gone..];
        let count = rest.partition_point(|&p| points.id[p as usize] < end);
        let mut rows = Vec::with_capacity(count * width(&self.sources));
        for p in rest[..count].iter().map(|&p| p as usize) {
            rows.push(points.id[p] as f64);
            rows.extend(observe::in_space(&points.x[p]));
            self.sources.iter().for_each(|source| source.put(points, p, &mut rows));
        }
        self.gone += count;
        rows
    }

    fn frame(&self, rows: &[&[f64]]) -> Frame {
        unpack(rows, self.moment, &self.sources)
    }
}

/// Numbers of a point before its fields: id, x, y, z.
const HEAD: usize = 4;

/// Numbers of a point on its way to rank 0.
fn width<const D: usize>(sources: &[FieldSource<'_, D>]) -> usize {
    HEAD + sources.iter().map(FieldSource::components).sum::<usize>()
}

/// No points, with the columns of a scene.
fn no_points<const D: usize>(dynamic: bool) -> Points<D> {
    Points::from_seeds([], dynamic)
}

/// Bytes that a point takes in a frame's file.
pub fn point_bytes<const D: usize>(
    dynamic: bool,
    projected: bool,
    materials: &[LayeredMaterial],
    fields: &[FrameField],
) -> u64 {
    let points = no_points::<D>(dynamic);
    let sample = PointSample {
        points: &points,
        materials,
        bodies: &[],
        water: None,
        fluxes: &[],
    };
    let sources = FieldSource::all(sample, projected.then_some(&[]), fields);
    vtu::point_bytes(&unpack(
        &[],
        FrameMoment {
            step: 0,
            time: 0.0,
            lower: [0.0; 3],
        },
        &sources,
    ))
}

fn unpack<const D: usize>(
    rows: &[&[f64]],
    FrameMoment { step, time, lower }: FrameMoment,
    sources: &[FieldSource<'_, D>],
) -> Frame {
    let mut at = HEAD;
    let mut fields = Vec::with_capacity(sources.len());
    for source in sources {
        fields.push(source.field(rows, at));
        at += source.components();
    }
    let position = rows
        .iter()
        .map(|row| std::array::from_fn(|axis| lower[axis] + row[1 + axis]))
        .collect();
    Frame {
        step,
        time,
        position,
        fields,
    }
}
