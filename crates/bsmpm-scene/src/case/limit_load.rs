//! Data of a limit load analysis.

use super::MotionPath;

/// The search for the load at which the ground fails under what is moved.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitLoad {
    /// Factor by which Young's moduli are multiplied, and prescribed displacements divided, so that the geometry stays
    /// as drawn.
    pub stiffness: f64,
    /// Loads of everything that is moved, in the order of the file: the footing, prescribed motions, rigid bodies.
    pub loads: Vec<SoughtLoad>,
    /// Materials with friction whose cohesion is small against their weight, and may have been given for stability
    /// only.
    pub small_cohesions: Vec<String>,
    /// Whether volumetric strains are averaged, as for plastic flow without change of volume.
    pub averages: bool,
}

/// The load of one of the things that are moved: the sum of columns of `history.csv`, each times a weight.
#[derive(Clone, Debug, PartialEq)]
pub struct SoughtLoad {
    /// What is moved.
    pub name: String,
    /// Names of the columns with their weights.
    pub columns: Vec<(String, f64)>,
    /// Unit of the sum.
    pub unit: String,
    /// Its path in the run, divided by the stiffness factor.
    pub path: MotionPath,
    /// Its width at the start; `None` where it has none of its own, as a face of the grid.
    pub width: Option<LoadWidth>,
}

/// The width of what is moved, across its direction of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadWidth {
    /// m  of the whole, where a plane of symmetry cuts it
    pub length: f64,
    /// Cells across it.
    pub cells: f64,
    /// Part of the whole that is modelled: 1, or one half or one quarter at planes of symmetry.
    pub modelled: f64,
}
