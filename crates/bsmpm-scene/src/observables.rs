//! List of the quantities that histories record. A new quantity is an entry here; fields of frames and profiles are in
//! `fields.rs`.
//!
//! Units are those of plane strain, in which extensive quantities are per metre of thickness.

#[macro_use]
mod define;
mod columns;
mod fields;
mod place;
mod sample;
mod subject;

pub use columns::Columns;
pub use fields::{FrameField, PlaceSample, PointSample, ProfileQuantity};
pub use sample::{FootingSample, Sample, displacement_at};
pub use subject::{Face, HistorySubject, Made, PointSelection, SubjectKeys, SubjectKind};

use crate::words::Word;
use bsmpm::error::StepError;
use bsmpm::field::pore_water::observed::PoreWater;
use bsmpm::kinematics::Kinematics;
use bsmpm::observe;
use bsmpm::observe::noise;
use std::fmt;

/// Place of the vertical normal stress among XX YY ZZ XY YZ XZ.
const VERTICAL: usize = 1;

/// What an observable needs, and how it is treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aspect {
    /// It is zero in a quasi-static analysis.
    NeedsVelocities,
    /// It needs a footing.
    NeedsFooting,
    /// It needs pore-water flow.
    NeedsFlow,
    /// Its face, footing or motion must be in contact.
    NeedsContact,
    /// It needs a face with outflow.
    NeedsOutflow,
    /// Its points must have mass.
    NeedsMass,
    /// Its face must restrain the soil.
    NeedsSupport,
    /// It is a sum over points, which is 0 without points.
    Sum,
    /// It is a force, whose scatter is an indicator.
    Force,
    /// It is a motion of something rigid, which a stage can set to zero.
    RigidMotion,
    /// It is available in 2-D only.
    PlaneOnly,
    /// It is zero in axisymmetric cases.
    ZeroByAxisymmetry,
}

/// Definition of an observable.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Kind of subject that it is of.
    pub kind: SubjectKind,
    /// Unit of its numbers in plane strain.
    pub unit: &'static str,
    /// Its columns.
    pub columns: Columns,
    /// What it needs, and how it is treated.
    pub aspects: &'static [Aspect],
    /// The keys besides `quantity` of an example.
    pub example: &'static [&'static str],
}

