//! The causal bound in words: when which boundary is felt, and whether a held base can converge at all.

use super::report::short;
use super::{Size, Study};
use crate::model::arrival::{Return, Returns};
use crate::study::quantity::Quantity;

/// First return of the boundaries that move (sides with the width, base with the height) to a probe that is compared,
/// through the ground alone [s]; infinite where there is none.
pub fn first(returns: Option<&Returns>, [width, height]: [bool; 2], quantities: &[Quantity]) -> f64 {
    let Some(returns) = returns else { return f64::INFINITY };
    let boundaries = [(width, &returns.sides), (height, &returns.base)];
    let moved = boundaries.into_iter().filter(|(moves, _)| *moves).flat_map(|(_, list)| list);
    moved.filter(|r| is_compared(r, quantities)).map(|r| r.through_ground).fold(f64::INFINITY, f64::min)
}

/// A ring is felt where any of its probes is: then all count.
fn is_compared(r: &Return, quantities: &[Quantity]) -> bool {
    quantities.iter().any(|q| match q {
        Quantity::Motion { probe, .. } => *probe == r.probe,
        Quantity::Ring { .. } => true,
    })
}

fn milliseconds(t: f64) -> String {
    if t.is_finite() { format!("{:.2}", 1e3 * t) } else { "never".into() }
}

impl Study<'_> {
    /// When each boundary of a size is first felt at each probe, and what follows.
    pub fn bound(&self, size: Size, returns: &Returns, beta: f64) -> String {
        let mut text = format!(
            "first return of P waves at {} x {} (ground: through the ground alone; bound: no wave can be earlier, pipes crossed \
             in no time)\n  probe     base [ms]: ground   bound   sides [ms]: ground   bound\n",
            short(size[0]),
            short(size[1])
        );
        for (base, side) in returns.base.iter().zip(&returns.sides) {
            let [a, b, c, d] =
                [base.through_ground, base.not_before, side.through_ground, side.not_before].map(milliseconds);
            text += &format!("  {:<9} {a:>17} {b:>7} {c:>20} {d:>7}\n", base.probe);
        }
        text += match (returns.sides_carry_free_field, returns.something_scatters) {
            (true, true) => {
                "  sides: they carry the uniform load's plane wave exactly; only what pipes, cavities or inner supports scatter \
                 feels them\n"
            }
            (true, false) => "  sides: they carry the uniform load's plane wave exactly, and nothing scatters it\n",
            (false, _) => "  sides: felt from the nearest place on that is loaded, or moves at t = 0\n",
        };
        let base = first(Some(returns), [false, true], &self.quantities);
        if beta > 0. && base.is_finite() {
            let spread = (beta * base).sqrt();
            text += &format!(
                "  beta = {beta:.4e} s spreads a front over about sqrt(beta T) = {} ms: felt faintly from about T - 2 sqrt(beta T) \
                 = {} ms on\n",
                milliseconds(spread),
                milliseconds((base - 2. * spread).max(0.))
            );
        }
        text + &self.rigid_base(size, returns, base)
    }

    /// Whether the window is longer than a held base lets it be. Each metre of height delays the return by 2 / c_p.
    fn rigid_base(&self, [_, height]: Size, returns: &Returns, first: f64) -> String {
        if !returns.base_is_held || first >= self.until {
            return String::new();
        }
        let until = milliseconds(self.until);
        if !returns.load_is_uniform {
            return format!(
                "  the base is held: it gives waves back. In the {until} ms compared, what comes after {} ms changes with the height until \
                 they have spread out or been damped; compare until then (--until), go deeper, or write \"boundaries\": {{ \"base\": \
                 \"viscous\" }}\n",
                milliseconds(first)
            );
        }
        let needed = height + (self.until - first) * returns.base_speed / 2.;
        format!(
            "  the base is held: it gives the plane wave of a uniform load back whole, however deep it lies. In the {until} ms \
             compared, what comes after {} ms cannot converge below {} = {} but by damping; compare until {} ms (--until), go that \
             deep, or write \"boundaries\": {{ \"base\": \"viscous\" }}\n",
            milliseconds(first),
            self.options.height,
            short((10. * needed).ceil() / 10.),
            milliseconds(first)
        )
    }
}
