//! Fields that are unknowns beside the displacement. The only one is the excess pore pressure.

pub mod pore_water;
