//! Converts drains, inflows and soils with pore water of a case to types of `bsmpm`.

use super::on_line;
use crate::grid::vector;
use crate::{ActiveLoads, Case, DrainSite, Face, LoadedLine, Site};
use bsmpm::field::pore_water::flow::{Course, Drain, DrainedFace, Given, Inflow, Permeability, Soil};
use bsmpm::grid::Grid;
use bsmpm::kinematics::Kinematics;

/// Where the physics has a drain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrainPlace {
    /// Number among the drained faces of the grid.
    Face(usize),
    /// Number among the drained surfaces of bodies.
    Surface(usize),
}

/// Where every drain of a case is, in the order of the file.
pub fn drain_places(case: &Case) -> Vec<DrainPlace> {
    let mut faces = 0..;
    let mut surfaces = 0..;
    let drains = case.flow.iter().flat_map(|flow| &flow.drains);
    let places = drains.filter_map(|drain| match drain.site {
        DrainSite::Face(_) => faces.next().map(DrainPlace::Face),
        DrainSite::Lines(_) | DrainSite::Circle { .. } | DrainSite::Plate(_) => {
            surfaces.next().map(DrainPlace::Surface)
        }
    });
    places.collect()
}

/// What the case calls a drained surface or, behind those, an inflow, by the numbers that the physics has.
pub fn name_of_drain(case: &Case, surface: usize) -> String {
    let places = drain_places(case);
    match places.iter().position(|place| *place == DrainPlace::Surface(surface)) {
        Some(number) => format!("drain.{number}"),
        None => {
            let drains = places
                .iter()
                .filter(|place| matches!(place, DrainPlace::Surface(_)))
                .count();
            format!("inflow.{}", surface - drains)
        }
    }
}

/// What the case calls a drained face of the grid, by the number that the physics has.
pub fn name_of_drained_face(case: &Case, face: usize) -> String {
    let number = drain_places(case)
        .iter()
        .position(|place| *place == DrainPlace::Face(face));
    format!("drain.{}", number.unwrap_or_default())
}

/// What flow is to the soils and to surfaces once the stages until the time `t` have begun, if water flows.
pub fn flow<K: Kinematics<D>, const D: usize>(
    case: &Case,
    grid: &Grid<D>,
    t: f64,
) -> Option<bsmpm::field::pore_water::flow::Flow<D>> {
    let flow = case.flow.as_ref()?;
    let base = case.grid.lower()[D - 1];
    let mut drains = Vec::new();
    let mut faces = Vec::new();
    for (number, drain) in flow.drains.iter().enumerate() {
        let given = given_above(&drain.given, base);
        let acts = case.acts_since(ActiveLoads::Drain(number), t).is_some();
        if let DrainSite::Face(Face { axis, upper }) = drain.site {
            faces.push(DrainedFace {
                axis,
                upper,
                given,
                acts,
            });
            continue;
        }
        let lines = drain.site.lines().into_iter();
        let parts = lines.map(|line| on_line::<K, D>(case, grid, &line));
        let (points, normals) = parts
            .flat_map(|(points, normals)| points.into_iter().zip(normals))
            .unzip();
        drains.push(Drain {
            points,
            normals,
            given,
            acts,
        });
    }
    let mut inflows = Vec::new();
    for (number, inflow) in flow.inflows.iter().enumerate() {
        let line = match inflow.site {
            Site::Segment { from, to } => Some(LoadedLine::Segment { from, to }),
            Site::Plate(plate) => Some(LoadedLine::Plate(plate)),
            Site::Face(_) => None,
        };
        let (points, normals) = line.map(|line| on_line::<K, D>(case, grid, &line)).unwrap_or_default();
        inflows.push(Inflow {
            points,
            normals,
            rate: inflow.rate.clone(),
            runs_off: inflow.runs_off,
            acts: case.acts_since(ActiveLoads::Inflow(number), t).is_some(),
        });
    }
    Some(bsmpm::field::pore_water::flow::Flow {
        bulk: flow.bulk,
        soils: flow.soils.iter().map(|soil| soil.as_ref().map(of_ground)).collect(),
        drains,
        faces,
        inflows,
        suction: flow.suction,
        motion: case.water_at(t),
    })
}

/// What is given at a drain, with heads (m) above the grid's lower corner, whose height is `base`, m.
fn given_above(given: &Given, base: f64) -> Given {
    match given {
        Given::Head(Course(rows)) => Given::Head(Course(rows.iter().map(|(t, head)| (*t, head - base)).collect())),
        other => other.clone(),
    }
}

/// A soil in the dimension of the geometry.
fn of_ground<const D: usize>(soil: &Soil<3>) -> Soil<D> {
    let permeability = soil.permeability.as_ref().map(|permeability| Permeability {
        along: vector(permeability.along.into()),
        law: permeability.law,
    });
    Soil {
        porosity: soil.porosity,
        permeability,
        retention: soil.retention.clone(),
    }
}
