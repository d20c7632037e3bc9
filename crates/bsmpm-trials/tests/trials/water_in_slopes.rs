//! Tests factors of safety of slopes with water.

use std::path::Path;

use bsmpm_tools::fos::{FosArguments, run};
use serde_json::Value;

use crate::support::results::last_frame;
use crate::support::{Scratch, processes, program, shipped};

/// Degrees  of the infinite slope, and the friction of its soil.
const INCLINED: f64 = 20.0;
const FRICTION: f64 = 35.0;
/// kN/m3  of the soil and of the water
const WEIGHTS: [f64; 2] = [20.0, 9.81];
/// m  along x, of the layers, whose ends are free; its middle is looked at
const LENGTH: f64 = 40.0;

/// tan phi sigma_n'/tau on planes along the slope, of what all points above the line through (0, `base`) carry within
/// 2 m of the middle.
fn factor(set: &[String], inclined: f64, base: f64) -> f64 {
    let scratch = Scratch::new();
    let case = shipped("validation/infinite_slope.toml");
    let mut arguments = vec![case.to_str().unwrap(), "-q", "-o", "out"];
    arguments.extend(set.iter().flat_map(|set| ["--set", set.as_str()]));
    scratch.mpirun(1, &arguments).expect(0);
    let frame = last_frame(&scratch.path("out"));
    let stress = frame.real("stress", 6).unwrap();
    let (sin, cos) = inclined.to_radians().sin_cos();
    let [mut normal, mut shear] = [0.0; 2];
    for (p, place) in frame.position.iter().enumerate() {
        if (place[0] - LENGTH / 2.0).abs() < 2.0 && place[1] - place[0] * sin / cos > base {
            let [xx, yy, xy] = [stress[6 * p], stress[6 * p + 1], stress[6 * p + 3]];
            normal -= xx * sin * sin - 2.0 * xy * sin * cos + yy * cos * cos;
            shear += (yy - xx) * sin * cos + xy * (cos * cos - sin * sin);
        }
    }
    FRICTION.to_radians().tan() * normal / shear.abs()
}

/// Water flows along the slope, from its whole surface that drains, through soil without a level. Seen along the
/// slope.
#[test]
fn seepage_along_an_infinite_slope_leaves_the_share_of_its_buoyant_weight() {
    let found = ["0.5", "0.25"].map(|cell| {
        let set = [
            "analysis={ type = \"consolidation\", end = \"50 s\", steps = 5 }",
            "material.clay={ model = \"elastic\", young = \"100 MPa\", poisson = 0.3, unit_weight = \"20 kN/m3\", \
             drainage = \"coupled\", porosity = 0.4, permeability = \"1e-2 m/s\" }",
            "gravity={ acceleration = [3.3552176056, -9.2183847172] }",
            "drain=[{ from = [0.0, 2.0], to = [40.0, 2.0] }]",
            "stabilisation.method=consistent-f-bar",
            &format!("grid.cell={cell}"),
        ];
        factor(&set.map(str::to_owned), 0.0, 0.0)
    });
    let tan = |degrees: f64| degrees.to_radians().tan();
    let closed = (1.0 - WEIGHTS[1] / WEIGHTS[0]) * tan(FRICTION) / tan(INCLINED);
    println!("seepage along the slope, h = 0.5, 0.25 m: {found:.4?}; {closed:.4}");
    assert!((closed - 0.9802).abs() < 5e-5);
    assert!(
        found.iter().all(|found| (found / closed - 1.0).abs() < 1e-3),
        "{found:?}"
    );
}

