//! From values on three refinements to the value on infinitely many (Richardson 1911; Roache 1994 for the safety
//! factor).
//!
//! ```text
//! q(h) = q + C h^p;  with h_1 = r h_2 = r^2 h_3:  p = ln((q_2 - q_1) / (q_3 - q_2)) / ln r,
//! q = q_3 + (q_3 - q_2) / (r^p - 1)
//! ```

/// What three values on refinements by the same ratio say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Estimate {
    /// they approach `limit`, with the order observed; `error`: of the limit itself, with the safety factor
    Ordered { limit: f64, order: f64, error: f64 },
    /// they swing about their limit in steps that shrink, or scatter so little that no order can be seen
    Settling { limit: f64, error: f64 },
    /// the steps between them do not shrink
    Diverging,
}

/// Of the methods in use: bilinear elements and the trapezium rule in displacements.
const FORMAL_ORDER: f64 = 2.;
/// Observed orders below it are no convergence that three values could show.
const LEAST_ORDER: f64 = 0.5;
/// Roache's factor for three grids.
const SAFETY: f64 = 1.25;
/// Roache's factor where no order was observed.
const SAFETY_WITHOUT_ORDER: f64 = 3.;
/// Steps below this share of the value that do not shrink are the scatter of unlike meshes, not divergence.
const SCATTER: f64 = 0.01;

impl Estimate {
    /// `values` from the coarsest to the finest, `ratio` > 1 between neighbours.
    pub fn of(values: [f64; 3], ratio: f64) -> Estimate {
        let [coarse, middle, fine] = values;
        let [first, second] = [middle - coarse, fine - middle];
        let largest = first.abs().max(second.abs());
        let order = (first / second).abs().ln() / ratio.ln();
        let shrinks = order >= LEAST_ORDER; // not for 0 / 0 either
        if !shrinks && largest <= SCATTER * fine.abs() {
            return Estimate::Settling { limit: fine, error: SAFETY_WITHOUT_ORDER * largest };
        }
        if !shrinks {
            return Estimate::Diverging;
        }
        // a larger order than the method's own is luck: it must make the error smaller neither by the power nor by the step
        let power = ratio.powf(order.min(FORMAL_ORDER));
        let step = second.abs().max(first.abs() / power);
        if first * second < 0. {
            return Estimate::Settling { limit: (middle + fine) / 2., error: step };
        }
        Estimate::Ordered { limit: fine + second / (power - 1.), order, error: SAFETY * step / (power - 1.) }
    }

    /// The limit and its error, if there is one.
    pub fn limit(&self) -> Option<(f64, f64)> {
        match *self {
            Estimate::Ordered { limit, error, .. } | Estimate::Settling { limit, error } => Some((limit, error)),
            Estimate::Diverging => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sequence(limit: f64, constant: f64, order: f64, ratio: f64) -> [f64; 3] {
        [2, 1, 0].map(|k| limit + constant * ratio.powf(order * k as f64))
    }

    #[test]
    fn a_known_order_and_limit_are_found() {
        for (order, ratio) in [(2., 2.), (1., 2.), (1.5, 1.5), (0.7, 3.)] {
            let Estimate::Ordered { limit, order: found, error } =
                Estimate::of(sequence(3., 0.01, order, ratio), ratio)
            else {
                panic!("order {order}");
            };
            // round-off of the differences, 1e-16 of 3 over 0.003
            assert!((found - order).abs() < 1e-10 && (limit - 3.).abs() < 1e-12, "{found} {limit}");
            assert!((error - 1.25 * 0.01).abs() < 1e-10);
        }
    }

    #[test]
    fn an_order_better_than_the_methods_own_makes_no_smaller_error() {
        let Estimate::Ordered { order, error, .. } = Estimate::of(sequence(1., 0.01, 4., 2.), 2.) else { panic!() };
        // the first step, 0.01 (256 - 16) = 2.4, at order 2: a second of 0.6, and 0.2 to go
        assert!((order - 4.).abs() < 1e-9 && (error - 1.25 * 0.2).abs() < 1e-12);
    }

    /// Steps of 0.05 and 0.0001 are no order of 15: by the first of them, at order 2 and ratio 1.5, 0.05 / 2.25 =
    /// 0.0222 is still to come in the second and 0.0222 / 1.25 after it.
    #[test]
    fn two_values_that_happen_to_agree_do_not_make_a_small_error() {
        let Estimate::Ordered { error, .. } = Estimate::of([1., 1.05, 1.0501], 1.5) else { panic!() };
        assert!((error - 1.25 * 0.05 / 2.25 / 1.25).abs() < 1e-12, "{error}");
        let Estimate::Settling { error, .. } = Estimate::of([1., 1.05, 1.0499], 1.5) else { panic!() };
        assert!((error - 0.05 / 2.25).abs() < 1e-12, "{error}");
    }

    #[test]
    fn what_grows_with_each_refinement_diverges() {
        assert_eq!(Estimate::of([1., 2., 4.], 2.), Estimate::Diverging);
        assert_eq!(Estimate::of([1., 2., 3.], 2.), Estimate::Diverging);
        assert_eq!(Estimate::of([1., 2., 0.5], 2.), Estimate::Diverging);
        assert_eq!(Estimate::of([1., 1., 2.], 2.), Estimate::Diverging);
        assert_eq!(Estimate::of([f64::NAN, 1., 2.], 2.), Estimate::Diverging);
    }

    #[test]
    fn what_swings_less_and_less_settles() {
        assert_eq!(Estimate::of([1., 3., 2.], 2.), Estimate::Settling { limit: 2.5, error: 1. });
        assert_eq!(Estimate::of([2., 2., 2.], 2.), Estimate::Settling { limit: 2., error: 0. });
        assert_eq!(Estimate::of([0.; 3], 2.).limit(), Some((0., 0.)));
        let Some((limit, error)) = Estimate::of([100., 100.1, 99.8], 2.).limit() else { panic!() };
        assert!(limit == 99.8 && (error - 0.9).abs() < 1e-9);
    }
}
