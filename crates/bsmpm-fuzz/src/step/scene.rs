//! Makes small, mostly valid cases from bytes.

use crate::draw::{between, signed, size};
use arbitrary::{Result, Unstructured};
use std::fmt::Write;

/// The grid that the rest is placed on.
struct FuzzGrid {
    lower: [f64; 2],
    upper: [f64; 2],
    h: f64,
}

impl FuzzGrid {
    /// The two ends of a segment, as lines of a case.
    fn segment(&self, u: &mut Unstructured<'_>) -> Result<String> {
        Ok(format!("from = {:?}\nto = {:?}", self.place(u)?, self.place(u)?))
    }

    /// A place in eighths of the grid, ends included.
    fn place(&self, u: &mut Unstructured<'_>) -> Result<[f64; 2]> {
        let mut parts = [0.0; 2];
        for part in &mut parts {
            *part = f64::from(u.int_in_range(0..=8_u8)?) / 8.0;
        }
        Ok([0, 1].map(|axis| self.lower[axis] + parts[axis] * (self.upper[axis] - self.lower[axis])))
    }

    /// A motion up to some cells.
    fn motion(&self, u: &mut Unstructured<'_>) -> Result<[f64; 2]> {
        Ok([signed(u, -9.0, 0.5)? * self.h, signed(u, -9.0, 0.5)? * self.h])
    }
}

/// Where the stress at the start comes from.
#[derive(Clone, Copy, PartialEq)]
enum FuzzStart {
    Nothing,
    AtRest,
    Elastic,
}

/// The whole case.
pub fn text(u: &mut Unstructured<'_>) -> Result<String> {
    let mut text = String::from("geometry = \"plane-strain\"\n");
    let dynamic = analysis(u, &mut text)?;
    let grid = grid(u, &mut text)?;
    let start = *u.choose(&[
        FuzzStart::Nothing,
        FuzzStart::Nothing,
        FuzzStart::AtRest,
        FuzzStart::Elastic,
    ])?;
    let materials = u.int_in_range(1..=2)?;
    for number in 0..materials {
        material(u, number, dynamic, start, &mut text)?;
    }
    bodies(u, &grid, materials, &mut text)?;
    let faces = boundary(u, &mut text)?;
    gravity(u, start, &mut text)?;
    loads(u, &grid, &mut text)?;
    strips(u, &grid, faces, &mut text)?;
    solver(u, &mut text)?;
    Ok(text)
}

/// Adds a line.
fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

