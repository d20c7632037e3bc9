//! Tests of one material point.

use super::Kind::*;
use super::Presence::{Default, Optional, Required};
use super::{Dimension as In, Kind, Range, Table, key, loads, one_of};
use crate::words::{Path, Word};

pub(super) static ELEMENT: Table = Table {
    header: "[element.NAME]",
    doc: "A laboratory test of one material point, which `bsmpm element` computes; runs of the case leave it alone",
    keys: &[
        key("material", Name, Optional, "name of the material; the only one unless given"),
        key(
            "height",
            Quantity(In::Length, Range::ANY),
            Optional,
            "y of the point, in 3-D z, for parameters that depend on the height (required then)",
        ),
        key(
            "pressure",
            Quantity(In::Stress, Range::NOT_NEGATIVE),
            Default("0.0"),
            "effective vertical pressure at the start",
        ),
        key("k0", Quantity(In::Number, loads::COEFFICIENT), Default("1.0"), "horizontal over vertical stress then"),
        key("stage", Tables(&STAGE), Required, "what is done to it, one after the other"),
    ],
    exclusive: &[],
};

const GROWTH: Kind = Quantity(In::Number, Range::ANY);
const STRESS: Kind = Quantity(In::Stress, Range::ANY);

static STAGE: Table = Table {
    header: "stage = [{ test, ... }, ...]",
    doc: "A part of a test. Strains are logarithmic and count from its start, stresses are Cauchy's at its end; between, \
          all grow in proportion. `compression` and `pressure` are positive in compression, the components of a mixed \
          stage in tension, as everywhere else",
    keys: &[
        key("test", Choice(Path::WORDS), Required, "what is held"),
        key(
            "undrained",
            Flag,
            Default("false"),
            "whether the volume stays; stresses are total ones then, and the rest is pore pressure",
        ),
        key("compression", GROWTH, Optional, "shortening along y; isotropic: of the volume"),
        key("pressure", STRESS, Optional, "pressure along y instead; isotropic: on all sides"),
        key("shear", GROWTH, Optional, "of simple-shear and mixed: motion along x per height; mixed: 0 unless given"),
        key("shear_stress", STRESS, Optional, "the shear stress instead"),
        key("strain_xx", GROWTH, Optional, "of a mixed stage, along x"),
        key("strain_yy", GROWTH, Optional, "along y"),
        key("strain_zz", GROWTH, Optional, "along z"),
        key("stress_xx", STRESS, Optional, "of a mixed stage instead of the strain, along x"),
        key("stress_yy", STRESS, Optional, "along y"),
        key("stress_zz", STRESS, Optional, "along z"),
        key(
            "duration",
            Quantity(In::Duration, Range::POSITIVE),
            Optional,
            "time that it takes, for a strength that follows the rate; without it there is none",
        ),
        key("steps", Count(1, 1_000_000), Default("100"), "equal steps, each a row of the table"),
    ],
    exclusive: &[
        one_of(&["compression", "pressure"], false),
        one_of(&["shear", "shear_stress"], false),
        one_of(&["strain_xx", "stress_xx"], false),
        one_of(&["strain_yy", "stress_yy"], false),
        one_of(&["strain_zz", "stress_zz"], false),
    ],
};
