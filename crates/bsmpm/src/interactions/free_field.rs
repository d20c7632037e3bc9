//! Free-field boundaries: before each step, every rank advances a soil column, whose stress and velocity act on a side
//! of the grid, theory-manual equations (T6.14), (T6.15).

mod tied;

use crate::boundary::{AnchoredPoints, Boundary, Support};
use crate::dynamics::newmark::Newmark;
use crate::error::StepError;
use crate::grid::{Grid, KnotVector, Shape, transfer};
use crate::initial;
use crate::interactions::absorbing::{ColumnAction, less};
use crate::interactions::state::{InteractionState, SoilColumn};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::solve;
use crate::step::adjoint::Pressures;
use crate::step::commit;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::report::Counts;
use crate::step::trial::DeformationIncrement;
use crate::tensor::Vector;
use tied::{Band, TiedHalo};

/// Free-field columns after a step, and their action on the faces that they drive.
#[derive(Clone, Debug, Default)]
pub struct FreeField<const D: usize> {
    /// Columns at the end of the step.
    pub columns: Vec<SoilColumn<D>>,
    /// Action of each column.
    pub actions: Vec<ColumnAction<D>>,
}

impl<const D: usize> FreeField<D> {
    /// Advances every column over the interval. Each rank computes all columns. In their first step, columns are copied
    /// from the material `points` next to the faces, with two reductions per face. Empty without free-field faces.
    pub fn after<K: Kinematics<D>>(
        model: &Model<K, D>,
        points: &Points<D>,
        state: &InteractionState<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let mut field = Self::default();
        let followers = model.boundary.absorbing().enumerate().filter(|(_, face)| face.follows);
        for (number, (face, support)) in followers.enumerate() {
            let alone = beside(model, support)?;
            let (column, start) = match state.columns.get(number) {
                Some(column) => (column.clone(), None),
                None => {
                    let column = copied(model, &alone, support, points, halo);
                    begin(&alone, support, column, state, interval.start)?
                }
            };
            let (column, action) = advance(&alone, support, column, interval)?;
            field.actions.push(ColumnAction { face, start, ..action });
            field.columns.push(column);
        }
        Ok(field)
    }
}

/// Updates columns and held forces at time `t` after a stage has changed the ground. The columns act all along, so
/// their forces are subtracted from the new held forces. The forces at a column's base are recomputed, because the base
/// may have become absorbing.
pub fn go_on<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    state: &mut InteractionState<D>,
    t: f64,
) -> Result<(), StepError> {
    let followers = model.boundary.absorbing().enumerate().filter(|(_, face)| face.follows);
    for ((face, support), column) in followers.zip(&mut state.columns) {
        let now = hold(&beside(model, support)?, support, column, t)?;
        if let Some(held) = state.held.get_mut(face) {
            *held = less(held, Some(&now));
        }
    }
    Ok(())
}

/// Returns the model of the column next to a face: one cell wide, with the supports of the other axes.
fn beside<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, face: &Support<D>) -> Result<Model<K, D>, StepError> {
    let mut axes = model.grid.axes().clone();
    let axis = face.axis;
    debug_assert!(axis == 0, "layers of nodes across axis 0 are tied");
    let width = model.grid.axes()[axis].breakpoint(face.last_cell(&model.grid) + 1)
        - model.grid.axes()[axis].breakpoint(face.last_cell(&model.grid));
    // Neither call fails, because the axes come from a valid grid.
    axes[axis] = KnotVector::uniform(width, 1, model.grid.order()).map_err(|_| StepError::OtherRank)?;
    let grid = Grid::new(axes).map_err(|_| StepError::OtherRank)?;
    let grid = grid.reaching(model.grid.beyond());
    let supports = model
        .boundary
        .supports
        .iter()
        .filter(|support| support.axis != axis)
        .copied()
        .collect();
    let boundary = Boundary {
        supports,
        reach: model.boundary.reach.clone(),
        ..Boundary::default()
    };
    Ok(Model {
        grid,
        boundary,
        balances_energy: false,
        ..model.clone()
    })
}

