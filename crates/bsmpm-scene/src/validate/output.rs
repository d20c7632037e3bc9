//! Validates the output of frames, residuals and checkpoints.

use crate::case::{Checkpoint, Every, Format, Output};
use crate::report::Report;
use crate::schema::{CheckpointTable, Draft, OutputTable};

/// What is wanted; nothing without the table.
pub(super) fn read(draft: &Draft, end: Option<f64>, report: &mut Report<'_>) -> Option<Output> {
    if !draft.output.is_given() {
        return Some(nothing());
    }
    let output = draft.output.value()?;
    let every = match (output.every.is_given(), output.every_steps.is_given()) {
        (true, _) => Some(Every::Time(output.every.get()?)),
        (_, true) => Some(Every::Steps(output.every_steps.get()?)),
        _ => None,
    };
    if let (Some(Every::Time(every)), Some(end)) = (every, end) {
        check_interval(output, every, end, report);
    }
    let mut times = output.times.list()?.to_vec();
    if let Some(late) = times.iter().find(|time| end.is_some_and(|end| **time > end)) {
        output.times.error(super::history::after_the_end(*late), report);
        return None;
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    let checkpoint = if output.checkpoint.is_given() {
        checkpoint(output.checkpoint.value()?)?
    } else {
        Checkpoint::default()
    };
    Some(Output {
        every,
        times,
        format: output.format.get()?,
        residuals: output.residuals.get()?,
        projected_pressure: output.projected_pressure.get()?,
        fields: output.fields.list()?.to_vec(),
        accept: output.accept.list()?.to_vec(),
        checkpoint,
    })
}

/// Warns of an interval of frames that is longer than the run until `end`, and refuses one that is far too short.
fn check_interval(output: &OutputTable, every: f64, end: f64, report: &mut Report<'_>) {
    if every > end {
        report.warn(format!(
            "W0661: output.every: the interval of {every} is longer than the run of {end}, so only the first and \
             last frames are written. Reduce `every`."
        ));
    }
    if end / every > super::MOST_STEPS {
        let message = format!(
            "E0662: with this interval the run would write {:.3e} frames (limit: {:e}). Increase `every`.",
            end / every,
            super::MOST_STEPS
        );
        output.every.error(message, report);
    }
}

fn nothing() -> Output {
    Output {
        every: None,
        times: Vec::new(),
        format: Format::Vtu,
        residuals: false,
        projected_pressure: false,
        fields: Vec::new(),
        accept: Vec::new(),
        checkpoint: Checkpoint::default(),
    }
}

fn checkpoint(table: &CheckpointTable) -> Option<Checkpoint> {
    Some(Checkpoint {
        wall: table.wall.get()?,
        every_steps: table.every_steps.if_given()?,
        keep: table.keep.get()?,
        at_end: true,
    })
}
