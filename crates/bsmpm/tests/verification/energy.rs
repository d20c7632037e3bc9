//! Tests of the energy balance: its residual stays within the tolerance, and terms with known values are reproduced.

use super::bar::{PERIOD, bar};
use crate::support::scene::{Scene, axis, hencky};
use crate::support::solver::Skyline;
use bsmpm::boundary::{Support, surface};
use bsmpm::control::Stepper;
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::energy::{EnergyAccounts, StoredEnergy};
use bsmpm::error::StepError;
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::load::Load;
use bsmpm::interactions::strip::{Path, Strip};
use bsmpm::kinematics::{Kinematics, PlaneStrain, Solid};
use bsmpm::material::{Elastic, Material, MohrCoulomb, Separation};
use bsmpm::model::{AverageWeight, Gravity, Regime};
use bsmpm::schedule::Schedule;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::tensor::Vector;

const METHODS: [Stabilisation; 3] = [Stabilisation::None, Stabilisation::FBar, Stabilisation::ModifiedFBar];

/// The course of a run's energy.
struct Course {
    books: EnergyAccounts,
    stored: StoredEnergy,
    /// J  the largest of all energies so far
    largest: f64,
    /// J  the largest closure so far
    closure: f64,
}

impl Course {
    fn relative(&self) -> f64 {
        self.closure / self.largest
    }
}

/// Runs a scene with its books.
fn kept<K: Kinematics<D>, const D: usize>(mut scene: Scene<K, D>, dt: f64, end: f64) -> Course {
    scene.model.balances_energy = true;
    let model = scene.model.clone();
    let halo = scene.halo();
    let stored = StoredEnergy::of(&model, &scene.points, 0.0, &halo);
    let mut course = Course {
        books: EnergyAccounts::open(stored),
        stored,
        largest: 0.0,
        closure: 0.0,
    };
    scene.march(dt, end, |points, accepted| {
        let step = accepted.report.energy.expect("the model balances energy");
        assert!(step.plastic >= 0.0, "plastic flow dissipates: {step:?}");
        course.books.flows += step;
        let turnover = accepted.report.turnover.expect("whatever balances energy has it");
        assert_eq!((turnover.external, turnover.plastic), (step.external, step.plastic));
        course.stored = StoredEnergy::of(&model, points, accepted.t, &halo);
        let Course { books, stored, .. } = course;
        let energies = [
            stored.kinetic,
            stored.elastic,
            books.flows.plastic,
            books.flows.external.abs(),
        ];
        course.largest = energies.into_iter().fold(course.largest, f64::max);
        course.closure = course.closure.max(books.residual(stored).abs());
    });
    course
}

fn tell(name: &str, course: &Course) {
    println!(
        "{name}: kinetic {:.4e} elastic {:.4e} {:?}, closure {:.1e}",
        course.stored.kinetic,
        course.stored.elastic,
        course.books.flows,
        course.relative()
    );
}

#[test]
fn a_model_that_does_not_balance_energy_reports_none() {
    bar(Stabilisation::None).march(0.1, 0.2, |_, accepted| assert_eq!(accepted.report.energy, None));
}

/// What a material's damping takes stands with what flow does: `1 - exp(-2 xi omega t)` of the bar's energy.
#[test]
fn the_books_tell_what_damping_takes() {
    let ratio = 0.02;
    let omega = 2.0 * std::f64::consts::PI / PERIOD;
    for method in [Stabilisation::None, Stabilisation::ConsistentFBar] {
        let mut damped = bar(method);
        damped.model.damping = vec![2.0 * ratio / omega];
        let course = kept(damped, PERIOD / 80.0, 2.0 * PERIOD);
        tell(&format!("{method:?}"), &course);
        let taken = course.books.flows.plastic / course.books.start;
        let expected = 1.0 - (-2.0 * ratio * omega * 2.0 * PERIOD).exp();
        println!("damping took {taken:.6}, less 1: {:.1e}", taken / expected - 1.0);
        assert!(
            course.relative() <= 1e-9 && (taken / expected - 1.0).abs() <= 5e-3,
            "{taken} for {expected}"
        );
    }
}

