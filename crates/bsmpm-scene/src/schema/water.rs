//! Schema of hydrostatic water.

use super::{Dimension as In, Range};
use crate::record::KeyPlace;
use crate::words::Drainage;

table! {
    /// Water in and above the ground. With this table the stresses of the soil are effective stresses. The program
    /// applies buoyancy, seepage forces and the water pressure on submerged surfaces. Ground below the water table is
    /// saturated. Above it the pore pressure is zero in "hydrostatic" soil, and negative (suction) in "coupled" soil.
    struct WaterTable = "[water]" {
        /// Height of the water table, which may be above the ground.
        level: Quantity(In::Length, Range::ANY), Optional, example(r#""6 m""#);
        /// Alternative to `level`: time-dependent water table, in rows [t, y] with increasing t. The height is linear
        /// between the rows, and constant before and after them.
        level_path: Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]), Optional,
            example(r#"[[0.0, 8.0], ["5 d", 2.0]]"#);
        /// Alternative to `level`: a phreatic line, in rows [x, y] with increasing x. The line is linear between the
        /// rows, and horizontal beyond its ends. The pore pressure is that of the vertical depth below the line.
        line: Rows(&[(In::Length, Range::ANY), (In::Length, Range::ANY)]), Optional,
            example("[[0.0, 3.0], [20.0, 8.0]]");
        /// Alternative to `level`: time-dependent phreatic line, in rows [t, x, y]. All times have the same x. The
        /// line is linear between the times, and constant before and after them.
        line_path: Rows(&[ (In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY), (In::Length, Range::ANY), ]), Optional,
            example(r#"[[0.0, 0.0, 3.0], [0.0, 20.0, 8.0], ["1 d", 0.0, 3.0], ["1 d", 20.0, 5.0]]"#);
        /// Unit weight of the water.
        unit_weight: Quantity(In::UnitWeight, Range::POSITIVE), Default("\"9.81 kN/m3\""),
            symbol("γ_w"),
            example(r#""9.81 kN/m3""#);
        /// Bulk modulus of the water. Without this key the water is incompressible.
        bulk: Quantity(In::Stress, Range::POSITIVE), Optional, symbol("K_w"), example(r#""2.2 GPa""#);
        /// Upper bound of the initial suction above the water table, in materials with a retention curve. Without
        /// this key the suction has no bound.
        suction: Quantity(In::Stress, Range::NOT_NEGATIVE), Optional, example(r#""20 kPa""#);
        /// Drainage of all materials without a `drainage` of their own. Default: "hydrostatic".
        drainage: Choice(Drainage), Optional, example(r#""coupled""#);
    }
    one_of optional [level, level_path, line, line_path];
}

impl WaterTable {
    /// Whether the case has no water table.
    pub(crate) fn gives_no_table(&self) -> bool {
        let keys: [&KeyPlace; 4] = [&self.level, &self.level_path, &self.line, &self.line_path];
        !keys.into_iter().any(KeyPlace::is_given)
    }
}
