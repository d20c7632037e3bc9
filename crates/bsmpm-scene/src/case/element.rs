//! Data of tests of one material point.

use bsmpm::element::Target;

/// A test of one point, as a laboratory does it.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementTest {
    /// Name in the file.
    pub name: String,
    /// Number of its material.
    pub material: usize,
    /// m  height above the grid's lower corner at which its parameters are taken; `None`: they are the same everywhere
    pub height: Option<f64>,
    /// Pa  effective vertical pressure at the start
    pub pressure: f64,
    /// horizontal over vertical stress at the start
    pub k0: f64,
    /// What is done, one after the other; at least one.
    pub stages: Vec<ElementStage>,
}

/// A part of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementStage {
    /// What becomes of xx, yy, zz and the shear; `None`: the stress stays as it is when the stage begins.
    pub targets: [Option<Target>; 4],
    /// Whether the volume stays.
    pub undrained: bool,
    /// Equal steps.
    pub steps: u64,
    /// s  that it takes; infinite unless given
    pub duration: f64,
}
