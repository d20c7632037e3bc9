//! State of the interactions between steps.

use crate::boundary::Anchors;
use crate::field::pore_water::crossed::{CrossedVolumes, PreviousFlow};
use crate::interactions::rigid::RigidState;
use crate::points::Points;
use crate::tensor::Vector;

/// State of the interactions between steps; the same on every rank. Steps read it, and only an accepted step writes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InteractionState<const D: usize> {
    /// Traction of every strip on the body at its points, in the last converged state (Pa). For an open point it is the
    /// penalty times the displacement of the point relative to the material, see
    /// [`strip`](crate::interactions::strip).
    pub traction: Vec<Vec<Vector<D>>>,
    /// Positions of the points of every load (m). They move with the material that anchors them.
    pub position: Vec<Vec<Vector<D>>>,
    /// Traction of every follower load at full amplitude, per initial area (Pa), rotated and stretched with the
    /// material (see [`follower`](crate::interactions::load::follower)); empty for dead loads.
    pub pressure: Vec<Vec<Vector<D>>>,
    /// Material points that anchor the surface points.
    pub anchors: Anchors,
    /// Forces that carry the initial stress at the nodes of every absorbing face (N), in the order of the nodes on the
    /// face of the whole grid; empty without initial stress.
    pub held: Vec<Vec<Vector<D>>>,
    /// State of every rigid body.
    pub bodies: Vec<RigidState>,
    /// Cumulative flux of water through drains and inflows since the start.
    pub crossed: CrossedVolumes,
    /// Flow of the last step, if the next step continues from it.
    pub flowed: Option<PreviousFlow>,
    /// Soil columns of the free field, in the order of the faces that have one; empty before the first step.
    pub columns: Vec<SoilColumn<D>>,
}

/// Soil column of a free-field boundary; the same on every rank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SoilColumn<const D: usize> {
    /// Material points of the column.
    pub points: Points<D>,
    /// State of the interactions at the column: forces at an absorbing base.
    pub state: InteractionState<D>,
}
