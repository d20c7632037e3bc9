//! Measures the speed of this machine by return mappings.

use std::hint::black_box;
use std::time::Instant;

use bsmpm::tensor::Symmetric;
use bsmpm_scene::Case;

/// ns of a return on the machine on which [`super::stored`] was measured.
const REFERENCE: f64 = 40.0;
/// Returns of one round, and rounds: the fastest one was disturbed the least.
const RETURNS: usize = 4096;
const ROUNDS: usize = 40;

/// Any plastic material.
const CASE: &str = include_str!("../../../../cases/short/column_collapse.toml");

/// Time of a return on this machine, over that of the machine of reference.
pub(super) fn speed() -> f64 {
    nanoseconds() / REFERENCE
}

/// ns of a return.
fn nanoseconds() -> f64 {
    let case = Case::from_text("reference", CASE, &[]).expect("a shipped case is valid");
    let law = case.materials[0].material.at(0.0);
    let states: Vec<Symmetric> = (0..RETURNS).map(state).collect();
    let mut fastest = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let sum: f64 = states
            .iter()
            .filter_map(|b| Some(law.respond(black_box(b), &[]).ok()?.tau().0[0]))
            .sum();
        black_box(sum);
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    fastest * 1e9 / RETURNS as f64
}

/// A trial state, pressed and sheared: some beyond yield, some not.
fn state(number: usize) -> Symmetric {
    let share = number as f64 / RETURNS as f64;
    let pressed = 1.0 - 2e-3 * (1.0 + share);
    let sheared = 4e-3 * share;
    Symmetric([pressed, pressed - sheared, pressed, 0.5 * sheared, 0.0, 0.0])
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_speed_is_a_positive_number() {
        let speed = super::speed();
        assert!(speed.is_finite() && speed > 0.0, "{speed}");
    }
}
