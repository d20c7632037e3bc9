//! Cases with extreme parameters, in any units and with any origin of coordinates.

/// What a metre, a kilogram and a second are, and where the origin lies (m).
#[derive(Clone, Copy, Debug)]
pub struct Units {
    pub length: f64,
    pub mass: f64,
    pub time: f64,
    pub origin: f64,
}

/// SI, at the origin.
pub const SI: Units = Units {
    length: 1.0,
    mass: 1.0,
    time: 1.0,
    origin: 0.0,
};

impl Units {
    /// The value of a stress of 1 Pa.
    pub fn stress(&self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    fn place(&self, x: f64) -> f64 {
        self.origin + self.length * x
    }
}

/// A soil with friction, as numbers in SI and degrees.
#[derive(Clone, Copy, Debug)]
pub struct Soil {
    pub young: f64,
    pub poisson: f64,
    pub friction: f64,
    pub cohesion: f64,
}

/// The rods of the collapse.
pub const RODS: Soil = Soil {
    young: 5840e3,
    poisson: 0.3,
    friction: 21.9,
    cohesion: 0.0,
};

/// The coarse column collapse with cells of `cell` m and `per_cell` x `per_cell` points, up to `end` s by steps of `dt`
/// s.
pub struct Collapse {
    pub soil: Soil,
    pub method: &'static str,
    pub end: f64,
    pub dt: f64,
    pub cell: f64,
    pub per_cell: usize,
    pub mirrored: bool,
    pub units: Units,
}

impl Default for Collapse {
    fn default() -> Self {
        let soil = RODS;
        let units = SI;
        Self {
            soil,
            method: "modified-f-bar",
            end: 0.1,
            dt: 0.5e-3,
            cell: 0.01,
            per_cell: 2,
            mirrored: false,
            units,
        }
    }
}

impl Collapse {
    /// The text: 20 x 10 cells of material in a grid of 56 x 11.
    pub fn text(&self) -> String {
        let Self {
            soil,
            method,
            cell,
            per_cell,
            units,
            ..
        } = self;
        let [zero, top] = [0.0, 11.0 * cell].map(|y| units.place(y));
        let (left, right) = if self.mirrored { (36.0, 56.0) } else { (0.0, 20.0) };
        let [left, right, end] = [left, right, 56.0].map(|cells| units.place(cells * cell));
        let acceleration = -9.81 * units.length / (units.time * units.time);
        // The program takes density = unit_weight / 9.81 m/s2.
        let weight = 20.4e3 * units.mass / units.length.powi(3);
        let strength = format!(
            "friction_angle = {}\ncohesion = {}",
            soil.friction,
            soil.cohesion * units.stress()
        );
        format!(
            "geometry = \"plane-strain\"\n[analysis]\ntype = \"dynamic\"\nend = {}\ndt = {}\n\
             [grid]\nlower = [{zero}, {zero}]\nupper = [{end}, {top}]\ncell = {}\ndegree = \"quadratic\"\n\
             [material.rods]\nmodel = \"mohr-coulomb\"\nyoung = {}\npoisson = {}\n{strength}\nunit_weight = {weight}\n\
             [[body]]\nmaterial = \"rods\"\nbox = {{ lower = [{left}, {zero}], upper = [{right}, {}] }}\n\
             points_per_cell = {per_cell}\n[gravity]\nacceleration = [0.0, {acceleration}]\n\
             [boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n\
             [stabilisation]\nmethod = \"{method}\"\n[output]\ntimes = [{}]\n\
             [[history]]\nquantity = \"runout\"\n[[history]]\nquantity = \"max-displacement\"\n",
            self.end * units.time,
            self.dt * units.time,
            cell * units.length,
            soil.young * units.stress(),
            soil.poisson,
            units.place(10.0 * cell),
            self.end * units.time,
        )
    }
}

/// The coarse strip footing of half a cell per 0.5 m, pushed to `depth` m in `steps` steps.
pub struct Footing {
    pub poisson: f64,
    pub method: &'static str,
    pub depth: f64,
    pub steps: usize,
    pub per_cell: usize,
    /// m  the grid's upper end, above the ground at 5 m
    pub top: f64,
    pub solver: &'static str,
    pub units: Units,
}

impl Default for Footing {
    fn default() -> Self {
        let depth = 0.2;
        let steps = 16;
        Self {
            poisson: 0.495,
            method: "modified-f-bar",
            depth,
            steps,
            per_cell: 3,
            top: 7.0,
            solver: "",
            units: SI,
        }
    }
}

impl Footing {
    /// The text: 5 x 5 m of weightless clay, E/c = 100, under a strip 1 m wide beside the axis of symmetry.
    pub fn text(&self) -> String {
        let Self {
            poisson,
            method,
            per_cell,
            units,
            ..
        } = self;
        let [zero, one, five, top] = [0.0, 1.0, 5.0, self.top].map(|x| units.place(x));
        let depth = self.depth * units.length;
        let cell = 0.5 * units.length;
        format!(
            "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nsteps = {}\n\
             [grid]\nlower = [{zero}, {zero}]\nupper = [{five}, {top}]\ncell = {cell}\ndegree = \"quadratic\"\n\
             [material.clay]\nmodel = \"tresca\"\nyoung = {}\npoisson = {poisson}\ncohesion = {}\n\
             [[body]]\nmaterial = \"clay\"\nbox = {{ lower = [{zero}, {zero}], upper = [{five}, {five}] }}\n\
             points_per_cell = {per_cell}\n[footing]\nfrom = [{zero}, {five}]\nto = [{one}, {five}]\n\
             displacement = [0.0, -{depth}]\ninterface = \"smooth\"\n\
             [boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n\
             [stabilisation]\nmethod = \"{method}\"\n[solver]\nbackground = 1e-3\nmax_iterations = 1000\n{}\n\
             [output]\ntimes = [1.0]\n[[history]]\nquantity = \"footing-pressure\"\nname = \"pressure\"\n\
             [[history]]\nquantity = \"pressure-noise\"\nname = \"noise\"\n",
            self.steps,
            1e5 * units.stress(),
            1e3 * units.stress(),
            self.solver,
        )
    }

