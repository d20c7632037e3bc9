//! Reads what the other parts of a case refer to: analysis, grid and bodies, then structures, then loads.

use super::history::CaseBodies;
use super::limit_load::{MovedBodies, shrink};
use super::material::{CaseFacts, Reduction};
use super::site::AroundStrip;
use super::{analysis, body, boundary, contacts, grid, initial, load, material, reduction, rigid, stage, strip};
use crate::case::{
    Analysis, Body, Footing, Gravity, Initial, NamedMaterial, PointLoad, PrescribedMotion, Rigid, Stage, Support,
    Traction,
};
use crate::grid::GridSpec;
use crate::report::Report;
use crate::schema::Draft;
use crate::words::AnalysisType;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::model::Regime;

/// Analysis, grid and bodies of a case, each `None` after an error.
pub(super) struct Domain {
    pub(super) regime: Option<Regime>,
    pub(super) analysis: Option<Analysis>,
    pub(super) boundary: Option<[[Support; 2]; 3]>,
    pub(super) grid: Option<GridSpec>,
    pub(super) bodies: Option<Vec<Body>>,
    /// By which the strength is divided from the start, if it is.
    pub(super) factor: Option<f64>,
    pub(super) stages: Option<Vec<Stage>>,
    pub(super) contacts: Option<[[Option<Contact>; 2]; 3]>,
}

impl Domain {
    /// Reads the tables in the order in which their errors are reported.
    pub(super) fn read(draft: &Draft, report: &mut Report<'_>) -> Self {
        let kind: Option<AnalysisType> = draft.analysis.value().and_then(|analysis| analysis.r#type.get());
        let regime = kind.map(AnalysisType::regime);
        let analysis = analysis(draft, kind, report);
        let boundary = boundary(draft);
        let grid = grid::read(draft, boundary, report);
        let bodies = body::read_all(draft, grid.as_ref(), regime, report);
        let time = analysis.as_ref().map(|analysis| (analysis.end, analysis.dt));
        let factor = reduction::at_start(draft).and_then(|reduction| reduction.factor.get());
        let stages = stage::read_all(draft, factor, bodies.as_deref(), time, report);
        let contacts = contacts(draft, factor, report);
        Self {
            regime,
            analysis,
            boundary,
            grid,
            bodies,
            factor,
            stages,
            contacts,
        }
    }

    /// End of the analysis (s).
    pub(super) fn end(&self) -> Option<f64> {
        self.analysis.as_ref().map(|analysis| analysis.end)
    }

    /// What the case says to strips, loads, drains and inflows.
    pub(super) fn around(&self) -> AroundStrip<'_> {
        let stepped = self
            .analysis
            .as_ref()
            .filter(|analysis| analysis.kind != AnalysisType::Consolidation);
        AroundStrip {
            grid: self.grid.as_ref(),
            bodies: self.bodies.as_deref(),
            boundary: self.boundary,
            factor: self.factor,
            end: self.end(),
            dt: stepped.map(|analysis| analysis.dt),
        }
    }

    /// Materials of the case, with Young's moduli multiplied by a `stiffness`; `None` after an error.
    pub(super) fn materials(
        &self,
        draft: &Draft,
        stiffness: f64,
        report: &mut Report<'_>,
    ) -> Option<Vec<NamedMaterial>> {
        let facts = CaseFacts {
            regime: self.regime,
            geometry: draft.geometry.get(),
            grid: self.grid.as_ref(),
            bodies: self.bodies.as_deref(),
            stages: self.stages.as_deref(),
            reduction: Reduction::of(draft, stiffness),
        };
        material::read_all(draft, facts, report)
    }

    /// The bodies with their materials, if neither have an error.
    pub(super) fn bodies_of<'a>(&'a self, materials: Option<&'a [NamedMaterial]>) -> Option<CaseBodies<'a>> {
        Some(CaseBodies {
            materials: materials?,
            bodies: self.bodies.as_deref()?,
        })
    }
}

/// What moves or holds soil beside the faces of the grid.
pub(super) struct Structures {
    pub(super) footing: Option<Footing>,
    pub(super) prescribed: Vec<PrescribedMotion>,
    pub(super) rigid: Vec<Rigid>,
    /// By which Young's moduli are multiplied for a limit load, whose displacements are divided by it.
    pub(super) stiffness: f64,
}

impl Structures {
    /// Reads footing, prescribed motions and rigid bodies.
    pub(super) fn read(draft: &Draft, domain: &Domain, report: &mut Report<'_>) -> Self {
        let around = domain.around();
        let mut footing = strip::footing(draft, around, report);
        let mut prescribed = strip::prescribed(draft, around, report);
        let mut rigid = rigid::read_all(draft, around, domain.regime, domain.factor, report);
        let moved = MovedBodies {
            footing: footing.as_mut(),
            prescribed: &mut prescribed,
            rigid: &mut rigid,
        };
        let stiffness = shrink(draft, around.grid, moved, report);
        Self {
            footing,
            prescribed,
            rigid,
            stiffness,
        }
    }
}

/// Gravity, surface and point loads, and the initial stress, which is absent if the ground begins without load.
pub(super) struct Loads {
    pub(super) gravity: Option<Gravity>,
    pub(super) tractions: Vec<Traction>,
    pub(super) point_loads: Vec<PointLoad>,
    pub(super) initial: Option<Initial>,
}

impl Loads {
    /// Reads the loads; in ground that begins without load all of them, and those of `rigid`, grow until the end.
    pub(super) fn read(
        draft: &Draft,
        domain: &Domain,
        materials: Option<&[NamedMaterial]>,
        gravity: Option<Gravity>,
        rigid: &mut [Rigid],
        report: &mut Report<'_>,
    ) -> Self {
        let around = domain.around();
        let tractions = load::tractions(draft, around, report);
        let point_loads = load::point_loads(draft, around, report);
        let initial = initial::initial(draft, materials, around.bodies, gravity.as_ref(), domain.regime, report);
        let mut loads = Self {
            gravity,
            tractions,
            point_loads,
            initial,
        };
        if let Some(end) = around.end.filter(|_| load::is_unloaded(draft)) {
            loads.initial = None;
            let gravity = loads.gravity.as_mut();
            load::grow(
                gravity,
                &mut loads.tractions,
                &mut loads.point_loads,
                rigid,
                end,
                report,
            );
        }
        loads
    }
}
