//! Frames: all points by ascending id, so that a frame does not depend on the number of ranks, block by block on rank 0, so
//! that no rank holds more of them than its own and a block.

use bsmpm::points::Points;
use bsmpm_io::frame::{Field, Frame, Values};
use bsmpm_io::vtu;
use mpi::collective::{CommunicatorCollectives, Root, SystemOperation};
use mpi::datatype::PartitionMut;
use mpi::topology::{Communicator, SimpleCommunicator};

/// Numbers of a point on its way to rank 0: id, material, x 2, u 2, v 2, sigma 6, plastic strain, volume, and the projected
/// pressure, 0 where it is not asked for.
const WIDTH: usize = 17;
/// Ids of a block: 2 MB of numbers on their way.
const BLOCK: u64 = 1 << 14;

/// When and where a frame is.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// accepted steps
    pub step: u64,
    /// s, or pseudo-time
    pub time: f64,
    /// m  the grid's lower corner
    pub lower: [f64; 2],
}

/// The frame of the present state, on its way to rank 0.
pub struct Gathering<'a> {
    world: &'a SimpleCommunicator,
    points: &'a Points<2>,
    projected: Option<Vec<f64>>, // Pa
    moment: Moment,
    by_id: Vec<u32>, // this rank's points, those that have gone first
    gone: usize,
    ids: std::ops::Range<u64>, // of the next block, and the end of them all
    total: usize,
}

impl<'a> Gathering<'a> {
    /// The points of all ranks, with their projected pressures (Pa) if these are wanted. Collective.
    pub fn new(
        world: &'a SimpleCommunicator,
        points: &'a Points<2>,
        projected: Option<Vec<f64>>,
        moment: Moment,
    ) -> Self {
        let mut by_id: Vec<u32> = (0..points.len() as u32).collect();
        by_id.sort_unstable_by_key(|&p| points.id[p as usize]);
        let own = by_id.last().map_or(0, |&p| points.id[p as usize] + 1);
        let (mut end, mut total) = (0_u64, 0_u64);
        world.all_reduce_into(&own, &mut end, SystemOperation::max());
        world.all_reduce_into(&(points.len() as u64), &mut total, SystemOperation::sum());
        Self { world, points, projected, moment, by_id, gone: 0, ids: 0..end, total: total as usize }
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
        let mut rows: Vec<&[f64]> = all.chunks_exact(WIDTH).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Some(self.frame(&rows))
    }

    /// This rank's points up to the id `end`, which have not gone before.
    fn pack(&mut self, end: u64) -> Vec<f64> {
        let (points, rest) = (self.points, &self.by_id[self.gone..]);
        let count = rest.partition_point(|&p| points.id[p as usize] < end);
        let mut rows = Vec::with_capacity(count * WIDTH);
        for p in rest[..count].iter().map(|&p| p as usize) {
            let velocity = points.motion.as_ref().map_or([0.0; 2], |motion| motion.v[p].into());
            rows.extend([points.id[p] as f64, f64::from(points.material[p])]);
            rows.extend(points.x[p].iter());
            rows.extend(points.u[p].iter());
            rows.extend(velocity);
            rows.extend(points.sigma.at(p).0);
            rows.extend([points.eps_p[p], points.volume[p] * points.F.at(p).determinant()]);
            rows.push(self.projected.as_ref().map_or(0.0, |projected| projected[p]));
        }
        self.gone += count;
        rows
    }

    fn frame(&self, rows: &[&[f64]]) -> Frame {
        unpack(rows, self.moment, (self.points.motion.is_some(), self.projected.is_some()))
    }
}

/// Bytes that a point takes in a frame's file.
pub fn point_bytes(dynamic: bool, projected: bool) -> u64 {
    vtu::point_bytes(&unpack(&[], Moment { step: 0, time: 0.0, lower: [0.0; 2] }, (dynamic, projected)))
}

fn unpack(rows: &[&[f64]], Moment { step, time, lower }: Moment, (dynamic, projected): (bool, bool)) -> Frame {
    let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<f64>>();
    let vector = |at: usize| rows.iter().flat_map(|row| [row[at], row[at + 1], 0.0]).collect::<Vec<f64>>();
    let pressure = rows.iter().map(|row| -(row[8] + row[9] + row[10]) / 3.0).collect();
    let ids = rows.iter().map(|row| row[0] as u64).collect();
    let materials = rows.iter().map(|row| row[1] as u16).collect();
    let mut fields = vec![
        Field::real("displacement", 3, vector(4)),
        Field::real("velocity", 3, vector(6)),
        Field::real("stress", 6, rows.iter().flat_map(|row| row[8..14].to_vec()).collect()),
        Field::real("pressure", 1, pressure),
        Field::real("projected_pressure", 1, column(16)),
        Field::real("plastic_strain", 1, column(14)),
        Field::real("volume", 1, column(15)),
        Field { name: "material".into(), components: 1, values: Values::U16(materials) },
        Field { name: "id".into(), components: 1, values: Values::U64(ids) },
    ];
    fields.retain(|field| dynamic || field.name != "velocity");
    fields.retain(|field| projected || field.name != "projected_pressure");
    let position = rows.iter().map(|row| [lower[0] + row[2], lower[1] + row[3], 0.0]).collect();
    Frame { step, time, position, fields }
}
