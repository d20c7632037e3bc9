//! Schema of hydrostatic water.

use super::Kind::*;
use super::Presence::{Default, Optional};
use super::{Dimension as In, Range, Table, key, one_of};
use crate::words::{Drainage, Word};

pub(super) static WATER: Table = Table {
    header: "[water]",
    doc: "Water in and above the ground. Stresses of the soil are then effective stresses. The program adds \
          buoyancy, seepage forces and the water pressure on submerged surfaces. Ground below the level or the \
          phreatic line is saturated. Above it the pore pressure of hydrostatic soil is zero, and coupled soil has \
          suction.",
    keys: &[
        key(
            "level",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Height of the water table, in the ground or above it.",
        )
        .example(r#""6 m""#),
        key(
            "level_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]),
            Optional,
            "Rows [t, y] of a level that changes, instead of level, with t increasing. The level is interpolated \
             linearly, and is constant before the first row and after the last.",
        )
        .example(r#"[[0.0, 8.0], ["5 d", 2.0]]"#),
        key(
            "line",
            Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]),
            Optional,
            "Rows [x, y] of a phreatic line, instead of level, with x increasing. The line is interpolated linearly \
             and is horizontal beyond its ends. The pore pressure is that of the depth vertically below it.",
        )
        .example("[[0.0, 3.0], [20.0, 8.0]]"),
        key(
            "line_path",
            Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY), (In::Length, Range::ANY)]),
            Optional,
            "Rows [t, x, y] of a phreatic line that changes, instead of line. All times have the same places x. The \
             line is interpolated linearly in time, and is constant before the first time and after the last.",
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
            "Largest suction above the water table at the start, in materials with a retention curve. Without this \
             key the suction is hydrostatic.",
        )
        .example(r#""20 kPa""#),
        key(
            "drainage",
            Choice(Drainage::WORDS),
            Optional,
            "Drainage of the materials that do not give theirs. Without this key it is \"hydrostatic\".",
        )
        .example(r#""coupled""#),
    ],
    exclusive: &[one_of(&["level", "level_path", "line", "line_path"], false)],
};
