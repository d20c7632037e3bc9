//! Tests constitutive laws with state variables.

use crate::support::Scratch;
use crate::support::results::{at, history, ids, last_frame};

/// Softening, sensitive clay by its rate, Cam-clay and mu(I), of one stiffness.
const LAWS: &str = r#"
[material.softening]
model = "mohr-coulomb-softening"
young = "1 MPa"
poisson = 0.3
density = 2000
friction_angle = 18
cohesion = "500 Pa"
residual_friction_angle = 15
residual_cohesion = 0
softening_strain = 0.01
[material.sensitive]
model = "sensitive-clay"
young = "1 MPa"
poisson = 0.3
density = 2000
cohesion = "3 kPa"
sensitivity = 3
softening_strain = 0.2
rate_parameter = 0.1
reference_rate = 0.01
[material.clay]
model = "modified-cam-clay"
young = "1 MPa"
poisson = 0.3
density = 2000
kappa_star = 0.02
lambda_star = 0.12
critical_state_ratio = 1.0
ocr = 1.2
[material.grains]
model = "mu-i"
young = "1 MPa"
poisson = 0.3
density = 2000
mu_s = 0.3
mu_2 = 0.6
inertial_number = 0.3
grain_diameter = "5 mm"
grain_density = 2650
"#;
const NAMES: [&str; 4] = ["softening", "sensitive", "clay", "grains"];

/// The block, 2 m wide and 1 m high, and of a solid so `thick` (m) between what holds its front and its back.
fn block(geometry: &str, thick: f64, back: &str) -> String {
    let is_solid = geometry == "solid";
    let place = |x: f64, y: f64, z: f64| {
        if is_solid {
            format!("[{x}, {y}, {z}]")
        } else {
            format!("[{x}, {z}]")
        }
    };
    let part = |k: usize, name: &str| {
        let left = 0.5 * k as f64;
        let right = 0.5 * (k + 1) as f64;
        let [lower, upper, middle] = [
            place(left, 0.0, 0.0),
            place(right, thick, 1.0),
            place(left + 0.3, 0.1, 0.3),
        ];
        format!(
            "[[body]]\nmaterial = \"{name}\"\nbox = {{ lower = {lower}, upper = {upper} }}\npoints_per_cell = 2\n\
             [[history]]\nname = \"{name}\"\nquantity = \"stress\"\nat = {middle}\n\
             [[history]]\nname = \"{name}-moved\"\nquantity = \"displacement\"\nat = {middle}\n"
        )
    };
    let parts: String = NAMES.iter().enumerate().map(|(k, name)| part(k, name)).collect();
    let sides = if is_solid {
        format!("front = \"roller\"\nback = \"{back}\"\n")
    } else {
        String::new()
    };
    format!(
        "geometry = \"{geometry}\"\n\
         analysis = {{ type = \"dynamic\", end = 0.2, dt = 0.02 }}\n\
         grid = {{ lower = {}, upper = {}, cell = 0.25, degree = \"quadratic\", c0_lines = \"none\" }}\n\
         gravity = {{ acceleration = {} }}\ninitial = {{ k0 = 0.5 }}\n\
         solver = {{ tolerance = 1e-18, force_tolerance = 1e-12, background = 0 }}\n\
         output = {{ every = 0.1 }}\n\
         {LAWS}{parts}[boundary]\nleft = \"roller\"\nbottom = \"fixed\"\n{sides}",
        place(0.0, 0.0, 0.0),
        place(3.0, if back == "free" { thick + 0.25 } else { thick }, 1.25),
        place(0.0, 0.0, -9.81),
    )
}

/// A block in the round and one in space whose back is free.
#[test]
fn laws_with_a_state_go_on_to_the_bit_in_the_round_and_in_space() {
    for case in [block("axisymmetric", 0.0, ""), block("solid", 0.5, "free")] {
        let scratch = Scratch::with_case(&case);
        scratch.goes_on(2, &["4"]);
        let [whole, part] = ["whole2", "part2"].map(|name| last_frame(&scratch.path(name)));
        assert!(whole == part);
        let strain = whole.real("plastic_strain", 1).unwrap();
        let ids = ids(&whole);
        for (body, name) in NAMES.iter().enumerate() {
            let own = ids
                .iter()
                .zip(strain)
                .filter(|(id, _)| **id as usize * NAMES.len() / ids.len() == body);
            let most = own.map(|(_, strain)| *strain).fold(0.0, f64::max);
            assert!(most > 1e-3, "{name} flows: {most:e}");
        }
    }
}

#[test]
fn a_slice_of_laws_with_a_state_is_plane_strain() {
    let run = |case: &str| {
        let scratch = Scratch::with_case(case);
        scratch.direct(&["case.toml", "-q", "-o", "out"]).expect(0);
        history(&scratch.path("out"))
    };
    let plane = run(&block("plane-strain", 0.0, ""));
    let solid = run(&block("solid", 0.25, "roller"));
    for name in NAMES {
        for (of_plane, of_solid) in [
            ("xx", "xx"),
            ("yy", "zz"),
            ("zz", "yy"),
            ("moved-x", "moved-x"),
            ("moved-y", "moved-z"),
        ] {
            let [expected, found] = [
                at(&plane, &format!("{name}-{of_plane}"), 0.2),
                at(&solid, &format!("{name}-{of_solid}"), 0.2),
            ];
            let apart = found / expected - 1.0;
            println!("{name}, {of_solid}: {expected:e}, {apart:e}");
            assert!(apart.abs() < 1e-9, "{name}, {of_solid}: {found} for {expected}");
        }
    }
}
