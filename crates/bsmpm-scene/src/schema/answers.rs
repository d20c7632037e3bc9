//! Hints for unknown keys that users may write in a case file, such as symbols and names from other programs.

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
    Answer {
        names,
        table: MATERIAL,
        text,
    }
}

const fn top(names: &'static [&'static str], text: &'static str) -> Answer {
    Answer {
        names,
        table: TOP,
        text,
    }
}

const fn anywhere(names: &'static [&'static str], text: &'static str) -> Answer {
    Answer { names, table: "", text }
}

const ANSWERS: &[Answer] = &[
    symbol(
        &["E", "Eref", "E50", "E_ref", "E_mod", "Emod", "modulus"],
        "Young's modulus is the key `young`, a constant. For E50 take its value at the stress of the problem.",
    ),
    symbol(
        &["nu", "poisson_ratio", "poissons_ratio"],
        "Poisson's ratio is the key `poisson`.",
    ),
    symbol(
        &["phi", "phi_prime", "phi'", "friction_angle_deg", "friction_coefficient"],
        "The friction angle is the key `friction_angle`, in degrees.",
    ),
    symbol(
        &["psi", "psi'"],
        "The dilation angle is the key `dilation_angle`, in degrees.",
    ),
    symbol(&["c", "c'", "c_prime"], "The cohesion is the key `cohesion`."),
    symbol(
        &["su", "Su", "s_u", "cu", "c_u", "undrained_strength"],
        "The undrained shear strength is the key `cohesion` with model = \"tresca\".",
    ),
    symbol(&["gamma", "unit_wt"], "The unit weight is the key `unit_weight`."),
    symbol(
        &["gamma_sat", "gammasat"],
        "The saturated unit weight is the key `saturated_unit_weight`.",
    ),
    symbol(
        &["gamma_d", "gamma_dry", "gamma_unsat"],
        "The unit weight above the water table is the key `unit_weight`.",
    ),
    symbol(&["rho"], "The density is the key `density`."),
    symbol(
        &["e", "e0", "e_0", "e_init"],
        "The void ratio of modified Cam-clay is the key `void_ratio`; the porosity e0/(1 + e0) is the key `porosity`.",
    ),
    symbol(&["n", "n0"], "The porosity is the key `porosity`."),
    symbol(
        &["k", "kx", "ky", "ksat", "k_sat"],
        "The hydraulic conductivity (m/s) is the key `permeability`: one value, or one along each axis.",
    ),
    symbol(
        &["M"],
        "The slope of the critical state line is the key `critical_state_ratio`.",
    ),
    symbol(&["OCR"], "The overconsolidation ratio is the key `ocr`."),
    symbol(
        &["K0", "K_0", "k_0", "K0nc"],
        "The coefficient of earth pressure at rest is the key `k0`. For overconsolidated soil do not take its normally \
         consolidated value.",
    ),
    symbol(
        &["pc", "p_c", "pc0"],
        "The isotropic preconsolidation pressure is the key `preconsolidation`; the overconsolidation ratio is `ocr`.",
    ),
    symbol(
        &["G", "shear_modulus", "K", "bulk_modulus"],
        "The elastic constants are the keys `young` and `poisson`: E = 2 G (1 + nu) = 3 K (1 - 2 nu).",
    ),
    symbol(
        &["St", "S_t"],
        "The sensitivity is the key `sensitivity`, of model = \"sensitive-clay\".",
    ),
    symbol(
        &["tension_cutoff", "tension_cut_off", "sigma_t", "ft", "f_t"],
        "The tension cut-off is the key `tensile_strength`, the largest tensile stress; 0 for soil without tension.",
    ),
    symbol(
        &["fracture_energy", "Gf", "G_f"],
        "The softening of a crack with the fracture energy G_f is the key `crack_opening` = 2 G_f / tensile_strength (linear softening).",
    ),
    symbol(
        &["adhesion"],
        "E0012: an adhesion between soil and structure is not available. Set the contact to \"smooth\" or \"rough\", \
         or give it a `friction_coefficient`.",
    ),
    top(
        &["groundwater", "phreatic", "water_table", "pore_water"],
        "Water in the ground is the table `[water]`, with `level` or `line`.",
    ),
    top(
        &[
            "anchor", "anchors", "beam", "beams", "plate", "plates", "pile", "piles", "geogrid", "geogrids", "strut",
            "wall", "walls",
        ],
        "E0012: structural elements (beams, plates, anchors) are not available. Use an elastic [[body]] with the same \
         bending stiffness, or a [[rigid]] body. Anchors and geogrids have no substitute.",
    ),
    top(&["bodies"], "Bodies are tables `[[body]]`, one for each."),
    top(&["materials"], "Materials are tables `[material.NAME]`, one for each."),
    top(
        &["load", "loads", "surcharge"],
        "Loads are tables `[[traction]]` and `[[point_load]]`.",
    ),
    top(
        &["boundaries", "supports", "fixities"],
        "Supports of the grid's faces are the table `[boundary]`.",
    ),
    top(
        &["phase", "phases", "stages"],
        "Construction stages are tables `[[stage]]`.",
    ),
    top(&["mesh"], "The background grid is the table `[grid]`."),
    top(
        &["earthquake", "seismic"],
        "A ground motion is the table `[shaking]`; for a pseudo-static analysis add a horizontal part to \
         `gravity.acceleration`.",
    ),
    anywhere(
        &["probe"],
        "A quantity at a place over time is a table [[history]] with `quantity` and `at`.",
    ),
    anywhere(
        &["regularisation", "regularization"],
        "The width of the shear band, for which `softening_strain` was determined, is the key `band_width`.",
    ),
    anywhere(
        &["traction_path"],
        "A traction that changes with time is the key `stress_path`, a pressure the key `pressure_path`.",
    ),
];

/// What to write for a key that a table does not have, if others than its author have typed it before. It begins with
/// its code where what is meant does not exist.
pub(crate) fn answer(table: &Table, key: &str) -> Option<&'static str> {
    let is_meant = |answer: &&Answer| answer.table.is_empty() || answer.table == table.header;
    let is_alike = |answer: &&Answer| answer.names.iter().any(|name| name.eq_ignore_ascii_case(key));
    let is_same = |answer: &&Answer| answer.names.contains(&key);
    let same = ANSWERS.iter().filter(is_meant).find(is_same);
    same.or_else(|| ANSWERS.iter().filter(is_meant).find(is_alike))
        .map(|answer| answer.text)
}
