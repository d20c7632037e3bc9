//! Tests of `bsmpm plot`, `compare`, `validate` and `fos` on synthetic runs.

mod collapse;
mod compare;
mod fos;
mod quasi_static;
mod still;
mod validate;

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bsmpm_io::directory::{ExistingRunPolicy, OutputDirectory};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::Manifest;
use bsmpm_tools::plot::{PlotArguments, draw, run};
use collapse::Collapse;

const LONG: Collapse = Collapse {
    body: [0.2, 0.1],
    grid: [0.55, 0.1025],
    cell: 2.5e-3,
    points: [120, 60],
};
const TALL: Collapse = Collapse {
    body: [2.0, 10.0],
    grid: [5.0, 12.0],
    cell: 0.25,
    points: [40, 200],
};

/// A picture as it is on the disk.
struct Picture {
    width: usize,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap()))
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self {
            width: info.width as usize,
            pixels: bytes.as_chunks().0.to_vec(),
        }
    }

    fn rows(&self) -> impl DoubleEndedIterator<Item = &[[u8; 3]]> + ExactSizeIterator {
        self.pixels.chunks_exact(self.width)
    }

    fn colours(&self) -> usize {
        self.pixels.iter().collect::<HashSet<_>>().len()
    }
}

fn is_coloured(pixel: &[u8; 3]) -> bool {
    pixel.iter().max().unwrap() - pixel.iter().min().unwrap() > 40
}

fn bsmpm(arguments: &[&Path]) -> Output {
    // Without any variable, such as those that lead to fonts.
    Command::new(env!("CARGO_BIN_EXE_bsmpm"))
        .env_clear()
        .arg("plot")
        .args(arguments)
        .output()
        .unwrap()
}

fn code(arguments: &[&Path]) -> i32 {
    let output = bsmpm(arguments);
    assert!(
        output.status.success() || output.stderr.starts_with(b"bsmpm: "),
        "{output:?}"
    );
    output.status.code().unwrap()
}

#[test]
fn every_picture_of_a_run_is_drawn_and_named() {
    for (collapse, times) in [(LONG, vec![0.12, 0.24, 0.6, 9.0]), (TALL, vec![])] {
        let dir = tempfile::tempdir().unwrap();
        collapse.write(dir.path(), &times, true).unwrap();
        let output = bsmpm(&[dir.path()]);
        assert!(output.status.success(), "{output:?}");
        let printed = String::from_utf8(output.stdout).unwrap();
        let paths: Vec<PathBuf> = printed.lines().map(PathBuf::from).collect();
        assert_eq!(paths.len(), 9);
        for path in &paths {
            let picture = Picture::read(path);
            let height = picture.rows().len();
            assert!(
                (900..=1600).contains(&picture.width) && (400..=1700).contains(&height),
                "{}",
                path.display()
            );
            assert!(picture.colours() > 20, "{}", path.display());
            let title = picture.rows().take(60).flatten().filter(|pixel| pixel[0] < 100).count();
            assert!(title > 500, "{} has no title", path.display());
        }
        let manifest = Manifest::read(dir.path()).unwrap();
        let named = manifest
            .outputs
            .iter()
            .filter(|output| output.path.ends_with(".png"))
            .count();
        assert_eq!(named, 9);
        OutputDirectory::hold(dir.path(), Unseen::Respect)
            .and_then(|held| held.claim(ExistingRunPolicy::Delete, &manifest))
            .unwrap();
        assert!(paths.iter().all(|path| !path.exists()));
    }
}

#[test]
fn the_body_is_filled_and_its_colours_mean_the_same_at_all_times() {
    for volumes in [true, false] {
        let dir = tempfile::tempdir().unwrap();
        LONG.write(dir.path(), &[0.12, 0.36, 0.6], volumes).unwrap();
        let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
        assert_eq!(
            names[..3],
            ["stress-yy_0.12.png", "stress-yy_0.36.png", "stress-yy_0.6.png"]
        );
        let pictures: Vec<_> = names[..3]
            .iter()
            .map(|name| Picture::read(&dir.path().join(name)))
            .collect();
        for picture in &pictures {
            // Above the bar of colours, every row of this body is one piece, but for the scallops of its rim.
            let bodies = picture.rows().rev().skip(150).filter(|row| row.iter().any(is_coloured));
            let mut filled = 0;
            let mut white = 0;
            for row in bodies {
                let first = row.iter().position(is_coloured).unwrap();
                let last = row.iter().rposition(is_coloured).unwrap();
                white += row[first..=last].iter().filter(|pixel| **pixel == [255; 3]).count();
                filled += last - first;
            }
            assert!(
                filled > 40_000 && white < filled / 500,
                "{white} of {filled}, volumes: {volumes}"
            );
        }
        let bar = |picture: &Picture| picture.rows().rev().take(100).flatten().copied().collect::<Vec<_>>();
        assert!(pictures.iter().all(|picture| bar(picture) == bar(&pictures[0])));
    }
}

