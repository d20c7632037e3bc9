//! Checks that each motion of a rigid body is either prescribed or free.

use crate::case::Rigid;
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::RigidTable;
use crate::validate::NO_INERTIA;
use bsmpm::model::Regime;

/// A motion is on a way or follows from forces.
pub(super) fn moves_as_given(record: &RigidTable, rigid: &Rigid, report: &mut Report<'_>) {
    let way = record.motion().place();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        if rigid.free[axis] && rigid.path.rows.iter().any(|(_, moved)| moved[axis] != 0.0) {
            way.error(prescribed_and_free(&format!("motion along {name}")), report);
        }
        if !rigid.free[axis] && rigid.force[axis] != 0.0 {
            let key = match record.force_path.is_given() {
                true => &*record.force_path,
                false => &record.force,
            };
            key.error(without_effect(&format!("motion along {name}"), name), report);
        }
        if !rigid.free[axis] && rigid.velocity[axis] != 0.0 {
            record
                .start_velocity
                .error(without_effect(&format!("motion along {name}"), name), report);
        }
    }
    if rigid.free[2] && !rigid.rotation.is_empty() {
        record.rotation.error(prescribed_and_free("rotation"), report);
    }
    for (key, value) in [
        (&record.moment, rigid.force[2]),
        (&record.start_spin, rigid.velocity[2]),
    ] {
        if !rigid.free[2] && value != 0.0 {
            key.error(without_effect("rotation", "rotation"), report);
        }
    }
    if rigid.free.contains(&true) && record.about.is_given() {
        let message = "E0425: a rigid body that moves freely rotates about its centre of mass, not about this point. Delete \
             `about`.";
        record.about.error(message, report);
    }
}

/// Says that a motion is prescribed and free.
fn prescribed_and_free(motion: &str) -> String {
    format!(
        "E0423: this key prescribes the {motion} of the rigid body, but `free` lists the same motion as free. Delete \
         this key, or remove the {motion} from `free`."
    )
}

/// Says that what acts on a motion, called `name` in `free`, has no effect on it.
fn without_effect(motion: &str, name: &str) -> String {
    format!(
        "E0424: this key has no effect, because the {motion} of the rigid body is not free. Add \"{name}\" to \
         `free`, or delete this key."
    )
}

/// What moves freely has mass in dynamics, and what has mass moves freely.
pub(super) fn of_free_motions(record: &RigidTable, rigid: &Rigid, regime: Option<Regime>, report: &mut Report<'_>) {
    let is_free = rigid.free.contains(&true);
    if !is_free {
        let masses = [&record.mass, &record.density, &record.inertia];
        for key in masses.into_iter().filter(|key| key.is_given()) {
            let message = format!(
                "E0426: `{0}` has no effect, because all motions of this rigid body are prescribed. Delete `{0}`, or list \
                 the free motions in `free`.",
                key.name()
            );
            key.error(message, report);
        }
    }
    let massless = rigid.mass[0] == 0.0 || rigid.free[2] && rigid.mass[1] == 0.0;
    if is_free && massless && regime == Some(Regime::Dynamic) {
        let message = "E0427: in a dynamic analysis a rigid body that moves freely needs mass, but this body has \
                       none. Give `mass` or `density`.";
        record.free.error(message, report);
    }
    if is_free && rigid.mass[0] == 0.0 && rigid.force == [0.0; 3] {
        let message = "E0428: this rigid body can move freely, but neither weight nor load acts on it. Give `mass`, \
                       `density`, `force` or `moment`.";
        record.free.error(message, report);
    }
    let scaling: [&KeyPlace; 2] = [&record.ramp, &record.amplitude];
    for key in scaling
        .into_iter()
        .filter(|key| key.is_given() && rigid.force == [0.0; 3])
    {
        let path = key.path();
        report.warn(format!(
            "W0410: {path}: the rigid body has no `force` or `moment` that this key could scale, so the key has no \
             effect. Delete the key, or give a force or moment."
        ));
    }
    let starts: [&KeyPlace; 2] = [&record.start_velocity, &record.start_spin];
    for key in starts {
        if key.is_given() && regime == Some(Regime::QuasiStatic) {
            key.error(NO_INERTIA, report);
        }
    }
}
