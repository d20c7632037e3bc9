//! Writes the factor of safety and its trials as text, CSV and JSON.

use bsmpm_messages::headed;
use serde::Serialize;

use super::conditions::Conditions;
use super::curve::{Bracket, DOUBLED, FactorCurve, Kink};
use super::moved::{Mechanism, PulledSide};
use super::search::SearchPlan;
use super::sought::{ELASTIC, PushedSide, Sought};
use super::subject::Subject;
use super::trial::{End, FosTrial};
use crate::record::short;
use crate::report::{Quoted, ReportTable, some, word};

/// A factor of safety by one criterion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Finding {
    pub criterion: &'static str,
    pub last_stable: Option<f64>,
    pub first_failed: Option<f64>,
    /// within the band
    pub estimate: Option<f64>,
}

/// The finding under the name of what was sought.
#[derive(Debug, Default, Serialize)]
pub(super) struct Found {
    #[serde(skip_serializing_if = "Option::is_none")]
    factor_of_safety: Option<Finding>,
    #[serde(skip_serializing_if = "Option::is_none")]
    critical_seismic_coefficient: Option<Finding>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pushed_to: Option<PushedSide>,
}

/// How a trial is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Verdict {
    /// the reference of the others
    Elastic,
    Stable,
    /// beyond the kink
    Failed,
    /// no equilibrium under the whole load
    NoEquilibrium,
}

/// A trial with what it is worth.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FosRow {
    pub verdict: Verdict,
    /// displacement over the elastic one
    pub growth: f64,
    #[serde(flatten)]
    pub trial: FosTrial,
}

/// All of it.
#[derive(Debug, Serialize)]
pub(super) struct FosReport {
    pub case: String,
    pub title: String,
    /// the one of the kink; where it shows none, the coarse one
    #[serde(skip)]
    pub finding: Finding,
    #[serde(flatten)]
    pub found: Found,
    pub criteria: [Finding; 2],
    /// what the case calls the largest displacement of any point
    pub column: String,
    /// of the elastic body, as that of the trials
    pub elastic_displacement: f64,
    /// in which material is judged: the lower and the upper corner, m; everywhere without
    pub region: Option<[[f64; 3]; 2]>,
    /// where the ground moves in the first trial that has failed
    pub mechanism: Option<Mechanism>,
    pub conditions: Conditions,
    pub plan: SearchPlan,
    pub command: Vec<String>,
    pub notes: Vec<String>,
    pub trials: Vec<FosRow>,
    /// trials at the same time; they change the clock only
    pub jobs: usize,
    /// s  by the clock, those of trials that were kept left out
    pub seconds: f64,
    #[serde(skip)]
    pub kink: Option<Kink>,
}

impl Finding {
    fn of(criterion: &'static str, band: Bracket, estimate: Option<f64>) -> Self {
        let Bracket {
            last_stable,
            first_failed,
        } = band;
        Self {
            criterion,
            last_stable,
            first_failed,
            estimate: estimate.map(short),
        }
    }

    /// The band and the estimate.
    pub fn words(&self) -> String {
        let estimate = self
            .estimate
            .map_or_else(String::new, |estimate| format!(", estimate {estimate:.3}"));
        match (self.last_stable, self.first_failed) {
            (Some(low), Some(high)) => format!("{low} (stable) to {high} (failed){estimate}"),
            (Some(low), None) => format!("above {low}: no failure up to there"),
            _ => "none".to_owned(),
        }
    }
}

impl Found {
    fn of(finding: Finding, sought: Sought) -> Self {
        match sought {
            Sought::FactorOfSafety => Self {
                factor_of_safety: Some(finding),
                ..Self::default()
            },
            Sought::SeismicCoefficient(pushed) => Self {
                critical_seismic_coefficient: Some(finding),
                pushed_to: Some(pushed),
                ..Self::default()
            },
        }
    }
}

