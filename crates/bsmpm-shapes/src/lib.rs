#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod axis;
mod cells;
mod edge;
mod error;
mod extent;
mod lattice;
mod measure;
mod outline;
mod raster;
mod region;
mod skin;
mod solid;
mod surface;
mod sweep;
mod volume;

pub mod heights;
pub mod polygon;
pub mod stl;

pub use axis::GridAxis;
pub use cells::{CellPlace, Lattice};
pub use edge::Edge;
pub use error::{HeightsError, RasterError, ShapeError, StlError, SurfaceError};
pub use extent::{AxisExtent, left_of_box};
pub use outline::{MOST_COLUMNS, MOST_EDGES, Outline};
pub use raster::Raster;
pub use region::Region;
pub use skin::skin;
pub use solid::{Section, SolidShape, plane};
pub use surface::{EdgeSide, Surface, edges_of};
pub use sweep::{Slice, Window, is_filled, sweep};
pub use volume::{Volume, bounds_of_difference};
