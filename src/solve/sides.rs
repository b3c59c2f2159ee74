//! The displacements that each jump lies between: jump = u(ground) - u(body).

/// For each jump where ground and body stand in a vector of displacements; none where a support holds that side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sides(Vec<[Option<usize>; 2]>);

impl Sides {
    pub fn new(of_jumps: Vec<[Option<usize>; 2]>) -> Sides {
        Sides(of_jumps)
    }

    /// Number of jumps.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// In the vector that begins with displacement `first`; no side stands before it.
    pub fn from(&self, first: usize) -> Sides {
        Sides(self.0.iter().map(|sides| sides.map(|side| side.map(|i| i - first))).collect())
    }

    /// (place, sign) of the displacements whose sum a jump is.
    pub fn of(&self, jump: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        self.0[jump].into_iter().zip([1., -1.]).filter_map(|(place, sign)| Some((place?, sign)))
    }

    /// The jumps of displacements (or velocities) u [as u].
    pub fn differences(&self, u: &[f64]) -> Vec<f64> {
        let at = |side: Option<usize>| side.map_or(0., |i| u[i]);
        self.0.iter().map(|&[ground, body]| at(ground) - at(body)).collect()
    }

    /// f <- f + factor times what forces [N] that pull at the jumps are on ground and bodies.
    pub fn add(&self, f: &mut [f64], factor: f64, forces: &[f64]) {
        for (&[ground, body], force) in self.0.iter().zip(forces) {
            ground.iter().for_each(|&i| f[i] += factor * force);
            body.iter().for_each(|&i| f[i] -= factor * force);
        }
    }
}
