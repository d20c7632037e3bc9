//! Places and motions, which several tables give by the same keys.

use super::body::{BoxTable, CircleTable, SphereTable, SurfaceTable};
use super::flow::{DrainTable, InflowTable};
use super::loads::{DiscTable, FootingTable, FrictionalTable, PrescribedTable, TractionTable};
use crate::record::{CaseTable, Field, KeyPlace, ListRow, Location};
use crate::words::Side;

/// The key that gives a motion. Without any it is the path, which is then absent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MotionKey<'a> {
    Displacement(&'a Field<Vec<f64>>),
    Velocity(&'a Field<Vec<f64>>),
    Path(&'a Field<Vec<ListRow>>),
}

impl<'a> MotionKey<'a> {
    /// Where the key is written.
    pub(crate) fn place(self) -> &'a KeyPlace {
        match self {
            Self::Displacement(key) | Self::Velocity(key) => key,
            Self::Path(key) => key,
        }
    }
}

/// The key of a plate in space.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PlateKey<'a> {
    Rectangle(&'a Field<BoxTable>),
    Disc(&'a Field<DiscTable>),
}

/// The keys that give a place. Without any they are the ends of a segment, which are then absent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SiteKey<'a> {
    Face(&'a Field<Side>),
    Plate(PlateKey<'a>),
    Circle(&'a Field<CircleTable>),
    Sphere(&'a Field<SphereTable>),
    Surface(&'a Field<SurfaceTable>),
    /// Its ends.
    Segment(&'a Field<[f64; 2]>, &'a Field<[f64; 2]>),
}

impl<'a> SiteKey<'a> {
    /// Where the key is written; of a segment its first end.
    pub(crate) fn place(self) -> &'a KeyPlace {
        match self {
            Self::Face(key) => key,
            Self::Plate(PlateKey::Rectangle(key)) => key,
            Self::Plate(PlateKey::Disc(key)) => key,
            Self::Circle(key) => key,
            Self::Sphere(key) => key,
            Self::Surface(key) => key,
            Self::Segment(from, _) => from,
        }
    }

    /// The other end of a segment, or the key of another place.
    pub(crate) fn end(self) -> &'a KeyPlace {
        match self {
            Self::Segment(_, to) => to,
            other => other.place(),
        }
    }

    /// m  the ends of a segment
    pub(crate) fn ends(self) -> Option<[[f64; 2]; 2]> {
        match self {
            Self::Segment(from, to) => Some([from.get()?, to.get()?]),
            _ => None,
        }
    }
}

/// The plate or the segment of a table.
macro_rules! plate_or_segment {
    ($table:ident) => {
        if $table.disc.is_given() {
            SiteKey::Plate(PlateKey::Disc(&$table.disc))
        } else if $table.rectangle.is_given() {
            SiteKey::Plate(PlateKey::Rectangle(&$table.rectangle))
        } else {
            SiteKey::Segment(&$table.from, &$table.to)
        }
    };
}
impl FootingTable {
    /// The keys of the base.
    pub(crate) fn site(&self) -> SiteKey<'_> {
        plate_or_segment!(self)
    }
}

impl PrescribedTable {
    /// The keys of the place.
    pub(crate) fn site(&self) -> SiteKey<'_> {
        match plate_or_segment!(self) {
            SiteKey::Segment(..) if self.face.is_given() => SiteKey::Face(&self.face),
            site => site,
        }
    }
}

impl TractionTable {
    /// The keys of the place.
    pub(crate) fn site(&self) -> SiteKey<'_> {
        if self.circle.is_given() {
            return SiteKey::Circle(&self.circle);
        }
        match plate_or_segment!(self) {
            SiteKey::Segment(..) if self.sphere.is_given() => SiteKey::Sphere(&self.sphere),
            SiteKey::Segment(..) if self.surface.is_given() => SiteKey::Surface(&self.surface),
            site => site,
        }
    }
}

impl InflowTable {
    /// The keys of the place.
    pub(crate) fn site(&self) -> SiteKey<'_> {
        match plate_or_segment!(self) {
            SiteKey::Segment(..) if self.face.is_given() => SiteKey::Face(&self.face),
            site => site,
        }
    }
}

impl DrainTable {
    /// The keys of a plate or of a segment.
    pub(crate) fn site(&self) -> SiteKey<'_> {
        plate_or_segment!(self)
    }
}

/// What a footing and a prescribed motion have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripKeys<'a> {
    pub(crate) location: &'a Location,
    pub(crate) name: &'a Field<String>,
    pub(crate) site: SiteKey<'a>,
    pub(crate) from: &'a Field<[f64; 2]>,
    pub(crate) to: &'a Field<[f64; 2]>,
    pub(crate) rectangle: &'a KeyPlace,
    pub(crate) disc: &'a KeyPlace,
    pub(crate) motion: MotionKey<'a>,
    /// The key of the interface.
    pub(crate) interface: &'a KeyPlace,
    /// The table of frictional contact, if it is given.
    pub(crate) contact: Option<&'a FrictionalTable>,
}

/// The motion and the common keys of a strip.
macro_rules! strip_table {
    ($Table:ident, $interface:ident) => {
        impl $Table {
            /// The key of the motion.
            pub(crate) fn motion(&self) -> MotionKey<'_> {
                first_given!(self, MotionKey: Displacement(displacement), Velocity(velocity), Path(path))
            }

            /// What footings and prescribed motions have in common.
            pub(crate) fn strip(&self) -> StripKeys<'_> {
                StripKeys {
                    location: self.location(),
                    name: &self.name,
                    site: self.site(),
                    from: &self.from,
                    to: &self.to,
                    rectangle: &self.rectangle,
                    disc: &self.disc,
                    motion: self.motion(),
                    interface: &self.$interface,
                    contact: self.$interface.table(),
                }
            }
        }
    };
}

strip_table!(FootingTable, interface);
strip_table!(PrescribedTable, components);
