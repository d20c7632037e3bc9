//! Volumes of water that left or entered the ground.

/// Water volumes through the surfaces of the ground (m3, per metre in plane strain).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrossedVolumes {
    /// Outflow of every drain.
    pub drains: Vec<f64>,
    /// Outflow of every drained face of the grid.
    pub faces: Vec<f64>,
    /// Inflow of every inflow surface.
    pub inflows: Vec<f64>,
    /// Water that removed ground had taken in since the start, less the surplus of placed ground over its content at
    /// the start.
    pub removed: f64,
}

impl CrossedVolumes {
    /// Adds `times` the volumes of `more`.
    pub fn add(&mut self, times: f64, more: &Self) {
        let lists = [&mut self.drains, &mut self.faces, &mut self.inflows];
        for (sums, more) in lists.into_iter().zip([&more.drains, &more.faces, &more.inflows]) {
            sums.resize(sums.len().max(more.len()), 0.0);
            sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += times * more);
        }
        self.removed += times * more.removed;
    }

    /// Returns the total of net outflows or the total of net inflows through the surfaces, whichever is larger.
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

    /// Returns total outflow less total inflow through the surfaces.
    pub fn out(&self) -> f64 {
        self.drains.iter().chain(&self.faces).sum::<f64>() - self.inflows.iter().sum::<f64>()
    }
}

/// Flow in the last step, which the second-order difference uses. The points store the changes of their water content.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PreviousFlow {
    /// Length of the step (s).
    pub dt: f64,
    /// Volumes through the surfaces of the ground (m3).
    pub crossed: CrossedVolumes,
    /// Sum of the residual of the water balance (m3).
    pub left: f64,
}
