//! Tests that rigid bodies at faces and in free fields are reported.

use super::set;

/// Half of a rigid body on half of the ground, and one that never comes to it.
#[test]
fn rigid_bodies_that_faces_cut_and_that_stay_outside_are_reported() {
    let with = |rigid: &str| {
        let text = format!(
            "geometry = 'plane-strain'\nanalysis = {{ type = 'quasi-static', steps = 4 }}\n\
             grid = {{ lower = [0, 0], upper = [4, 4], cell = 0.5, degree = 'quadratic' }}\n\
             material.soil = {{ model = 'elastic', young = 1e6, poisson = 0.3 }}\n\
             boundary = {{ bottom = 'fixed', left = 'roller' }}\n\
             [[body]]\nmaterial = 'soil'\nbox = {{ lower = [0, 0], upper = [4, 2] }}\npoints_per_cell = 2\n\
             [[rigid]]\nname = 'it'\n{rigid}\n"
        );
        bsmpm_scene::Case::from_text("case.toml", &text, &[])
            .expect("a valid case")
            .warnings
            .join("\n")
    };
    let push = "free = ['y']\nforce = [0, -1.0]";
    let cut = "W0419";
    let away = "W0417";
    for (rigid, reported) in [
        (format!("polygon = [[-1, 2], [1, 2], [1, 3], [-1, 3]]\n{push}"), cut),
        (format!("circle = {{ centre = [0, 3], radius = 1 }}\n{push}"), cut),
        ("polygon = [[5, 2], [6, 2], [6, 3], [5, 3]]".to_owned(), away),
        (format!("polygon = [[6, 2], [7, 2], [7, 3], [6, 3]]\n{push}"), away),
    ] {
        let found = with(&rigid);
        assert!(found.contains(reported), "{rigid}: {found}");
    }
    for rigid in [
        format!("polygon = [[0, 2], [1, 2], [1, 3], [0, 3]]\n{push}"),
        "polygon = [[-1, 2], [1, 2], [1, 3], [-1, 3]]\ndisplacement = [0, -0.1]".to_owned(),
        "polygon = [[5, 2], [6, 2], [6, 3], [5, 3]]\npath = [[1.0, -2.0, 0]]".to_owned(),
    ] {
        let found = with(&rigid);
        assert!(!found.contains(cut) && !found.contains(away), "{rigid}: {found}");
    }
}

/// What a rigid body does to the columns of the free field is seen along its way, too.
#[test]
fn rigid_bodies_stay_out_of_the_free_field_on_their_way() {
    let base = r#"
        geometry = "plane-strain"
        analysis = { type = "dynamic", end = 1, dt = 0.01 }
        grid = { lower = [0, 0], upper = [4, 4], cell = 0.5, degree = "quadratic" }
        boundary = { left = "free-field", right = "free-field", bottom = "fixed" }
        shaking = { acceleration = [[0, 0, 0], [1, 1, 0]] }
        [material.soil]
        model = "elastic"
        young = "10 MPa"
        poisson = 0.3
        density = 2000
        [[body]]
        material = "soil"
        box = { lower = [0, 0], upper = [4, 3] }
        points_per_cell = 2
    "#;
    let refused = |more: &str| {
        let block = format!("rigid.0={{ name = \"block\", polygon = [[1, 3], [2, 3], [2, 4], [1, 4]], {more} }}");
        let reported = set(base, &[&block])
            .err()
            .map(|errors| format!("{errors:?}"))
            .unwrap_or_default();
        let of = |side: &str| reported.contains(&format!("boundary.{side}")) && reported.contains("a rigid body acts");
        ["left", "right"].map(of)
    };
    assert_eq!(refused("friction_coefficient = 0.1"), [false; 2]);
    assert_eq!(refused("path = [[0.1, -0.6, 0], [0.2, 0, 0]]"), [true, false]);
    assert_eq!(refused("displacement = [1.6, 0]"), [false, true]);
    assert_eq!(refused("rotation = [[1, 90]], about = [3, 3.5]"), [false, true]);
}