/// Still water whose line is the surface: its pressure is that of the depth straight below. On rock that the
/// cells do not follow; of the soil's upper half, as cells that both fill give the rock what is the soil's to carry
/// (all of it: 0.951, 0.898).
#[test]
fn a_line_along_an_infinite_slope_presses_as_its_depth_straight_below() {
    let rise = LENGTH * INCLINED.to_radians().tan();
    let found = ["0.5", "0.25"].map(|cell| {
        let set = [
            format!("grid={{ lower = [-1, 0], upper = [41, 18], cell = {cell}, degree = \"quadratic\" }}"),
            "material={ soil = { model = \"elastic\", young = 1e8, poisson = 0.3, unit_weight = 2e4 }, rock = { model = \
             \"hencky\", young = 1e10, poisson = 0.3, unit_weight = 2e4 } }"
                .to_owned(),
            format!(
                "body=[{{ material = \"soil\", polygon = [[0, 1], [{LENGTH}, {}], [{LENGTH}, {}], [0, 3]], \
                 points_per_cell = 3 }}, {{ material = \"rock\", polygon = [[0, 0], [{LENGTH}, 0], [{LENGTH}, {}], \
                 [0, 1]], points_per_cell = 3 }}]",
                1.0 + rise,
                3.0 + rise,
                1.0 + rise
            ),
            format!("water={{ line = [[0, 3], [{LENGTH}, {}]] }}", 3.0 + rise),
            "gravity={ acceleration = [0, -9.81], ramp = 1 }".to_owned(),
            "stabilisation.method=consistent-f-bar".to_owned(),
            "analysis.steps=5".to_owned(),
            "history=[]".to_owned(),
        ];
        factor(&set, INCLINED, 2.0)
    });
    let tan = |degrees: f64| degrees.to_radians().tan();
    let cos = INCLINED.to_radians().cos();
    let closed = tan(FRICTION) / tan(INCLINED) * (1.0 - WEIGHTS[1] / (WEIGHTS[0] * cos * cos));
    println!("a line along the slope, h = 0.5, 0.25 m: {found:.4?}; {closed:.4}");
    assert!((closed - 0.8552).abs() < 5e-5);
    assert!(
        (found[0] / closed - 1.0).abs() < 0.0125 && (found[1] / closed - 1.0).abs() < 0.002,
        "{found:?}"
    );
}

/// m above the toe; the middle of another program's band by twice the elastic displacement; Lane and Griffiths
/// (2000), where a value of theirs is known.
const LEVELS: [(&str, f64, Option<f64>); 7] = [
    ("10.0", 1.8225, Some(1.85)),
    ("7.0", 1.4615, None),
    ("5.0", 1.3305, None),
    ("4.0", 1.2975, None),
    ("3.0", 1.2865, Some(1.3)),
    ("2.0", 1.2975, None),
    ("0.0001", 1.3635, Some(1.4)),
];

#[test]
fn a_slope_under_a_level_has_the_factor_of_each_level() {
    for (level, doubled, published) in LEVELS {
        let dir = tempfile::tempdir().unwrap();
        let found = search(level, dir.path());
        let of = |criterion: &str| {
            let all = found["criteria"].as_array().unwrap().iter();
            let [one] = all.filter(|of| of["criterion"] == criterion).collect::<Vec<_>>()[..] else {
                panic!("{found}")
            };
            one["estimate"].as_f64().unwrap()
        };
        println!(
            "level {level} m: doubled {} ({doubled}), kink {} ({published:?})",
            of("doubled"),
            of("kink")
        );
        assert!((of("doubled") - doubled).abs() < 0.03, "{level}: {found}");
        assert!(
            published.is_none_or(|published| (of("kink") - published).abs() < 0.03),
            "{level}: {found}"
        );
    }
}

fn search(level: &str, output: &Path) -> Value {
    let arguments = FosArguments {
        from: Some(1.0),
        to: Some(2.0),
        jobs: Some(2),
        set: vec![format!("water.level={level}")],
        output: Some(output.to_owned()),
        command: vec![program().to_owned()],
        ..FosArguments::of(shipped("drawdown_levels.toml"))
    };
    let _turn = processes::turn();
    run(&arguments, |_| ()).unwrap();
    serde_json::from_str(&std::fs::read_to_string(output.join("fos.json")).unwrap()).unwrap()
}
