//! Chooses the mass matrix (lumped or consistent), and warns if cells are too large to resolve waves.

use crate::case::{Body, Case, MASS, Support};
use crate::report::Report;
use crate::schema::Draft;
use crate::waves::{WaveInput, fewest_cells, inputs};
use crate::words::Word;
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::material::Moduli;
use bsmpm::model::Regime;

/// Part of the cells asked for that are enough: those of a preset are stretched to come out whole.
const WHOLE: f64 = 0.98;

/// Chooses the mass matrix of a dynamic case that gives none: the consistent one where waves matter. Flows and contact
/// keep the lumped one: with the other the run-out of a column changes, and bodies bounce on faces in contact.
pub(super) fn choose_mass(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let is_given = draft.analysis.value().is_none_or(|analysis| analysis.mass.is_given());
    if is_given || case.analysis.regime != Regime::Dynamic || touches(case) {
        return;
    }
    let followed = (0..case.materials.len()).filter(|&number| case.is_followed(number));
    let is_elastic = followed
        .map(|number| &case.materials[number])
        .all(|named| !named.material.yields());
    let reason = match (case.shaking.is_empty(), is_elastic) {
        (false, _) => "waves of [shaking] have the correct speed with it",
        (true, true) => "elastic waves have the correct speed with it",
        (true, false) => return,
    };
    case.analysis.mass = MassMatrix::Consistent;
    report.note(MASS, MassMatrix::Consistent.word(), reason);
}

/// Whether a face, a strip or a rigid body is in contact with material at any time.
fn touches(case: &Case) -> bool {
    let strips = case.footing.iter().map(|footing| footing.contact);
    let mut strips = strips.chain(case.prescribed.iter().map(|prescribed| prescribed.contact));
    case.is_ever(Support::Contact) || !case.rigid.is_empty() || strips.any(|contact| contact.is_some())
}

/// Warns of the input whose waves have the fewest cells, where their speed is wrong by more than 2 %.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.analysis.regime != Regime::Dynamic {
        return;
    }
    let fewest = fewest_cells(case.analysis.mass, case.grid.order);
    let inputs = inputs(draft);
    let cells = inputs.iter().filter_map(|input| Some((input, cells(case, input)?)));
    let Some((input, cells)) = cells
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, cells)| *cells < WHOLE * fewest)
    else {
        return;
    };
    let remedy = match case.analysis.mass {
        MassMatrix::Lumped if cells >= fewest_cells(MassMatrix::Consistent, case.grid.order) && !touches(case) => {
            "Use analysis.mass = \"consistent\", or reduce `grid.cell`"
        }
        _ => "Reduce `grid.cell`",
    };
    let wave = if input.axis.is_some() { "compression" } else { "shear" };
    report.warn(format!(
        "W0680: {}: {wave} waves of {:.3} Hz have {cells:.1} cells per wavelength (at least {fewest} needed), and \
         travel more than 2 % too slowly. {remedy}.",
        input.name, input.frequency
    ));
}

/// Cells in the wavelength of an input in the body where it has fewest.
fn cells(case: &Case, input: &WaveInput) -> Option<f64> {
    let cells = case.bodies.iter().filter_map(|body| cells_in_body(case, input, body));
    cells.reduce(f64::min)
}

/// Cells in the wavelength of an input in a body.
fn cells_in_body(case: &Case, input: &WaveInput, body: &Body) -> Option<f64> {
    let occupied = body.occupied(&case.grid);
    let axes = (0..case.grid.dims()).filter(|axis| input.axis.is_none_or(|along| along == *axis));
    let edges = axes.flat_map(|axis| occupied[axis].clone().map(move |cell| (axis, cell)));
    let longest = edges
        .map(|(axis, cell)| case.grid.axes[axis].cell(cell))
        .fold(0.0, f64::max);
    Some(speed(case, body, input.axis.is_some())? / (input.frequency * longest))
}

/// m/s  speed of elastic waves of shear or compression in a body, at the middle of its height; with the water in its
/// pores if that moves with it.
fn speed(case: &Case, body: &Body, compresses: bool) -> Option<f64> {
    let named = &case.materials[body.material];
    let vertical = case.grid.dims() - 1;
    let [lower, upper] = body.region.corners().map(|corner| corner[vertical]);
    let stiffness = named
        .material
        .relative_stiffness(0.5 * (lower + upper) - case.grid.lower()[vertical]);
    let Moduli { lambda, mu } = named.material.elastic().moduli();
    let soil = case
        .flow
        .as_ref()
        .and_then(|flow| Some((flow.bulk, flow.soils[body.material].as_ref()?)));
    let water = soil.map_or(0.0, |(bulk, soil)| bulk / soil.porosity);
    let modulus = if compresses {
        stiffness * (lambda + 2.0 * mu) + water
    } else {
        stiffness * mu
    };
    Some((modulus / named.density.filter(|density| *density > 0.0)?).sqrt()).filter(|speed| speed.is_finite())
}
