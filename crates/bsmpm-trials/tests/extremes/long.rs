//! Tests of long runs and large numbers of steps.

use crate::scenes::{Footing, block, layers};
use crate::solver::Run;
use crate::steps::{PERIOD, bar, energy};
use crate::support::{Scratch, program};
use crate::table::Found;
use bsmpm::schedule::Schedule;
use std::process::{Command, Stdio};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

const STEPS: usize = 100_000;

const FLOOR: &str = "[gravity]\nacceleration = [0.0, -9.81]\n[boundary]\nbottom = \"roller\"\n";

fn flight() -> Arc<Run> {
    Run::of(&block([0.25, 0.0], STEPS, ""), 1, &[])
}

fn bounce() -> Arc<Run> {
    Run::of(&block([0.0, 0.0], STEPS, FLOOR), 1, &[])
}

fn different_masses(run: &Run) -> Found {
    run.found(|run| {
        let mass = run.column("mass");
        assert_eq!(mass.len(), STEPS + 1);
        mass.iter().filter(|m| **m != mass[0]).count() as f64
    })
}

/// Steps of the free flight whose total mass has other bits.
pub fn mass_in_flight() -> Found {
    different_masses(&flight())
}

/// The same of the bouncing block.
pub fn mass_in_bounce() -> Found {
    different_masses(&bounce())
}

/// Largest drift of the momentum in free flight, relative.
pub fn momentum() -> Found {
    flight().found(|run| {
        let x = run.column("momentum-x");
        let y = run.column("momentum-y");
        x.iter()
            .zip(&y)
            .map(|(px, py)| (px - x[0]).hypot(*py))
            .fold(0.0, f64::max)
            / x[0]
    })
}

/// Highest place that the bouncing block comes to after its first fall, over the height that it was dropped from.
pub fn rebound() -> Found {
    bounce().found(|run| {
        let height = run.column("height");
        let fall = height[..1000]
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |(step, _)| step);
        height[fall..].iter().copied().fold(0.0, f64::max) / height[0]
    })
}

/// Growth of the resident memory (kB per 1000 steps) over the last four fifths of a flight with that speed (m/s), and
/// whether the number of open files changed there.
fn growth(speed: f64) -> (f64, bool) {
    let scratch = Scratch::with_case(&block([speed, 0.0], STEPS, ""));
    let mut command = Command::new(program());
    command
        .args(["case.toml", "-q"])
        .current_dir(scratch.path(""))
        .stdin(Stdio::null())
        .stderr(Stdio::null());
    let mut child = command.spawn().expect("the program starts");
    let of_process = |name: &str| format!("/proc/{}/{name}", child.id());
    let status = of_process("status");
    let files = of_process("fd");
    let mut samples = Vec::new();
    let ended = loop {
        std::thread::sleep(Duration::from_millis(250));
        if let Some(ended) = child.try_wait().expect("its state") {
            break ended;
        }
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let memory = text
            .lines()
            .find_map(|line| line.strip_prefix("VmRSS:")?.trim().strip_suffix(" kB")?.parse().ok());
        let open = std::fs::read_dir(&files).map_or(0, Iterator::count);
        samples.extend(memory.map(|memory: f64| (memory, open)));
    };
    assert!(
        ended.success() && samples.len() >= 20,
        "{ended}, {} samples",
        samples.len()
    );
    // The last samples may be of the program's end.
    let steady = &samples[samples.len() / 5..samples.len() - samples.len() / 20 - 1];
    let first = steady[0].0;
    let last = steady[steady.len() - 1].0;
    let steps = STEPS as f64 * steady.len() as f64 / samples.len() as f64;
    (
        1e3 * (last - first) / steps,
        steady.iter().any(|(_, open)| *open != steady[0].1),
    )
}

/// Growth of the resident memory in a flight with that speed (m/s), kB per 1000 steps.
pub fn memory(speed: f64) -> Found {
    let (slope, changes) = growth(speed);
    Found::Figure(
        slope,
        if changes {
            "open files change".into()
        } else {
            "open files constant".into()
        },
    )
}

