//! Inertia: time integration, mass matrix, nodal velocities and accelerations, and viscous damping (chapters 2 and 5 of
//! the theory manual).

pub mod damping;
pub mod inertia;
pub mod mass;
pub mod newmark;
