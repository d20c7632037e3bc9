//! Parallel loops over material points, whose results do not depend on the number of threads.

use crate::exact::Exact;
use rayon::Yield;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex};
use std::thread;

/// Points of a chunk: enough that scheduling costs little, few enough that threads finish together.
pub(crate) const CHUNK: usize = 1024;

/// Executes `work` for all indices below `count`, distributed over the threads one index at a time, because columns of
/// cells differ in size. The function is not generic in `work`, which keeps the compiled code small.
pub(crate) fn share(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().with_max_len(1).for_each(work);
}

/// Executes `work` for chunks of `points`, with the number of the chunk and its range.
pub(crate) fn by_chunks(points: usize, work: &(dyn Fn(usize, Range<usize>) + Sync)) {
    share(points.div_ceil(CHUNK), &|chunk| {
        work(chunk, chunk * CHUNK..points.min((chunk + 1) * CHUNK));
    });
}

/// Returns the result of `of` for every chunk of points.
pub(crate) fn of_chunks<T: Send>(points: usize, of: impl Fn(usize, Range<usize>) -> T + Sync) -> Vec<T> {
    let parts: Vec<Mutex<Option<T>>> = (0..points.div_ceil(CHUNK)).map(|_| Mutex::default()).collect();
    by_chunks(points, &|chunk, points| {
        *parts[chunk].lock().expect("the chunk's only thread") = Some(of(chunk, points))
    });
    parts
        .into_iter()
        .filter_map(|part| part.into_inner().expect("no thread panicked"))
        .collect()
}

/// Returns a value for every point, in order.
pub fn each<T: Send>(points: usize, value: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..points).into_par_iter().map(&value).collect()
}

/// Returns the exact sum of a value over the points.
pub fn sum(points: usize, value: impl Fn(usize) -> f64 + Sync) -> Exact {
    let [sum] = sums(points, |p| [value(p)]);
    sum
}

/// Returns the exact sums of several values over the points.
pub fn sums<const N: usize>(points: usize, values: impl Fn(usize) -> [f64; N] + Sync) -> [Exact; N] {
    let parts = of_chunks(points, |_, points| {
        let mut sums = [const { Exact::ZERO }; N];
        points.for_each(|p| sums.iter_mut().zip(values(p)).for_each(|(sum, value)| sum.add(value)));
        sums
    });
    added(parts)
}

/// Returns the exact sums of the results of `of` for all indices below `pieces`.
pub fn total<const N: usize>(pieces: usize, of: impl Fn(usize) -> [Exact; N] + Sync) -> [Exact; N] {
    added(each(pieces, of))
}

/// Returns the sums of sums.
pub(crate) fn added<const N: usize>(parts: Vec<[Exact; N]>) -> [Exact; N] {
    let mut sums = [const { Exact::ZERO }; N];
    for part in parts {
        sums.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
    }
    sums
}

/// Returns the largest value of the points, at least 0.
pub fn largest(points: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
    of_chunks(points, |_, points| points.map(&value).fold(0.0, f64::max))
        .into_iter()
        .fold(0.0, f64::max)
}

/// Splits the rows of the points, of `width` items each, into chunks for one thread at a time.
pub(crate) fn apart<T>(rows: &mut [T], width: usize) -> Vec<Mutex<&mut [T]>> {
    rows.chunks_mut(width * CHUNK).map(Mutex::new).collect()
}

/// Applies `change` to the row of every point, of `width` items each.
pub fn change<T: Send>(rows: &mut [T], width: usize, change: impl Fn(usize, &mut [T]) + Sync) {
    let points = rows.len() / width;
    let rows = apart(rows, width);
    by_chunks(points, &|chunk, points| {
        let rows = &mut **rows[chunk].lock().expect("the chunk's only thread");
        points
            .zip(rows.chunks_exact_mut(width))
            .for_each(|(p, row)| change(p, row));
    });
}

/// Guard that keeps the other threads awake while it exists. Threads that sleep join the next pass late, and a step has
/// many short passes.
pub struct Awake(Arc<AtomicBool>);

impl Awake {
    /// Creates the guard, which is active if there are enough points to share.
    pub fn over(points: usize) -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        if rayon::current_num_threads() > 1 && points >= 2 * CHUNK {
            let is_over = Arc::clone(&is_over);
            rayon::spawn_broadcast(move |thread| {
                // Thread 0 executes the work of the rank.
                while thread.index() > 0 && !is_over.load(Relaxed) {
                    if rayon::yield_now() != Some(Yield::Executed) {
                        thread::yield_now();
                    }
                }
            });
        }
        Self(is_over)
    }
}

impl Drop for Awake {
    fn drop(&mut self) {
        self.0.store(true, Relaxed);
    }
}