fn quoted<'a>(u: &mut Unstructured<'_>, words: &[&'a str]) -> Result<&'a str> {
    u.choose(words).copied()
}

fn analysis(u: &mut Unstructured<'_>, text: &mut String) -> Result<bool> {
    let dynamic = u.arbitrary()?;
    let kind = if dynamic { "dynamic" } else { "quasi-static" };
    let steps = u.int_in_range(1..=4)?;
    line(
        text,
        &format!(
            "analysis = {{ type = \"{kind}\", end = {:?}, steps = {steps} ",
            size(u, -6.0, 3.0)?
        ),
    );
    text.pop();
    match u.int_in_range(0..=3)? {
        0 if dynamic => write!(text, ", spectral_radius = {:?}", between(u, 0.0, 1.0)?),
        1 if dynamic => write!(text, ", gamma = {:?}", between(u, 0.5, 1.0)?),
        _ => Ok(()),
    }
    .expect("a string takes all");
    line(text, " }");
    Ok(dynamic)
}

fn grid(u: &mut Unstructured<'_>, text: &mut String) -> Result<FuzzGrid> {
    let order = quoted(u, &["linear", "quadratic", "cubic"])?;
    let cells = [u.int_in_range(1..=3_u8)?, u.int_in_range(1..=3_u8)?];
    let h = *u.choose(&[1.0, 0.125, 2.5e-3, 64.0])?;
    let lower = *u.choose(&[[0.0, 0.0], [-3.0, 7.0], [1e6, -1e6]])?;
    let mut upper = [0, 1].map(|axis| lower[axis] + h * f64::from(cells[axis]));
    if u.ratio(1, 4)? {
        let mut knots = lower.map(|lower| vec![lower]);
        for (knots, cells) in knots.iter_mut().zip(cells) {
            for _ in 0..cells {
                knots.push(knots[knots.len() - 1] + h * size(u, -1.5, 0.5)?);
            }
        }
        upper = [0, 1].map(|axis| knots[axis][knots[axis].len() - 1]);
        let [x, y] = knots;
        line(
            text,
            &format!("grid = {{ knots = {{ x = {x:?}, y = {y:?} }}, order = \"{order}\" }}"),
        );
    } else {
        line(
            text,
            &format!("grid = {{ lower = {lower:?}, upper = {upper:?}, cell = {h:?}, order = \"{order}\" }}"),
        );
    }
    Ok(FuzzGrid { lower, upper, h })
}

fn material(u: &mut Unstructured<'_>, number: usize, dynamic: bool, start: FuzzStart, text: &mut String) -> Result<()> {
    let model = quoted(u, &["elastic", "mohr-coulomb", "tresca", "drucker-prager", "von-mises"])?;
    let poisson = if u.ratio(1, 8)? {
        0.5 - size(u, -9.0, -1.0)?
    } else {
        between(u, -0.5, 0.499)?
    };
    let young = size(u, 0.0, 11.0)?;
    line(
        text,
        &format!("[material.m{number}]\nmodel = \"{model}\"\npoisson = {poisson:?}"),
    );
    if u.ratio(1, 6)? {
        let growth = young * signed(u, -4.0, 0.0)?;
        line(
            text,
            &format!("young = {{ value = {young:?}, at_y = 0.0, per_metre = {growth:?} }}"),
        );
    } else {
        line(text, &format!("young = {young:?}"));
    }
    let closing = model == "mohr-coulomb" && u.arbitrary()?;
    if model == "von-mises" {
        let strength = young * size(u, -8.0, 0.0)?;
        let hardening = young * size(u, -8.0, 0.0)?;
        line(text, &format!("yield_stress = {strength:?}\nhardening = {hardening:?}"));
    } else if model != "elastic" {
        let cohesion = if closing || u.ratio(1, 4)? {
            0.0
        } else {
            young * size(u, -8.0, 0.0)?
        };
        line(text, &format!("cohesion = {cohesion:?}"));
    }
    if closing {
        line(text, "separation = \"gap\"");
    }
    if ["mohr-coulomb", "drucker-prager"].contains(&model) {
        let friction = between(u, if closing { 1.0 } else { 0.0 }, 60.0)?;
        line(
            text,
            &format!(
                "friction_angle = {friction:?}\ndilation_angle = {:?}",
                friction * between(u, 0.0, 1.0)?
            ),
        );
    }
    if dynamic || u.ratio(3, 4)? {
        line(text, &format!("density = {:?}", size(u, 0.0, 5.0)?));
    }
    if start == FuzzStart::AtRest && u.ratio(1, 4)? {
        line(text, &format!("k0 = {:?}", between(u, 0.0, 3.0)?));
    }
    Ok(())
}

fn bodies(u: &mut Unstructured<'_>, grid: &FuzzGrid, materials: usize, text: &mut String) -> Result<()> {
    for _ in 0..u.int_in_range(1..=2)? {
        let material = u.int_in_range(0..=materials - 1)?;
        let points = u.int_in_range(1..=4_u8)?;
        line(
            text,
            &format!("[[body]]\nmaterial = \"m{material}\"\npoints_per_cell = {points}"),
        );
        let [a, b] = [grid.place(u)?, grid.place(u)?];
        match u.int_in_range(0..=7)? {
            0 => line(text, &format!("polygon = [{a:?}, {b:?}, {:?}]", grid.place(u)?)),
            1 => line(
                text,
                &format!(
                    "circle = {{ center = {a:?}, radius = {:?} }}",
                    grid.h * size(u, -1.0, 0.5)?
                ),
            ),
            _ => {
                let lower = [a[0].min(b[0]), a[1].min(b[1])];
                let upper = [a[0].max(b[0]), a[1].max(b[1])];
                line(text, &format!("box = {{ lower = {lower:?}, upper = {upper:?} }}"));
            }
        }
        if u.ratio(1, 4)? {
            line(
                text,
                &format!("velocity = [{:?}, {:?}]", signed(u, -3.0, 3.0)?, signed(u, -3.0, 3.0)?),
            );
        }
    }
    Ok(())
}

/// The supports; whether each face of left, right, bottom, top is free.
fn boundary(u: &mut Unstructured<'_>, text: &mut String) -> Result<[bool; 4]> {
    line(text, "[boundary]");
    let mut free = [false; 4];
    for (face, free) in ["left", "right", "bottom", "top"].into_iter().zip(&mut free) {
        let support = quoted(u, &["fixed", "roller", "free"])?;
        *free = support == "free";
        line(text, &format!("{face} = \"{support}\""));
    }
    Ok(free)
}

fn ramp(u: &mut Unstructured<'_>) -> Result<f64> {
    if u.arbitrary()? { Ok(0.0) } else { size(u, -6.0, 3.0) }
}

/// Gravity, and the stress at the start that belongs to it.
fn gravity(u: &mut Unstructured<'_>, start: FuzzStart, text: &mut String) -> Result<()> {
    if start == FuzzStart::Nothing && u.ratio(1, 4)? {
        return Ok(());
    }
    let across = if start != FuzzStart::AtRest && u.ratio(1, 4)? {
        signed(u, -3.0, 2.0)?
    } else {
        0.0
    };
    let down = if start == FuzzStart::AtRest {
        -size(u, -1.0, 2.5)?
    } else {
        signed(u, -1.0, 2.5)?
    };
    let ramp = if start == FuzzStart::Nothing { ramp(u)? } else { 0.0 };
    line(
        text,
        &format!("[gravity]\nacceleration = [{across:?}, {down:?}]\nramp = {ramp:?}"),
    );
    match start {
        FuzzStart::Nothing => {}
        FuzzStart::AtRest => line(text, &format!("[initial]\nk0 = {:?}", between(u, 0.0, 3.0)?)),
        FuzzStart::Elastic => line(text, "[initial]\ngravity = \"elastic\""),
    }
    Ok(())
}

/// A traction, a point load, a reduction of strength.
fn loads(u: &mut Unstructured<'_>, grid: &FuzzGrid, text: &mut String) -> Result<()> {
    if u.ratio(1, 6)? {
        let stress = [signed(u, 0.0, 9.0)?, signed(u, 0.0, 9.0)?];
        let from = grid.place(u)?;
        let to = grid.place(u)?;
        let ramp = ramp(u)?;
        line(
            text,
            &format!("[[traction]]\nfrom = {from:?}\nto = {to:?}\nstress = {stress:?}\nramp = {ramp:?}"),
        );
    }
    if u.ratio(1, 6)? {
        let at = grid.place(u)?;
        let force = [signed(u, 0.0, 9.0)?, signed(u, 0.0, 9.0)?];
        line(
            text,
            &format!("[[point_load]]\nat = {at:?}\nforce = {force:?}\nramp = {:?}", ramp(u)?),
        );
    }
    if u.ratio(1, 8)? {
        line(
            text,
            &format!("[strength_reduction]\nfactor = {:?}", between(u, 0.1, 5.0)?),
        );
    }
    Ok(())
}

/// A footing, and a face or segment that moves.
fn strips(u: &mut Unstructured<'_>, grid: &FuzzGrid, free: [bool; 4], text: &mut String) -> Result<()> {
    if u.ratio(1, 4)? {
        let segment = grid.segment(u)?;
        let base = quoted(u, &["smooth", "rough"])?;
        let moved = grid.motion(u)?;
        line(
            text,
            &format!("[footing]\n{segment}\ndisplacement = {moved:?}\nbase = \"{base}\""),
        );
    }
    if u.ratio(1, 6)? {
        let number = u.int_in_range(0..=3)?;
        let site = if free[number] {
            format!("face = \"{}\"", ["left", "right", "bottom", "top"][number])
        } else {
            grid.segment(u)?
        };
        let way = quoted(u, &["displacement", "velocity"])?;
        let components = quoted(u, &["all", "normal"])?;
        line(
            text,
            &format!(
                "[[prescribed]]\n{site}\n{way} = {:?}\ncomponents = \"{components}\"",
                grid.motion(u)?
            ),
        );
    }
    Ok(())
}

/// Stabilisation and iteration; few iterations, so that many cases are tried.
fn solver(u: &mut Unstructured<'_>, text: &mut String) -> Result<()> {
    let methods = ["none", "f-bar", "modified-f-bar", "consistent-f-bar", "subgrid-f-bar"];
    line(text, &format!("[stabilisation]\nmethod = \"{}\"", quoted(u, &methods)?));
    let nonlinear = quoted(u, &["auto", "broyden", "newton"])?;
    line(
        text,
        &format!(
            "[solver]\nnonlinear = \"{nonlinear}\"\nmax_iterations = {}",
            u.int_in_range(1..=16)?
        ),
    );
    if u.arbitrary()? {
        let tolerances = [size(u, -12.0, -1.0)?, size(u, -9.0, -1.0)?];
        line(
            text,
            &format!("tolerance = {:?}\nforce_tolerance = {:?}", tolerances[0], tolerances[1]),
        );
    }
    if u.arbitrary()? {
        line(
            text,
            &format!(
                "background = {:?}",
                if u.ratio(1, 4)? { 0.0 } else { size(u, -9.0, 0.0)? }
            ),
        );
    }
    if u.ratio(1, 4)? {
        line(text, "[[history]]\nquantity = \"energy\"");
    }
    Ok(())
}
