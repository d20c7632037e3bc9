//! What the value of an observable is of: points, a place, a face, a footing, a rigid body, a section or a drain.

use crate::words::{Geometry, Side};

/// The points that a history counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointSelection {
    /// by what they are made of
    pub made: Made,
    /// m  lower and upper corner of the box that they are in at that time, in the case's coordinates; `None`: anywhere
    pub within: Option<[[f64; 3]; 2]>,
}

/// What the points are of that a history counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Made {
    /// All of them.
    #[default]
    All,
    /// Those of the material of this number.
    Material(u16),
    /// Those of the body of this number.
    Body(usize),
}

/// A face of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// axis that it is normal to
    pub axis: usize,
    /// the face at the axis' upper end
    pub upper: bool,
}

impl Face {
    /// The face at a side, if the geometry has one there.
    pub fn of(side: Side, geometry: Geometry) -> Option<Self> {
        Side::of(geometry).iter().enumerate().find_map(|(axis, sides)| {
            let number = sides.iter().position(|own| *own == side)?;
            let upper = number == 1;
            Some(Self { axis, upper })
        })
    }

    /// Where it is.
    pub fn side(self, geometry: Geometry) -> Side {
        Side::of(geometry)[self.axis][usize::from(self.upper)]
    }
}

/// What a history is of.
#[derive(Clone, Debug, PartialEq)]
pub enum HistorySubject {
    /// The whole case.
    Case,
    /// The points that count.
    Part(PointSelection),
    /// The points that count, without the farthest ones.
    Percentile {
        /// %  of the points that remain; 100: all
        percentile: f64,
        /// the points that count
        of: PointSelection,
    },
    /// The points that count, near an x.
    Near {
        /// m  of the points within half a cell of this x; `None`: of all
        at_x: Option<f64>,
        /// the points that count
        of: PointSelection,
    },
    /// The point that is nearest to a place at the start.
    Place {
        /// m  in the case's coordinates
        at: [f64; 3],
        /// the place itself instead, by a plane through the points around it
        surface: bool,
    },
    /// A section.
    Section {
        /// m  ends of the line, in the case's coordinates; in space of the lines along t1 and t2 through the middle
        lines: Vec<[[f64; 3]; 2]>,
        /// They are diameters of a disc; in space middle lines of a rectangle else.
        round: bool,
        /// The section stays where it is in space; it goes with the material else.
        fixed: bool,
    },
    /// A face of the grid.
    Face(Face),
    /// The footing or a prescribed motion, by number: the footing, then the motions in the order of the file.
    Strip(usize),
    /// The rigid body of this number.
    Rigid(usize),
    /// The drain of this number, in the order of the file; `None`: all, less the inflows.
    Drain(Option<usize>),
}

/// Kind of subject that an observable has, which determines the keys of its histories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubjectKind {
    /// [`HistorySubject::Case`].
    Case,
    /// [`HistorySubject::Part`].
    Part,
    /// [`HistorySubject::Percentile`].
    Percentile,
    /// [`HistorySubject::Near`].
    Near,
    /// [`HistorySubject::Place`] without the choice of the surface.
    MaterialPlace,
    /// [`HistorySubject::Place`].
    Place,
    /// [`HistorySubject::Section`].
    Section,
    /// [`HistorySubject::Face`] or [`HistorySubject::Strip`].
    Face,
    /// [`HistorySubject::Strip`].
    Strip,
    /// [`HistorySubject::Rigid`].
    Rigid,
    /// [`HistorySubject::Drain`].
    Drain,
}

impl SubjectKind {
    /// Whether it can be of a footing or prescribed motion.
    pub fn is_of_strip(self) -> bool {
        matches!(self, Self::Face | Self::Strip)
    }

    /// The keys of a history that it allows, and those that it needs.
    pub fn keys(self, geometry: Option<Geometry>) -> SubjectKeys {
        match self {
            Self::Case => SubjectKeys::new(&[], &[]),
            Self::Part => SubjectKeys::new(&["material", "body", "box"], &[]),
            Self::Percentile => SubjectKeys::new(&["percentile", "material", "body", "box"], &[]),
            Self::Near => SubjectKeys::new(&["at_x", "material", "body", "box"], &[]),
            Self::MaterialPlace => SubjectKeys::new(&[], &["at"]),
            Self::Place => SubjectKeys::new(&["surface"], &["at"]),
            Self::Section if geometry == Some(Geometry::Solid) => {
                SubjectKeys::new(&["fixed", "rectangle", "disc"], &[])
            }
            Self::Section => SubjectKeys::new(&["fixed"], &["from", "to"]),
            Self::Face => SubjectKeys::new(&[], &["face"]),
            Self::Strip => SubjectKeys::new(&[], &["of"]),
            Self::Rigid => SubjectKeys::new(&[], &["rigid"]),
            Self::Drain => SubjectKeys::new(&["drain", "face"], &[]),
        }
    }
}

/// Keys of a history.
#[derive(Clone, Copy, Debug)]
pub struct SubjectKeys {
    /// Keys that may be given.
    pub own: &'static [&'static str],
    /// Keys that must be given.
    pub needed: &'static [&'static str],
}

impl SubjectKeys {
    const fn new(own: &'static [&'static str], needed: &'static [&'static str]) -> Self {
        Self { own, needed }
    }
}
