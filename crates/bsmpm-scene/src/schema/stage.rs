//! Schema of stages.

use super::loads::{self, ContactTable};
use super::{Dimension as In, Range};
use crate::words::Support;

table! {
    /// A change at a given time, between two steps. A stage can remove bodies (excavation), add bodies (fill),
    /// activate or deactivate loads and prescribed motions, change supports at faces of the grid, and change the law
    /// or the strength of materials.
    struct StageTable = "[[stage]]" {
        /// Name of the stage in the log and in results.
        name: Text(64), Optional, example(r#""excavation""#);
        /// Time at which the stage begins. A step ends at this time.
        at: Quantity(In::Time, Range::POSITIVE), Required, example("1.0");
        /// Names of the bodies that the stage removes.
        remove: Names, Optional, example(r#"["pit_1"]"#);
        /// Names of the bodies that the stage adds. Before the stage they are absent. An added body has its given
        /// shape, no stress and, with flowing water, no excess pore pressure.
        add: Names, Optional, example(r#"["lift_1"]"#);
        /// Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that have no effect
        /// before this stage, and act from then on.
        activate: Names, Optional, example(r#"["surcharge"]"#), renamed_from(&["apply"]);
        /// Names of loads, footings, prescribed displacements, rigid bodies, drains and inflows that cease to act at
        /// this stage.
        deactivate: Names, Optional, example(r#"["strut"]"#), renamed_from(&["release"]);
        /// New supports at faces of the grid. The other faces keep their supports.
        boundary: Table(StageBoundaryTable), Optional, example(r#"{ left = "free" }"#);
        /// Changes of the laws that bodies follow.
        materials: Tables(ExchangeTable), Optional, example(r#"[{ from = "clay", to = "stiff_clay" }]"#);
        /// Factor by which the strength of all materials is divided from this stage on. It replaces the factor of
        /// [strength_reduction].
        strength_reduction: Quantity(In::Number, loads::FACTOR), Optional, symbol("F"), example("1.3");
        /// With true, this stage resets all reported displacements to zero, also those of the footing and of rigid
        /// bodies.
        reset_displacements: Flag, Default("false");
    }
}

table! {
    /// New supports, with the words of [boundary]. Examples are a gate that opens and a wall that is installed.
    struct StageBoundaryTable = "boundary = { left, right, front, back, bottom, top }" {
        /// Support at the face with the lowest x.
        left: ChoiceOr(Support, ContactTable), Optional, example(r#""free""#);
        /// Support at the face with the highest x.
        right: ChoiceOr(Support, ContactTable), Optional, example(r#""free""#);
        /// Support at the face with the lowest y. Only in 3-D.
        front: ChoiceOr(Support, ContactTable), Optional, example(r#""free""#);
        /// Support at the face with the highest y. Only in 3-D.
        back: ChoiceOr(Support, ContactTable), Optional, example(r#""free""#);
        /// Support at the face with the lowest y (in 3-D: the lowest z).
        bottom: ChoiceOr(Support, ContactTable), Optional, example(r#""roller""#);
        /// Support at the face with the highest y (in 3-D: the highest z).
        top: ChoiceOr(Support, ContactTable), Optional, example(r#""free""#);
    }
}

table! {
    /// From this stage on, all bodies of one material follow the law of another material. Their stress and mass do
    /// not change.
    struct ExchangeTable = "materials = [{ from, to }, ...]" {
        /// Name of the material that the bodies have in [[body]].
        from: Name, Required, example(r#""clay""#);
        /// Name of the material whose law the bodies follow. The name given in `from` restores their first law.
        to: Name, Required, example(r#""treated_clay""#);
    }
}

support_table!(StageBoundaryTable);