    /// Mean pressure under the strip over the cohesion, from its history.
    pub fn factor(pressure: f64) -> f64 {
        pressure / 1e3
    }
}

/// Layers of elastic soil between smooth walls, from the bottom up, each with Young's modulus (Pa), density (kg/m3) and
/// height (m), 2 m wide on cells of 1 m, under gravity that grows in `steps` steps.
pub fn layers(layers: &[(f64, f64, f64)], further: &str, steps: usize, acceleration: f64) -> String {
    let mut materials = String::new();
    let mut base = 0.0;
    for (number, (young, density, height)) in layers.iter().enumerate() {
        let top = base + height;
        materials += &format!(
            "[material.layer{number}]\nmodel = \"elastic\"\nyoung = {young}\npoisson = 0.3\ndensity = {density}\n\
             [[body]]\nmaterial = \"layer{number}\"\nbox = {{ lower = [0.0, {base:?}], upper = [2.0, {top:?}] }}\n\
             points_per_cell = 3\n"
        );
        base = top;
    }
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"quasi-static\"\nsteps = {steps}\n\
         [grid]\nlower = [0.0, 0.0]\nupper = [2.0, {:?}]\ncell = 1.0\ndegree = \"quadratic\"\n{materials}\
         [gravity]\nacceleration = [0.0, {}]\nramp = 1.0\n\
         [boundary]\nbottom = \"fixed\"\nleft = \"roller\"\nright = \"roller\"\n[output]\ntimes = [1.0]\n\
         [[history]]\nquantity = \"reaction\"\nface = \"bottom\"\n[[history]]\nquantity = \"max-displacement\"\n{further}",
        base + 1.0,
        -acceleration,
    )
}

/// A free elastic block of 5 x 5 cells of 0.5 m, 100 points, with a velocity, for `steps` steps of 1 ms.
pub fn block(velocity: [f64; 2], steps: usize, further: &str) -> String {
    let [x, y] = velocity;
    format!(
        "geometry = \"plane-strain\"\n[analysis]\ntype = \"dynamic\"\nend = {:?}\nsteps = {steps}\n\
         [grid]\nlower = [0.0, 0.0]\nupper = [30.0, 4.0]\ncell = 0.5\ndegree = \"quadratic\"\n\
         [material.rubber]\nmodel = \"elastic\"\nyoung = 1e5\npoisson = 0.3\ndensity = 1000.0\n\
         [[body]]\nmaterial = \"rubber\"\nbox = {{ lower = [1.0, 0.5], upper = [3.5, 3.0] }}\npoints_per_cell = 2\n\
         velocity = [{x:e}, {y:e}]\n{further}\
         [output]\nevery_steps = {steps}\n[[history]]\nquantity = \"mass\"\n[[history]]\nquantity = \"momentum\"\n\
         [[history]]\nquantity = \"height\"\n",
        steps as f64 * 1e-3,
    )
}
