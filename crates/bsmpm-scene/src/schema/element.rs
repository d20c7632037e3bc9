//! Schema of tests of one material point.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, key, loads, one_of};
use crate::words::{Path, Word};

pub(super) static ELEMENT: Table = Table {
    header: "[element.NAME]",
    doc: "A laboratory test of one material point, which `bsmpm element` computes. Runs of the case ignore it.",
    keys: &[
        key("material", Name, Optional, "Name of the material. Without this key it is the only one of the case.")
            .example(r#""sand""#),
        key(
            "height",
            Quantity(In::Length, Range::ANY),
            Optional,
            "Height of the point, y and in 3-D z. Required if parameters of the material depend on the height.",
        )
        .example(r#""5 m""#),
        key(
            "pressure",
            Quantity(In::Stress, Range::NOT_NEGATIVE),
            Default("0.0"),
            "Effective vertical pressure at the start.",
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
        key("stage", Tables(&STAGE), Required, "Stages of the test, one after the other."),
    ],
    exclusive: &[],
};

const GROWTH: Kind = Quantity(In::Number, Range::ANY);
const STRESS: Kind = Quantity(In::Stress, Range::ANY);

static STAGE: Table = Table {
    header: "stage = [{ test, ... }, ...]",
    doc: "A stage of a laboratory test. Strains are logarithmic and count from the start of the stage. Stresses are \
          Cauchy stresses at its end. In between they change linearly. `compression` and `pressure` are positive in \
          compression. The components of a mixed stage are positive in tension, as everywhere else.",
    keys: &[
        key(
            "test",
            Choice(Path::WORDS),
            Required,
            "Kind of the test: which components are constant and which one is prescribed.",
        )
        .example(r#""triaxial""#),
        key(
            "undrained",
            Flag,
            Default("false"),
            "Whether the volume is constant. Stresses are then total stresses, and the pore pressure makes up the \
             difference.",
        ),
        key(
            "compression",
            GROWTH,
            Optional,
            "Axial logarithmic strain along y, positive when the sample shortens. A sample that shortens by half has \
             0.693. In an isotropic test it is the volumetric strain.",
        )
        .symbol("ε_a")
        .example("0.1"),
        key(
            "pressure",
            STRESS,
            Optional,
            "Axial pressure along y, instead of compression. In an isotropic test it acts on all sides.",
        )
        .symbol("σ_a")
        .example(r#""200 kPa""#),
        key(
            "shear",
            GROWTH,
            Optional,
            "Shear strain of simple-shear and mixed tests: displacement along x per height. In a mixed test it is 0 \
             without this key.",
        )
        .symbol("γ")
        .example("0.2"),
        key("shear_stress", STRESS, Optional, "Shear stress, instead of shear.").symbol("τ").example(r#""20 kPa""#),
        key("strain_xx", GROWTH, Optional, "Strain along x, in a mixed test.").symbol("ε_xx").example("0.01"),
        key("strain_yy", GROWTH, Optional, "Strain along y, in a mixed test.").symbol("ε_yy").example("-0.02"),
        key("strain_zz", GROWTH, Optional, "Strain along z, in a mixed test.").symbol("ε_zz").example("0.0"),
        key("stress_xx", STRESS, Optional, "Stress along x, in a mixed test, instead of the strain.")
            .symbol("σ_xx")
            .example(r#""-50 kPa""#),
        key("stress_yy", STRESS, Optional, "Stress along y, in a mixed test, instead of the strain.")
            .symbol("σ_yy")
            .example(r#""-100 kPa""#),
        key("stress_zz", STRESS, Optional, "Stress along z, in a mixed test, instead of the strain.")
            .symbol("σ_zz")
            .example(r#""-50 kPa""#),
        key(
            "duration",
            Quantity(In::Duration, Range::POSITIVE),
            Optional,
            "Duration of the stage, for strengths that depend on the strain rate. Without this key the rate has no \
             effect.",
        )
        .example(r#""1 h""#),
        key(
            "steps",
            Count(1, 1_000_000),
            Default("100"),
            "Number of equal steps, each of which is a row of the table.",
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
