//! Schema of drains and inflows.

use super::body::{self, BoxTable, CircleTable};
use super::loads::{self, DiscTable};
use super::{Dimension as In, Range};
use crate::words::Side;

table! {
    /// A surface through which water flows freely, at the hydrostatic pressure or at a given pore pressure. A drain at
    /// the surface of a body moves with the material. Surfaces without a drain or inflow are impermeable.
    struct DrainTable = "[[drain]]" {
        /// Name of the drain in histories and stages.
        name: Name, Optional, example(r#""river_bed""#);
        /// A face of the grid to which bodies extend. The drain does not move with the ground. If the ground moves away
        /// from the face, give the surface of the body instead.
        face: Choice(Side), Optional, example(r#""bottom""#);
        /// One end of a segment on the surface of a body, at the start.
        from: Pair(In::Length, Range::ANY), Optional, example("[0.0, 6.0]");
        to: Shared(loads::TO_KEY, Pair);
        circle: Shared(body::CIRCLE_KEY, Table(CircleTable));
        rectangle: Shared(loads::RECTANGLE_KEY, Table(BoxTable));
        disc: Shared(loads::DISC_KEY, Table(DiscTable));
        /// With true, the drain is the whole surface of the permeable bodies, except at faces of the grid that support
        /// them. The surface is that at the start, or when a stage activates the drain.
        surface: Flag, Optional;
        /// Hydraulic head: height to which water would rise in a standpipe.
        head: Quantity(In::Length, Range::ANY), Optional, example(r#""4 m""#);
        /// Alternative to `head`: time-dependent head, in rows [t, head] with increasing t. The head is linear between
        /// the rows, and constant before and after them.
        head_path: Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Length, Range::ANY)]), Optional,
            example(r#"[[0.0, 4.0], ["1 d", 2.0]]"#);
        /// Alternative to `head`: pore pressure at the drain.
        pressure: Quantity(In::Stress, Range::ANY), Optional, example(r#""0 kPa""#);
        /// Alternative to `head`: time-dependent pore pressure, in rows [t, pressure] with increasing t. The pressure
        /// is linear between the rows, and constant before and after them.
        pressure_path: Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Stress, Range::ANY)]), Optional,
            example(r#"[[0.0, "20 kPa"], ["1 d", 0.0]]"#);
        /// With true, the drain is a seepage face: above the water table the pore pressure is zero, and water can only
        /// flow out.
        seepage: Flag, Optional;
    }
    one_of required [face, from, circle, surface, rectangle, disc];
    one_of required [face, to, circle, surface, rectangle, disc];
    one_of optional [head, head_path, pressure, pressure_path, seepage];
}

table! {
    /// A surface through which water enters the ground at a given rate. An inflow at the surface of a body moves with
    /// the material.
    struct InflowTable = "[[inflow]]" {
        /// Name of the inflow in the log, results and stages.
        name: Name, Optional, example(r#""rain""#);
        /// A face of the grid. Water enters only between the ends of the permeable bodies at this face.
        face: Choice(Side), Optional, example(r#""top""#);
        from: Shared(loads::FROM_KEY, Pair);
        to: Shared(loads::TO_KEY, Pair);
        rectangle: Shared(loads::RECTANGLE_KEY, Table(BoxTable));
        disc: Shared(loads::DISC_KEY, Table(DiscTable));
        /// Volume of water per area and time, positive into the ground.
        rate: Quantity(In::Seepage, Range::ANY), Optional, symbol("q"), example(r#""5 mm/h""#);
        /// Alternative to `rate`: time-dependent rate, in rows [t, rate] with increasing t. The rate is linear between
        /// the rows, and constant before and after them.
        rate_path: Rows(&[(In::Time, Range::NOT_NEGATIVE), (In::Seepage, Range::ANY)]), Optional,
            example(r#"[[0.0, "5 mm/h"], ["6 h", 0.0]]"#);
        /// With true, water enters only as long as the pore pressure at the surface is not positive, as with rain. The
        /// rest runs off.
        runoff: Flag, Default("false"), renamed_from(&["runs_off"]);
    }
    one_of required [face, from, rectangle, disc];
    one_of required [face, to, rectangle, disc];
    one_of required [rate, rate_path];
}
