//! When frames are wanted.

use bsmpm_scene::Case;
use bsmpm_scene::model::{frame_times, schedule};

fn times(end: &str, every: &str) -> (Vec<f64>, f64) {
    let column = include_str!("../../../cases/short/column_collapse.toml");
    let changes =
        [format!("analysis.end={end}"), format!("output.every={every}"), "output.times=[]".into(), "check=[]".into()];
    let case = Case::from_text("column", column, &changes).unwrap();
    let schedule = schedule(&case);
    (frame_times(&case), std::iter::successors(schedule.next(0.0), |&t| schedule.next(t)).last().unwrap())
}

/// 1.2 / 0.1 is 11.999999999999998, and 12 x 0.1 is 1.2000000000000002.
#[test]
fn the_end_is_the_last_of_equal_parts_of_it() {
    for (end, every, count) in
        [("1.2", "0.1", 12), ("0.3", "0.1", 3), ("0.6", "0.2", 3), ("0.7", "0.1", 7), ("1.0", "0.1", 10)]
    {
        let (found, last) = times(end, every);
        assert_eq!((found.len(), *found.last().unwrap()), (count, last), "{end} by {every}: {found:?}");
        assert_eq!(last, end.parse::<f64>().unwrap());
    }
    assert_eq!(times("1.25", "0.5").0, [0.5, 1.0]);
}
