//! Synthetic quasi-static runs of a slope and a footing.

use std::path::Path;

use bsmpm_io::directory::{ExistingRunPolicy, HISTORY, OutputDirectory};
use bsmpm_io::frame::{Field, Frame};
use bsmpm_io::frames::{COLLECTION, Frames};
use bsmpm_io::lock::Unseen;
use bsmpm_io::manifest::{GridExtent, Manifest, ManifestCase, Status};
use bsmpm_io::steps::{STEPS, StepRow};
use bsmpm_io::table::{Cell, CsvTable, TableColumn};

/// A run whose pseudo-time goes from 0 to 1.
pub struct Still {
    pub scene: Scene,
    /// Of stabilisation; empty: the case has no such table.
    pub method: &'static str,
    /// By which the displacements are multiplied.
    pub softness: f64,
    /// m  between points
    pub spacing: f64,
    /// How many of the 40 steps were made.
    pub steps: u64,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Scene {
    /// 10 m high on a foundation of 5 m (Fig. 7 of the paper).
    Slope,
    /// Half of a strip 2 m wide (Fig. 11).
    Footing,
}

const ALL: u64 = 40;
const STEPS_PER_FRAME: u64 = 10;
/// Pa  cohesion below the footing
const COHESION: f64 = 2e4;

impl Still {
    /// Writes the run into `directory`.
    pub fn write(&self, directory: &Path, picture_times: &[f64]) -> Result<(), bsmpm_io::Error> {
        let (title, upper) = match self.scene {
            Scene::Slope => ("Slope stability, Xie et al. (2023), section 3.2", [55.0, 16.0]),
            Scene::Footing => (
                "Large penetration of a strip footing, Xie et al. (2023), section 3.3",
                [5.0, 11.0],
            ),
        };
        let case = ManifestCase::new("still.toml", title, "plane-strain", self.text(title));
        let mut manifest = Manifest::begin("0.1.0", vec!["bsmpm-par".to_owned(), "still.toml".to_owned()], case);
        manifest.picture_times = picture_times.to_vec();
        manifest.grid = Some(GridExtent {
            lower: vec![0.0; 2],
            upper: upper.to_vec(),
            cell: vec![2.0 * self.spacing; 2],
        });
        let directory = OutputDirectory::hold(directory, Unseen::Respect)
            .and_then(|held| held.claim(ExistingRunPolicy::Refuse, &manifest))?;
        let mut frames = Frames::create(directory.path())?;
        for step in (0..=self.steps).step_by(STEPS_PER_FRAME as usize) {
            manifest.name_output(&Frames::file(step));
            frames.write(&self.frame(step))?;
        }
        self.write_tables(directory.path())?;
        [COLLECTION, HISTORY, STEPS]
            .iter()
            .for_each(|file| manifest.name_output(file));
        if self.steps == ALL {
            manifest.finish(Status::Finished, 0);
        } else {
            manifest.finish(Status::Stopped, 75);
        }
        manifest.seal(directory.path())?;
        manifest.write(directory.path())
    }

    fn text(&self, title: &str) -> String {
        let histories = match self.scene {
            Scene::Slope => {
                vec![
                    ("max-displacement", "max-displacement", "1.0"),
                    ("max-displacement", "E_delta_over_gamma_H2", "50.0"),
                ]
            }
            Scene::Footing => vec![
                ("footing-pressure", "p_over_c", "5e-5"),
                ("footing-force", "footing-force", "1.0"),
                ("penetration", "penetration", "1.0"),
                ("slip", "slip", "1.0"),
                ("heave", "heave", "1.0"),
            ],
        };
        let mut text = format!("title = \"{title}\"\n\n[analysis]\ntype = \"quasi-static\"\n\n");
        text += "[boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n";
        if self.scene == Scene::Footing {
            text += "\n[footing]\nfrom = [0.0, 10.0]\nto = [\"1 m\", 10.0]\ndisplacement = [0.0, -2.0]\n";
        }
        if !self.method.is_empty() {
            text += &format!("\n[stabilisation]\nmethod = \"{}\"\n", self.method);
        }
        for (quantity, name, scale) in histories {
            text += &format!("\n[[history]]\nquantity = \"{quantity}\"\nname = \"{name}\"\nscale = {scale}\n");
        }
        text
    }

    /// Where there is material at the start.
    fn has(&self, [x, y]: [f64; 2]) -> bool {
        match self.scene {
            Scene::Slope => y < 5.0 || (y < 15.0 && x < 20.0 + 2.0 * (15.0 - y)),
            Scene::Footing => y < 10.0,
        }
    }

