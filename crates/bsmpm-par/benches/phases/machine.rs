//! Measures memory bandwidth and arithmetic speed of a core.

use std::hint::black_box;
use std::time::Instant;

/// Numbers of an array of the triad: three of them do not fit into any cache.
const LENGTH: usize = 1 << 23;

/// Best rate of a = b + s c, GB/s, by the bytes that the loop names (McCalpin, 1995: STREAM).
pub fn triad(seconds: f64) -> f64 {
    let b = vec![1.0; LENGTH];
    let c = vec![2.0; LENGTH];
    let mut a = vec![0.0; LENGTH];
    let shortest = super::kernels::shortest(seconds, || {
        let s = black_box(3.0);
        a.iter_mut().zip(&b).zip(&c).for_each(|((a, b), c)| *a = b + s * c);
        black_box(&a);
    });
    (3 * 8 * LENGTH) as f64 / shortest * 1e-9
}

/// Rate of multiplications and additions in sixteen chains that do not wait for each other, GFlop/s.
pub fn multiply_add(seconds: f64) -> f64 {
    const ROUNDS: usize = 1 << 20;
    let mut chains = [1.0_f64; 16];
    let begin = Instant::now();
    let mut rounds = 0;
    while begin.elapsed().as_secs_f64() < seconds {
        let s = black_box(0.999_999);
        let t = black_box(1e-6);
        for _ in 0..ROUNDS {
            chains.iter_mut().for_each(|x| *x = *x * s + t);
        }
        rounds += ROUNDS;
    }
    black_box(chains);
    (2 * chains.len() * rounds) as f64 / begin.elapsed().as_secs_f64() * 1e-9
}