#[test]
fn the_bars_books_close_and_say_where_its_energy_went() {
    for method in METHODS {
        let course = kept(bar(method), PERIOD / 80.0, 5.0 * PERIOD);
        tell(&format!("{method:?}"), &course);
        let flows = course.books.flows;
        let start = course.books.start;
        let left = (course.stored.kinetic + course.stored.elastic) / start;
        assert!(course.relative() <= 1e-10); // measured 1.1e-11
        assert_eq!(
            (flows.external, flows.plastic, flows.artificial_stiffness, flows.penalty),
            (0.0, 0.0, 0.0, 0.0)
        );
        assert!((left + flows.numerical() / start - 1.0).abs() <= 1e-10);
        match method {
            // 0.549 of the energy is left (T3.5), and smoothing has taken it.
            Stabilisation::ModifiedFBar => assert!((flows.smoothing / start - 0.44).abs() <= 0.01),
            _ => assert_eq!(flows.smoothing, 0.0),
        }
    }
}

#[test]
fn numerical_damping_is_a_loss_of_the_integration() {
    // Part of the energy after two periods that the integration takes in the next two: the first steps are a transient.
    let lost = |newmark: Newmark| {
        let after = |periods: f64| {
            let mut scene = bar(Stabilisation::None);
            scene.model.newmark = newmark;
            let course = kept(scene, PERIOD / 20.0, periods * PERIOD);
            tell(&format!("{newmark:?}"), &course);
            assert!(course.relative() <= 1e-8); // measured 1.3e-9: the force tolerance is 1e-9
            course
        };
        let early = after(2.0);
        let late = after(4.0);
        let loss = late.books.flows.integration - early.books.flows.integration;
        loss / (early.stored.kinetic + early.stored.elastic)
    };
    // Amplitudes decay by these logarithms a step (`damping`), energies by twice them, in 40 steps.
    let decays = [2.9e-5, 3.674e-3, 4.833e-3];
    let schemes = [
        Newmark::default(),
        Newmark::of_spectral_radius(0.0),
        Newmark::of_gamma(0.6),
    ];
    for (newmark, decay) in schemes.into_iter().zip(decays) {
        let found = lost(newmark);
        let expected = 1.0 - f64::exp(-80.0 * decay);
        println!("{newmark:?}: lost {found:.4}, by the decay {expected:.4}");
        // The energy of a damped mode swings about its decay.
        assert!((found - expected).abs() <= 0.02);
    }
}

/// A column of dry soil, 2 x 1 m of 0.25 m cells, that collapses on a rough base beside a smooth wall.
fn collapse(method: Stabilisation, separation: Separation) -> Scene<PlaneStrain, 2> {
    let soil = MohrCoulomb::new(
        Elastic {
            young: 1e5,
            poisson: 0.3,
        },
        0.4,
        0.0,
        0.0,
    )
    .separating(separation);
    Scene::new(
        [axis(0.25, 16, 2), axis(0.25, 6, 2)],
        Material::MohrCoulomb(soil),
        Regime::Dynamic,
    )
    .body([0..4, 0..4], 2, 2000.0, |x| x * 0.0)
    .support(Support::roller(0, false))
    .support(Support::fixed(1, false))
    .gravity(10.0, 0.1)
    .stabilised(method)
}

#[test]
fn a_collapse_with_friction_closes() {
    for (method, separation) in [
        (Stabilisation::FBar, Separation::Forgotten),
        (Stabilisation::ModifiedFBar, Separation::Forgotten),
        (Stabilisation::ConsistentFBar, Separation::Forgotten),
        (Stabilisation::ConsistentFBar, Separation::Closing),
    ] {
        let mut scene = collapse(method, separation);
        scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-4 });
        let course = kept(scene, 2e-3, 0.3);
        tell(&format!("{method:?}"), &course);
        let flows = course.books.flows;
        assert!(course.relative() <= 1e-8); // measured 8.7e-12, 1.5e-12
        assert!(flows.plastic >= 0.1 * flows.external && flows.artificial_stiffness > 0.0);
        assert!(course.stored.kinetic > 0.0 && flows.external > 0.0);
    }
}

