//! Physics that knows no mesh: element, material, joint law, histories in time.

pub mod damping;
pub mod element;
pub mod explosion;
pub mod friedlander;
pub mod front;
pub mod joint;
pub mod material;
pub mod polyline;
pub mod pulse;
pub mod shape;
