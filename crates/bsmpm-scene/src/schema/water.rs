//! Schema of hydrostatic water.

use super::Kind::*;
use super::Presence::{Default, Optional};
use super::{Dimension as In, Range, Table, key, one_of};
use crate::words::{Drainage, Word};

pub(super) static WATER: Table = Table {
    header: "[water]",
    doc: "Water in and above the ground. With this table the stresses of the soil are effective stresses. The program \
          applies buoyancy, seepage forces and the water pressure on submerged surfaces. Ground below the water table \
          is saturated. Above it the pore pressure is zero in \"hydrostatic\" soil, and negative (suction) in \
          \"coupled\" soil.",
    keys: &[
        key(
            "level",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Height of the water table, which may be above the ground.",
        )
        .example(r#""6 m""#),
        key(
            "level_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "Alternative to `level`: time-dependent water table, in rows [t, y] with increasing t. The height is \
             linear between the rows, and constant before and after them.",
        )
        .example(r#"[[0.0, 8.0], ["5 d", 2.0]]"#),
        key(
            "line",
            Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]),
            Optional,
            "Alternative to `level`: a phreatic line, in rows [x, y] with increasing x. The line is linear between the \
             rows, and horizontal beyond its ends. The pore pressure is that of the vertical depth below the line.",
        )
        .example("[[0.0, 3.0], [20.0, 8.0]]"),
        key(
            "line_path",
            Rows(&[
                (In::Time, Range::NOT_NEGATIVE),
                (In::Length, Range::ANY),
                (In::Length, Range::ANY),
            ]),
            Optional,
            "Alternative to `level`: time-dependent phreatic line, in rows [t, x, y]. All times have the same x. The \
             line is linear between the times, and constant before and after them.",
        )
        .example(r#"[[0.0, 0.0, 3.0], [0.0, 20.0, 8.0], ["1 d", 0.0, 3.0], ["1 d", 20.0, 5.0]]"#),
        key(
            "unit_weight",
            Quantity(In::UnitWeight, Range::POSITIVE),
            Default("\"9.81 kN/m3\""),
            "Unit weight of the water.",
        )
        .symbol("γ_w")
        .example(r#""9.81 kN/m3""#),
        key(
            "bulk",
            Quantity(In::Stress, Range::POSITIVE),
            Optional,
            "Bulk modulus of the water. Without this key the water is incompressible.",
        )
        .symbol("K_w")
        .example(r#""2.2 GPa""#),
        key(
            "suction",
            Quantity(In::Stress, Range::NOT_NEGATIVE),
            Optional,
            "Upper bound of the initial suction above the water table, in materials with a retention curve. Without \
             this key the suction has no bound.",
        )
        .example(r#""20 kPa""#),
        key(
            "drainage",
            Choice(Drainage::WORDS),
            Optional,
            "Drainage of all materials without a `drainage` of their own. Default: \"hydrostatic\".",
        )
        .example(r#""coupled""#),
    ],
    exclusive: &[one_of(&["level", "level_path", "line", "line_path"], false)],
};
