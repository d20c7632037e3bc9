//! Accepted words for options of the numerical method, such as the mass matrix.

use super::retired::F_BAR_ZHAO;
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::field::pore_water::flow::PermeabilityLaw;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;

words! { MassMatrix {
    Lumped = "lumped": "Lumped (diagonal) mass matrix.",
    Consistent = "consistent": "Sum of 95 % of the consistent and 5 % of the lumped mass matrix.",
} }

words! { WallVelocity {
    Own = "own": "Material points keep their velocity.",
    Relaxed = "relaxed": "The velocity of a material point is adjusted gradually to its displacement rate, over a quarter of a cell.",
} }

words! { Stabilisation {
    None = "none": "No stabilisation: the plain B-spline method.",
    FBar = "f-bar": "F-bar method: averages the volume changes of the step.",
    ModifiedFBar = "modified-f-bar": "F-bar method of Xie et al. (2023), which also averages the elastic strains after every step.",
    ConsistentFBar = "consistent-f-bar": "F-bar method with consistent forces. Averages over B-splines of the next lower degree.",
    SubgridFBar = "subgrid-f-bar": "F-bar method with consistent forces. Averages over pairs of cells.",
} removed [F_BAR_ZHAO] }

words! { Quadrature {
    Points = "points": "Volumes of the material points.",
    Fitted = "fitted": "Fitted weights, which integrate the splines inside bodies exactly.",
} }

words! { ExtendedSplines {
    Off = "off": "No extension: all functions are unknowns.",
    Linear = "linear": "Nearly empty cells continue the displacement of the nearest full cell linearly.",
} }

words! { PermeabilityLaw {
    Constant = "constant": "The permeability is constant.",
    KozenyCarman = "kozeny-carman": "The permeability follows the porosity n as n^3/(1 - n)^2.",
} }
