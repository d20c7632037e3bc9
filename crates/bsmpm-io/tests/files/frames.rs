//! Tests frames and their list.

use bsmpm_io::frame::{Field, FieldValues, Frame, Parts};
use bsmpm_io::frames::{Frames, read_collection};
use bsmpm_io::manifest::{Manifest, ManifestCase};
use bsmpm_io::{Error, vtu};

use crate::listing;
use std::path::Path;

/// Numbers whose bits a careless writer would lose.
const DELICATE: [f64; 6] = [0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1.0 / 3.0, -1e-7];

fn frame(points: usize) -> Frame {
    let delicate = |count: usize| (0..count).map(|i| DELICATE[i % DELICATE.len()]).collect::<Vec<_>>();
    Frame {
        step: 1 << 40,
        time: 0.1 + 0.2,
        position: (0..points).map(|p| [p as f64 / 3.0, DELICATE[p % 6], 0.0]).collect(),
        fields: vec![
            Field::real("velocity", 3, delicate(3 * points)),
            Field::real("stress", 6, delicate(6 * points)),
            Field::real("pressure", 1, delicate(points)),
            Field {
                name: "material".into(),
                components: 1,
                values: FieldValues::U16(vec![65_535; points]),
            },
            Field {
                name: "id".into(),
                components: 1,
                values: FieldValues::U64((0..points as u64).map(|p| u64::MAX - p).collect()),
            },
        ],
    }
}

fn bits(frame: &Frame) -> Vec<u64> {
    let mut bits: Vec<_> = frame
        .position
        .as_flattened()
        .iter()
        .map(|value| value.to_bits())
        .collect();
    for (name, components) in [("velocity", 3), ("stress", 6), ("pressure", 1)] {
        bits.extend(
            frame
                .real(name, components)
                .unwrap()
                .iter()
                .map(|value| value.to_bits()),
        );
    }
    bits.push(frame.time.to_bits());
    bits
}

#[test]
fn a_frame_reads_back_to_the_bit() {
    let dir = tempfile::tempdir().unwrap();
    for points in [0, 1, 1000] {
        let path = dir.path().join(format!("{points}.vtu"));
        let written = frame(points);
        vtu::write(&path, &written).unwrap();
        let read = vtu::read(&path).unwrap();
        assert_eq!(bits(&read), bits(&written));
        assert_eq!(read, written);
    }
}

/// The points `range` of a frame.
fn part(frame: &Frame, range: std::ops::Range<usize>) -> Frame {
    let mut part = frame.without_points();
    part.position = frame.position[range.clone()].to_vec();
    for (to, from) in part.fields.iter_mut().zip(&frame.fields) {
        let numbers = range.start * from.components..range.end * from.components;
        to.values = match &from.values {
            FieldValues::F64(values) => FieldValues::F64(values[numbers].to_vec()),
            FieldValues::U64(values) => FieldValues::U64(values[numbers].to_vec()),
            FieldValues::U16(values) => FieldValues::U16(values[numbers].to_vec()),
        };
    }
    part
}

/// Writes `announced` points of which `frame` has `parts`.
fn write_parts(path: &Path, frame: &Frame, announced: usize, parts: &[std::ops::Range<usize>]) -> Result<(), Error> {
    let mut parts = parts.iter().map(|range| part(frame, range.clone()));
    vtu::write_parts(
        path,
        Parts {
            head: frame.without_points(),
            points: announced,
            names: &[],
            next: &mut || parts.next(),
        },
    )
}

#[test]
fn a_frame_has_the_same_bytes_in_whatever_parts_it_comes() {
    let dir = tempfile::tempdir().unwrap();
    let whole = dir.path().join("whole.vtu");
    let apart = dir.path().join("apart.vtu");
    let frame = frame(1000);
    vtu::write(&whole, &frame).unwrap();
    for parts in [&[0..1, 1..1, 1..999, 999..1000][..], &[0..333, 333..666, 666..1000]] {
        write_parts(&apart, &frame, 1000, parts).unwrap();
        assert!(
            std::fs::read(&whole).unwrap() == std::fs::read(&apart).unwrap(),
            "{parts:?}"
        );
    }
}

#[test]
fn a_frame_of_other_than_the_announced_points_replaces_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("frame.vtu");
    vtu::write(&path, &frame(3)).unwrap();
    let before = std::fs::read(&path).unwrap();
    for (announced, parts) in [(9, [0..4, 4..8]), (9, [0..5, 5..10]), (0, [0..1, 1..2])] {
        let refused = write_parts(&path, &frame(10), announced, &parts).unwrap_err();
        assert!(
            matches!(refused, Error::Length { expected, .. } if expected == announced),
            "{refused}"
        );
    }
    let mut bad = frame(10);
    bad.position[7][0] = f64::NAN;
    assert!(matches!(
        write_parts(&path, &bad, 10, &[0..5, 5..10]),
        Err(Error::PointNotFinite { .. })
    ));
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(listing(dir.path()), ["frame.vtu"]);
}

