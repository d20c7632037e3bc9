//! Material points: their state between steps, as one array per quantity, sorted by cell.

mod column;
mod packed;

pub use column::{Column, Number, Rows};
pub use packed::{Components, PackedTensors};

use crate::boundary::Surface;
use crate::boundary::anchor::AnchorCandidates;
use crate::grid::{Grid, PointPositions, Shape};
use crate::tensor::{Symmetric, Tensor, Vector};
use crate::threads;
use rayon::prelude::*;

/// Material points and their shape functions.
#[derive(Clone, Copy)]
pub struct MappedPoints<'a, const D: usize> {
    /// Shape functions at the points.
    pub shape: &'a Shape<D>,
    /// The points.
    pub points: &'a Points<D>,
}

/// What a column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnInfo {
    /// as checkpoints name it
    pub name: &'static str,
    /// its unit, "-" for none
    pub unit: &'static str,
    /// as frames name it, if they show it
    pub frame: Option<&'static str>,
}

/// The name of a column in checkpoints: that of its field, unless older checkpoints have another one.
macro_rules! column_name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $name:literal) => {
        $name
    };
}

/// The columns, each with its type, unit, name in frames, and what it starts from. Seeding, sorting, migration,
/// checkpoints and frames walk this list, so that a new state variable is one line.
macro_rules! columns {
    (
        every { $($(#[$doc:meta])+ $name:ident: $Type:ty, $unit:literal, $frame:expr, |$seed:ident| $start:expr;)+ }
        dynamic { $($(#[$moving_doc:meta])+
            $moving:ident: $MovingType:ty, $moving_unit:literal, $moving_frame:expr, |$moving_seed:ident| $moving_start:expr;)+ }
        some { $($(#[$some_doc:meta])+
            $some:ident $(as $some_name:literal)?: $SomeType:ty, $some_unit:literal, $some_frame:expr, || $some_start:expr;)+ }
    ) => {
        /// Velocity and acceleration; absent in quasi-static scenes.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Motion<const D: usize> {
            $($(#[$moving_doc])+ pub $moving: $MovingType,)+
        }

        /// The material points of one rank. Read-only until a step is committed.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Points<const D: usize> {
            $($(#[$doc])+ pub $name: $Type,)+
            /// velocity and acceleration
            pub motion: Option<Motion<D>>,
            $($(#[$some_doc])+ pub $some: Option<$SomeType>,)+
            /// state variables of the points' laws, if any law has some
            pub state: Option<Rows>,
            /// what strips and loads carry on; no column: it is the same on every rank
            pub surface: Surface<D>,
            /// the columns of the free field, in the order of the faces that have one; the same on every
            /// rank, none before the first step
            pub free_field: Vec<Points<D>>,
        }

        impl<const D: usize> Points<D> {
            /// What the columns are; but for the laws' state, which has variables of its own.
            pub const COLUMNS: &'static [ColumnInfo] = &[
                $(ColumnInfo { name: stringify!($name), unit: $unit, frame: $frame },)+
                $(ColumnInfo { name: stringify!($moving), unit: $moving_unit, frame: $moving_frame },)+
                $(ColumnInfo { name: column_name!($some $($some_name)?), unit: $some_unit, frame: $some_frame },)+
            ];

            /// Adds a stress-free point at rest or with its initial velocity, with every column that is there.
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

            /// No points, with room for the columns of these names: those that a scene does without are there if they
            /// are named. `state`: numbers that the laws' state consists of.
            pub fn holding(names: &[&str], state: usize) -> Self {
                let has = |name| names.contains(&name);
                Self {
                    motion: [$(stringify!($moving)),+].into_iter().all(has).then(Motion::default),
                    $($some: has(column_name!($some $($some_name)?)).then(Default::default),)+
                    state: has(LAW_STATE).then(|| Rows::of(state)),
                    ..Self::default()
                }
            }

            /// Every array once, by name.
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

            /// The array of a name, if the scene has it.
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
        /// global id, unique over all ranks
        id: Vec<u64>, "-", Some("id"), |seed| seed.id;
        /// number of the material
        material: Vec<u16>, "-", Some("material"), |seed| seed.material;
        /// m  position from the grid's lower corner
        x: Vec<Vector<D>>, "m", None, |seed| seed.x;
        /// m  displacement since the start
        u: Vec<Vector<D>>, "m", Some("displacement"), |_seed| Vector::zeros();
        /// kg (per metre in plane strain)
        mass: Vec<f64>, "kg", None, |seed| seed.mass;
        /// m^D  reference volume V0; the current one is det F V0
        volume: Vec<f64>, "m^D", None, |seed| seed.volume;
        /// -  deformation gradient
        F: PackedTensors<D, Tensor>, "-", None, |_seed| Tensor::identity();
        /// -  elastic left Cauchy-Green tensor that the next step starts from (smoothed under some F-bar methods)
        b_e: PackedTensors<D, Symmetric>, "-", None, |_seed| Symmetric::IDENTITY;
        /// Pa  Cauchy stress of the last converged step
        sigma: PackedTensors<D, Symmetric>, "Pa", Some("stress"), |_seed| Symmetric::default();
        /// -  accumulated plastic strain
        eps_p: Vec<f64>, "-", Some("plastic_strain"), |_seed| 0.0;
    }
    dynamic {
        /// m/s  velocity
        v: Vec<Vector<D>>, "m/s", Some("velocity"), |seed| seed.v;
        /// m/s2  acceleration
        a: Vec<Vector<D>>, "m/s2", None, |_seed| Vector::zeros();
    }
    some {
        /// -  J-bar/J, J-bar the dilation that the stress has felt, under F-bar from its first step on; before that it
        ///   is 1
        dilation: Vec<f64>, "-", None, || 1.0;
        /// -  b^e after smoothing by that before, a left Cauchy-Green tensor, in the last step, where damped points are
        ///   smoothed; before that it is the identity
        smoothing: PackedTensors<D, Symmetric>, "-", None, || Symmetric::IDENTITY;
        /// -  logarithm of the volume of the gap, where a material closes its gaps, from its first step on; before that
        ///   it is 0
        gap: Vec<f64>, "-", None, || 0.0;
        /// m  displacement when displacements were last set to zero, from that stage on; before that it is 0
        datum: Vec<Vector<D>>, "m", None, || Vector::zeros();
        /// -  part of what its F makes a point reach to a side that it has beside rigid bodies, if there are any: at
        ///   the start as far as they leave it, then as the steps have left it; of points that come later it is 1
        extent: Vec<f64>, "-", None, || 1.0;
        /// N  tangential force of a rigid body with friction, from the first step on; before that it is 0
        tangential_force as "grip": Vec<Vector<D>>, "N", None, || Vector::zeros();
        /// Pa  excess pore pressure, where water flows, from the first step on; before that it is 0
        pore_pressure: Vec<f64>, "Pa", None, || 0.0;
        /// Pa/m  gradient of the whole pore pressure, where water flows, from the first step on; before that it is that
        ///   of the still water
        pressure_gradient: Vec<Vector<D>>, "Pa/m", None, || Vector::zeros();
        /// -  water per reference volume that came in the last step, where water flows that goes on as it did, from the
        ///   first step on; before that it is 0
        content_change: Vec<f64>, "-", None, || 0.0;
        /// Pa/m  what the gradient of the whole pore pressure changed by then
        gradient_change: Vec<Vector<D>>, "Pa/m", None, || Vector::zeros();
        /// Pa  pore pressure as a share of the weight above at the start, under the full gravity, where some material
        ///   has one; of points that come later it is 0
        carried_pressure: Vec<f64>, "Pa", None, || 0.0;
    }
}

/// A point as it is placed at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed<const D: usize> {
    /// global id
    pub id: u64,
    /// number of the material
    pub material: u16,
    /// m  position from the grid's lower corner
    pub x: Vector<D>,
    /// m^D  volume
    pub volume: f64,
    /// kg  mass
    pub mass: f64,
    /// m/s  initial velocity
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
    /// The points as surfaces are anchored to them.
    pub fn anchored(&self) -> AnchorCandidates<'_, D> {
        AnchorCandidates {
            id: &self.id,
            material: &self.material,
            x: &self.x,
            u: &self.u,
            F: &self.F,
        }
    }

    /// Stress-free points at rest or with their initial velocity; with `dynamic` they carry velocity and acceleration.
    pub fn from_seeds(seeds: impl IntoIterator<Item = Seed<D>>, dynamic: bool) -> Self {
        let mut points = Self {
            motion: dynamic.then(Motion::default),
            ..Self::default()
        };
        seeds.into_iter().for_each(|seed| points.push(&seed));
        points
    }

    /// The same points with `width` numbers of state each, at their start: 0. None for 0.
    pub fn with_state(self, width: usize) -> Self {
        let state = (width > 0).then(|| Rows {
            width,
            numbers: vec![0.0; width * self.len()],
        });
        Self { state, ..self }
    }

    /// Places further points, which start as others did.
    pub fn place(&mut self, seeds: impl IntoIterator<Item = Seed<D>>) {
        seeds.into_iter().for_each(|seed| self.push(&seed));
    }

    /// The points `kept`, in that order, without what is the same on every rank.
    pub fn only(&self, kept: &[u32]) -> Self {
        let mut some = Self {
            surface: Surface::default(),
            free_field: Vec::new(),
            ..self.clone()
        };
        some.columns().into_iter().for_each(|column| column.reorder(kept));
        some
    }

    /// Takes the points away whose ids `gone` says.
    pub fn remove(&mut self, gone: impl Fn(u64) -> bool) {
        let stay: Vec<u32> = (0..self.len() as u32).filter(|&p| !gone(self.id[p as usize])).collect();
        if stay.len() < self.len() {
            self.columns().into_iter().for_each(|column| column.reorder(&stay));
        }
    }

    /// What flowed in the last step says nothing of the next one: the ground has changed, or what acts on it.
    pub fn forget_flow(&mut self) {
        (self.content_change, self.gradient_change, self.surface.flowed) = (None, None, None);
    }

    /// Displacements count from here.
    pub fn reset_displacements(&mut self) {
        self.datum = Some(self.u.clone());
    }

    /// Displacement of a point since displacements were last set to zero, m.
    #[inline]
    pub fn displacement(&self, p: usize) -> Vector<D> {
        self.datum.as_ref().map_or(self.u[p], |datum| self.u[p] - datum[p])
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether this rank has no point.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Height at which a point was placed, along the last axis from the grid's lower corner, m.
    #[inline]
    pub fn height(&self, p: usize) -> f64 {
        self.x[p][D - 1] - self.u[p][D - 1]
    }

    /// Logarithm of the volume of the gap at a point.
    #[inline]
    pub fn gap_of(&self, p: usize) -> f64 {
        self.gap.as_ref().map_or(0.0, |gap| gap[p])
    }

    /// What smoothing made of a point's elastic strain after the last step, as a left Cauchy-Green tensor.
    #[inline]
    pub fn smoothing_of(&self, p: usize) -> Symmetric {
        self.smoothing
            .as_ref()
            .map_or(Symmetric::IDENTITY, |smoothing| smoothing.at(p))
    }

    /// State of a point's law; its variables are the first ones.
    #[inline]
    pub fn state_of(&self, p: usize) -> &[f64] {
        self.state.as_ref().map_or(&[], |state| state.of_point(p))
    }

    /// J-bar/J of a point.
    #[inline]
    pub fn dilation_of(&self, p: usize) -> f64 {
        self.dilation.as_ref().map_or(1.0, |dilation| dilation[p])
    }

    /// Every array once.
    pub fn columns(&mut self) -> Vec<&mut dyn Column> {
        self.named_columns().into_iter().map(|(_, column)| column).collect()
    }

    /// Bytes of one point in a message.
    pub fn bytes(&mut self) -> usize {
        self.columns().iter().map(|column| column.bytes()).sum()
    }

    /// Bytes of one point in memory: fewer where the dimension leaves components out, see [`PackedTensors`].
    pub fn memory(&mut self) -> usize {
        self.columns().iter().map(|column| column.memory()).sum()
    }

    /// Sorts by (cell, id), the canonical order: neither migration nor restart then matters to any sum over points.
    /// Points outside the window keep the end.
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