impl FosReport {
    pub fn of(
        subject: &Subject,
        plan: SearchPlan,
        command: &[String],
        curve: &FactorCurve,
        trials: Vec<FosTrial>,
    ) -> Self {
        let kink = curve.kink();
        let by = if plan.softens { "first-failure" } else { "kink" };
        let by_kink = Finding::of(by, curve.kinked(), kink.map(|kink| kink.factor));
        let doubled = Finding::of("doubled", curve.crossing(DOUBLED), curve.reaches(DOUBLED));
        let mut rows = Vec::new();
        for trial in trials {
            let state = trial.state();
            let verdict = if state.factor == ELASTIC {
                Verdict::Elastic
            } else if !state.whole {
                Verdict::NoEquilibrium
            } else if curve.is_failed(kink.as_ref(), &state) {
                Verdict::Failed
            } else {
                Verdict::Stable
            };
            let growth = curve.growth(&state);
            rows.push(FosRow { verdict, growth, trial });
        }
        rows.sort_by(|a, b| a.trial.factor.total_cmp(&b.trial.factor));
        let [last_stable, first_failed] = [by_kink.last_stable, by_kink.first_failed].map(|factor| {
            let row = rows.iter().find(|row| Some(row.trial.factor) == factor);
            row.map(|row| &row.trial)
        });
        let mechanism = first_failed.map(|trial| trial.mechanism.clone());
        let of_ground = [
            last_stable.and_then(loose_points),
            last_stable.and_then(untrusted),
            mechanism
                .as_ref()
                .and_then(|mechanism| pulled_sides(mechanism, plan.sought)),
        ];
        let of_search = notes(curve, kink.as_ref(), &rows, subject);
        let notes = [subject.notes(), of_search, of_ground.into_iter().flatten().collect()].concat();
        Self {
            case: subject.path().display().to_string(),
            title: subject.title.clone(),
            finding: by_kink,
            found: Found::of(by_kink, plan.sought),
            criteria: [by_kink, doubled],
            column: subject.column.clone(),
            elastic_displacement: curve.elastic(),
            region: subject.counted.region,
            mechanism,
            conditions: subject.conditions.clone(),
            plan,
            command: command.to_vec(),
            notes,
            trials: rows,
            jobs: 1,
            seconds: 0.0,
            kink,
        }
    }

    /// The row of a factor.
    pub fn at(&self, factor: f64) -> Option<&FosRow> {
        self.trials.iter().find(|row| row.trial.factor == factor)
    }

    /// For the screen.
    pub fn text(&self) -> String {
        let [first, second] = self.conditions.lines();
        let mut text = format!("{}\n{first}\n{second}\n\n{}", self.title, self.table());
        let [kink, doubled] = &self.criteria;
        let by = if self.plan.softens {
            "by the first failure:"
        } else {
            "by the kink:"
        };
        text += &format!("\n{}, {by:<16} {}\n", self.plan.sought.name(), kink.words());
        text += &format!("by twice the elastic displacement: {}\n", doubled.words());
        text += self.which();
        if let Some(mechanism) = &self.mechanism {
            text += &format!("mechanism of the first failed trial: {}\n", mechanism.words());
        }
        self.notes
            .iter()
            .for_each(|note| text += &format!("{}\n", headed(note, "note")));
        let cpu: f64 = self.trials.iter().map(|row| row.trial.cpu_seconds).sum();
        let kept = self.trials.iter().filter(|row| row.trial.kept).count();
        let kept = if kept > 0 {
            format!(", {kept} of them reused")
        } else {
            String::new()
        };
        text + &format!(
            "{} trials{kept}, {cpu:.1} CPU s, {:.1} s of wall time with {} at the same time\n",
            self.trials.len(),
            self.seconds,
            self.jobs
        )
    }

    /// Which of both criteria is the factor of safety; nothing where no trial failed.
    fn which(&self) -> &'static str {
        match (&self.kink, self.criteria[1].first_failed) {
            (_, None) => "",
            (Some(_), _) => {
                "Use the result by the kink, where displacements start to increase without bound. The other one is \
                 a rough check; it is too low where soil yields long before it fails.\n"
            }
            (None, _) if self.plan.softens => {
                "Use the first result. The other one is too low where soil yields long before it fails.\n"
            }
            (None, _) => {
                "There is no kink. Use the first result, whose criterion is given below. The other one is too low \
                 where soil yields long before it fails.\n"
            }
        }
    }

    fn table(&self) -> String {
        ReportTable::of(&self.trials)
            .right(self.plan.sought.value(), |row| row.trial.factor)
            .right("verdict", |row| word(row.verdict))
            .right("displacement", |row| format!("{:.4e}", row.trial.displacement))
            .right("/ elastic", |row| format!("{:.3}", row.growth))
            .right("plastic strain", |row| {
                some(row.trial.plastic_strain.map(|strain| format!("{strain:.2e}")))
            })
            .right("iterations", |row| row.trial.iterations)
            .right("cuts", |row| row.trial.cuts)
            .right("CPU s", |row| format!("{:.2}", row.trial.cpu_seconds))
            .right("s", |row| format!("{:.2}", row.trial.seconds))
            .column("", |row| {
                some(row.trial.end.early().map(|(load, reason)| row.early(load, reason)))
            })
            .text("")
    }

    /// A row a trial.
    pub fn csv(&self) -> String {
        let made = ReportTable::of(&self.trials)
            .column(self.plan.sought.value(), |row| row.trial.factor)
            .column("verdict", |row| word(row.verdict))
            .column(&self.column, |row| row.trial.largest_displacement)
            .column("growth", |row| row.growth)
            .column("plastic_strain", |row| some(row.trial.plastic_strain))
            .column("load", |row| row.trial.end.early().map_or(1.0, |(load, _)| load))
            .column("steps", |row| row.trial.steps)
            .column("iterations", |row| row.trial.iterations)
            .column("cuts", |row| row.trial.cuts)
            .column("cpu_seconds", |row| row.trial.cpu_seconds)
            .column("seconds", |row| row.trial.seconds)
            .column("displacement", |row| row.trial.displacement)
            .csv(Quoted::Needed);
        made.replacen('\n', "\n# -,-,as the case,-,-,-,-,-,-,s,s,as the case\n", 1)
    }
}

