//! Tests the times of frames and steps.

use bsmpm_scene::Case;
use bsmpm_scene::model::{frame_times, schedule};

fn times(end: &str, every: &str) -> (Vec<f64>, f64) {
    let column = include_str!("../../../cases/short/column_collapse.toml");
    let changes = [
        format!("analysis.end={end}"),
        format!("output.every={every}"),
        "output.times=[]".into(),
        "check=[]".into(),
    ];
    let case = Case::from_text("column", column, &changes).unwrap();
    let schedule = schedule(&case);
    (
        frame_times(&case),
        std::iter::successors(schedule.next(0.0), |&t| schedule.next(t))
            .last()
            .unwrap(),
    )
}

/// 1.2 / 0.1 is 11.999999999999998, and 12 x 0.1 is 1.2000000000000002.
#[test]
fn the_end_is_the_last_of_equal_parts_of_it() {
    for (end, every, count) in [
        ("1.2", "0.1", 12),
        ("0.3", "0.1", 3),
        ("0.6", "0.2", 3),
        ("0.7", "0.1", 7),
        ("1.0", "0.1", 10),
    ] {
        let (found, last) = times(end, every);
        assert_eq!(
            (found.len(), *found.last().unwrap()),
            (count, last),
            "{end} by {every}: {found:?}"
        );
        assert_eq!(last, end.parse::<f64>().unwrap());
    }
    assert_eq!(times("1.25", "0.5").0, [0.5, 1.0]);
}

/// A step over a row would take what is given there for a straight way.
#[test]
fn where_water_flows_steps_end_where_what_is_given_turns() {
    let column = include_str!("../../../cases/validation/terzaghi.toml");
    let found = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|change| (*change).into()).collect();
        let case = Case::from_text("column", column, &changes).unwrap();
        let schedule = schedule(&case);
        std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).collect::<Vec<f64>>()
    };
    let pulse = "[[0, 0], [1e5, 0], [1.01e5, 1], [1.1e5, 0]]";
    let growing = [
        "analysis.dt=1e3",
        "analysis.dt_max=1e9",
        "analysis.growth=1.2",
        "output.times=[]",
    ];
    let plain = found(&growing);
    let given = [
        format!("traction.0.amplitude={pulse}"),
        "traction.0.ramp=1.1e5".into(),
        format!("drain.0.head_path={pulse}"),
        format!(
            "water={{ level_path = {pulse} }}\ngravity={{ acceleration = [0, -9.81] }}\nmaterial.clay.unit_weight=2e4"
        ),
        "prescribed=[{ face = \"left\", path = [[1e5, 0, 0], [1.1e5, 1e-6, 0]] }]\nboundary.left=free".into(),
    ];
    for given in &given {
        let steps = found(&growing.into_iter().chain(given.lines()).collect::<Vec<_>>());
        assert!(steps.contains(&1.1e5) && !plain.contains(&1.1e5), "{given}: {steps:?}");
        assert!(steps.contains(&1e5) || given.contains("ramp"), "{given}: {steps:?}");
    }
    // A rate has its mean over a step.
    let rain = format!("inflow=[{{ from = [0, 0.2], to = [0, 0.8], rate_path = {pulse} }}]");
    assert_eq!(found(&[&growing[..], &[&rain]].concat()), plain);
}
