//! Validates the output of frames, residuals and checkpoints.

use crate::case::{Checkpoint, Every, Format, Output};
use crate::record::Record;
use crate::report::Report;

/// What is wanted; nothing without the table.
pub(super) fn read(root: &Record, end: Option<f64>, report: &mut Report<'_>) -> Option<Output> {
    if !root.gives("output") {
        return Some(nothing());
    }
    let output = root.record("output")?;
    let every = match (output.gives("every"), output.gives("every_steps")) {
        (true, _) => Some(Every::Time(output.number("every")?)),
        (_, true) => Some(Every::Steps(output.count("every_steps")?)),
        _ => None,
    };
    if let (Some(Every::Time(every)), Some(end)) = (every, end) {
        check_interval(output, every, end, report);
    }
    let mut times = if output.gives("times") {
        output.numbers("times")?.to_vec()
    } else {
        Vec::new()
    };
    if let Some(late) = times.iter().find(|time| end.is_some_and(|end| **time > end)) {
        output.error("times", super::history::after_the_end(*late), report);
        return None;
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    let checkpoint = if output.gives("checkpoint") {
        checkpoint(output.record("checkpoint")?)?
    } else {
        Checkpoint::default()
    };
    Some(Output {
        every,
        times,
        format: output.word("format")?,
        residuals: output.flag("residuals")?,
        projected_pressure: output.flag("projected_pressure")?,
        fields: if output.gives("fields") {
            output.choices("fields")?
        } else {
            Vec::new()
        },
        accept: if output.gives("accept") {
            output.choices("accept")?
        } else {
            Vec::new()
        },
        checkpoint,
    })
}

/// Warns of an interval of frames that is longer than the run until `end`, and refuses one that is far too short.
fn check_interval(output: &Record, every: f64, end: f64, report: &mut Report<'_>) {
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
        output.error("every", message, report);
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

fn checkpoint(table: &Record) -> Option<Checkpoint> {
    let every_steps = if table.gives("every_steps") {
        Some(table.count("every_steps")?)
    } else {
        None
    };
    Some(Checkpoint {
        wall: table.number("wall")?,
        every_steps,
        keep: table.count("keep")?,
        at_end: true,
    })
}