#[test]
fn a_method_that_makes_energy_exceeds_the_budget_and_no_other() {
    let soil = |friction: f64, dilation: f64| {
        Material::MohrCoulomb(MohrCoulomb::new(
            Elastic {
                young: 5e7,
                poisson: 0.3,
            },
            friction,
            dilation,
            0.0,
        ))
    };
    for (method, material, makes) in [
        (Stabilisation::None, soil(0.4, 0.0), false),
        (Stabilisation::None, soil(0.4, 0.4), false),
        (Stabilisation::None, soil(0.0, 0.0), false),
        (Stabilisation::ConsistentFBar, soil(0.4, 0.0), false),
        (Stabilisation::ConsistentFBar, soil(0.4, 0.4), false),
        (Stabilisation::ModifiedFBar, soil(0.4, 0.0), false),
        (Stabilisation::FBar, soil(0.4, 0.0), false),
        (Stabilisation::FBar, soil(0.4, 0.4), true),
    ] {
        let mut scene = collapse(method, Separation::Forgotten);
        scene.model.materials = vec![material.into()];
        scene.model.gravity = Some(Gravity {
            acceleration: [0.0, -10.0].into(),
            ramp: 0.0,
            starts_vertical: false,
        });
        let schedule = Schedule::new(2e-3, 0.14, []);
        let halo = scene.halo();
        let mut solver = Skyline::new(&scene.model.grid);
        let mut stepper = Stepper::new(scene.model.grid.nodes() * 2);
        let ended = loop {
            match scene.advance(&mut stepper, &schedule, &halo, &mut solver) {
                Some(Ok(_)) => scene.points.sort_by_cell(&scene.model.grid),
                Some(Err(failure)) => break failure.attempts.last().cloned(),
                None => break None,
            }
        };
        println!(
            "{method:?}: {:?} at {}, {:?}",
            ended,
            stepper.time(),
            stepper.progress().budget
        );
        assert_eq!(matches!(ended, Some(StepError::EnergyMade { .. })), makes);
        assert!(makes || ended.is_none());
    }
}

#[test]
fn the_books_close_with_consistent_mass() {
    // Without supports the points gain what the nodes gain or less, whatever they do.
    let bar = kept(
        bar(Stabilisation::None).with_mass(MassMatrix::Consistent),
        PERIOD / 80.0,
        PERIOD,
    );
    let mut sand = collapse(Stabilisation::ConsistentFBar, Separation::Forgotten).with_mass(MassMatrix::Consistent);
    sand.model.gravity = Some(Gravity {
        acceleration: [0.0, -10.0].into(),
        ramp: 0.0,
        starts_vertical: false,
    });
    let sand = kept(sand, 2e-3, 0.2);
    for (name, course) in [("bar", &bar), ("sand", &sand)] {
        tell(name, course);
        assert!(course.relative() <= 1e-8);
        assert!(course.books.flows.transfer >= -1e-12 * course.largest);
    }
}

/// A block of Tresca soil, 0.25 m cells, into which a smooth strip is pressed.
fn footing(method: Stabilisation) -> Scene<PlaneStrain, 2> {
    let clay = MohrCoulomb::new(
        Elastic {
            young: 1e5,
            poisson: 0.4,
        },
        0.0,
        0.0,
        1e3,
    );
    let mut scene = Scene::new(
        [axis(0.25, 6, 2), axis(0.25, 6, 2)],
        Material::MohrCoulomb(clay),
        Regime::QuasiStatic,
    )
    .body([0..6, 0..4], 2, 0.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::fixed(1, false))
    .stabilised(method);
    scene.model.weighting = AverageWeight::Volume;
    scene.model.artificial_stiffness = Some(ArtificialStiffness { coefficient: 1e-3 });
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.0, 1.0].into(), &[0.5, 1.0].into(), 2);
    let path = Path {
        rows: vec![(1.0, [0.0, -0.05].into())],
    };
    scene.strip(Strip {
        contact: None,
        points,
        normal: Some([0.0, 1.0].into()),
        transitions: Default::default(),
        path,
        penalty: 4e9,
    })
}

