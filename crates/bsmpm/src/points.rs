//! Material points: the permanent state, one array per quantity, sorted by cell.

mod column;
mod packed;

pub use column::{Column, Number, Rows};
pub use packed::{Components, Packed};

use crate::boundary::Surface;
use crate::boundary::anchor::Anchored;
use crate::grid::{Grid, Located};
use crate::tensor::{Symmetric, Tensor, Vector};

/// Velocity and acceleration; absent in quasi-static scenes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion<const D: usize> {
    /// m/s  velocity
    pub v: Vec<Vector<D>>,
    /// m/s2  acceleration
    pub a: Vec<Vector<D>>,
}

/// The material points of one rank. Read-only until a step is committed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points<const D: usize> {
    /// global id, unique over all ranks
    pub id: Vec<u64>,
    /// number of the material
    pub material: Vec<u16>,
    /// m  position from the grid's lower corner
    pub x: Vec<Vector<D>>,
    /// m  displacement since the start
    pub u: Vec<Vector<D>>,
    /// velocity and acceleration
    pub motion: Option<Motion<D>>,
    /// kg (per metre in plane strain)
    pub mass: Vec<f64>,
    /// m^D  reference volume V0; the current one is det F V0
    pub volume: Vec<f64>,
    /// -  deformation gradient
    pub F: Packed<D, Tensor>,
    /// -  elastic left Cauchy-Green tensor that the next step starts from (smoothed under some F-bar methods)
    pub b_e: Packed<D, Symmetric>,
    /// Pa  Cauchy stress of the last converged step
    pub sigma: Packed<D, Symmetric>,
    /// -  accumulated plastic strain
    pub eps_p: Vec<f64>,
    /// -  J-bar/J, J-bar the dilation that the stress has felt, under F-bar from its first step on; before that it is 1
    pub dilation: Option<Vec<f64>>,
    /// -  logarithm of the volume that gapes, where a material closes its gaps, from its first step on; before that it is 0
    pub gap: Option<Vec<f64>>,
    /// state variables of the points' laws, if any law has some
    pub state: Option<Rows>,
    /// what strips and loads carry on; no column: it is the same on every rank
    pub surface: Surface<D>,
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

impl<const D: usize> Located<D> for Points<D> {
    fn places(&self) -> &[Vector<D>] {
        &self.x
    }
    fn id(&self, p: usize) -> u64 {
        self.id[p]
    }
}

impl<const D: usize> Points<D> {
    /// The points as surfaces are anchored to them.
    pub fn anchored(&self) -> Anchored<'_, D> {
        Anchored { id: &self.id, x: &self.x, u: &self.u, F: &self.F }
    }

    /// Stress-free points at rest or with their initial velocity; with `dynamic` they carry velocity and acceleration.
    pub fn from_seeds(seeds: impl IntoIterator<Item = Seed<D>>, dynamic: bool) -> Self {
        let mut points = Self { motion: dynamic.then(Motion::default), ..Self::default() };
        for seed in seeds {
            points.id.push(seed.id);
            points.material.push(seed.material);
            points.x.push(seed.x);
            points.u.push(Vector::zeros());
            points.mass.push(seed.mass);
            points.volume.push(seed.volume);
            points.F.push(Tensor::identity());
            points.b_e.push(Symmetric::IDENTITY);
            points.sigma.push(Symmetric::default());
            points.eps_p.push(0.0);
            if let Some(motion) = &mut points.motion {
                motion.v.push(seed.v);
                motion.a.push(Vector::zeros());
            }
        }
        points
    }

    /// The same points with `width` numbers of state each, at their start: 0. None for 0.
    pub fn with_state(self, width: usize) -> Self {
        let state = (width > 0).then(|| Rows { width, numbers: vec![0.0; width * self.len()] });
        Self { state, ..self }
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

    /// Logarithm of the volume that gapes at a point.
    #[inline]
    pub fn gap_of(&self, p: usize) -> f64 {
        self.gap.as_ref().map_or(0.0, |gap| gap[p])
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

    /// No points, with room for the columns of these names: those that a scene does without are there if they are named.
    /// `state`: numbers that the laws' state consists of.
    pub fn holding(names: &[&str], state: usize) -> Self {
        let has = |name| names.contains(&name);
        Self {
            motion: has("v").then(Motion::default),
            dilation: has("dilation").then(Vec::new),
            gap: has("gap").then(Vec::new),
            state: has("law_state").then(|| Rows::of(state)),
            ..Self::default()
        }
    }

    /// Every array once, by name: sorting, migration and checkpoints walk this list, so that a new state variable is one
    /// line.
    pub fn named_columns(&mut self) -> Vec<(&'static str, &mut dyn Column)> {
        let mut columns: Vec<(&'static str, &mut dyn Column)> = vec![
            ("id", &mut self.id),
            ("material", &mut self.material),
            ("x", &mut self.x),
            ("u", &mut self.u),
            ("mass", &mut self.mass),
            ("volume", &mut self.volume),
            ("F", &mut self.F),
            ("b_e", &mut self.b_e),
            ("sigma", &mut self.sigma),
            ("eps_p", &mut self.eps_p),
        ];
        if let Some(motion) = &mut self.motion {
            columns.push(("v", &mut motion.v));
            columns.push(("a", &mut motion.a));
        }
        if let Some(dilation) = &mut self.dilation {
            columns.push(("dilation", dilation));
        }
        if let Some(gap) = &mut self.gap {
            columns.push(("gap", gap));
        }
        if let Some(state) = &mut self.state {
            columns.push(("law_state", state));
        }
        columns
    }

    /// Every array once.
    pub fn columns(&mut self) -> Vec<&mut dyn Column> {
        self.named_columns().into_iter().map(|(_, column)| column).collect()
    }

    /// Bytes of one point in a message.
    pub fn bytes(&mut self) -> usize {
        self.columns().iter().map(|column| column.bytes()).sum()
    }

    /// Bytes of one point in memory: fewer where the dimension leaves components out, see [`Packed`].
    pub fn memory(&mut self) -> usize {
        self.columns().iter().map(|column| column.memory()).sum()
    }

    /// Sorts by (cell, id), the canonical order: neither migration nor restart then matters to any sum over points.
    /// Points outside the window keep the end.
    pub fn sort_by_cell(&mut self, grid: &Grid<D>) {
        let key = |p: usize| match grid.locate(&self.x[p]) {
            Some(cell) if grid.holds(&cell) => (grid.cell_index(&cell), self.id[p]),
            _ => (usize::MAX, self.id[p]),
        };
        let keys: Vec<(usize, u64)> = (0..self.len()).map(key).collect();
        if keys.is_sorted() {
            return;
        }
        let mut order: Vec<u32> = (0..self.len() as u32).collect();
        order.sort_by_key(|&p| keys[p as usize]);
        for column in self.columns() {
            column.reorder(&order);
        }
    }
}
