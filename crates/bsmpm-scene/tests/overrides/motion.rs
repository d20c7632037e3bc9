//! Tests bodies with initial velocity or spin.

use super::{FULL, STATIC, set, valid};
use bsmpm::kinematics::PlaneStrain;
use bsmpm::tensor::Vector;
use bsmpm_scene::seed;

/// A square with 1 m edges in cells of 0.25 m, 2 points along an axis of each: its points lie 0.0625 m inside.
#[test]
fn a_free_body_at_the_edge_of_the_grid_is_warned_of() {
    let head = "geometry = \"plane-strain\"\nanalysis = { type = \"dynamic\", end = 0.2, dt = 0.01 }\n\
                grid = { lower = [0, 0], upper = [3, 3], cell = 0.25, degree = \"quadratic\" }\n\
                [boundary]\nbottom = \"free\"\n[material.m]\nmodel = \"elastic\"\nyoung = 1e9\npoisson = 0.3\ndensity = \
                1000\n";
    let warned = |x: f64, motion: &str, set: &[&str]| -> Vec<String> {
        let body = format!(
            "{head}[[body]]\nmaterial = \"m\"\npoints_per_cell = 2\nbox = {{ lower = [{x:?}, 1.0], upper = [{:?}, 2.0] \
             }}\n\
             {motion}\n",
            x + 1.0
        );
        let warnings = valid(&body, set).warnings;
        warnings
            .into_iter()
            .filter(|warning| warning.starts_with("W0230"))
            .collect()
    };
    let found = warned(0.0, "velocity = [-1.0, 0.0]", &[]);
    assert!(
        found.len() == 1
            && found[0].starts_with("W0230: body.0: the body moves out of the grid through the free face left"),
        "{found:?}"
    );
    assert!(
        found[0].contains("at about t = 0.064 s") && found[0].contains("Enlarge the grid at this face by 0.138 m"),
        "{found:?}"
    );
    assert_eq!(warned(0.2, "velocity = [-2.0, 0.0]", &[]).len(), 1);
    assert!(warned(0.0, "spin = { rate = 2.0, about = [0.5, 1.5] }", &[])[0].contains("free face left"));
    let held: &[&str] = &["boundary.left=roller"];
    for (x, motion, set) in [
        (0.0, "velocity = [1.0, 0.0]", &[][..]),
        (0.0, "", &[]),
        (1.0, "velocity = [-1.0, 0.0]", &[]),
        (0.0, "velocity = [-1.0, 0.0]", held),
        (0.1, "spin = { rate = 0.1, about = [0.6, 1.5] }", &[]),
    ] {
        assert_eq!(warned(x, motion, set), [""; 0], "{x} {motion} {set:?}");
    }
    let rigid = |velocity: &str| {
        let disc = format!(
            "{head}[[body]]\nmaterial = \"m\"\npoints_per_cell = 2\nbox = {{ lower = [0.0, 0.0], upper = [3.0, 1.0] \
             }}\n\
             [[rigid]]\nname = \"disc\"\ncircle = {{ centre = [0.5, 1.5], radius = 0.5 }}\ndensity = 1000\n\
             free = [\"x\", \"y\", \"rotation\"]\nstart_velocity = [{velocity}, 0.0]\n"
        );
        let warnings = valid(&disc, &["boundary.bottom=fixed"]).warnings;
        warnings
            .iter()
            .filter(|warning| warning.contains("0.000 m from boundary `left`"))
            .count()
    };
    assert_eq!([rigid("-1.0"), rigid("1.0"), rigid("0.0")], [1, 0, 0]);
}