/// Column with its force on the nodes of the face (N) under the initial stress, if there is any.
type StartedColumn<const D: usize> = (SoilColumn<D>, Option<Vec<Vector<D>>>);

/// Copies the material points next to a face into the column. Two reductions.
fn copied<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    alone: &Model<K, D>,
    face: &Support<D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Points<D> {
    let last = face.last_cell(&model.grid);
    let at_face = (0..points.len()).filter(|&p| {
        let cell = model.grid.locate(&points.x[p]);
        cell.is_some_and(|cell| cell[face.axis] == last)
    });
    let own: Vec<u32> = at_face.map(|p| p as u32).collect();
    let mut column = everywhere(points.only(&own), halo);
    let lower = model.grid.axes()[face.axis].breakpoint(last);
    column.x.iter_mut().for_each(|x| x[face.axis] -= lower);
    column.sort_by_cell(&alone.grid);
    column
}

/// Starts the column at time `t`, when the ground has the `state`, and computes its force on the face (N) if there is
/// initial stress.
fn begin<K: Kinematics<D>, const D: usize>(
    alone: &Model<K, D>,
    face: &Support<D>,
    points: Points<D>,
    state: &InteractionState<D>,
    t: f64,
) -> Result<StartedColumn<D>, StepError> {
    let mut column = SoilColumn {
        points,
        state: InteractionState::default(),
    };
    if state.held.is_empty() {
        return Ok((column, None));
    }
    let force = hold(alone, face, &mut column, t)?;
    Ok((column, Some(force)))
}

/// Computes the forces that hold a column in equilibrium at time `t` where its base absorbs. Returns its force on the
/// face (N).
fn hold<K: Kinematics<D>, const D: usize>(
    alone: &Model<K, D>,
    face: &Support<D>,
    column: &mut SoilColumn<D>,
    t: f64,
) -> Result<Vec<Vector<D>>, StepError> {
    let SoilColumn { points, state } = column;
    let tied = TiedHalo::of(&alone.grid);
    let mut solver = Band::of(&alone.grid);
    state.held.clear();
    initial::hold_at(alone, points, state, t, &tied, &mut solver)?;
    for held in &mut state.held {
        let row = held.len() / (alone.grid.order() + 1);
        let first = held[..row].to_vec();
        held.chunks_exact_mut(row)
            .for_each(|layer| layer.copy_from_slice(&first));
    }
    let shape = Shape::at(&alone.grid, points)?;
    let instant = TimeInterval { start: t, dt: 0.0 };
    let nodes = GridState::from_points(alone, &shape, points, state, instant, &tied)?;
    let problem = Problem {
        model: alone,
        shape: &shape,
        nodes: &nodes,
        points,
        halo: &tied,
    };
    let trial = DeformationIncrement::of(
        alone,
        &shape,
        &nodes,
        points,
        &vec![0.0; nodes.constraints.free.len()],
        &tied,
    );
    force(&problem, &trial, face)
}

/// Broadcasts the material points of the one rank that has any. Two reductions.
fn everywhere<const D: usize>(mut own: Points<D>, halo: &dyn Halo) -> Points<D> {
    let mut message = Vec::new();
    for p in 0..own.len() {
        own.columns().into_iter().for_each(|column| column.put(p, &mut message));
    }
    let mut length = [message.len() as f64];
    halo.all_reduce_sum(&mut length);
    let mut bytes: Vec<f64> = message.iter().map(|&byte| f64::from(byte)).collect();
    bytes.resize(length[0] as usize, 0.0);
    halo.all_reduce_sum(&mut bytes);
    let message: Vec<u8> = bytes.iter().map(|&byte| byte as u8).collect();
    let mut all = own.only(&[]);
    let mut rest = &message[..];
    while !rest.is_empty() {
        all.columns().into_iter().for_each(|column| column.take(&mut rest));
    }
    all
}

