//! Tests of properties of single modules. Comments after `measured` give the value on the development machine.

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
