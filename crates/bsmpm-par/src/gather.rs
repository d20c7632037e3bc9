//! Frames: all points on rank 0, by ascending id, so that a frame does not depend on the number of ranks.

use bsmpm::points::Points;
use bsmpm_io::frame::{Field, Frame, Values};
use bsmpm_io::vtu;
use mpi::collective::Root;
use mpi::datatype::PartitionMut;
use mpi::topology::{Communicator, SimpleCommunicator};

/// Numbers of a point on its way to rank 0: id, material, x 2, u 2, v 2, sigma 6, plastic strain, volume.
const WIDTH: usize = 16;

/// The frame of the present state on rank 0, `None` elsewhere; `lower` is the grid's lower corner (m).
pub fn frame(
    world: &SimpleCommunicator,
    points: &Points<2>,
    lower: [f64; 2],
    (step, time): (u64, f64),
) -> Option<Frame> {
    let own = pack(points);
    let count = i32::try_from(own.len()).expect("a rank's frame stays below 2^31 numbers");
    let root = world.process_at_rank(0);
    if world.rank() != 0 {
        root.gather_into(&count);
        root.gather_varcount_into(&own[..]);
        return None;
    }
    let mut counts = vec![0_i32; world.size().unsigned_abs() as usize];
    root.gather_into_root(&count, &mut counts[..]);
    let starts: Vec<i32> = counts.iter().scan(0, |at, count| Some(std::mem::replace(at, *at + count))).collect();
    let mut all = vec![0.0; counts.iter().map(|&count| count as usize).sum()];
    root.gather_varcount_into_root(&own[..], &mut PartitionMut::new(&mut all[..], &counts[..], &starts[..]));
    let mut rows: Vec<&[f64]> = all.chunks_exact(WIDTH).collect();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut frame = unpack(&rows, lower, (step, time));
    if points.motion.is_none() {
        frame.fields.retain(|field| field.name != "velocity");
    }
    Some(frame)
}

/// Bytes that a point takes in a frame's file.
pub fn point_bytes(dynamic: bool) -> u64 {
    let mut frame = unpack(&[], [0.0; 2], (0, 0.0));
    frame.fields.retain(|field| dynamic || field.name != "velocity");
    vtu::point_bytes(&frame.fields)
}

fn pack(points: &Points<2>) -> Vec<f64> {
    let mut rows = Vec::with_capacity(points.len() * WIDTH);
    for p in 0..points.len() {
        let velocity = points.motion.as_ref().map_or([0.0; 2], |motion| motion.v[p].into());
        rows.extend([points.id[p] as f64, f64::from(points.material[p])]);
        rows.extend(points.x[p].iter());
        rows.extend(points.u[p].iter());
        rows.extend(velocity);
        rows.extend(points.sigma[p].0);
        rows.extend([points.eps_p[p], points.volume[p] * points.F[p].determinant()]);
    }
    rows
}

fn unpack(rows: &[&[f64]], lower: [f64; 2], (step, time): (u64, f64)) -> Frame {
    let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<f64>>();
    let vector = |at: usize| rows.iter().flat_map(|row| [row[at], row[at + 1], 0.0]).collect::<Vec<f64>>();
    let pressure = rows.iter().map(|row| -(row[8] + row[9] + row[10]) / 3.0).collect();
    let ids = rows.iter().map(|row| row[0] as u64).collect();
    let materials = rows.iter().map(|row| row[1] as u16).collect();
    Frame {
        step,
        time,
        position: rows.iter().map(|row| [lower[0] + row[2], lower[1] + row[3], 0.0]).collect(),
        fields: vec![
            Field::real("displacement", 3, vector(4)),
            Field::real("velocity", 3, vector(6)),
            Field::real("stress", 6, rows.iter().flat_map(|row| row[8..14].to_vec()).collect()),
            Field::real("pressure", 1, pressure),
            Field::real("plastic_strain", 1, column(14)),
            Field::real("volume", 1, column(15)),
            Field { name: "material".into(), components: 1, values: Values::U16(materials) },
            Field { name: "id".into(), components: 1, values: Values::U64(ids) },
        ],
    }
}
