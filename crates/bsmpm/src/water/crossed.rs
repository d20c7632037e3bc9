//! Volumes of water that left or entered the ground.

/// m3 (per metre in plane strain)  volumes of water, per surface
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CumulativeFlux {
    /// out of the ground, through every drain
    pub drains: Vec<f64>,
    /// out of the ground, through every drained face of the grid
    pub faces: Vec<f64>,
    /// into the ground, through every inflow
    pub inflows: Vec<f64>,
    /// that ground had taken in since the start which stages took away, less what ground that they placed held more
    /// than it would have at the start
    pub removed: f64,
}

impl CumulativeFlux {
    /// Adds `times` as much as has gone through since.
    pub fn add(&mut self, times: f64, more: &Self) {
        let lists = [&mut self.drains, &mut self.faces, &mut self.inflows];
        for (sums, more) in lists.into_iter().zip([&more.drains, &more.faces, &more.inflows]) {
            sums.resize(sums.len().max(more.len()), 0.0);
            sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += times * more);
        }
        self.removed += times * more.removed;
    }

    /// What has left the ground through its surface, or what has come in, whichever is more.
    pub fn through(&self) -> f64 {
        let out = self
            .drains
            .iter()
            .chain(&self.faces)
            .copied()
            .chain(self.inflows.iter().map(|inflow| -inflow));
        let mut left = 0.0;
        let mut come = 0.0;
        out.for_each(|out| if out > 0.0 { left += out } else { come -= out });
        f64::max(left, come)
    }

    /// All that has left the ground through its surface, less what has come in.
    pub fn out(&self) -> f64 {
        self.drains.iter().chain(&self.faces).sum::<f64>() - self.inflows.iter().sum::<f64>()
    }
}

/// The last step's flow, which the next one goes on with; what points took in stands with them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PreviousFlow {
    /// s  length of the step
    pub dt: f64,
    /// m3  that crossed the surface of the ground in it
    pub crossed: CumulativeFlux,
    /// m3  that it left out of balance
    pub left: f64,
}
