//! Material points: their state between steps, as one array per quantity, sorted by cell.

mod column;
mod packed;

pub use column::{Column, Number, Rows};
pub use packed::{Components, PackedTensors};

use crate::grid::{Grid, PointPositions, Shape};
use crate::tensor::{Symmetric, Tensor, Vector};
use crate::threads;
use rayon::prelude::*;

/// Material points and their shape functions.
#[derive(Clone, Copy)]
pub struct MappedPoints<'a, const D: usize> {
    /// Shape functions at the points.
    pub shape: &'a Shape<D>,
    /// Material points.
    pub points: &'a Points<D>,
}

/// Description of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnInfo {
    /// Name in checkpoints.
    pub name: &'static str,
    /// Unit, "-" for none.
    pub unit: &'static str,
    /// Name in frames, if shown.
    pub frame: Option<&'static str>,
}

/// Name of a column in checkpoints: the field's, unless older checkpoints use another one.
macro_rules! column_name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $name:literal) => {
        $name
    };
}

/// List of the columns, each with type, unit, name in frames and initial value. Seeding, sorting, migration,
/// checkpoints and frames use this list, so that a new state variable needs one line.
macro_rules! columns {
    (
        every { $($(#[$doc:meta])+ $name:ident: $Type:ty, $unit:literal, $frame:expr, |$seed:ident| $start:expr;)+ }
        dynamic { $($(#[$moving_doc:meta])+
            $moving:ident: $MovingType:ty, $moving_unit:literal, $moving_frame:expr, |$moving_seed:ident| $moving_start:expr;)+ }
        some { $($(#[$some_doc:meta])+
            $some:ident $(as $some_name:literal)?: $SomeType:ty, $some_unit:literal, $some_frame:expr, || $some_start:expr;)+ }
    ) => {
        /// Velocity and acceleration; absent in quasi-static cases.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Motion<const D: usize> {
            $($(#[$moving_doc])+ pub $moving: $MovingType,)+
        }

        /// Material points of one rank, constant during the iterations of a step.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Points<const D: usize> {
            $($(#[$doc])+ pub $name: $Type,)+
            /// Velocity and acceleration.
            pub motion: Option<Motion<D>>,
            $($(#[$some_doc])+ pub $some: Option<$SomeType>,)+
            /// State variables of the constitutive laws, if any.
            pub state: Option<Rows>,
        }

        impl<const D: usize> Points<D> {
            /// Descriptions of all columns except the state of the laws, which has its own variables.
            pub const COLUMNS: &'static [ColumnInfo] = &[
                $(ColumnInfo { name: stringify!($name), unit: $unit, frame: $frame },)+
                $(ColumnInfo { name: stringify!($moving), unit: $moving_unit, frame: $moving_frame },)+
                $(ColumnInfo { name: column_name!($some $($some_name)?), unit: $some_unit, frame: $some_frame },)+
            ];

            /// Adds a stress-free point, at rest or with its initial velocity, to every existing column.
            fn push(&mut self, seed: &Seed<D>) {
                $({ let $seed = seed; self.$name.push($start); })+
                if let Some(motion) = &mut self.motion {
                    $({ let $moving_seed = seed; motion.$moving.push($moving_start); })+
                }
                $(if let Some(column) = &mut self.$some {
                    column.push($some_start);
                })+
                self.state.iter_mut().for_each(Rows::push_zeros);
            }

            /// Creates an empty set of points with the columns of these names; optional columns exist if they are
            /// named. `state` is the number of state variables of the laws.
            pub fn holding(names: &[&str], state: usize) -> Self {
                let has = |name| names.contains(&name);
                Self {
                    motion: [$(stringify!($moving)),+].into_iter().all(has).then(Motion::default),
                    $($some: has(column_name!($some $($some_name)?)).then(Default::default),)+
                    state: has(LAW_STATE).then(|| Rows::of(state)),
                    ..Self::default()
                }
            }

            /// Returns every array once, with its name.
            pub fn named_columns(&mut self) -> Vec<(&'static str, &mut dyn Column)> {
                let mut columns: Vec<(&'static str, &mut dyn Column)> = vec![$((stringify!($name), &mut self.$name),)+];
                if let Some(motion) = &mut self.motion {
                    $(columns.push((stringify!($moving), &mut motion.$moving));)+
                }
                $(if let Some(column) = &mut self.$some {
                    columns.push((column_name!($some $($some_name)?), column));
                })+
                columns.extend(self.state.as_mut().map(|state| (LAW_STATE, state as &mut dyn Column)));
                columns
            }

            /// Returns the array of a name, if it exists.
            pub fn column(&self, name: &str) -> Option<&dyn Column> {
                $(if name == stringify!($name) {
                    return Some(&self.$name);
                })+
                $(if name == stringify!($moving) {
                    return self.motion.as_ref().map(|motion| &motion.$moving as &dyn Column);
                })+
                $(if name == column_name!($some $($some_name)?) {
                    return self.$some.as_ref().map(|column| column as &dyn Column);
                })+
                None
            }
        }
    };
}

/// Name of the column of the laws' state.
const LAW_STATE: &str = "law_state";

columns! {
    every {
        /// Global id, unique over all ranks.
        id: Vec<u64>, "-", Some("id"), |seed| seed.id;
        /// Number of the material.
        material: Vec<u16>, "-", Some("material"), |seed| seed.material;
        /// Position from the lower corner of the grid (m).
        x: Vec<Vector<D>>, "m", None, |seed| seed.x;
        /// Displacement since the start (m).
        u: Vec<Vector<D>>, "m", Some("displacement"), |_seed| Vector::zeros();
        /// Mass (kg, per metre in plane strain).
        mass: Vec<f64>, "kg", None, |seed| seed.mass;
        /// Reference volume V0 (m^D); the present one is det F V0.
        volume: Vec<f64>, "m^D", None, |seed| seed.volume;
        /// Deformation gradient (-).
        F: PackedTensors<D, Tensor>, "-", None, |_seed| Tensor::identity();
        /// Elastic left Cauchy-Green tensor at the start of the next step, smoothed with some F-bar methods (-).
        b_e: PackedTensors<D, Symmetric>, "-", None, |_seed| Symmetric::IDENTITY;
        /// Cauchy stress of the last converged step (Pa).
        sigma: PackedTensors<D, Symmetric>, "Pa", Some("stress"), |_seed| Symmetric::default();
        /// Accumulated plastic strain (-).
        eps_p: Vec<f64>, "-", Some("plastic_strain"), |_seed| 0.0;
    }
    dynamic {
        /// Velocity (m/s).
        v: Vec<Vector<D>>, "m/s", Some("velocity"), |seed| seed.v;
        /// Acceleration (m/s2).
        a: Vec<Vector<D>>, "m/s2", None, |_seed| Vector::zeros();
    }
    some {
        /// Ratio J-bar/J with F-bar, J-bar being the volume ratio that determines the stress (-); 1 before the first
        /// step.
        dilation: Vec<f64>, "-", None, || 1.0;
        /// Tensor b^e after smoothing multiplied by the inverse of that before, in the last step, for damped points
        /// that are smoothed (-); identity before the first step.
        smoothing: PackedTensors<D, Symmetric>, "-", None, || Symmetric::IDENTITY;
        /// Logarithm of the volume of the gap, for materials that close their gaps (-); 0 before the first step.
        gap: Vec<f64>, "-", None, || 0.0;
        /// Displacement when displacements were last reset (m); 0 before the first reset.
        datum: Vec<Vector<D>>, "m", None, || Vector::zeros();
        /// Fraction of the extent by F that a point keeps next to rigid bodies (-): initially limited by the bodies,
        /// then updated by the steps; 1 for points placed later.
        extent: Vec<f64>, "-", None, || 1.0;
        /// Tangential force of a rigid body with friction (N); 0 before the first step.
        tangential_force as "grip": Vec<Vector<D>>, "N", None, || Vector::zeros();
        /// Excess pore pressure, with coupled flow (Pa); 0 before the first step.
        pore_pressure: Vec<f64>, "Pa", None, || 0.0;
        /// Gradient of the whole pore pressure, with coupled flow (Pa/m); the hydrostatic one before the first step.
        pressure_gradient: Vec<Vector<D>>, "Pa/m", None, || Vector::zeros();
        /// Change of the water content per reference volume in the last step, for smooth flow (-); 0 before the first
        /// step.
        content_change: Vec<f64>, "-", None, || 0.0;
        /// Change of the gradient of the whole pore pressure in the last step (Pa/m).
        gradient_change: Vec<Vector<D>>, "Pa/m", None, || Vector::zeros();
        /// Pore pressure from the ratio r_u and the initial weight above, under full gravity (Pa); 0 for points placed
        /// later.
        carried_pressure: Vec<f64>, "Pa", None, || 0.0;
    }
}

/// Initial data of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed<const D: usize> {
    /// Global id.
    pub id: u64,
    /// Number of the material.
    pub material: u16,
    /// Position from the lower corner of the grid (m).
    pub x: Vector<D>,
    /// Volume (m^D).
    pub volume: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Initial velocity (m/s).
    pub v: Vector<D>,
}

impl<const D: usize> PointPositions<D> for Points<D> {
    fn places(&self) -> &[Vector<D>] {
        &self.x
    }
    fn id(&self, p: usize) -> u64 {
        self.id[p]
    }
}

impl<const D: usize> Points<D> {
    /// Creates stress-free points at rest or with their initial velocity; with `dynamic` they store velocity and
    /// acceleration.
    pub fn from_seeds(seeds: impl IntoIterator<Item = Seed<D>>, dynamic: bool) -> Self {
        let mut points = Self {
            motion: dynamic.then(Motion::default),
            ..Self::default()
        };
        seeds.into_iter().for_each(|seed| points.push(&seed));
        points
    }

    /// Returns the points with `width` state variables each, all 0; without state for 0.
    pub fn with_state(self, width: usize) -> Self {
        let state = (width > 0).then(|| Rows {
            width,
            numbers: vec![0.0; width * self.len()],
        });
        Self { state, ..self }
    }

    /// Adds points in their initial state.
    pub fn place(&mut self, seeds: impl IntoIterator<Item = Seed<D>>) {
        seeds.into_iter().for_each(|seed| self.push(&seed));
    }

    /// Returns the points `kept`, in that order.
    pub fn only(&self, kept: &[u32]) -> Self {
        let mut some = self.clone();
        some.columns().into_iter().for_each(|column| column.reorder(kept));
        some
    }

    /// Removes the points whose ids are selected by `gone`.
    pub fn remove(&mut self, gone: impl Fn(u64) -> bool) {
        let stay: Vec<u32> = (0..self.len() as u32).filter(|&p| !gone(self.id[p as usize])).collect();
        if stay.len() < self.len() {
            self.columns().into_iter().for_each(|column| column.reorder(&stay));
        }
    }

    /// Discards the flow of the last step, after a change of the ground or of its loads.
    pub fn forget_flow(&mut self) {
        (self.content_change, self.gradient_change) = (None, None);
    }

    /// Resets the displacements: later output counts from the present state.
    pub fn reset_displacements(&mut self) {
        self.datum = Some(self.u.clone());
    }

    /// Returns the displacement of a point since the last reset (m).
    #[inline]
    pub fn displacement(&self, p: usize) -> Vector<D> {
        self.datum.as_ref().map_or(self.u[p], |datum| self.u[p] - datum[p])
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Returns whether this rank has no point.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Returns the height at which a point was placed, along the last axis from the lower corner of the grid (m).
    #[inline]
    pub fn height(&self, p: usize) -> f64 {
        self.x[p][D - 1] - self.u[p][D - 1]
    }

    /// Returns the logarithm of the volume of the gap at a point.
    #[inline]
    pub fn gap_of(&self, p: usize) -> f64 {
        self.gap.as_ref().map_or(0.0, |gap| gap[p])
    }

    /// Returns the change of a point's elastic strain by smoothing after the last step, as a left Cauchy-Green tensor.
    #[inline]
    pub fn smoothing_of(&self, p: usize) -> Symmetric {
        self.smoothing
            .as_ref()
            .map_or(Symmetric::IDENTITY, |smoothing| smoothing.at(p))
    }

    /// Returns the state of a point; the variables of its law come first.
    #[inline]
    pub fn state_of(&self, p: usize) -> &[f64] {
        self.state.as_ref().map_or(&[], |state| state.of_point(p))
    }

    /// Returns the ratio J-bar/J of a point.
    #[inline]
    pub fn dilation_of(&self, p: usize) -> f64 {
        self.dilation.as_ref().map_or(1.0, |dilation| dilation[p])
    }

    /// Returns every array once.
    pub fn columns(&mut self) -> Vec<&mut dyn Column> {
        self.named_columns().into_iter().map(|(_, column)| column).collect()
    }

    /// Returns the size of one point in a message (bytes).
    pub fn bytes(&mut self) -> usize {
        self.columns().iter().map(|column| column.bytes()).sum()
    }

    /// Returns the size of one point in memory (bytes), smaller in two dimensions, see [`PackedTensors`].
    pub fn memory(&mut self) -> usize {
        self.columns().iter().map(|column| column.memory()).sum()
    }

    /// Sorts by (cell, id), the canonical order, so that sums over points do not depend on migration or restart. Points
    /// outside the window come last.
    pub fn sort_by_cell(&mut self, grid: &Grid<D>) {
        let keys = threads::each(self.len(), |p| match grid.locate(&self.x[p]) {
            Some(cell) if grid.holds(&cell) => (grid.cell_index(&cell), self.id[p]),
            _ => (usize::MAX, self.id[p]),
        });
        if keys.is_sorted() {
            return;
        }
        let mut order: Vec<u32> = (0..self.len() as u32).collect();
        order.par_sort_by_key(|&p| keys[p as usize]);
        self.columns().into_par_iter().for_each(|column| column.reorder(&order));
    }
}
