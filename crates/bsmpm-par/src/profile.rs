//! Computes profiles: fields along a line.

use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::observe;
use bsmpm::observe::place::{self, Configuration};
use bsmpm::parallel::Halo;
use bsmpm::points::Points;
use bsmpm::tensor::{Symmetric, Vector};
use bsmpm_scene::Profile;
use bsmpm_scene::model::vector;
use bsmpm_scene::observables::PlaceSample;

/// Numbers that a row is made of: displacement since the start and since displacements count, velocity, stress, plastic
/// strain, pore pressure and the excess in it.
const FIELDS: usize = 3 + 3 + 3 + 6 + 1 + 2;

/// A row for every place that material is at: distance along the line, present place, then what the profile reports;
/// `lower` is the grid's corner, `t` the time. Collective.
pub fn rows<K: Kinematics<D>, const D: usize>(
    profile: &Profile,
    model: &Model<K, D>,
    lower: [f64; 3],
    t: f64,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<Vec<f64>> {
    let places = profile.places();
    let local: Vec<Vector<D>> = places
        .iter()
        .map(|(_, at)| vector::<D, _>(*at) - vector(lower))
        .collect();
    let configuration = if profile.fixed {
        Configuration::Present
    } else {
        Configuration::Initial
    };
    let water = PoreWater::of(model, points, t);
    let found = place::values::<K, D, _>(
        &model.grid,
        points,
        &local,
        configuration,
        |p| fields(points, water, p),
        halo,
    );
    let mut rows = Vec::new();
    for ((distance, at), found) in places.iter().zip(found) {
        let Some(found) = found else { continue };
        let mut row = vec![*distance];
        row.extend((0..D).map(|axis| at[axis] + if profile.fixed { 0.0 } else { found[axis] }));
        extend::<D>(&mut row, profile, &found);
        rows.push(row);
    }
    rows
}

/// The numbers of a point that a row is made of.
fn fields<const D: usize>(points: &Points<D>, water: Option<PoreWater<'_, D>>, p: usize) -> [f64; FIELDS] {
    let velocity = points.motion.as_ref().map_or(Vector::zeros(), |motion| motion.v[p]);
    let vectors = [points.u[p], points.displacement(p), velocity].map(|vector| observe::in_space(&vector));
    let pores = water.map_or([0.0; 2], |water| [water.pressure(p), water.excess(p)]);
    let numbers = vectors
        .into_iter()
        .flatten()
        .chain(points.sigma.at(p).0)
        .chain([points.eps_p[p]])
        .chain(pores);
    let mut fields = [0.0; FIELDS];
    fields
        .iter_mut()
        .zip(numbers)
        .for_each(|(field, number)| *field = number);
    fields
}

/// Adds the quantities that the profile reports in `D` dimensions.
fn extend<const D: usize>(row: &mut Vec<f64>, profile: &Profile, fields: &[f64; FIELDS]) {
    let [
        ..,
        dx,
        dy,
        dz,
        vx,
        vy,
        vz,
        xx,
        yy,
        zz,
        xy,
        yz,
        xz,
        plastic_strain,
        pore_pressure,
        excess_pressure,
    ] = *fields;
    let sample = PlaceSample {
        displacement: [dx, dy, dz],
        velocity: [vx, vy, vz],
        stress: Symmetric([xx, yy, zz, xy, yz, xz]),
        plastic_strain,
        pore_pressure,
        excess_pressure,
    };
    for quantity in &profile.quantities {
        quantity.put::<D>(&sample, row);
    }
}
