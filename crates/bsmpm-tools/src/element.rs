//! `bsmpm element`: simulates laboratory tests on one material point, with [`bsmpm::element`].

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use bsmpm_io::atomic;
use bsmpm_scene::Case;
use clap::Args;

use crate::report::ReportTable;
use crate::{Error, case};

mod course;
mod picture;

use course::StressPath;

/// Which tests.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
A test is a table of the case: a start and stages, each with what is held and what is driven.

  [element.tx100]
  material = \"sand\"
  pressure = \"100 kPa\"
  stage = [{ test = \"triaxial\", compression = 0.1 }]

Tests: triaxial, biaxial, oedometer, isotropic, simple-shear, mixed; triaxial, biaxial, simple-shear and mixed also undrained.
DIR gets NAME.csv, a row a step, and a picture of all tests: compression.png of those along y, shear.png of those in shear.
Stresses are effective ones of Cauchy, positive in tension; pressure, deviator and pore-pressure are p, q and u.
Nothing but the material, at one height, is used of the case; strength_reduction acts on it, and a softening_strain by
its cells. A test needs neither [gravity] nor [initial].

Exit codes: 0 done; 2 command line; 65 the case has errors, or no such test; 66 no such case; 74 a file could not be written;
80 a material cannot carry what a stage asks for: the tables end where it was left.

Examples:
  bsmpm element case.toml
  bsmpm element case.toml tx100 tx200 --set material.sand.friction_angle=36
  bsmpm element case.toml --material till --set element.tx100.pressure=\"200 kPa\"")]
pub struct ElementArguments {
    /// The case file
    pub case: PathBuf,
    /// Names of tests [default: all]
    pub tests: Vec<String>,
    /// The material of all tests, instead of each one's own
    #[arg(long, value_name = "NAME")]
    pub material: Option<String>,
    /// Where the tables and pictures are written [default: the case's stem with .element]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Override one key of the case, as for bsmpm-par; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Computes the tests and writes their tables and pictures; returns a table of all of them and the files. `report` gets
/// what is doubtful, and why a test ended early.
///
/// # Errors
/// [`Error::Missing`] and [`Error::BadCase`] before anything is written, [`Error::Usage`] for names of no test;
/// [`Error::Element`] after all files were written, where a test did not come to its end.
pub fn run(arguments: &ElementArguments, report: impl FnMut(&str)) -> Result<(String, Vec<PathBuf>), Error> {
    let path = &arguments.case;
    let mut set = arguments.set.clone();
    set.extend(
        arguments
            .material
            .iter()
            .map(|name| format!("element.*.material={name:?}")),
    );
    let case = case::parsed_for_element_tests(path, &case::load(path)?, &set)?;
    let courses = chosen(&case, arguments)?;
    let output = arguments
        .output
        .clone()
        .unwrap_or_else(|| case::directory(path, ".element"));
    fs::create_dir_all(&output).map_err(bsmpm_io::Error::file("create", &output))?;
    let mut files = Vec::new();
    for course in &courses {
        let file = output.join(format!("{}.csv", course.name));
        atomic::replace(&file, |text| text.write_all(course.csv().as_bytes()))?;
        files.push(file);
    }
    files.extend(picture::draw(&case.title, &courses, &output)?);
    let failed: Vec<String> = courses
        .iter()
        .filter_map(|course| Some(format!("{}: {}", course.name, course.failure.as_ref()?)))
        .collect();
    if failed.is_empty() {
        return Ok((table(&courses), files));
    }
    table(&courses).lines().for_each(report);
    Err(Error::Element { failed })
}

/// The tests that are wanted, followed to their ends.
fn chosen(case: &Case, arguments: &ElementArguments) -> Result<Vec<StressPath>, Error> {
    let known: Vec<&str> = case.elements.iter().map(|test| test.name.as_str()).collect();
    let path = arguments.case.display();
    if known.is_empty() {
        let reason = format!(
            "E0851: {path} has no element test. Add a table [element.NAME] with its stages; `bsmpm element --help` has an example."
        );
        return Err(Error::Usage { reason });
    }
    if let Some(name) = arguments.tests.iter().find(|name| !known.contains(&name.as_str())) {
        let reason = format!(
            "E0852: {path} has no element test `{name}`. Use one of: {}.",
            known.join(", ")
        );
        return Err(Error::Usage { reason });
    }
    case.elements
        .iter()
        .filter(|test| arguments.tests.is_empty() || arguments.tests.contains(&test.name))
        .map(|test| StressPath::of(case, test))
        .collect()
}

/// A row for each test: where its deviator is largest.
fn table(courses: &[StressPath]) -> String {
    let mut table = ReportTable::of(courses);
    let short = crate::record::short;
    table
        .column("test", |course| &course.name)
        .column("material", |course| &course.material)
        .right("rows", |course| course.rows.len())
        .right("largest q (Pa)", |course| short(course.peak().deviator))
        .right("p there (Pa)", |course| short(course.peak().pressure))
        .right("strain-yy", |course| short(course.peak().strain[1]))
        .right("shear-xy", |course| short(course.peak().strain[3]))
        .right("p at the end (Pa)", |course| short(course.last().pressure))
        .right("volume-strain", |course| short(course.last().volume_strain()));
    table.text("")
}
