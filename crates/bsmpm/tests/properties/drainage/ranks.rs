//! Tests of drains on several ranks.

use super::{DT, Plane, deform, drainage, linear, no_water, out, scene, slope};
use bsmpm::boundary::{AnchoredPoints, Anchors};
use bsmpm::exact::{Exact, WORDS};
use bsmpm::field::pore_water::backward::Differences;
use bsmpm::field::pore_water::drain::Drainage;
use bsmpm::field::pore_water::flow::{Course, Given, PermeabilityLaw};
use bsmpm::grid::Contributions;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::model::Model;
use bsmpm::parallel::{Halo, OwnedNodes};
use bsmpm::points::Points;
use bsmpm::schedule::TimeInterval;
use bsmpm::tensor::Vector;
use std::ops::Range;
use std::sync::{Barrier, Mutex};

/// Ranks that are threads: numbers that all wait for.
struct Meeting {
    barrier: Barrier,
    numbers: Mutex<Vec<Vec<f64>>>,
    words: Mutex<Vec<i64>>,
}

struct Rank<'a> {
    number: usize,
    nodes: usize,
    meeting: &'a Meeting,
}

impl Rank<'_> {
    fn together(&self, own: &mut [f64], join: impl Fn(f64, f64) -> f64) {
        self.meeting.numbers.lock().expect("no panic")[self.number] = own.to_vec();
        self.meeting.barrier.wait();
        let all = self.meeting.numbers.lock().expect("no panic").clone();
        own.copy_from_slice(&all[0]);
        all[1..]
            .iter()
            .for_each(|of| own.iter_mut().zip(of).for_each(|(sum, of)| *sum = join(*sum, *of)));
        self.meeting.barrier.wait();
    }
}

impl Halo for Rank<'_> {
    fn owned(&self) -> OwnedNodes {
        OwnedNodes::first(self.nodes)
    }
    fn assemble_ghosts(&self, contributions: &Contributions) -> Vec<f64> {
        contributions.alone()
    }
    fn update_ghosts(&self, _nodal: &mut [f64], _width: usize) {}
    fn ghost_max(&self, _nodal: &mut [f64], _width: usize) {}
    fn all_reduce_sum(&self, numbers: &mut [f64]) {
        self.together(numbers, |a, b| a + b);
    }
    fn reproducible_sum(&self, sums: &[Exact]) -> Vec<f64> {
        let own: Vec<i64> = sums.iter().flat_map(|sum| *sum.words()).collect();
        {
            let mut words = self.meeting.words.lock().expect("no panic");
            words.resize(own.len(), 0);
            words.iter_mut().zip(&own).for_each(|(sum, word)| *sum += word);
        }
        self.meeting.barrier.wait();
        let words = self.meeting.words.lock().expect("no panic").clone();
        words
            .chunks_exact(WORDS)
            .map(|words| Exact::of_words(words).value())
            .collect()
    }
    fn all_reduce_max(&self, numbers: &mut [f64]) {
        self.together(numbers, f64::max);
    }
}

/// A rank's part of the scene: its columns of the grid, and the points in them.
fn part(whole: &Plane, columns: Range<usize>) -> (Model<PlaneStrain, 2>, Points<2>) {
    let grid = whole.model.grid.window(columns.clone());
    let mut points = whole.points.clone();
    let away = |x: &Vector<2>| {
        whole
            .model
            .grid
            .locate(x)
            .is_none_or(|cell| !columns.contains(&cell[0]))
    };
    let gone: Vec<u64> = (0..points.len())
        .filter(|&p| away(&points.x[p]))
        .map(|p| points.id[p])
        .collect();
    points.remove(|id| gone.contains(&id));
    (
        Model {
            grid,
            ..whole.model.clone()
        },
        points,
    )
}

#[test]
fn several_ranks_make_the_same_of_drains_to_the_bit() {
    let mut whole = scene(
        2,
        PermeabilityLaw::KozenyCarman,
        slope(),
        Given::Pressure(Course(vec![(0.0, 50.0)])),
    );
    // Turned by a third of a circle, so that anchors and places are on different ranks.
    deform(&mut whole.points, [[-0.5, -0.85], [0.9, -0.5]]);
    whole.points.sort_by_cell(&whole.model.grid);
    let field = |x: &Vector<2>| (3.0 * x[0]).sin() * 1e3 + x[1].powi(2) * 4e3;
    let one = drainage(&whole).expect("permeable");
    let (p, _) = linear(&whole.model.grid, field);
    let alone = one.report(&p, &whole.halo());
    let nodal = out(&whole.model.grid, &one, &p);
    let cuts = [0..4, 4..5, 5..8];
    let meeting = Meeting {
        barrier: Barrier::new(cuts.len()),
        numbers: Mutex::new(vec![Vec::new(); cuts.len()]),
        words: Mutex::new(Vec::new()),
    };
    let sums = Mutex::new(vec![0.0; nodal.len()]);
    std::thread::scope(|scope| {
        for (number, columns) in cuts.into_iter().enumerate() {
            let (model, points) = part(&whole, columns);
            let meeting = &meeting;
            let sums = &sums;
            let alone = &alone;
            scope.spawn(move || {
                let halo = Rank {
                    number,
                    nodes: model.grid.nodes(),
                    meeting,
                };
                let ground = AnchoredPoints {
                    points: &points,
                    anchors: &Anchors::default(),
                };
                let drainage = Drainage::at(
                    &model,
                    ground,
                    TimeInterval { start: 0.0, dt: DT },
                    Differences::EULER,
                    |_| true,
                    no_water,
                    &halo,
                )
                .expect("permeable");
                let (p, _) = linear(&model.grid, field);
                assert_eq!(drainage.report(&p, &halo), *alone);
                let mut sums = sums.lock().expect("no panic");
                let out = out(&model.grid, &drainage, &p);
                out.iter()
                    .enumerate()
                    .for_each(|(node, out)| sums[model.grid.number_of(node)] += out);
            });
        }
    });
    let largest = nodal.iter().fold(0.0_f64, |most, out| most.max(out.abs()));
    for (sum, alone) in sums.into_inner().expect("no panic").iter().zip(&nodal) {
        assert!((sum - alone).abs() <= 1e-14 * largest);
    }
}