    /// The displacement and the plastic strain of a point.
    fn motion(&self, [x, y]: [f64; 2], progress: f64) -> ([f64; 2], f64) {
        match self.scene {
            Scene::Slope => {
                let arm = [x - 37.0, y - 24.0];
                let distance = arm[0].hypot(arm[1]);
                // The slide turns about its centre, within a band as a whole.
                let share = ((20.5 - distance) / 1.5).clamp(0.0, 1.0);
                let turn = 0.1 * self.softness * progress * share;
                let band = (-((distance - 19.75) / 0.7).powi(2)).exp();
                ([-arm[1] * turn, arm[0] * turn], self.softness * progress * band)
            }
            Scene::Footing => {
                let deep = (-((10.0 - y) / 2.5).powi(2)).exp();
                let heave = 0.35 * (x - 1.0) * (1.0 - x).exp() * deep;
                let strain = 1.5 * progress * (-(((x - 1.0) / 0.5).powi(2) + ((y - 9.0) / 0.8).powi(2))).exp();
                let sink = 2.0 * progress * (y / 10.0);
                let up = if x < 1.0 { -sink } else { sink * heave };
                ([0.0, up], strain)
            }
        }
    }

    fn frame(&self, step: u64) -> Frame {
        let time = step as f64 / ALL as f64;
        let [width, height] = if self.scene == Scene::Slope {
            [55.0, 15.0]
        } else {
            [5.0, 10.0]
        };
        let count = |length: f64| (length / self.spacing).round() as usize;
        let mut position = Vec::new();
        let mut displacement = vec![];
        let mut stress = vec![];
        let mut strain = vec![];
        let mut pressure = vec![];
        for index in 0..count(width) * count(height) {
            let start = [index / count(height), index % count(height)].map(|i| (i as f64 + 0.5) * self.spacing);
            if !self.has(start) {
                continue;
            }
            let ([right, up], plastic) = self.motion(start, time * time);
            let vertical = -20e3 * (height - start[1]) * (0.2 + 0.8 * time);
            position.push([start[0] + right, start[1] + up, 0.0]);
            displacement.extend([right, up, 0.0]);
            stress.extend([0.4 * vertical, vertical, 0.4 * vertical, 0.1 * vertical, 0.0, 0.0]);
            pressure.push(-0.6 * vertical);
            strain.push(plastic);
        }
        let volume = vec![self.spacing * self.spacing; position.len()];
        let fields = vec![
            Field::real("displacement", 3, displacement),
            Field::real("stress", 6, stress),
            Field::real("pressure", 1, pressure),
            Field::real("plastic_strain", 1, strain),
            Field::real("volume", 1, volume),
        ];
        Frame {
            step,
            time,
            position,
            fields,
        }
    }

    fn write_tables(&self, directory: &Path) -> Result<(), bsmpm_io::Error> {
        let columns: &[(&str, &str)] = match self.scene {
            Scene::Slope => &[("max-displacement", "m"), ("E_delta_over_gamma_H2", "scaled m")],
            Scene::Footing => &[
                ("p_over_c", "scaled Pa"),
                ("footing-force", "N/m"),
                ("penetration", "m"),
                ("slip", "-"),
                ("heave", "m"),
            ],
        };
        let columns = [("step", "-"), ("time", "-")].iter().chain(columns);
        let columns: Vec<TableColumn> = columns.map(|(name, unit)| TableColumn::new(name, unit)).collect();
        let mut history = CsvTable::create(&directory.join(HISTORY), &columns)?;
        let mut steps = CsvTable::create(&directory.join(STEPS), &StepRow::columns("-"))?;
        for step in 0..=self.steps {
            let time = step as f64 / ALL as f64;
            let mut cells = vec![Cell::Int(step), Cell::Float(time)];
            cells.extend(self.recorded(step, time).into_iter().map(Cell::Float));
            history.row(&cells)?;
            if step > 0 {
                steps.row(&Self::step(step, time).cells())?;
            }
        }
        Ok(())
    }

    fn recorded(&self, step: u64, time: f64) -> Vec<f64> {
        if self.scene == Scene::Slope {
            let most = 2.0 * self.softness * time * time;
            return vec![most, 50.0 * most];
        }
        let rough = 0.1 * (step as f64 * 1.7).sin() * time;
        let pressure = (5.3 + 2.0 * time) / self.softness * (1.0 - (-12.0 * time).exp()) + rough;
        vec![
            pressure,
            COHESION * pressure,
            2.0 * time,
            0.02 + rough.abs() / 10.0,
            0.5 * time,
        ]
    }

    fn step(step: u64, time: f64) -> StepRow {
        StepRow {
            step,
            time,
            dt: 1.0 / ALL as f64,
            iterations: 6 + step * 7919 % 11,
            residual: 1e-9,
            linear_iterations: 0,
            cutbacks: 0,
            active_nodes: 900,
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
