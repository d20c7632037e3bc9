//! Tests `bsmpm plot` on quasi-static runs.

use std::fs;

use bsmpm_tools::plot::{FieldName, PlotArguments, draw};

use crate::still::{Scene, Still};
use crate::{Picture, is_coloured};

pub const SLOPE: Still = Still {
    scene: Scene::Slope,
    method: "modified-f-bar",
    softness: 1.0,
    spacing: 0.25,
    steps: 40,
};
pub const FOOTING: Still = Still {
    scene: Scene::Footing,
    spacing: 0.1,
    ..SLOPE
};

#[test]
fn a_slope_has_pictures_of_stress_and_plastic_strain_but_none_of_a_runout() {
    let dir = tempfile::tempdir().unwrap();
    SLOPE.write(dir.path(), &[0.5, 1.0]).unwrap();
    let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
    let fields = [
        "stress-yy_0.5.png",
        "stress-yy_1.png",
        "plastic-strain_0.5.png",
        "plastic-strain_1.png",
    ];
    assert_eq!(names[..4], fields);
    assert_eq!(
        names[4..],
        [
            "displacement.png",
            "displacement-E_delta_over_gamma_H2.png",
            "convergence.png"
        ]
    );
    let chosen = PlotArguments {
        field: Some(FieldName::Pressure),
        ..PlotArguments::of(dir.path().to_owned())
    };
    assert_eq!(draw(&chosen).unwrap()[..2], ["pressure_0.5.png", "pressure_1.png"]);

    // A surface to compare with is drawn over the run's own.
    let reference = dir.path().join("survey.csv");
    fs::write(&reference, "time,x,y\n1,20,15\n1,40,5\n").unwrap();
    let compared = PlotArguments {
        reference: Some(reference),
        ..PlotArguments::of(dir.path().to_owned())
    };
    assert!(draw(&compared).unwrap().contains(&"surface.png".to_owned()));
}

#[test]
fn a_slope_is_not_filled_to_a_box() {
    let dir = tempfile::tempdir().unwrap();
    Still { softness: 0.0, ..SLOPE }.write(dir.path(), &[0.5]).unwrap();
    for field in [
        FieldName::StressYy,
        FieldName::PlasticStrain,
        FieldName::Pressure,
        FieldName::Displacement,
    ] {
        let arguments = PlotArguments {
            field: Some(field),
            ..PlotArguments::of(dir.path().to_owned())
        };
        let picture = Picture::read(&dir.path().join(&draw(&arguments).unwrap()[0]));
        // The body, without the bar of colours below it.
        let rows = picture.rows().len() - 150;
        let coloured = picture
            .rows()
            .take(rows)
            .flatten()
            .filter(|pixel| is_coloured(pixel))
            .count();
        let widest = picture
            .rows()
            .take(rows)
            .map(|row| row.iter().filter(|pixel| is_coloured(pixel)).count())
            .max();
        let metre = widest.unwrap() as f64 / 55.0;
        // 55 m by 5 m, 20 m by 10 m, and half of 20 m by 10 m.
        let expected = (275.0 + 200.0 + 100.0) * metre * metre;
        assert!(
            (coloured as f64 / expected - 1.0).abs() < 0.02,
            "{coloured} for {expected}, {field:?}"
        );
    }
}

#[test]
fn a_body_goes_up_to_the_walls_that_hold_it() {
    let dir = tempfile::tempdir().unwrap();
    Still {
        softness: 0.0,
        spacing: 1.0,
        ..SLOPE
    }
    .write(dir.path(), &[0.5])
    .unwrap();
    let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
    let picture = Picture::read(&dir.path().join(&names[0]));
    let body = picture
        .rows()
        .take(picture.rows().len() - 150)
        .filter(|row| row.iter().any(is_coloured));
    let begins: Vec<usize> = body.map(|row| row.iter().position(is_coloured).unwrap()).collect();
    // The uppermost rows are the scallops of the free surface.
    let first = begins.iter().min().unwrap();
    let rest = &begins[begins.len() / 10..];
    assert!(rest.iter().all(|begin| begin - first <= 1), "{begins:?}");
}

#[test]
fn a_footing_has_its_pressure_over_its_penetration_and_over_time() {
    let dir = tempfile::tempdir().unwrap();
    FOOTING.write(dir.path(), &[]).unwrap();
    let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
    let curves = [
        "displacement",
        "footing-pressure",
        "footing-pressure-time",
        "footing-force",
        "slip",
        "convergence",
    ];
    assert_eq!(names[6..], curves.map(|name| format!("{name}.png")));
    let read = |name: &str| Picture::read(&dir.path().join(name)).pixels;
    let plain = read("footing-pressure.png");
    assert_ne!(plain, read("footing-pressure-time.png"));

    let reference = dir.path().join("pfem.csv");
    fs::write(&reference, "penetration,p_over_c\n0.5,5\n2,7\n").unwrap();
    draw(&PlotArguments {
        reference: Some(reference),
        ..PlotArguments::of(dir.path().to_owned())
    })
    .unwrap();
    assert_ne!(read("footing-pressure.png"), plain);
}

#[test]
fn a_run_that_stopped_without_plastic_strain_is_drawn_as_far_as_it_came() {
    let dir = tempfile::tempdir().unwrap();
    Still { steps: 12, ..FOOTING }.write(dir.path(), &[0.25, 1.0]).unwrap();
    for name in ["step_000000000.vtu", "step_000000010.vtu"] {
        let path = dir.path().join("frames").join(name);
        let bytes = fs::read(&path).unwrap();
        let at = bytes
            .windows(14)
            .position(|window| window == b"plastic_strain")
            .unwrap();
        let renamed = [&bytes[..at], b"elastic_strain", &bytes[at + 14..]].concat();
        fs::write(&path, renamed).unwrap();
    }
    let names = draw(&PlotArguments::of(dir.path().to_owned())).unwrap();
    assert_eq!(names[..2], ["stress-yy_0.25.png", "displacement.png"]);
    let wanted = PlotArguments {
        field: Some(FieldName::PlasticStrain),
        ..PlotArguments::of(dir.path().to_owned())
    };
    assert_eq!(draw(&wanted).unwrap_err().exit_code(), 66);
}