observables! { sample =>
    /// The coordinate x that `percentile` per cent of the material points do not exceed, also in 3-D. The initial
    /// length of the body is not subtracted. For the run-out of a flow use `percentile = 99`, because single
    /// material points and a thin tip run ahead.
    Runout = "runout": Percentile, "m", SCALAR, [], ["percentile = 99.0"] => vec![sample.runout()];
    /// Position x of the front. In the lowest row of cells with material, the last cell before the front is at
    /// least half full. With a thin tip the position does not converge on finer grids; use `runout` with
    /// `percentile = 99`.
    Front = "front": Case, "m", SCALAR, [PlaneOnly], [] =>
        vec![sample.lower[0] + observe::front(sample.model, sample.points, sample.halo)];
    /// The largest y of all material points, or of those within half a cell of `at_x`. 0 without material points.
    Height = "height": Near, "m", SCALAR, [], ["at_x = 2.0"] => vec![sample.height()];
    /// The largest displacement of all material points.
    MaxDisplacement = "max-displacement": Part, "m", SCALAR, [], [] =>
        vec![observe::largest_displacement(sample.points, sample.part, sample.halo)];
    /// Mass of the material points.
    Mass = "mass": Part, "kg/m", SCALAR, [Sum], [r#"body = "fill""#] => vec![observe::mass(sample.points, sample.part, sample.halo)];
    /// Momentum of the material points.
    Momentum = "momentum": Part, "kg/s", VECTOR, [NeedsVelocities, Sum], [r#"body = "fill""#] =>
        observe::momentum(sample.points, sample.part, sample.halo).as_slice().to_vec();
    /// Centre of mass. If there is no material: the lower corner of the grid.
    CentreOfMass = "centre-of-mass": Part, "m", VECTOR, [NeedsMass], [r#"body = "fill""#] => sample.centre_of_mass();
    /// Angular momentum about the origin, positive counter-clockwise.
    AngularMomentum = "angular-momentum": Part, "kg m/s", MOMENT, [NeedsVelocities, Sum, ZeroByAxisymmetry], [r#"body = "fill""#] => {
        let about = observe::angular_momentum(sample.points, sample.part, &-sample.lower, sample.halo);
        about[if D == 3 { 0 } else { 2 }..].to_vec()
    };
    /// Kinetic energy of the material points.
    KineticEnergy = "kinetic-energy": Part, "J/m", SCALAR, [NeedsVelocities, Sum], [r#"body = "fill""#] =>
        vec![observe::kinetic_energy(sample.points, sample.part, sample.halo)];
    /// Mean Cauchy stress, positive in tension, weighted with the present volumes of the material points.
    MeanStress = "mean-stress": Part, "Pa", STRESS, [], ["box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }"] =>
        observe::stress_components::<D>(&observe::mean_stress(sample.points, sample.part, sample.halo));
    /// Mean displacement, weighted with the present volumes of the material points.
    MeanDisplacement = "mean-displacement": Part, "m", VECTOR, [], [r#"material = "sand""#] =>
        observe::mean_displacement(sample.points, sample.part, sample.halo).as_slice().to_vec();
    /// Mean velocity, weighted with the present volumes of the material points.
    MeanVelocity = "mean-velocity": Part, "m/s", VECTOR, [NeedsVelocities], [r#"body = "fill""#] =>
        observe::mean_velocity(sample.points, sample.part, sample.halo).as_slice().to_vec();
    /// Accumulated plastic strain, the sum of sqrt(2/3) times the norm of the deviatoric plastic strain increments.
    PlasticStrain = "plastic-strain": Part, "-", STRAIN, [], [r#"material = "sand""#] =>
        observe::plastic_strain(sample.points, sample.part, sample.halo).to_vec();
    /// Forces of the effective stress on a section: the line from `from` to `to`, in 3-D a `rectangle` or `disc`.
    /// Parts outside the body do not count. The forces act on the material to the left of the line, in 3-D on the
    /// material before the section (on the side of the negative normal axis). The axes t1 and t2 follow the normal
    /// axis in the cyclic order x, y, z, and rotate with the section.
    SectionForces = "section-forces": Section, "N/m", SECTION, [], ["from = [1.0, 0.0]", "to = [1.0, 1.25]"] => sample.section_forces();
    /// Mass that has left the grid through faces with outflow since the start.
    Outflow = "outflow": Case, "kg/m", SCALAR, [NeedsOutflow], [] => vec![sample.outflow];
    /// Force of a supported face, footing or prescribed displacement on the soil. At a common edge of two supported
    /// faces each force component belongs to the face that is normal to this component. At a common edge of a fixed
    /// face and a footing or prescribed displacement the force belongs to the face. In water the force is that of
    /// the effective stress and the excess pore pressure.
    Reaction = "reaction": Face, "N/m", VECTOR, [NeedsSupport, Force], [r#"face = "bottom""#] => sample.reaction();
    /// Moment of the reaction force of a footing or prescribed displacement about its centre, positive
    /// counter-clockwise.
    Moment = "moment": Strip, "N", SCALAR, [PlaneOnly, ZeroByAxisymmetry], [r#"of = "footing""#] =>
        vec![sample.strip().map_or(0.0, |strip| strip.moment)];
    /// Work of a footing or prescribed displacement on the soil since the start, computed with the mean force of
    /// every step.
    Work = "work": Strip, "J/m", SCALAR, [], [r#"of = "footing""#] => vec![sample.work];
    /// Displacement of the material that is initially at `at`, extrapolated from the nearest material point.
    Displacement = "displacement": MaterialPlace, "m", VECTOR, [], ["at = [2.0, 0.5]"] => sample.displacement();
    /// Velocity of the material point that is initially nearest to `at`; with `surface`, velocity at `at`.
    Velocity = "velocity": Place, "m/s", VECTOR, [NeedsVelocities], ["at = [2.0, 1.0]", "surface = true"] =>
        sample.at_place(|p| sample.velocity(p));
    /// Cauchy stress, positive in tension, of the material point that is initially nearest to `at`; with `surface`,
    /// stress at `at`.
    Stress = "stress": Place, "Pa", STRESS, [], ["at = [2.0, 1.0]", "surface = true"] =>
        observe::stress_components::<D>(&sample.at_place(|p| sample.points.sigma.at(p).0));
    /// Pore pressure, positive in compression, at the material point that is initially nearest to `at`.
    PorePressure = "pore-pressure": Place, "Pa", SCALAR, [], ["at = [2.0, 0.5]"] => sample.pore_water(PoreWater::pressure);
    /// Pore pressures, positive in compression, of all material points, or those of a material or body.
    PorePressures = "pore-pressures": Part, "Pa", RANGE, [], [r#"material = "clay""#] =>
        sample.water().map_or([0.0; 3], |water| water.range(sample.part, sample.halo)).to_vec();
    /// Excess pore pressure (pore pressure minus hydrostatic pressure of the present water level) at the material
    /// point that is initially nearest to `at`.
    ExcessPressure = "excess-pressure": Place, "Pa", SCALAR, [NeedsFlow], ["at = [2.0, 0.5]"] => sample.pore_water(PoreWater::excess);
    /// Porosity at the material point that is initially nearest to `at`, with pore-water flow.
    Porosity = "porosity": Place, "-", SCALAR, [NeedsFlow], ["at = [2.0, 0.5]"] => sample.pore_water(PoreWater::porosity);
    /// Darcy velocity (volume of water per area and time, relative to the soil) at the material point that is
    /// initially nearest to `at`. At the surface of strongly deformed ground the values of adjacent cells can
    /// differ by a third or more. `water-outflow` does not have this error.
    Flux = "flux": Place, "m/s", VECTOR, [NeedsFlow], ["at = [2.0, 0.5]"] => sample.flux()?;
    /// Volume of water that has left the ground through a drain since the start. Without `drain` it is the volume
    /// through all drains minus the volume of all inflows.
    WaterOutflow = "water-outflow": Drain, "m3/m", SCALAR, [NeedsFlow], [r#"drain = "base""#] => vec![sample.drained];
    /// Relative error of the water balance: the change of the water volume in the ground since the start plus the
    /// volume that has left the ground, divided by the larger of these volumes. It is 0 if no water is created or
    /// lost.
    WaterBalance = "water-balance": Case, "-", SCALAR, [NeedsFlow], [] =>
        vec![sample.water().and_then(|water| water.balance(sample.crossed, sample.halo)).unwrap_or(0.0)];
    /// Oscillation of the vertical stress between neighbouring material points: its root mean square, divided by
    /// the mean of |sigma_yy|.
    StressNoise = "stress-noise": Case, "-", NOISE, [PlaneOnly], [] => both(noise::stress_noise(
        &sample.model.grid,
        sample.points,
        sample.model.weighting,
        VERTICAL,
        sample.halo,
    )?);
    /// Oscillation of the pressure between neighbouring material points: its root mean square.
    PressureNoise = "pressure-noise": Part, "Pa", NOISE, [PlaneOnly], ["box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }"] =>
        both(noise::pressure_noise(
            &sample.model.grid,
            sample.points,
            sample.part,
            sample.model.weighting,
            sample.halo,
        )?);
    /// The largest upward displacement of all material points.
    Heave = "heave": Part, "m", SCALAR, [], [] => vec![observe::heave(sample.points, sample.part, sample.halo)];
    /// Mean normal pressure at the base of the footing.
    FootingPressure = "footing-pressure": Case, "Pa", SCALAR, [NeedsFooting, Force], [] => vec![sample.footing.pressure];
    /// Force of the soil on the footing, positive against the motion of the footing.
    FootingForce = "footing-force": Case, "N/m", SCALAR, [NeedsFooting, Force], [] => vec![sample.footing.force];
    /// Downward displacement of the footing.
    Penetration = "penetration": Case, "m", SCALAR, [NeedsFooting, RigidMotion], [] => vec![sample.footing.penetration];
    /// Largest slip of the material along the footing in the step, divided by the displacement of the footing in
    /// the step.
    Slip = "slip": Case, "-", SCALAR, [NeedsFooting], [] => vec![sample.footing.slip];
    /// Contact of a face, footing or segment: fraction of its nodes near material at which the contact is closed,
    /// and fraction of its normal force at which material slides.
    Contact = "contact": Face, "-", CONTACT, [NeedsContact], [r#"of = "footing""#] => {
        let found = sample.contact();
        vec![found.closed, found.sliding]
    };
    /// Smallest and largest distance of the material from the nodes of a face, footing or segment in contact. Only
    /// nodes with material in their cells count. Without such nodes, and before the first step, the values are 0.
    Gap = "gap": Face, "m", GAP, [NeedsContact], [r#"of = "footing""#] => sample.contact().gap.to_vec();
    /// Sliding velocity of the material along a face, footing or segment in contact: mean of the step, weighted
    /// with the normal force.
    SlipRate = "slip-rate": Face, "m/s", SCALAR, [NeedsContact], [r#"of = "footing""#] => vec![sample.rate(sample.contact().slip)];
    /// Power that friction dissipates at a face, footing or segment in contact: mean of the step.
    FrictionPower = "friction-power": Face, "W/m", SCALAR, [NeedsContact], [r#"of = "footing""#] =>
        vec![sample.rate(sample.contact().dissipated)];
    /// Mobilised friction of a face, footing or segment in contact: the tangential part of its `reaction`, divided by
    /// the friction coefficient times the normal part. It is 1 if all nodes slide in the same direction, and 0 without
    /// pressure or friction.
    MobilisedFriction = "mobilised-friction": Face, "-", SCALAR, [NeedsContact], [r#"of = "footing""#] =>
        vec![sample.mobilised_friction()];
    /// Force of the soil on a rigid body.
    RigidForce = "rigid-force": Rigid, "N/m", VECTOR, [Force], [r#"rigid = "pipe""#] => sample.rigid().force.as_slice()[..D].to_vec();
    /// Moment of the soil on a rigid body about its reference point, positive counter-clockwise.
    RigidMoment = "rigid-moment": Rigid, "N", SCALAR, [PlaneOnly, ZeroByAxisymmetry], [r#"rigid = "pipe""#] =>
        vec![sample.rigid().force[2]];
    /// Displacement of the reference point of a rigid body.
    RigidDisplacement = "rigid-displacement": Rigid, "m", VECTOR, [RigidMotion], [r#"rigid = "pipe""#] =>
        sample.rigid().moved.as_slice()[..D].to_vec();
    /// Rotation of a rigid body, positive counter-clockwise.
    RigidRotation = "rigid-rotation": Rigid, "deg", SCALAR, [RigidMotion, PlaneOnly, ZeroByAxisymmetry], [r#"rigid = "pipe""#] =>
        vec![sample.rigid().moved[2].to_degrees()];
    /// Velocity of the reference point of a rigid body.
    RigidVelocity = "rigid-velocity": Rigid, "m/s", VECTOR, [NeedsVelocities], [r#"rigid = "pipe""#] =>
        sample.rigid().velocity.as_slice()[..D].to_vec();
    /// Accumulated sliding distance of the soil along the outline of a rigid body. The slip of each step is a mean,
    /// weighted with the normal force.
    RigidSlip = "rigid-slip": Rigid, "m", SCALAR, [], [r#"rigid = "pipe""#] => vec![sample.rigid().slipped];
    /// Smallest distance of the soil from a rigid body. It is 0 in contact, and before the first step.
    RigidGap = "rigid-gap": Rigid, "m", SCALAR, [], [r#"rigid = "pipe""#] => vec![sample.rigid().gap];
    /// Work of a rigid body on the soil since the start, including friction. It is computed with the mean force of
    /// every step, in dynamic analyses with the force at the end of the step.
    RigidWork = "rigid-work": Rigid, "J/m", SCALAR, [], [r#"rigid = "pipe""#] => vec![sample.rigid().work];
    /// Energy balance since the start: external = change of kinetic + change of elastic + plastic + numerical +
    /// closure.
    Energy = "energy": Case, "J/m", ENERGY, [], [] => sample.energy.to_vec();
}

fn both(noise: noise::Noise) -> Vec<f64> {
    vec![noise.about_average, noise.about_plane]
}

impl fmt::Display for Observable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl Observable {
    /// Whether it has an aspect.
    pub fn has(self, aspect: Aspect) -> bool {
        self.definition().aspects.contains(&aspect)
    }

    /// An item of the list `history` that records it, as written in a case file.
    pub fn example(self) -> String {
        let quantity = format!("quantity = \"{self}\"");
        let keys = self.definition().example.iter().map(|key| (*key).to_owned());
        let keys: Vec<String> = std::iter::once(quantity).chain(keys).collect();
        format!("{{ {} }}", keys.join(", "))
    }

    /// Unit of its numbers in plane strain.
    pub fn unit(self) -> &'static str {
        self.definition().unit
    }

    /// What the names of its columns get appended along so many axes, in the order of the numbers, and what each is.
    pub fn columns_in(self, dims: usize) -> &'static [(&'static str, &'static str)] {
        self.definition().columns.in_dimensions(dims)
    }

    /// Unit of the numbers of a column, of those along so many axes.
    pub fn unit_of(self, column: usize, dims: usize) -> &'static str {
        // Forces along the axes are first, then the moments.
        if self == Self::SectionForces && column >= dims {
            "N m/m"
        } else {
            self.unit()
        }
    }
}
