//! Schema of tests of one material point.

use super::{Dimension as In, Range, loads};
use crate::record::Field;
use crate::words::Path;

table! {
    /// A laboratory test of one material point. `bsmpm element` computes the test; `bsmpm-par` ignores it.
    struct ElementTable = "[element.NAME]" {
        /// Name of the material. Default: the only material of the case.
        material: Name, Optional, example(r#""sand""#);
        /// Height of the material point: y, in 3-D z. Required if parameters of the material vary with the height.
        height: Quantity(In::Length, Range::ANY), Optional, example(r#""5 m""#);
        /// Vertical effective stress at the start, positive in compression.
        pressure: Quantity(In::Stress, Range::NOT_NEGATIVE), Default("0.0"), symbol("σ'_v"), example(r#""100 kPa""#);
        /// Ratio of horizontal to vertical effective stress at the start.
        k0: Quantity(In::Number, loads::COEFFICIENT), Default("1.0"), symbol("K0"), example("1.0");
        /// Stages of the test, one after the other.
        stage: Tables(ElementStageTable), Required,
            example(r#"[{ test = "isotropic", pressure = "200 kPa" }, { test = "triaxial", compression = 0.1 }]"#);
    }
}

table! {
    /// A stage of a laboratory test. Strains are logarithmic and count from the start of the stage. Stresses are
    /// Cauchy stresses at the end of the stage. During the stage the prescribed values change linearly. `compression`
    /// and `pressure` are positive in compression, all other strains and stresses in tension.
    struct ElementStageTable = "stage = [{ test, ... }, ...]" {
        /// Type of the test, which determines the constant and the prescribed components.
        test: Choice(Path), Required, example(r#""triaxial""#);
        /// With true, the volume is constant. Given stresses are then total stresses, and the pore pressure is
        /// computed.
        undrained: Flag, Default("false");
        /// Logarithmic axial strain (along y), positive if the specimen shortens. A specimen that shortens by half
        /// has 0.693. In an isotropic test: the volumetric strain.
        compression: Quantity(In::Number, Range::ANY), Optional, symbol("ε_a"), example("0.1");
        /// Alternative to `compression`: axial pressure (along y). In an isotropic test it acts on all sides.
        pressure: Quantity(In::Stress, Range::ANY), Optional, symbol("σ_a"), example(r#""200 kPa""#);
        /// Shear strain of simple-shear and mixed tests: displacement along x divided by the height. Default in a
        /// mixed test: 0.
        shear: Quantity(In::Number, Range::ANY), Optional, symbol("γ"), example("0.2");
        /// Alternative to `shear`: shear stress.
        shear_stress: Quantity(In::Stress, Range::ANY), Optional, symbol("τ"), example(r#""20 kPa""#);
        /// Strain along x in a mixed test.
        strain_xx: Quantity(In::Number, Range::ANY), Optional, symbol("ε_xx"), example("0.01");
        /// Strain along y in a mixed test.
        strain_yy: Quantity(In::Number, Range::ANY), Optional, symbol("ε_yy"), example("-0.02");
        /// Strain along z in a mixed test.
        strain_zz: Quantity(In::Number, Range::ANY), Optional, symbol("ε_zz"), example("0.0");
        /// Alternative to `strain_xx` in a mixed test: stress along x.
        stress_xx: Quantity(In::Stress, Range::ANY), Optional, symbol("σ_xx"), example(r#""-50 kPa""#);
        /// Alternative to `strain_yy` in a mixed test: stress along y.
        stress_yy: Quantity(In::Stress, Range::ANY), Optional, symbol("σ_yy"), example(r#""-100 kPa""#);
        /// Alternative to `strain_zz` in a mixed test: stress along z.
        stress_zz: Quantity(In::Stress, Range::ANY), Optional, symbol("σ_zz"), example(r#""-50 kPa""#);
        /// Duration of the stage, for a strength that depends on the strain rate. Without this key the rate has no
        /// effect.
        duration: Quantity(In::Duration, Range::POSITIVE), Optional, example(r#""1 h""#);
        /// Number of equal steps of the stage. Each step gives a row of the output table.
        steps: Count(1, 1_000_000), Default("100"), example("100");
    }
    one_of optional [compression, pressure];
    one_of optional [shear, shear_stress];
    one_of optional [strain_xx, stress_xx];
    one_of optional [strain_yy, stress_yy];
    one_of optional [strain_zz, stress_zz];
}

impl ElementStageTable {
    /// The keys that say what is driven, those of a mixed stage at the end.
    pub(crate) fn drives(&self) -> [&Field<f64>; 10] {
        [
            &self.compression,
            &self.pressure,
            &self.shear,
            &self.shear_stress,
            &self.strain_xx,
            &self.strain_yy,
            &self.strain_zz,
            &self.stress_xx,
            &self.stress_yy,
            &self.stress_zz,
        ]
    }
}