#[test]
fn the_bytes_of_a_point_are_those_that_a_frame_grows_by() {
    let dir = tempfile::tempdir().unwrap();
    let size = |points: usize| {
        let path = dir.path().join("frame.vtu");
        vtu::write(&path, &frame(points)).unwrap();
        std::fs::metadata(&path).unwrap().len()
    };
    // As many digits in both heads.
    let grown = size(2000) - size(1000);
    let head = grown.abs_diff(1000 * vtu::point_bytes(&frame(0)));
    assert!(head < 32, "{head} bytes of longer offsets");
}

#[test]
fn a_number_that_is_not_finite_is_named_and_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("bad.vtu");
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut bad = frame(9);
        let FieldValues::F64(stress) = &mut bad.fields[1].values else {
            unreachable!()
        };
        stress[6 * 7 + 3] = value;
        match vtu::write(&path, &bad) {
            Err(Error::PointNotFinite {
                field,
                component: 3,
                point,
                ..
            }) => {
                assert_eq!((field.as_str(), point), ("stress", u64::MAX - 7));
            }
            other => panic!("{other:?}"),
        }
        let mut bad = frame(2);
        bad.position[1][2] = value;
        assert!(matches!(vtu::write(&path, &bad), Err(Error::PointNotFinite { .. })));
        bad = Frame {
            time: value,
            ..frame(2)
        };
        assert_eq!(vtu::write(&path, &bad).unwrap_err().exit_code(), 81);
    }
    assert_eq!(listing(dir.path()), [""; 0]);
}

#[test]
fn fields_that_do_not_fit_are_refused() {
    let path = tempfile::tempdir().unwrap().path().join("bad.vtu");
    let mut short = frame(3);
    short.fields.push(Field::real("volume", 1, vec![1.0; 2]));
    assert!(matches!(
        vtu::write(&path, &short),
        Err(Error::Length {
            expected: 3,
            found: 2,
            ..
        })
    ));
    for name in ["", "a\"b", "a<b", "velocity"] {
        let mut named = frame(1);
        named.fields.push(Field::real(name, 1, vec![1.0]));
        assert!(matches!(vtu::write(&path, &named), Err(Error::Name { .. })), "{name}");
    }
}

#[test]
fn a_damaged_frame_is_an_error_wherever_it_is_cut() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("frame.vtu");
    vtu::write(&path, &frame(5)).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let data = whole.windows(2).position(|pair| pair == b"\n_").unwrap();
    for length in (0..data + 500).step_by(7) {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(matches!(vtu::read(&path), Err(Error::Format { .. })), "cut at {length}");
    }
    let mut huge = whole.clone();
    huge[data + 2..data + 10].copy_from_slice(&u64::MAX.to_le_bytes());
    std::fs::write(&path, &huge).unwrap();
    assert!(matches!(vtu::read(&path), Err(Error::Format { .. })));
}

#[test]
fn the_list_names_every_frame_with_its_exact_time() {
    let dir = tempfile::tempdir().unwrap();
    let mut frames = Frames::create(dir.path()).unwrap();
    let times = [0.0, 0.1 + 0.2, 0.607];
    for (step, time) in times.into_iter().enumerate() {
        frames
            .write(&Frame {
                step: step as u64,
                time,
                ..frame(2)
            })
            .unwrap();
    }
    frames
        .write(&Frame {
            step: 2,
            time: 0.607,
            ..frame(3)
        })
        .unwrap();
    let bad = Frame {
        step: 3,
        time: f64::NAN,
        ..frame(2)
    };
    assert!(frames.write(&bad).is_err());
    let entries = read_collection(dir.path()).unwrap();
    assert_eq!(entries, frames.entries());
    assert_eq!(entries.iter().map(|entry| entry.time).collect::<Vec<_>>(), times);
    assert_eq!(entries[1].file, Frames::file(1));
    assert_eq!(listing(dir.path()).len(), 4);
}

#[test]
fn a_list_that_leads_out_of_the_directory_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    for file in ["../secret.vtu", "/etc/passwd", "frames/../../a.vtu", ""] {
        let text = format!("<VTKFile><DataSet timestep=\"0\" file=\"{file}\"/></VTKFile>");
        std::fs::write(dir.path().join("frames.pvd"), text).unwrap();
        assert!(
            matches!(read_collection(dir.path()), Err(Error::Format { .. })),
            "{file}"
        );
    }
}

