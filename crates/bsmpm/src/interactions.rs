//! Forces on the nodes other than those of the material points' stresses: contact of faces, footings, rigid bodies,
//! loads, absorbing boundaries, free field, soft background.

pub mod absorbing;
pub mod background;
pub mod contact;
pub mod coulomb;
pub mod free_field;
pub mod load;
pub mod rigid;
pub mod strip;
