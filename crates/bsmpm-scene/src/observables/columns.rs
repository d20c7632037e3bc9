//! Columns of observables: what is appended to the name of a history, and what each column is.

/// Columns of an observable, in 2-D and in 3-D. Nothing is appended to the one column of a scalar.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Suffix and meaning of each column in 2-D.
    pub plane: &'static [(&'static str, &'static str)],
    /// The same in 3-D.
    pub space: &'static [(&'static str, &'static str)],
}

impl Columns {
    /// Columns along so many axes.
    pub(super) fn in_dimensions(self, dims: usize) -> &'static [(&'static str, &'static str)] {
        if dims == 3 { self.space } else { self.plane }
    }

    /// Columns that are the same in 2-D and in 3-D.
    const fn equal(columns: &'static [(&'static str, &'static str)]) -> Self {
        Self {
            plane: columns,
            space: columns,
        }
    }
}

pub(super) const SCALAR: Columns = Columns::equal(&[("", "")]);
pub(super) const VECTOR: Columns = Columns {
    plane: &[("-x", "along x"), ("-y", "along y")],
    space: &[("-x", "along x"), ("-y", "along y"), ("-z", "along z")],
};
/// A moment: a number in 2-D.
pub(super) const MOMENT: Columns = Columns {
    plane: SCALAR.plane,
    space: VECTOR.space,
};
pub(super) const STRESS: Columns = Columns {
    plane: &[
        ("-xx", "normal to x"),
        ("-yy", "normal to y"),
        ("-zz", "out of the plane"),
        ("-xy", "shear"),
    ],
    space: &[
        ("-xx", "normal to x"),
        ("-yy", "normal to y"),
        ("-zz", "normal to z"),
        ("-xy", "shear"),
        ("-yz", "shear"),
        ("-xz", "shear"),
    ],
};
pub(super) const SECTION: Columns = Columns {
    plane: &[
        ("-n", "normal force, positive in tension"),
        (
            "-q",
            "shear force along the line, on the material to the left of the line",
        ),
        (
            "-m",
            "bending moment about the centre of the line (N m/m), positive if the side of `to` is in tension",
        ),
    ],
    space: &[
        ("-n", "normal force, positive in tension"),
        ("-q1", "shear force along t1, on the material before the section"),
        ("-q2", "shear force along t2, on the material before the section"),
        (
            "-t",
            "torsional moment (N m) about the normal through the centre, on the material before the section",
        ),
        (
            "-m1",
            "bending moment about the centre (N m), positive if the side of positive t1 is in tension",
        ),
        (
            "-m2",
            "bending moment about the centre (N m), positive if the side of positive t2 is in tension",
        ),
    ],
};
pub(super) const RANGE: Columns = Columns::equal(&[
    ("-mean", "mean, weighted with the present volumes"),
    ("-least", "least value"),
    ("-largest", "largest value"),
]);
pub(super) const STRAIN: Columns = Columns::equal(&[
    ("-mean", "mean, weighted with the present volumes"),
    ("-largest", "largest value"),
]);
pub(super) const NOISE: Columns = Columns::equal(&[
    ("-average", "deviation from a local average over the grid"),
    (
        "-plane",
        "deviation from a plane through the neighbouring material points",
    ),
]);
pub(super) const CONTACT: Columns = Columns::equal(&[
    ("-closed", "fraction of the nodes that are closed"),
    ("-sliding", "fraction of the normal force that slides"),
]);
pub(super) const GAP: Columns = Columns::equal(&[("-least", "least value"), ("-largest", "largest value")]);
pub(super) const ENERGY: Columns = Columns::equal(&[
    ("-kinetic", "kinetic energy of the material points"),
    (
        "-elastic",
        "elastic energy of the material points, of compressed water and of suction",
    ),
    ("-plastic", "dissipation by plastic flow, damping and seepage"),
    (
        "-external",
        "work of gravity, loads and prescribed displacements, minus dissipation by friction at faces and by absorbing boundaries",
    ),
    (
        "-numerical",
        "numerical dissipation, the sum of transfer, integration, smoothing, background and penalty",
    ),
    (
        "-transfer",
        "dissipation by the transfer between material points and nodes",
    ),
    (
        "-integration",
        "dissipation by the integration in time and along the strain path",
    ),
    ("-smoothing", "dissipation by the averaging of elastic strains"),
    (
        "-background",
        "dissipation by the artificial stiffness `solver.background`",
    ),
    (
        "-penalty",
        "dissipation by the penalty method at footings and prescribed displacements",
    ),
    (
        "-closure",
        "residual of the balance: work of the out-of-balance forces, and round-off",
    ),
]);