#[test]
fn the_list_goes_on_with_the_frames_that_are_there() {
    let dir = tempfile::tempdir().unwrap();
    let mut frames = Frames::create(dir.path()).unwrap();
    for step in 0..4 {
        frames
            .write(&Frame {
                step,
                time: step as f64,
                ..frame(2)
            })
            .unwrap();
    }
    let entries = frames.entries().to_vec();
    std::fs::remove_file(dir.path().join(Frames::file(1))).unwrap();
    let mut again = Frames::resume(dir.path(), entries[..3].to_vec()).unwrap();
    assert_eq!(
        read_collection(dir.path()).unwrap(),
        [entries[0].clone(), entries[2].clone()]
    );
    again
        .write(&Frame {
            step: 3,
            time: 3.0,
            ..frame(2)
        })
        .unwrap();
    assert_eq!(again.entries().len(), 3);
}

/// A manifest, and a step's frame in two parts.
fn begin(frames: &mut Frames, manifest: &mut Manifest, step: u64, points: usize) -> Result<(), Error> {
    let frame = Frame {
        step,
        time: step as f64,
        ..frame(points)
    };
    let mut parts = [0..1, 1..points].into_iter().map(|range| part(&frame, range));
    manifest.name_output(&Frames::file(step));
    let parts = Parts {
        head: frame.without_points(),
        points,
        names: &[],
        next: &mut || parts.next(),
    };
    frames.begin(parts, manifest).map(|ended| manifest.complete(ended))
}

#[test]
fn frames_that_a_thread_ends_are_those_that_are_written_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let case = ManifestCase::new("a.toml", "A", "plane-strain", String::new());
    let mut manifest = Manifest::begin("0.1.0", vec![], case);
    std::fs::create_dir(dir.path().join("frames")).unwrap();
    std::fs::write(
        dir.path().join("frames/.step_000000007.vtu.tmp"),
        "what a killed run has left",
    )
    .unwrap();
    let mut frames = Frames::create(dir.path()).unwrap();
    // A burst of them, the last one of a step that is there already.
    let steps = (10..210)
        .map(|step| (step, 2))
        .chain([(0, 2), (1, 3), (2, 4), (3, 5), (3, 6)]);
    for (step, points) in steps {
        begin(&mut frames, &mut manifest, step, points).unwrap();
        let names = std::fs::read_dir(dir.path().join("frames")).unwrap();
        let open = names.filter(|name| name.as_ref().unwrap().file_name().as_encoded_bytes().starts_with(b"."));
        assert!(open.count() <= 40, "files that are open");
    }
    let ended = frames.ended(true).unwrap();
    manifest.complete(ended);
    assert_eq!(read_collection(dir.path()).unwrap(), frames.entries());
    assert_eq!(
        frames.entries()[200..]
            .iter()
            .map(|entry| entry.time)
            .collect::<Vec<_>>(),
        [0.0, 1.0, 2.0, 3.0]
    );
    assert_eq!(vtu::read(&dir.path().join(Frames::file(3))).unwrap().position.len(), 6);
    for output in &manifest.outputs {
        let bytes = std::fs::read(dir.path().join(&output.path)).unwrap();
        assert_eq!(output.bytes, Some(bytes.len() as u64), "{output:?}");
        assert_eq!(
            output.blake3,
            Some(blake3::hash(&bytes).to_hex().to_string()),
            "{output:?}"
        );
    }
    let named = Manifest::read(dir.path()).unwrap().outputs;
    assert!(
        named
            .iter()
            .map(|output| &output.path)
            .eq(manifest.outputs.iter().map(|output| &output.path))
    );
    assert_eq!(
        std::fs::read_dir(dir.path().join("frames")).unwrap().count(),
        204,
        "no temporary file"
    );
    assert!(frames.ended(true).unwrap().is_empty());
}

#[test]
fn what_a_thread_could_not_end_is_an_error_of_the_next_frame_or_of_the_end() {
    let dir = tempfile::tempdir().unwrap();
    let case = ManifestCase::new("a.toml", "A", "plane-strain", String::new());
    let mut manifest = Manifest::begin("0.1.0", vec![], case);
    let mut frames = Frames::create(dir.path()).unwrap();
    // A folder of that name is in the way of the file.
    std::fs::create_dir(dir.path().join(Frames::file(1))).unwrap();
    begin(&mut frames, &mut manifest, 0, 2).unwrap();
    let ended = frames.ended(true).unwrap();
    assert_eq!(ended.len(), 1);
    begin(&mut frames, &mut manifest, 1, 2).unwrap();
    // What is behind it is lost with it.
    let behind = begin(&mut frames, &mut manifest, 2, 2);
    let failed = frames.ended(true);
    assert!(behind.is_err() != failed.is_err(), "{behind:?} {failed:?}");
    assert!(frames.ended(true).unwrap().is_empty());
    assert_eq!(frames.entries().len(), 1);
    assert_eq!(
        read_collection(dir.path()).unwrap().len(),
        1,
        "it lists the frames before only"
    );
    assert_eq!(listing(&dir.path().join("frames")).len(), 1, "no temporary file");
}
