//! A synthetic run of a slumping column.

use std::f64::consts::PI;
use std::path::Path;

use bsmpm_io::directory::{ExistingRunPolicy, HISTORY, OutputDirectory};
use bsmpm_io::frame::{Field, FieldValues, Frame};
use bsmpm_io::frames::{COLLECTION, Frames};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::{GridExtent, Manifest, ManifestCase, Status};
use bsmpm_io::steps::{STEPS, StepRow};
use bsmpm_io::table::{Cell, CsvTable, TableColumn};

/// What slumps, and how finely.
pub struct Collapse {
    /// m  width and height of the column.
    pub body: [f64; 2],
    /// m  upper corner of the grid, whose lower one is the origin.
    pub grid: [f64; 2],
    /// m
    pub cell: f64,
    /// Points along each axis of the body.
    pub points: [usize; 2],
}

const END: f64 = 0.6;
const FRAMES: u64 = 6;
const STEPS_PER_FRAME: u64 = 200;

impl Collapse {
    /// Writes the run into `directory`; with `volumes` the frames hold those of the points.
    pub fn write(&self, directory: &Path, picture_times: &[f64], volumes: bool) -> Result<(), bsmpm_io::Error> {
        let title = "Granular column collapse, Xie et al. (2023), section 3.1";
        let mut manifest = Manifest::begin(
            "0.1.0",
            vec!["bsmpm-par".to_owned(), "collapse.toml".to_owned()],
            ManifestCase::new("collapse.toml", title, "plane-strain", format!("title = \"{title}\"\n")),
        );
        manifest.picture_times = picture_times.to_vec();
        manifest.grid = Some(GridExtent {
            lower: vec![0.0; 2],
            upper: self.grid.to_vec(),
            cell: vec![self.cell; 2],
        });
        let directory = OutputDirectory::hold(directory, Unseen::Respect)
            .and_then(|held| held.claim(ExistingRunPolicy::Refuse, &manifest))?;
        let mut frames = Frames::create(directory.path())?;
        for index in 0..FRAMES {
            let frame = self.frame(index, volumes);
            manifest.name_output(&Frames::file(frame.step));
            frames.write(&frame)?;
        }
        self.write_tables(directory.path())?;
        for file in [COLLECTION, HISTORY, STEPS] {
            manifest.name_output(file);
        }
        manifest.finish(Status::Finished, 0);
        manifest.seal(directory.path())?;
        manifest.write(directory.path())
    }

    /// How far the slump has gone, from 0 to 1.
    fn progress(time: f64) -> f64 {
        (1.0 - (PI * time / END).cos()) / 2.0
    }

    fn place(&self, [x, y]: [f64; 2], progress: f64) -> [f64; 2] {
        let [width, height] = self.body;
        let spread = (self.grid[0] / width - 1.0) * 0.75 * progress;
        let right = x / width;
        let up = y / height;
        let sink = 1.0 - 0.45 * progress - 0.35 * progress * right * right;
        [x * (1.0 + spread * right * (1.0 - up).powi(2)), y * sink]
    }

    fn frame(&self, index: u64, volumes: bool) -> Frame {
        let time = END * index as f64 / (FRAMES - 1) as f64;
        let [columns, rows] = self.points;
        let [width, height] = self.body;
        let count = columns * rows;
        let mut position = Vec::with_capacity(count);
        let mut displacement = Vec::with_capacity(3 * count);
        let mut stress = Vec::with_capacity(6 * count);
        for point in 0..count {
            let start = [
                ((point / rows) as f64 + 0.5) * width / columns as f64,
                ((point % rows) as f64 + 0.5) * height / rows as f64,
            ];
            let [x, y] = self.place(start, Self::progress(time));
            let top = self.place([start[0], height], Self::progress(time))[1];
            let noise = 40.0 * (point as f64 * 12.9898).sin();
            let vertical = -20_400.0 * (top - y) + noise;
            position.push([x, y, 0.0]);
            displacement.extend([x - start[0], y - start[1], 0.0]);
            stress.extend([0.5 * vertical, vertical, 0.5 * vertical, 0.1 * vertical, 0.0, 0.0]);
        }
        let pressure = stress.chunks_exact(6).map(|s| -(s[0] + s[1] + s[2]) / 3.0).collect();
        let mut fields = vec![
            Field::real("displacement", 3, displacement),
            Field::real("velocity", 3, vec![0.0; 3 * count]),
            Field::real("stress", 6, stress),
            Field::real("pressure", 1, pressure),
            Field::real("plastic_strain", 1, vec![0.0; count]),
            Field {
                name: "material".to_owned(),
                components: 1,
                values: FieldValues::U16(vec![0; count]),
            },
            Field {
                name: "id".to_owned(),
                components: 1,
                values: FieldValues::U64((0..count as u64).collect()),
            },
        ];
        if volumes {
            fields.push(Field::real("volume", 1, vec![width * height / count as f64; count]));
        }
        Frame {
            step: index * STEPS_PER_FRAME,
            time,
            position,
            fields,
        }
    }

    fn write_tables(&self, directory: &Path) -> Result<(), bsmpm_io::Error> {
        let lengths = ["runout", "front", "height"].map(|name| TableColumn::new(name, "m"));
        let mut columns = vec![TableColumn::new("step", "-"), TableColumn::new("time", "s")];
        columns.extend(lengths);
        columns.push(TableColumn::new("stress-noise", "-"));
        let energies = ["kinetic", "plastic", "numerical", "smoothing", "background"];
        columns.extend(energies.map(|part| TableColumn::new(&format!("energy-{part}"), "J/m")));
        let mut history = CsvTable::create(&directory.join(HISTORY), &columns)?;
        let mut steps = CsvTable::create(&directory.join(STEPS), &StepRow::columns("s"))?;
        let last = (FRAMES - 1) * STEPS_PER_FRAME;
        for step in 0..=last {
            let time = END * step as f64 / last as f64;
            let progress = Self::progress(time);
            let runout = self.place([self.body[0], 0.0], progress)[0];
            let height = self.place([0.0, self.body[1]], progress)[1];
            let noise = 0.02 * progress * (1.5 + (step as f64 * 0.7).sin());
            let energies = [
                progress * (1.0 - progress),
                progress,
                0.1 * progress,
                0.1 * progress,
                0.0,
            ];
            let lengths = [runout, 0.94 * runout, height, noise].into_iter();
            let cells: Vec<Cell> = lengths.chain(energies).map(Cell::Float).collect();
            history.row(&[&[Cell::Int(step), Cell::Float(time)], &cells[..]].concat())?;
            if step > 0 {
                steps.row(&Self::step(step, time, END / last as f64).cells())?;
            }
        }
        Ok(())
    }

    fn step(step: u64, time: f64, dt: f64) -> StepRow {
        let cutbacks = u64::from(step.is_multiple_of(170));
        StepRow {
            step,
            time,
            dt: if cutbacks > 0 { dt / 4.0 } else { dt },
            iterations: 9 + step * 7919 % 11 + 12 * cutbacks,
            residual: 1e-9,
            linear_iterations: 0,
            cutbacks,
            active_nodes: 9000,
            wall: 0.2,
            newton_iterations: 0,
            evaluations: 0,
            products: 0,
            factorisations: 0,
            reductions: 0,
            messages: 0,
            bytes: 0,
            imbalance: 1.0,
        }
    }
}
