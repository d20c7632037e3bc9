//! What must hold for any input: properties of the splines, the mapping, the kinematics, the iteration and the step
//! control. Numbers after `measured` are what this machine gave; bounds leave room for another one.

mod background;
mod broyden;
mod dilation;
mod drainage;
mod extension;
mod gap;
mod indicators;
mod kinematics;
mod lagged_background;
mod lanes;
mod linearised;
mod multisecant;
mod observe;
mod place;
mod points;
mod rigid;
mod spline;
mod stepping;
mod stiffness;
mod topology;
mod transfer;