#[test]
fn a_quasi_static_footing_closes() {
    let scenes = METHODS.map(|method| [footing(method), footing(method).fitted()]);
    for scene in scenes.into_iter().flatten() {
        let name = format!("{:?}, {:?}", scene.model.stabilisation, scene.model.quadrature);
        let course = kept(scene, 0.05, 1.0);
        tell(&name, &course);
        let flows = course.books.flows;
        assert!(course.relative() <= 1e-8); // measured 5.4e-12
        assert_eq!((course.stored.kinetic, flows.transfer), (0.0, 0.0));
        assert!(flows.plastic > 0.1 * flows.external && flows.penalty > 0.0 && flows.artificial_stiffness > 0.0);
        assert!(flows.penalty <= 1e-3 * flows.external);
    }
}

/// An elastic block under a traction or gravity.
fn block(ramp: f64) -> Scene<PlaneStrain, 2> {
    let scene = Scene::new(
        [axis(0.5, 2, 2), axis(0.5, 3, 2)],
        hencky(1e6, 0.3),
        Regime::QuasiStatic,
    )
    .body([0..2, 0..2], 3, 1.0, |x| x * 0.0)
    .rollers([0])
    .support(Support::roller(1, false));
    let points = surface::along::<PlaneStrain, 2>(&scene.model.grid, &[0.0, 1.0].into(), &[1.0, 1.0].into(), 3);
    scene
        .gravity(5.0, ramp)
        .load(Load::dead(points, [0.0, -100.0].into(), ramp))
}

#[test]
fn a_load_that_grows_stores_its_work_and_one_at_once_twice_as_much_as_is_stored() {
    let grown = kept(block(1.0), 0.1, 1.0);
    let at_once = kept(block(0.0), 1.0, 1.0);
    tell("grown", &grown);
    tell("at once", &at_once);
    let M = hencky(1e6, 0.3).elastic().oedometric();
    let exact = 0.5 * 100.0 * 100.0 / M; // of the traction alone, small strain
    assert!(
        (grown.stored.elastic / exact - 1.0).abs() <= 0.06,
        "{} {exact}",
        grown.stored.elastic
    );
    assert!((grown.books.flows.external / grown.stored.elastic - 1.0).abs() <= 1e-3);
    assert!((at_once.books.flows.external / at_once.stored.elastic - 2.0).abs() <= 1e-3);
    assert!(grown.relative() <= 1e-9 && at_once.relative() <= 1e-9); // measured 1.7e-10, 3.4e-12
}

#[test]
fn a_face_that_moves_does_the_work_of_its_reaction() {
    // From l = 1 to 0.9 in one step: W = M ln(l)^2 / 2, and the reaction M ln(l) / l at the end of the step does the
    // work.
    fn pressed<K: Kinematics<D>, const D: usize>() -> (f64, f64) {
        let mut pushed = Support::roller(D - 1, true);
        pushed.velocity[D - 1] = Some(-0.1);
        let scene = Scene::<K, D>::new(
            std::array::from_fn(|_| axis(0.5, 2, 2)),
            hencky(1e3, 0.3),
            Regime::QuasiStatic,
        )
        .body(std::array::from_fn(|_| 0..2), 2, 1.0, |x: &Vector<D>| x * 0.0)
        .rollers(0..D - 1)
        .support(Support::roller(D - 1, false))
        .support(pushed);
        let course = kept(scene, 1.0, 1.0);
        tell("pressed", &course);
        assert!(course.relative() <= 1e-12); // measured 4.7e-14
        (course.stored.elastic, course.books.flows.external)
    }
    let M = hencky(1e3, 0.3).elastic().oedometric();
    let strain = 0.9_f64.ln();
    for (stored, work) in [pressed::<PlaneStrain, 2>(), pressed::<Solid, 3>()] {
        assert!((stored / (0.5 * M * strain * strain) - 1.0).abs() <= 1e-12);
        assert!((work / (-0.1 * M * strain / 0.9) - 1.0).abs() <= 1e-12);
    }
}
