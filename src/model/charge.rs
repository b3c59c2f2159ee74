//! A charge at a place against the curve that its wave strikes.

use super::boundary::Border;
use super::mesh::Mesh;
use crate::number::short;
use crate::physics::explosion::Explosion;
use crate::physics::front::distance;
use crate::{Error, Result};

/// Nearer than this counts as on the curve [m].
const NOTHING: f64 = 1e-6;

/// A piece of the curve as the charge sees it.
struct Piece {
    /// [m]
    distance: f64,
    /// of the charge over the piece's straight line, on the side without solid [m]
    height: f64,
    /// between the way of the wave and the perpendicular, where the wave meets the piece first [degrees]
    angle: f64,
}

/// What does not fit between burst, wave and the charge's place.
///
/// Errors: the charge lies on the solid's side of the curve's nearest piece.
pub fn stands(explosion: &Explosion, at: [f64; 2], mesh: &Mesh, lines: &[Border]) -> Result<Option<String>> {
    let pieces: Vec<Piece> = lines.iter().map(|line| Piece::of(line, at, mesh)).collect();
    let nearest = pieces.iter().map(|p| p.distance).fold(f64::INFINITY, f64::min);
    // at a corner of the curve two pieces are as near: the charge is outside if it is outside of one
    let height =
        pieces.iter().filter(|p| p.distance <= nearest + NOTHING).map(|p| p.height).fold(f64::NEG_INFINITY, f64::max);
    if height < -NOTHING {
        return Err(Error::input(format!(
            "the charge at ({}, {}) m lies {} m under the curve, on the ground's side: the formulas are for bursts in air, on \
             the ground or above it, and nothing here computes a buried charge",
            short(at[0]),
            short(at[1]),
            short(-height)
        )));
    }
    let angles = pieces.iter().map(|p| p.angle);
    let angles = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], a| [low.min(a), high.max(a)]);
    Ok(explosion.misfit(height.max(0.), angles))
}

impl Piece {
    fn of(line: &Border, at: [f64; 2], mesh: &Mesh) -> Piece {
        let [a, b] = [0, 1].map(|i| mesh.points[line.nodes[i]]);
        let [tx, ty] = line.tangent(mesh);
        let [x, y] = [at[0] - a[0], at[1] - a[1]];
        let along = (x * tx + y * ty).clamp(0., distance(a, b));
        let way = distance(at, [a[0] + along * tx, a[1] + along * ty]);
        let height = x * ty - y * tx; // the solid is on the left of the line
        let angle = if way > NOTHING { (height.abs() / way).min(1.).acos().to_degrees() } else { 90. };
        Piece { distance: way, height, angle }
    }
}