/// The elastic bar with 80 steps a period: change of its energy, and the slope of it over the last half a step.
fn bar_energy() -> (f64, f64) {
    static FOUND: OnceLock<(f64, f64)> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let mut scene = bar();
        let start = energy(&scene.points);
        let mut worst = 0.0_f64;
        let mut middle = 0.0;
        let mut step = 0;
        scene.march(PERIOD / 80.0, STEPS as f64 * PERIOD / 80.0, |points, _| {
            step += 1;
            // Once a period: within it, the points' energies come and go with the phase.
            if step % 80 == 0 {
                let change = energy(points) / start - 1.0;
                worst = worst.max(change.abs());
                if step == STEPS / 2 {
                    middle = change;
                }
            }
        });
        let end = energy(&scene.points) / start - 1.0;
        (worst, (end - middle).abs() / (0.5 * STEPS as f64))
    })
}

/// Largest change of the bar's energy.
pub fn bar_change() -> f64 {
    bar_energy().0
}

/// Its slope, per step.
pub fn bar_slope() -> f64 {
    bar_energy().1
}

/// Steps numbered around 2^31: largest error of their length.
pub fn far_steps() -> f64 {
    let dt = 1e-3;
    let before = 2.0_f64.powi(31) - 2.0;
    let schedule = Schedule::new(dt, 1e-2 * 2.0_f64.powi(31), []);
    let mut t = schedule.next(before * dt).expect("a step");
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let next = schedule.next(t).expect("a step");
        worst = worst.max(((next - t) / dt - 1.0).abs());
        t = next;
    }
    worst
}

/// A column at rest, 8 m high, in equilibrium from the start, held for 1e4 steps with this method: largest displacement
/// over its elastic settlement gamma H^2 / (2 M).
pub fn held(method: &str) -> Found {
    let further = format!("[initial]\nk0 = 0.42857142857142855\n[stabilisation]\nmethod = \"{method}\"\n");
    let text = layers(&[(1e7, 2e3, 8.0)], &further, 10_000, 9.81).replacen("ramp = 1.0", "ramp = 0.0", 1);
    let modulus = 1e7 * 0.7 / (1.3 * 0.4);
    let settlement = 2e3 * 9.81 * 64.0 / (2.0 * modulus);
    Run::of(&text, 1, &[]).found(|run| Found::Figure(run.last("max-displacement") / settlement, run.effort()))
}

/// The footing to z/B = 0.1 with 8, 16, 32 and 64 steps: largest ratio of the change of p/c by a doubling to the change
/// before; or a warning that results belong to their number of steps.
pub fn step_count(method: &'static str) -> Found {
    let runs = [8, 16, 32, 64].map(|steps| {
        Run::of(
            &Footing {
                method,
                steps,
                ..Footing::default()
            }
            .text(),
            1,
            &[],
        )
    });
    if let Some(missing) = runs
        .iter()
        .map(|run| run.found(|_| 0.0))
        .find(|found| !matches!(found, Found::Figure(..)))
    {
        return missing;
    }
    let pressures = runs.each_ref().map(|run| Footing::factor(run.last("pressure")));
    let changes: Vec<f64> = pressures.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let ratio = changes.windows(2).map(|pair| pair[1] / pair[0]).fold(0.0, f64::max);
    let remark = format!("p/c {}", pressures.map(|p| format!("{p:.4}")).join(", "));
    runs[3].found_or_warned("number of steps", |_| Found::Figure(ratio, remark.clone()))
}

/// The footing pushed to z = 2 B in 320 steps: noise of the pressure about planes at its end, over c.
pub fn deep(method: &'static str) -> Found {
    let text = Footing {
        method,
        depth: 4.0,
        steps: 320,
        top: 12.0,
        ..Footing::default()
    }
    .text();
    Run::of(&text, 1, &[]).found(|run| {
        let p = Footing::factor(run.last("pressure"));
        Found::Figure(run.last("noise-plane") / 1e3, format!("p/c {p:.2}, {}", run.effort()))
    })
}
