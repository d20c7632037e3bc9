//! Schema of tests of one material point.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, key, loads, one_of};
use crate::words::{Path, Word};

pub(super) static ELEMENT: Table = Table {
    header: "[element.NAME]",
    doc: "A laboratory test of one material point. `bsmpm element` computes the test; `bsmpm-par` ignores it.",
    keys: &[
        key(
            "material",
            Name,
            Optional,
            "Name of the material. Default: the only material of the case.",
        )
        .example(r#""sand""#),
        key(
            "height",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Height of the material point: y, in 3-D z. Required if parameters of the material vary with the height.",
        )
        .example(r#""5 m""#),
        key(
            "pressure",
            Quantity(In::Stress, Range::NOT_NEGATIVE),
            Default("0.0"),
            "Vertical effective stress at the start, positive in compression.",
        )
        .symbol("σ'_v")
        .example(r#""100 kPa""#),
        key(
            "k0",
            Quantity(In::Number, loads::COEFFICIENT),
            Default("1.0"),
            "Ratio of horizontal to vertical effective stress at the start.",
        )
        .symbol("K0")
        .example("1.0"),
        key(
            "stage",
            Tables(&STAGE),
            Required,
            "Stages of the test, one after the other.",
        )
        .example(r#"[{ test = "isotropic", pressure = "200 kPa" }, { test = "triaxial", compression = 0.1 }]"#),
    ],
    exclusive: &[],
};

const GROWTH: Kind = Quantity(In::Number, Range::ANY);
const STRESS: Kind = Quantity(In::Stress, Range::ANY);

static STAGE: Table = Table {
    header: "stage = [{ test, ... }, ...]",
    doc: "A stage of a laboratory test. Strains are logarithmic and count from the start of the stage. Stresses are \
          Cauchy stresses at the end of the stage. During the stage the prescribed values change linearly. \
          `compression` and `pressure` are positive in compression, all other strains and stresses in tension.",
    keys: &[
        key(
            "test",
            Choice(Path::WORDS),
            Required,
            "Type of the test, which determines the constant and the prescribed components.",
        )
        .example(r#""triaxial""#),
        key(
            "undrained",
            Flag,
            Default("false"),
            "With true, the volume is constant. Given stresses are then total stresses, and the pore pressure is \
             computed.",
        ),
        key(
            "compression",
            GROWTH,
            Optional,
            "Logarithmic axial strain (along y), positive if the specimen shortens. A specimen that shortens by half \
             has 0.693. In an isotropic test: the volumetric strain.",
        )
        .symbol("ε_a")
        .example("0.1"),
        key(
            "pressure",
            STRESS,
            Optional,
            "Alternative to `compression`: axial pressure (along y). In an isotropic test it acts on all sides.",
        )
        .symbol("σ_a")
        .example(r#""200 kPa""#),
        key(
            "shear",
            GROWTH,
            Optional,
            "Shear strain of simple-shear and mixed tests: displacement along x divided by the height. Default in a \
             mixed test: 0.",
        )
        .symbol("γ")
        .example("0.2"),
        key(
            "shear_stress",
            STRESS,
            Optional,
            "Alternative to `shear`: shear stress.",
        )
        .symbol("τ")
        .example(r#""20 kPa""#),
        key("strain_xx", GROWTH, Optional, "Strain along x in a mixed test.")
            .symbol("ε_xx")
            .example("0.01"),
        key("strain_yy", GROWTH, Optional, "Strain along y in a mixed test.")
            .symbol("ε_yy")
            .example("-0.02"),
        key("strain_zz", GROWTH, Optional, "Strain along z in a mixed test.")
            .symbol("ε_zz")
            .example("0.0"),
        key(
            "stress_xx",
            STRESS,
            Optional,
            "Alternative to `strain_xx` in a mixed test: stress along x.",
        )
        .symbol("σ_xx")
        .example(r#""-50 kPa""#),
        key(
            "stress_yy",
            STRESS,
            Optional,
            "Alternative to `strain_yy` in a mixed test: stress along y.",
        )
        .symbol("σ_yy")
        .example(r#""-100 kPa""#),
        key(
            "stress_zz",
            STRESS,
            Optional,
            "Alternative to `strain_zz` in a mixed test: stress along z.",
        )
        .symbol("σ_zz")
        .example(r#""-50 kPa""#),
        key(
            "duration",
            Quantity(In::Duration, Range::POSITIVE),
            Optional,
            "Duration of the stage, for a strength that depends on the strain rate. Without this key the rate has no \
             effect.",
        )
        .example(r#""1 h""#),
        key(
            "steps",
            Count(1, 1_000_000),
            Default("100"),
            "Number of equal steps of the stage. Each step gives a row of the output table.",
        )
        .example("100"),
    ],
    exclusive: &[
        one_of(&["compression", "pressure"], false),
        one_of(&["shear", "shear_stress"], false),
        one_of(&["strain_xx", "stress_xx"], false),
        one_of(&["strain_yy", "stress_yy"], false),
        one_of(&["strain_zz", "stress_zz"], false),
    ],
};