/// Advances a column by one step, and returns it with its action on the face.
fn advance<K: Kinematics<D>, const D: usize>(
    alone: &Model<K, D>,
    face: &Support<D>,
    column: SoilColumn<D>,
    interval: TimeInterval,
) -> Result<(SoilColumn<D>, ColumnAction<D>), StepError> {
    let SoilColumn { mut points, state } = column;
    let tied = TiedHalo::of(&alone.grid);
    let mut solver = Band::of(&alone.grid);
    let shape = Shape::at(&alone.grid, &points)?;
    let nodes = mapped(alone, &shape, &points, &state, interval, &tied)?;
    let problem = Problem {
        model: alone,
        shape: &shape,
        nodes: &nodes,
        points: &points,
        halo: &tied,
    };
    let guess: Vec<f64> = nodes
        .inertia
        .iter()
        .flat_map(|inertia| inertia.v.iter().map(|v| v * interval.dt))
        .collect();
    let found = solve::find(&problem, &guess, None, &mut solver, &mut Counts::default())?;
    let ground = AnchoredPoints {
        points: &points,
        anchors: &state.anchors,
    };
    commit::check_inside(alone, &shape, ground, &found.u, &tied)?;
    let force = force(&problem, &found.trial, face)?;
    let inertia = nodes.inertia.as_ref();
    let layer = tied.owned().places::<D>();
    let velocity = layer.map(|c| inertia.map_or(0.0, |inertia| inertia.velocity(c, found.u[c])));
    let velocity: Vec<f64> = velocity.collect();
    let velocity = velocity.chunks_exact(D).map(Vector::from_column_slice).collect();
    let update = commit::constitutive_update(alone, &found.trial, &points, &tied)?;
    let across: Vec<f64> = points.x.iter().map(|x| x[face.axis]).collect();
    commit::update_points(alone, &shape, &nodes, found, update, &mut points, &tied);
    // The state is uniform across the column, so its points keep their position normal to the face.
    points
        .x
        .iter_mut()
        .zip(across)
        .for_each(|(x, across)| x[face.axis] = across);
    points.sort_by_cell(&alone.grid);
    Ok((
        SoilColumn { points, state },
        ColumnAction {
            face: 0,
            force,
            start: None,
            velocity,
        },
    ))
}

/// Returns the grid state of a column for a step. The first step at time 0 uses a dissipative integration if the forces
/// are out of balance.
fn mapped<K: Kinematics<D>, const D: usize>(
    alone: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    state: &InteractionState<D>,
    interval: TimeInterval,
    tied: &TiedHalo,
) -> Result<GridState<D>, StepError> {
    let mut nodes = GridState::from_points(alone, shape, points, state, interval, tied)?;
    if let Some(inertia) = nodes.inertia.as_mut().filter(|_| interval.start == 0.0)
        && initial::is_pushed(alone, points, state, tied)?
    {
        inertia.newmark = Newmark::for_sudden_load();
    }
    Ok(nodes)
}

/// Computes the force of the column's stress on every node of the face (N). It uses the same flux as the internal
/// forces of the ground, so that both balance where ground and column move alike.
fn force<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    trial: &DeformationIncrement<K, D>,
    face: &Support<D>,
) -> Result<Vec<Vector<D>>, StepError> {
    let Problem {
        model,
        shape,
        points,
        halo,
        ..
    } = *problem;
    let pressures = Pressures::of(problem, trial);
    let volume = problem.volume();
    let width = model.grid.axes()[face.axis].length();
    let outward = if face.upper { 1.0 } else { -1.0 };
    let mut fluxes: Vec<[f64; D]> = Vec::with_capacity(points.len());
    for (p, &volume) in volume.iter().enumerate() {
        let response = trial.respond(model, points, p);
        let response = response.map_err(|source| StepError::Material {
            id: points.id[p],
            source,
        })?;
        let tau = pressures.acting::<K, D>(p, volume, response.tau());
        let flux = K::flux(&trial.damped(model, points, p, &response, tau), &trial.dF(p));
        fluxes.push(std::array::from_fn(|i| outward * flux[(i, face.axis)] * volume / width));
    }
    let nodal = halo.assemble_ghosts(&transfer::to_nodes::<D, D>(shape, |p| fluxes[p]));
    Ok(halo
        .owned()
        .nodes()
        .map(|node| Vector::from_column_slice(&nodal[Nodal::<D>::of(node)]))
        .collect())
}
