//! What a frame takes from a state.

use crate::model::resolve::Model;
use crate::physics::joint::Status;
use crate::solve::interface::{Interface, JointPoint, JointState};
use crate::solve::system::{State, System};
use nalgebra::Vector2;

/// Everything of a state that a frame shows, taken out of the solver so that another thread can write it.
#[derive(Debug, Clone)]
pub struct Frame {
    /// [s]
    pub time: f64,
    /// the unknowns and their rates: what moves the nodes
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
    pub joints: Vec<JointCell>,
}

/// A joint element's mean over its points. Vectors are in global axes, each point's turned by its own normal n, which
/// points from the body into the ground, and tangent s, anticlockwise round the body: so a traction vector times the
/// joint's length is the force on the body, although the normal turns along a curved joint.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointCell {
    /// normal distance of the two sides, positive open [m]
    pub gap: f64,
    /// plastic slip, positive where the ground moved along s relative to the body [m]
    pub slip: f64,
    /// tension positive [Pa]
    pub normal_traction: f64,
    /// positive where the ground drags the body along s [Pa]
    pub shear_traction: f64,
    /// gap n [m]
    pub gap_vector: [f64; 2],
    /// slip s [m]
    pub slip_vector: [f64; 2],
    /// u(ground) - u(body) [m]
    pub jump_vector: [f64; 2],
    /// of the ground on the body, normal_traction n + shear_traction s [Pa]
    pub traction_vector: [f64; 2],
    /// the most open of its points: 1 sticks, 2 slips, 3 open
    pub status: i32,
}

impl Frame {
    pub fn of(model: &Model, system: &System, state: &State) -> Frame {
        Frame {
            time: state.time,
            q: state.q.clone(),
            v: state.v.clone(),
            a: state.a.clone(),
            joints: joint_cells(&system.interface, model.joints.len(), system.jumps(&state.q), state),
        }
    }
}

fn joint_cells(interface: &Interface, joints: usize, jumps: &[f64], state: &State) -> Vec<JointCell> {
    let mut cells = vec![JointCell::default(); joints];
    let mut areas = vec![0.; joints];
    for (point, memory) in interface.points.iter().zip(&state.joints) {
        let at_point = at_point(interface, point, jumps, memory);
        for &(joint, area) in &point.parts {
            cells[joint] = cells[joint].plus(area, &at_point);
            areas[joint] += area;
        }
    }
    cells.iter().zip(areas).map(|(sum, area)| sum.map(|value| value / area)).collect()
}

/// A joint point as if it were a whole joint.
fn at_point(interface: &Interface, point: &JointPoint, jumps: &[f64], memory: &JointState) -> JointCell {
    let jump = interface.local(point, jumps);
    let gap = jump[1] + point.law.gap;
    // R' turns (tangential, normal) into global axes
    let to_global = point.rotation().transpose();
    JointCell {
        gap,
        slip: memory.slip,
        normal_traction: memory.traction[1],
        shear_traction: memory.traction[0],
        gap_vector: (to_global * Vector2::new(0., gap)).into(),
        slip_vector: (to_global * Vector2::new(memory.slip, 0.)).into(),
        jump_vector: (to_global * jump).into(),
        traction_vector: (to_global * memory.traction).into(),
        status: status_number(memory.status),
    }
}

impl JointCell {
    /// With another's values times a weight; the status is the more open one.
    fn plus(&self, weight: f64, other: &JointCell) -> JointCell {
        let vector = |a: [f64; 2], b: [f64; 2]| [a[0] + weight * b[0], a[1] + weight * b[1]];
        JointCell {
            gap: self.gap + weight * other.gap,
            slip: self.slip + weight * other.slip,
            normal_traction: self.normal_traction + weight * other.normal_traction,
            shear_traction: self.shear_traction + weight * other.shear_traction,
            gap_vector: vector(self.gap_vector, other.gap_vector),
            slip_vector: vector(self.slip_vector, other.slip_vector),
            jump_vector: vector(self.jump_vector, other.jump_vector),
            traction_vector: vector(self.traction_vector, other.traction_vector),
            status: self.status.max(other.status),
        }
    }

    fn map(&self, of: impl Fn(f64) -> f64) -> JointCell {
        JointCell {
            gap: of(self.gap),
            slip: of(self.slip),
            normal_traction: of(self.normal_traction),
            shear_traction: of(self.shear_traction),
            gap_vector: self.gap_vector.map(&of),
            slip_vector: self.slip_vector.map(&of),
            jump_vector: self.jump_vector.map(&of),
            traction_vector: self.traction_vector.map(&of),
            status: self.status,
        }
    }
}

fn status_number(status: Status) -> i32 {
    match status {
        Status::Stick => 1,
        Status::SlipForward | Status::SlipBackward => 2,
        Status::Open => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::interface::testing::{LAW, along};

    /// Two joints of lengths 1 and 3 that share the middle one of three points: each one's mean is of its own two ends.
    #[test]
    fn a_joint_shows_the_mean_of_its_own_points() {
        let interface = along(&[[0., 0.], [1., 0.], [4., 0.]], &[LAW, LAW]);
        let joint = |slip: f64, status: Status| JointState { slip, status, traction: Vector2::new(slip, -2. * slip) };
        let joints = vec![joint(1., Status::Stick), joint(3., Status::SlipForward), joint(7., Status::Open)];
        let state = State { time: 0., q: vec![], v: vec![], a: vec![], joints, free_field: vec![], largest_force: 0. };
        // normals point down: y opens a joint by less of it
        let jumps = [0., -0.1, 0., -0.3, 0., -0.7];
        let cells = joint_cells(&interface, 2, &jumps, &state);
        for (cell, [slip, gap, status]) in cells.iter().zip([[2., 0.2, 2.], [5., 0.5, 3.]]) {
            let found = [cell.slip, cell.shear_traction, cell.normal_traction, cell.gap, f64::from(cell.status)];
            let should = [slip, slip, -2. * slip, gap, status];
            assert!(found.iter().zip(should).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}, should be {should:?}");
        }
    }

    /// A joint along (0.6, 0.8), the body above it on its left: n = (0.8, -0.6) points into the ground, s = (0.6, 0.8).
    /// Pressed by 5 Pa and dragged by 10 Pa along s, the body feels -5 n + 10 s = (2, 11) Pa. The gap before any load,
    /// 0.25 m, is in the gap and not in the jump.
    #[test]
    fn vectors_are_in_global_axes_and_tractions_act_on_the_body() {
        let law = crate::physics::joint::JointLaw { gap: 0.25, ..LAW };
        let interface = along(&[[0., 0.], [3., 4.]], &[law]);
        let memory = JointState { slip: 0.5, status: Status::SlipForward, traction: Vector2::new(10., -5.) };
        let state = State {
            time: 0.,
            q: vec![],
            v: vec![],
            a: vec![],
            joints: vec![memory; 2],
            free_field: vec![],
            largest_force: 0.,
        };
        // both pairs part by 2 along n and by 1 along s
        let cell = joint_cells(&interface, 1, &[2.2, -0.4, 2.2, -0.4], &state)[0];
        let found = [cell.gap_vector, cell.slip_vector, cell.jump_vector, cell.traction_vector];
        let should = [[2.25 * 0.8, -2.25 * 0.6], [0.3, 0.4], [2.2, -0.4], [2., 11.]];
        for (found, should) in found.iter().flatten().zip(should.iter().flatten()) {
            assert!((found - should).abs() < 1e-14, "{found} is not {should}");
        }
    }
}