#[test]
fn wanted_times_fields_and_references_are_heeded() {
    let dir = tempfile::tempdir().unwrap();
    LONG.write(dir.path(), &[0.6], true).unwrap();
    let reference = dir.path().join("experiment.csv");
    let plain = Picture::read(&run(&PlotArguments::of(dir.path().to_owned())).unwrap()[1]);
    fs::write(&reference, "# a laboratory\ntime,x,y\n0.6,0.3,0.08\n0.6,0.4,0.08").unwrap();
    let with = |options: &[&str]| {
        let options: Vec<_> = options.iter().map(Path::new).collect();
        bsmpm(&[&[dir.path()], &options[..]].concat())
    };
    let output = with(&[
        "--times",
        "0.25, 0.6 s",
        "--field",
        "displacement",
        "--reference",
        reference.to_str().unwrap(),
    ]);
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(
        printed.contains("displacement_0.24.png") && printed.contains("displacement_0.6.png"),
        "{printed}"
    );
    let compared = Picture::read(&dir.path().join("surface.png"));
    assert_ne!(compared.pixels, plain.pixels);
    assert_eq!(with(&["--field", "colour"]).status.code(), Some(2));
    assert_eq!(with(&["--times", "soon"]).status.code(), Some(2));
}

#[test]
fn what_is_missing_or_damaged_has_its_exit_code() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(code(&[&dir.path().join("nowhere")]), 66);
    assert_eq!(code(&[dir.path()]), 66);
    let file = dir.path().join("file");
    fs::write(&file, "").unwrap();
    assert_eq!(code(&[&file]), 66);

    let run = dir.path().join("run");
    LONG.write(&run, &[], true).unwrap();
    let option = Path::new("--reference");
    assert_eq!(code(&[&run, option, &dir.path().join("nowhere.csv")]), 66);
    assert_eq!(code(&[&run, option, &file]), 65);
    fs::write(run.join("frames/step_000001000.vtu"), "cut").unwrap();
    assert_eq!(code(&[&run]), 74);
    for name in ["frames.pvd", "history.csv", "steps.csv"] {
        fs::remove_file(run.join(name)).unwrap();
    }
    assert_eq!(code(&[&run]), 66);
    fs::write(run.join("run.json"), "{").unwrap();
    assert_eq!(code(&[&run]), 74);
}

#[test]
fn a_run_that_has_just_begun_is_drawn_as_far_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    LONG.write(dir.path(), &[], true).unwrap();
    fs::remove_file(dir.path().join("frames.pvd")).unwrap();
    let first_rows = |name: &str, rows: usize| {
        let text = fs::read_to_string(dir.path().join(name)).unwrap();
        let begin: String = text.split_inclusive('\n').take(2 + rows).collect();
        fs::write(dir.path().join(name), begin).unwrap();
    };
    first_rows("history.csv", 1);
    first_rows("steps.csv", 1);
    let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
    assert_eq!(names, ["runout.png", "stress-noise.png", "convergence.png"]);
    // One step is no line: a disc in either half.
    let picture = Picture::read(&dir.path().join("convergence.png"));
    let coloured: Vec<bool> = picture.rows().map(|row| row.iter().any(is_coloured)).collect();
    assert!(
        coloured
            .chunks(coloured.len() / 2)
            .take(2)
            .all(|half| half.contains(&true))
    );
    first_rows("history.csv", 0);
    first_rows("steps.csv", 0);
    assert_eq!(
        draw(&PlotArguments::of(dir.path().to_owned())).unwrap_err().exit_code(),
        66
    );
}
