//! Words of choices that the physics defines.

use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::mass::MassMatrix;
use bsmpm::water::flow::PermeabilityLaw;

words! { MassMatrix {
    Lumped = "lumped": "diagonal, the paper's",
    Consistent = "consistent": "mostly the consistent one",
} }

words! { WallVelocity {
    Own = "own": "their own: the paper's",
    Relaxed = "relaxed": "it relaxes to that of their motion, over a path of a quarter of a cell",
} }

words! { Stabilisation {
    None = "none": "the plain B-spline method",
    FBar = "f-bar": "dilations of the step averaged",
    FBarZhao = "f-bar-zhao": "total dilations averaged",
    ModifiedFBar = "modified-f-bar": "the paper's: elastic strain averaged after every step, too",
    ConsistentFBar = "consistent-f-bar": "dilations averaged by splines of the order below",
    SubgridFBar = "subgrid-f-bar": "the same on pairs of cells",
} }

words! { Quadrature {
    Points = "points": "points weigh their own volumes",
    Fitted = "fitted": "volumes that integrate splines inside bodies exactly",
} }

words! { ExtendedSplines {
    Off = "off": "all functions are unknowns",
    Linear = "linear": "functions of nearly empty cells continue the displacement of the nearest full cell linearly",
} }

words! { PermeabilityLaw {
    Constant = "constant": "it stays as it is",
    KozenyCarman = "kozeny-carman": "it follows the porosity n as n^3/(1-n)^2",
} }
