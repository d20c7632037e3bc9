//! What people type in place of a key: symbols of the field, names of other programs, and features that do not exist.

use super::Table;

/// Names that no table has, and what to write instead.
struct Answer {
    names: &'static [&'static str],
    /// header of the table in which they mean that; every table if empty
    table: &'static str,
    text: &'static str,
}

const MATERIAL: &str = "[material.NAME]";
const TOP: &str = "the file";

const fn symbol(names: &'static [&'static str], text: &'static str) -> Answer {
    Answer { names, table: MATERIAL, text }
}

const fn top(names: &'static [&'static str], text: &'static str) -> Answer {
    Answer { names, table: TOP, text }
}

const fn anywhere(names: &'static [&'static str], text: &'static str) -> Answer {
    Answer { names, table: "", text }
}

const ANSWERS: &[Answer] = &[
    symbol(
        &["E", "Eref", "E50", "E_ref", "modulus"],
        "Young's modulus is `young`, one constant; of E50 take the value at the stress of the problem",
    ),
    symbol(&["nu", "poisson_ratio", "poissons_ratio"], "Poisson's ratio is `poisson`"),
    symbol(&["phi", "phi_prime", "phi'", "friction_angle_deg"], "the friction angle is `friction_angle`, in degrees"),
    symbol(&["psi", "psi'"], "the dilation angle is `dilation_angle`, in degrees"),
    symbol(&["c", "c'", "c_prime"], "the cohesion is `cohesion`"),
    symbol(
        &["su", "Su", "s_u", "cu", "c_u", "undrained_strength"],
        "the undrained shear strength is `cohesion` with model = \"tresca\"",
    ),
    symbol(&["gamma", "unit_wt"], "the unit weight is `unit_weight`"),
    symbol(&["gamma_sat", "gammasat"], "the saturated unit weight is `saturated_unit_weight`"),
    symbol(&["gamma_d", "gamma_dry", "gamma_unsat"], "the unit weight above the water table is `unit_weight`"),
    symbol(&["rho"], "the density is `density`"),
    symbol(
        &["e", "e0", "e_0", "e_init"],
        "the void ratio is `void_ratio` (modified-cam-clay), and the porosity e0/(1 + e0) is `porosity`",
    ),
    symbol(&["n", "n0"], "the porosity is `porosity`"),
    symbol(
        &["k", "kx", "ky", "ksat", "k_sat"],
        "the hydraulic conductivity (m/s) is `permeability`, one value or one along each axis",
    ),
    symbol(&["M"], "the slope of the critical state line is `critical_state_ratio`"),
    symbol(&["OCR"], "the overconsolidation ratio is `ocr`"),
    symbol(
        &["K0", "K_0", "k_0", "K0nc"],
        "the ratio of horizontal to vertical effective stress at the start is `k0`, in overconsolidated soil not the normally \
             consolidated one",
    ),
    symbol(
        &["pc", "p_c", "pc0"],
        "the isotropic preconsolidation pressure is `preconsolidation`, the overconsolidation ratio `ocr`",
    ),
    symbol(
        &["G", "shear_modulus", "K", "bulk_modulus"],
        "the elastic moduli are `young` and `poisson`: E = 2 G (1 + nu) = 3 K (1 - 2 nu)",
    ),
    symbol(&["St", "S_t"], "the sensitivity is `sensitivity` (sensitive-clay)"),
    symbol(
        &["tension_cutoff", "tension_cut_off", "tensile_strength"],
        "a tension cut-off is not available: the apex of the Mohr-Coulomb pyramid is at a mean tension of c / tan(phi). A smaller \
         `cohesion` lowers it, and the shear strength with it; without cohesion use separation = \"gap\"",
    ),
    symbol(
        &["adhesion"],
        "an adhesion is not available: an interface is \"smooth\", \"rough\" or has a `friction_coefficient`",
    ),
    top(
        &["groundwater", "phreatic", "water_table", "pore_water"],
        "water in the ground is `[water]`, with `level` or `line`",
    ),
    top(
        &[
            "anchor", "anchors", "beam", "beams", "plate", "plates", "pile", "piles", "geogrid", "geogrids", "strut",
            "wall", "walls",
        ],
        "structural elements are not available: use an elastic [[body]] with the same bending stiffness, or [[rigid]]; anchors and \
         geogrids have no equivalent",
    ),
    top(&["bodies"], "bodies are `[[body]]`, one table each"),
    top(&["materials"], "materials are `[material.NAME]`, one table each"),
    top(&["load", "loads", "surcharge"], "loads are `[[traction]]` and `[[point_load]]`"),
    top(&["boundaries", "supports", "fixities"], "supports are `[boundary]`"),
    top(&["phase", "phases", "stages"], "phases are `[[stage]]`"),
    top(&["mesh"], "the background grid is `[grid]`"),
    top(
        &["earthquake", "seismic"],
        "an earthquake is `[shaking]`; a pseudo-static analysis adds the horizontal acceleration to `gravity.acceleration`",
    ),
    anywhere(
        &["probe"],
        "what is meant is [[history]] with `quantity` and `at`; surface = true reads the surface itself",
    ),
    anywhere(
        &["regularisation", "regularization"],
        "what is meant is `band_width`, the width of the shear band for which softening_strain was determined",
    ),
    anywhere(
        &["traction_path"],
        "what is meant is `stress_path` for a traction and `pressure_path` for a pressure, both histories in time",
    ),
];

/// What to write for a key that a table does not have, if others than its author have typed it before.
pub(crate) fn answer(table: &Table, key: &str) -> Option<&'static str> {
    let is_meant = |answer: &&Answer| answer.table.is_empty() || answer.table == table.header;
    ANSWERS.iter().filter(is_meant).find(|answer| answer.names.contains(&key)).map(|answer| answer.text)
}
