//! Why no step could be accepted.

use crate::physics::joint::Status;

#[derive(Debug, Clone, PartialEq)]
pub enum Unsettled {
    /// no statuses were found that agree with their jumps: the joint points that kept changing, and how all stood last
    Statuses { changing: Vec<usize>, last: Vec<Status> },
    /// the statuses stand, but the residual does not fall: what it stays at, and the joint point where it is largest
    Residual { relative: f64, largest: Option<usize>, last: Vec<Status> },
    /// a body, by its number, keeps moving whatever the joints do, and how they stood last
    Loose { body: usize, last: Vec<Status> },
    /// a node goes farther than any model that is held
    Far { node: usize },
    /// numbers beyond floating point
    Overflow(Place),
    /// joints have made more energy than is tolerated [J]
    Energy { made: f64, supplied: f64 },
}

/// Where numbers first go beyond floating point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    JointPoint(usize),
    Node(usize),
    /// in the matrix of a step
    Matrix,
}
