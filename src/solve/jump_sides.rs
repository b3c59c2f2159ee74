//! The displacements that each jump lies between: jump = u(ground) - u(body), all of them j = N u.

/// N, by where ground and body of each jump stand in a vector of displacements; none where a support holds that side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JumpSides(Vec<[Option<usize>; 2]>);

impl JumpSides {
    pub fn new(of_jumps: Vec<[Option<usize>; 2]>) -> JumpSides {
        JumpSides(of_jumps)
    }

    /// Number of jumps.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// In the part of the vector that begins with displacement `first`.
    ///
    /// # Panics
    /// If a side stands before it.
    pub fn behind(&self, first: usize) -> JumpSides {
        let place = |i: usize| i.checked_sub(first).expect("interface nodes are numbered last");
        JumpSides(self.0.iter().map(|sides| sides.map(|side| side.map(place))).collect())
    }

    /// (place, sign) of the displacements whose sum a jump is.
    pub fn of(&self, jump: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        self.0[jump].into_iter().zip([1., -1.]).filter_map(|(place, sign)| Some((place?, sign)))
    }

    /// N u: the jumps of displacements (or velocities) [as u].
    pub fn differences(&self, u: &[f64]) -> Vec<f64> {
        let at = |side: Option<usize>| side.map_or(0., |i| u[i]);
        self.0.iter().map(|&[ground, body]| at(ground) - at(body)).collect()
    }

    /// f <- f + factor N' forces [N].
    pub fn add_forces(&self, f: &mut [f64], factor: f64, forces: &[f64]) {
        for (&[ground, body], force) in self.0.iter().zip(forces) {
            ground.iter().for_each(|&i| f[i] += factor * force);
            body.iter().for_each(|&i| f[i] -= factor * force);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_is_ground_minus_body_and_a_held_side_does_not_move() {
        let sides = JumpSides::new(vec![[Some(2), Some(4)], [None, Some(3)]]);
        assert_eq!(sides.differences(&[0., 0., 5., 7., 2.]), [3., -7.]);
        assert_eq!(sides.of(0).collect::<Vec<_>>(), [(2, 1.), (4, -1.)]);
        assert_eq!(sides.behind(2).of(1).collect::<Vec<_>>(), [(1, -1.)]);
        let mut f = vec![1.; 5];
        sides.add_forces(&mut f, 2., &[10., 100.]);
        assert_eq!(f, [1., 1., 21., -199., -19.]);
    }
}
