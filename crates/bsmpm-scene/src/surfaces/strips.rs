//! Converts footings and prescribed segments of a case to surface points, with the penalty stiffness of theory-manual
//! equation (T6.5).

use super::transition::{self, Neighbour};
use super::{normal, on_plate, unit};
use crate::grid::vector;
use crate::validate::normal_of_site;
use crate::{ActiveLoads, Base, Case, Site};
use bsmpm::boundary::{SurfacePoint, surface};
use bsmpm::grid::Grid;
use bsmpm::interactions::strip::{Path, Strip, StripContact};
use bsmpm::kinematics::Kinematics;
use bsmpm::tensor::Vector;

/// Stiffness of the penalty over E/h of the stiffest material and the smallest cell. The traction is carried from step
/// to step, so that all slips together stay at p/beta: measured on the footing, 1e2 to 1e5 give the same pressure.
const PENALTY: f64 = 1e4;
/// Part of it that points have which rub and let go: with all of it most steps that change what they do are cut, and a
/// tenth gives the same forces within 0.2 %.
const RUBBING: f64 = 0.1;
/// Points of a strip in every cell that it crosses.
const HELD: usize = 4;

/// The penalty beta of all strips of a case, Pa/m.
pub fn penalty(young: f64, edge: f64) -> f64 {
    PENALTY * young / edge
}

/// Rigid strips once the stages until the time `t` have begun: the footing first, then the prescribed motions in the
/// order of the file.
pub fn strips<K: Kinematics<D>, const D: usize>(case: &Case, grid: &Grid<D>, penalty: f64, t: f64) -> Vec<Strip<D>> {
    let divided = case.divided_at(t);
    let footing = case.footing.iter();
    let footing = footing.map(|of| (&of.site, &of.path, of.base, of.contact));
    let prescribed = case.prescribed.iter();
    let prescribed = prescribed.map(|of| (&of.site, &of.path, of.base, of.contact));
    let mut strips = Vec::new();
    for (number, (site, path, base, contact)) in footing.chain(prescribed).enumerate() {
        let (points, normal) = held::<K, D>(case, grid, site);
        let contact = contact.map(|StripContact { mut law, inward }| {
            law.friction /= divided;
            let inward = vector::<D, 3>(inward.into());
            StripContact { law, inward }
        });
        let acts = case.acts_since(ActiveLoads::Strip(number), t).is_some();
        strips.push(Strip {
            points,
            normal: (base == Base::Smooth && contact.is_none()).then_some(normal),
            contact,
            path: Path {
                rows: path.rows.iter().map(|(time, moved)| (*time, vector(*moved))).collect(),
            },
            transitions: std::collections::BTreeMap::new(),
            penalty: match contact {
                _ if !acts => 0.0,
                Some(_) => RUBBING * penalty,
                None => penalty,
            },
        });
    }
    transition::connect(&mut strips, &neighbours(case, t), grid);
    strips
}

/// What strips see of each other, in the same order.
pub(crate) fn neighbours<const D: usize>(case: &Case, t: f64) -> Vec<Neighbour<D>> {
    let footing = case.footing.iter().map(|footing| footing.site);
    let sites = footing.chain(case.prescribed.iter().map(|prescribed| prescribed.site));
    let neighbours = sites.enumerate().map(|(number, site)| Neighbour {
        normal: vector(normal_of_site(site)),
        since: case.acts_since(ActiveLoads::Strip(number), t),
    });
    neighbours.collect()
}

/// Points of what is held, and the unit normal of it; a face is where the knots end.
fn held<K: Kinematics<D>, const D: usize>(
    case: &Case,
    grid: &Grid<D>,
    site: &Site,
) -> (Vec<SurfacePoint<D>>, Vector<D>) {
    match *site {
        Site::Segment { from, to } => {
            let [from, to] = [from, to].map(|at| vector(case.grid.local(at)));
            (surface::along::<K, D>(grid, &from, &to, HELD), normal(&from, &to))
        }
        Site::Plate(plate) => (on_plate::<K, D>(case, grid, &plate, HELD), unit(plate.normal())),
        Site::Face(face) => {
            let mut to = Vector::<D>::from_fn(|axis, _| case.grid.axes[axis].length());
            let mut from = Vector::<D>::zeros();
            let at = if face.upper { to[face.axis] } else { 0.0 };
            (from[face.axis], to[face.axis]) = (at, at);
            if D == 2 {
                return (surface::along::<K, D>(grid, &from, &to, HELD), normal(&from, &to));
            }
            (surface::over::<K, D>(grid, &from, &to, HELD), unit(face.axis))
        }
    }
}