/// Sixteen bodies of a cell each whose velocities are those of a rotation, of a translation, or of two halves that meet
/// head-on; and the rotation of bodies that are apart.
#[test]
fn a_rotation_by_velocities_is_warned_of_like_a_spin() {
    let head = "geometry = \"plane-strain\"\nanalysis = { type = \"dynamic\", end = 1, dt = 0.1 }\n\
                grid = { lower = [0, 0], upper = [8, 8], cell = 0.5, degree = \"quadratic\" }\n\
                [boundary]\nbottom = \"fixed\"\n[material.m]\nmodel = \"elastic\"\nyoung = 1e6\npoisson = 0.3\ndensity \
                = 2000\n";
    let rotates = |velocity: &dyn Fn(f64, f64) -> [f64; 2], distance: f64| {
        let body = |k: u32| {
            let [i, j] = [k % 4, k / 4].map(f64::from);
            let [x, y] = [2.0 + distance * i, 2.0 + distance * j];
            let [vx, vy] = velocity(i - 1.5, j - 1.5);
            format!(
                "[[body]]\nmaterial = \"m\"\npoints_per_cell = 2\nvelocity = [{vx:?}, {vy:?}]\n\
                 box = {{ lower = [{x:?}, {y:?}], upper = [{:?}, {:?}] }}\n",
                x + 0.5,
                y + 0.5
            )
        };
        let text = format!("{head}{}", (0..16).map(body).collect::<String>());
        // Elastic cases have the consistent mass unless they ask for this one.
        let lumped = valid(&text, &["analysis.mass=lumped"]);
        lumped.warnings.iter().any(|warning| warning.starts_with("W0673"))
    };
    assert!(rotates(&|x, y| [-y, x], 0.5));
    assert!(rotates(&|x, y| [3.0 - y, x], 0.5));
    assert!(!rotates(&|_, _| [1.0, 2.0], 0.5));
    assert!(!rotates(&|x, _| [-x.signum(), 0.0], 0.5));
    assert!(!rotates(&|x, y| [-y, x], 1.0));
}

#[test]
fn a_body_spins_about_its_place() {
    let case = set(FULL, &["body.2.spin={ rate = 2.0, about = [\"1 m\", 2.0] }"]).expect("a valid case");
    assert!(
        case.warnings.iter().any(|warning| warning.starts_with("W0673")),
        "{:?}",
        case.warnings
    );
    let mut seen = 0;
    for point in seed::<PlaneStrain, 2>(&case, 0..case.grid.axes[0].cells())
        .filter(|point| point.material == 2 && point.x[0] >= 1.0)
    {
        // The block's own velocity besides; the grid begins at the origin.
        let expected = [-2.0 * (point.x[1] - 2.0), -1.0 + 2.0 * (point.x[0] - 1.0)];
        assert!(
            (point.v - Vector::from(expected)).norm() < 1e-14,
            "{:?} at {:?}",
            point.v,
            point.x
        );
        seen += 1;
    }
    assert_eq!(seen, 8, "two cells of four points");
    let message = format!(
        "{:?}",
        set(STATIC, &["body.0.spin={ rate = 2.0, about = [0, 0] }"]).expect_err("at rest")
    );
    assert!(message.contains("E0218"), "{message}");
}

/// Rigid terrain lies between the body and the free bottom of the grid.
#[test]
fn a_body_above_rigid_terrain_does_not_leave_through_the_bottom() {
    let body = "geometry = \"3d\"\nanalysis = { type = \"dynamic\", end = 1.0, dt = 0.01 }\n\
                gravity = { acceleration = [0.0, 0.0, -9.81] }\n\
                grid = { lower = [0, 0, 0], upper = [4, 4, 4], cell = 0.5 }\n\
                [material.m]\nmodel = \"elastic\"\nyoung = 1e7\npoisson = 0.3\ndensity = 1000\n\
                [[body]]\nmaterial = \"m\"\npoints_per_cell = 2\nbox = { lower = [1, 1, 0.4], upper = [2, 2, 1.4] }\n";
    let terrain = "[[rigid]]\nname = \"ground\"\n\
                   terrain = { top = [[0, 0, 0.4], [4, 0, 0.4], [0, 4, 0.4], [4, 4, 0.4]] }\n";
    let leaves = |case: &str| {
        valid(case, &[])
            .warnings
            .iter()
            .any(|warning| warning.starts_with("W0230"))
    };
    assert!(leaves(body));
    assert!(!leaves(&format!("{body}{terrain}")));
}

/// A horizontal part in a quasi-static analysis is a load and no weight.
#[test]
fn a_pseudo_static_load_does_not_change_the_weight() {
    let warned = |gravity: &str| {
        let warnings = valid(STATIC, &[&format!("gravity.acceleration={gravity}")]).warnings;
        warnings.iter().any(|warning| warning.starts_with("W0205"))
    };
    assert!(warned("[0, -9.75]"));
    assert!(warned("[1.2, -9.75]"));
    assert!(!warned("[1.2, -9.81]"));
}
