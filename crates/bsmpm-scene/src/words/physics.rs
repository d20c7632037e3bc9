//! Accepted words for options of the numerical method, such as the mass matrix.

use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::mass::MassMatrix;
use bsmpm::water::flow::PermeabilityLaw;

words! { MassMatrix {
    Lumped = "lumped": "Lumped (diagonal) mass matrix, as in the paper.",
    Consistent = "consistent": "Consistent mass matrix (95 %), blended with the lumped one (5 %).",
} }

words! { WallVelocity {
    Own = "own": "Material points keep their velocity, as in the paper.",
    Relaxed = "relaxed": "While a point moves by a quarter of a cell, its velocity relaxes to its displacement per time.",
} }

words! { Stabilisation {
    None = "none": "No stabilisation: the plain B-spline method.",
    FBar = "f-bar": "F-bar method: volume changes of the step are averaged.",
    FBarZhao = "f-bar-zhao": "F-bar method of Zhao: total volume changes are averaged.",
    ModifiedFBar = "modified-f-bar": "Modified F-bar method of the paper: after every step the elastic strains are averaged as well.",
    ConsistentFBar = "consistent-f-bar": "F-bar method with averages over B-splines of the next lower degree and consistent forces.",
    SubgridFBar = "subgrid-f-bar": "Consistent F-bar method with averages over pairs of cells.",
} }

words! { Quadrature {
    Points = "points": "The volumes of the material points.",
    Fitted = "fitted": "Volumes that integrate the splines inside bodies exactly.",
} }

words! { ExtendedSplines {
    Off = "off": "No extension: all functions are unknowns.",
    Linear = "linear": "Functions of nearly empty cells continue the displacement of the nearest full cell linearly.",
} }

words! { PermeabilityLaw {
    Constant = "constant": "The permeability is constant.",
    KozenyCarman = "kozeny-carman": "The permeability follows the porosity n as n^3/(1 - n)^2.",
} }
