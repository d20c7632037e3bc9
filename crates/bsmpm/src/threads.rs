//! Parallel loops over material points, whose results do not depend on the number of threads.

use crate::exact::Exact;
use rayon::Yield;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex};
use std::thread;

/// Points of a chunk: enough that handing it out costs nothing, few enough that threads end together.
pub(crate) const CHUNK: usize = 1024;

/// Threads share `count` pieces of work, by their index, one at a time, so that they end together: columns of cells
/// differ in what they hold. Not generic in the work: with a copy for every pass, most of what is compiled of a program
/// would be the machinery of threads.
pub(crate) fn share(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().with_max_len(1).for_each(work);
}

/// The same by chunks of so many points.
pub(crate) fn by_chunks(points: usize, work: &(dyn Fn(usize, Range<usize>) + Sync)) {
    share(points.div_ceil(CHUNK), &|chunk| {
        work(chunk, chunk * CHUNK..points.min((chunk + 1) * CHUNK));
    });
}

/// What every chunk of points leaves.
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

/// A value of every point, in their order.
pub fn each<T: Send>(points: usize, value: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..points).into_par_iter().map(&value).collect()
}

/// Sum of a value over the points.
pub fn sum(points: usize, value: impl Fn(usize) -> f64 + Sync) -> Exact {
    let [sum] = sums(points, |p| [value(p)]);
    sum
}

/// Sums of several values over the points.
pub fn sums<const N: usize>(points: usize, values: impl Fn(usize) -> [f64; N] + Sync) -> [Exact; N] {
    let parts = of_chunks(points, |_, points| {
        let mut sums = [const { Exact::ZERO }; N];
        points.for_each(|p| sums.iter_mut().zip(values(p)).for_each(|(sum, value)| sum.add(value)));
        sums
    });
    added(parts)
}

/// Sums of what so many pieces of work have.
pub fn total<const N: usize>(pieces: usize, of: impl Fn(usize) -> [Exact; N] + Sync) -> [Exact; N] {
    added(each(pieces, of))
}

/// Sums of sums.
pub(crate) fn added<const N: usize>(parts: Vec<[Exact; N]>) -> [Exact; N] {
    let mut sums = [const { Exact::ZERO }; N];
    for part in parts {
        sums.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
    }
    sums
}

/// Largest value among the points, 0 without any that is larger.
pub fn largest(points: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
    of_chunks(points, |_, points| points.map(&value).fold(0.0, f64::max))
        .into_iter()
        .fold(0.0, f64::max)
}

/// Rows of the points, of `width` items each, by chunks for a thread at a time.
pub(crate) fn apart<T>(rows: &mut [T], width: usize) -> Vec<Mutex<&mut [T]>> {
    rows.chunks_mut(width * CHUNK).map(Mutex::new).collect()
}

/// Changes the rows of the points, of `width` items each.
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

/// As long as it lives, the other threads stay awake: one that has gone to sleep comes late to the next pass, and a
/// step has many short ones.
pub struct Awake(Arc<AtomicBool>);

impl Awake {
    /// From here on, if there are points enough to share.
    pub fn over(points: usize) -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        if rayon::current_num_threads() > 1 && points >= 2 * CHUNK {
            let is_over = Arc::clone(&is_over);
            rayon::spawn_broadcast(move |thread| {
                // The first one is that of the rank, which has work of its own.
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
