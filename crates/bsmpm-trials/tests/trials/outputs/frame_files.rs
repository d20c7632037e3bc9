//! Tests of frames.

use crate::support::Scratch;
use crate::support::cases::{COLUMN, SLIDING_BLOCK, changed};
use crate::support::results::{all_finite, all_frames, history, ids};
use bsmpm_io::frames;

/// Whatever the ranks, it is of the frames' own points; without being asked for it is not there.
#[test]
fn frames_have_the_projected_pressure_on_request() {
    let scratch = Scratch::with_case(COLUMN);
    let fields = |frame: &bsmpm_io::frame::Frame| -> Vec<String> {
        frame.fields.iter().map(|field| field.name.clone()).collect()
    };
    scratch.mpirun(1, &["case.toml", "-q"]).expect(0);
    let plain = all_frames(&scratch.path("case.out"));
    assert!(
        plain
            .iter()
            .all(|frame| !fields(frame).contains(&"projected_pressure".to_owned()))
    );
    let mut found: Vec<Vec<f64>> = Vec::new();
    for ranks in [1, 2] {
        scratch
            .mpirun(
                ranks,
                &["case.toml", "-q", "--force", "--set", "output.projected_pressure=true"],
            )
            .expect(0);
        let frames = all_frames(&scratch.path("case.out"));
        let last = frames.last().unwrap();
        let [projected, own] = ["projected_pressure", "pressure"].map(|name| last.real(name, 1).unwrap().to_vec());
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!(
            mean(&own) > 0.0 && (mean(&projected) / mean(&own) - 1.0).abs() < 0.02,
            "{} {}",
            mean(&projected),
            mean(&own)
        );
        assert!(projected != own);
        found.push(projected);
    }
    let largest = found[0].iter().copied().fold(0.0, f64::max);
    assert!(
        found[0]
            .iter()
            .zip(&found[1])
            .all(|(a, b)| (a - b).abs() <= 1e-6 * largest)
    );
}

#[test]
fn frames_are_at_the_start_the_wanted_times_and_the_end() {
    let times = "every = \"20 ms\"\ntimes = [\"7.5 ms\", \"33 ms\"]";
    let scratch = Scratch::with_case(&changed(SLIDING_BLOCK, "every = \"20 ms\"", times));
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let directory = scratch.path("case.out");
    let listed: Vec<f64> = frames::read_collection(&directory)
        .unwrap()
        .iter()
        .map(|entry| entry.time)
        .collect();
    assert_eq!(listed, [0.0, 0.0075, 0.02, 0.033, 0.04, 0.05]);
    assert_eq!(
        all_frames(&directory)
            .iter()
            .map(|frame| frame.time)
            .collect::<Vec<_>>(),
        listed
    );
    let times = history(&directory).get("time").unwrap().to_vec();
    assert!(listed.iter().all(|time| times.contains(time)), "hit exactly");
}

#[test]
fn frames_every_so_many_steps_and_without_a_table_come_as_asked() {
    let scratch = Scratch::with_case(&changed(COLUMN, "every = 0.4", "every_steps = 2"));
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let steps = |frames: Vec<bsmpm_io::frame::Frame>| frames.iter().map(|frame| frame.step).collect::<Vec<_>>();
    assert_eq!(steps(all_frames(&scratch.path("case.out"))), [0, 2, 4, 5]);
}

#[test]
fn a_frame_holds_every_point_once_by_id_with_all_its_quantities() {
    let scratch = Scratch::with_case(SLIDING_BLOCK);
    scratch.mpirun(3, &["case.toml", "-q"]).expect(0);
    for frame in all_frames(&scratch.path("case.out")) {
        let ids = ids(&frame);
        assert!(
            ids.len() == 128 && ids.windows(2).all(|pair| pair[0] < pair[1]),
            "{ids:?}"
        );
        let fields: Vec<_> = frame
            .fields
            .iter()
            .map(|field| (field.name.as_str(), field.components))
            .collect();
        for field in [
            ("displacement", 3),
            ("velocity", 3),
            ("stress", 6),
            ("pressure", 1),
            ("plastic_strain", 1),
        ] {
            assert!(fields.contains(&field), "{field:?} in {fields:?}");
        }
        assert!(fields.contains(&("material", 1)));
        let stress = frame.real("stress", 6).unwrap();
        let pressure = frame.real("pressure", 1).unwrap();
        let mean = stress.chunks_exact(6).map(|s| -(s[0] + s[1] + s[2]) / 3.0);
        assert!(
            mean.zip(pressure)
                .all(|(mean, pressure)| (mean - pressure).abs() <= 1e-9 * mean.abs())
        );
        assert!(
            frame
                .position
                .iter()
                .all(|x| x[2] == 0.0 && (0.0..=1.0).contains(&x[0]))
        );
    }
    all_finite(&scratch.path("case.out"));
}

/// Where a point is, less its displacement, is where it began.
#[test]
fn positions_are_in_the_coordinates_of_the_case() {
    let text = changed(
        SLIDING_BLOCK,
        "lower = [0.0, 0.0]\nupper = [1.0, 0.3]",
        "lower = [-0.5, 2.0]\nupper = [0.5, 2.3]",
    );
    let text = changed(
        &text,
        "{ lower = [0.1, 0.0], upper = [0.5, 0.2] }",
        "{ lower = [-0.4, 2.0], upper = [0.0, 2.2] }",
    );
    let scratch = Scratch::with_case(&text);
    scratch.mpirun(2, &["case.toml", "-q"]).expect(0);
    let frames = all_frames(&scratch.path("case.out"));
    let last = frames.last().unwrap();
    let displacement = last.real("displacement", 3).unwrap().chunks_exact(3);
    for ((x, u), start) in last.position.iter().zip(displacement).zip(&frames[0].position) {
        assert!(
            (0..2).all(|axis| (x[axis] - u[axis] - start[axis]).abs() < 1e-12),
            "{x:?} {u:?} {start:?}"
        );
        assert!(
            (-0.4..0.0).contains(&start[0]) && (2.0..2.2).contains(&start[1]),
            "{start:?}"
        );
    }
    let runout = history(&scratch.path("case.out")).get("runout").unwrap()[0];
    assert!((runout + 0.0125).abs() < 1e-12, "{runout}");
}