impl FosRow {
    /// What ended a trial early, at a share of its load.
    fn early(&self, load: f64, reason: &str) -> String {
        let what = if matches!(self.trial.end, End::Left { .. }) {
            "left"
        } else {
            "stopped"
        };
        format!("{what} at {load:.3} of the load: {reason}")
    }
}

/// That a few points of a stable trial have moved much farther than the ground about them.
fn loose_points(trial: &FosTrial) -> Option<String> {
    let [x, y, _] = trial.farthest;
    (trial.largest_displacement > DOUBLED * trial.displacement).then(|| {
        format!(
            "W0801: in trial {}, a few points near ({x:.2}, {y:.2}) m moved {:.1} times as far as the soil around \
             them. The result ignores these points. Check in ParaView that no soil fails there.",
            trial.factor,
            trial.largest_displacement / trial.displacement
        )
    })
}

/// That the last stable trial has indicators beyond their limits. Those beyond failure have them on purpose.
fn untrusted(trial: &FosTrial) -> Option<String> {
    (!trial.failed_indicators.is_empty()).then(|| {
        format!(
            "W0802: in the last stable trial ({}), quality indicators are beyond their limits: {}. The result may be \
             wrong by 10 % or more. Follow the advice in the log of this trial (in `trials`).",
            trial.factor,
            trial.failed_indicators.join(", ")
        )
    })
}

/// That the mechanism reaches sides of the grid which hold it by tension.
fn pulled_sides(mechanism: &Mechanism, sought: Sought) -> Option<String> {
    let pulled = mechanism.pulled.iter();
    let sides: Vec<String> = pulled
        .map(|PulledSide { side, share }| format!("{side} ({:.0} % of the normal stress)", 100.0 * share))
        .collect();
    (!sides.is_empty()).then(|| {
        format!(
            "W0803: the failure mechanism reaches sides of the grid that pull on the soil (tension): {}. The {} may \
             be too high. Move such a side farther away, or set its boundary to \"contact\".",
            sides.join(", "),
            sought.name()
        )
    })
}

/// What the reader of the factor should know of the search.
fn notes(curve: &FactorCurve, kink: Option<&Kink>, rows: &[FosRow], subject: &Subject) -> Vec<String> {
    let mut notes = Vec::new();
    let coarse = curve.crossing(DOUBLED);
    if coarse.first_failed.is_none() {
        let value = subject.sought.value();
        let last = rows.last().map_or(0.0, |row| row.trial.factor);
        notes.push(format!(
            "W0804: no trial fails up to the largest {value} ({last}), so only a lower bound is known. Increase --to."
        ));
    } else if kink.is_none() && curve.has_branch() {
        notes.push(
            "W0805: the displacements of failed trials do not grow in a straight line with the factor. The factor of \
             safety only lies between the last stable and the first failed trial. Increase `analysis.steps`."
                .to_owned(),
        );
    }
    let isolated = curve.isolated();
    if !isolated.is_empty() {
        let factors: Vec<String> = isolated.iter().map(f64::to_string).collect();
        notes.push(format!(
            "W0806: no equilibrium was found in the trial(s) {}, but trials closer to failure are stable, so the \
             solver failed. The result ignores these. If there are several, increase `analysis.steps`.",
            factors.join(", ")
        ));
    }
    let first = coarse
        .first_failed
        .and_then(|factor| rows.iter().find(|row| row.trial.factor == factor));
    if let Some(row) = first.filter(|row| row.verdict == Verdict::NoEquilibrium && row.growth <= DOUBLED) {
        notes.push(format!(
            "W0807: the first failed trial ({}) stopped at {:.2} times the elastic displacement. Soil that fails \
             moves farther, so perhaps the solver failed, not the soil. Increase `analysis.steps`.",
            row.trial.factor, row.growth
        ));
        if !subject.free_bodies.is_empty() {
            notes.push(format!(
                "W0808: in the first failed trial the soil hardly moved. Perhaps only a free rigid body moved away, \
                 and the soil did not fail ({}). Check how this body moves, or replace it by a [[traction]].",
                subject.free_bodies.join(", ")
            ));
        }
    }
    notes
}
