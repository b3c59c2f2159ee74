//! Line plots as SVG.

use crate::{Error, Result};
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// Curves over one pair of axes.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    pub title: String,
    pub x: String,
    pub y: String,
    /// the y axis is logarithmic; values that are not positive are left out
    pub log_y: bool,
    pub curves: Vec<Curve>,
}

#[derive(Debug, Clone, Default)]
pub struct Curve {
    pub name: String,
    pub points: Vec<(f64, f64)>,
    /// with a dot at each point
    pub dots: bool,
}

/// Width and height of a panel [px].
const SIZE: (u32, u32) = (760, 420);

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// The panels one below the other; those without points are left out.
pub fn svg(panels: &[Panel]) -> Result<String> {
    let panels: Vec<Panel> = panels.iter().map(drawable).filter(|p| !p.curves.is_empty()).collect();
    let mut text = String::new();
    {
        let height = SIZE.1 * panels.len().max(1) as u32;
        let root = SVGBackend::with_string(&mut text, (SIZE.0, height)).into_drawing_area();
        let drawn = root.fill(&WHITE).map_err(|e| not_drawn(&e)).and_then(|()| {
            root.split_evenly((panels.len().max(1), 1))
                .iter()
                .zip(&panels)
                .try_for_each(|(area, panel)| draw(area, panel))
        });
        drawn?;
        root.present().map_err(|e| not_drawn(&e))?;
    }
    Ok(text)
}

fn not_drawn(why: &dyn std::fmt::Display) -> Error {
    Error::input(format!("the plot cannot be drawn: {why}"))
}

/// Without points that have no place on the axes.
fn drawable(panel: &Panel) -> Panel {
    let has_place = |&(x, y): &(f64, f64)| x.is_finite() && y.is_finite() && (!panel.log_y || y > 0.);
    let curve = |c: &Curve| Curve { points: c.points.iter().copied().filter(|p| has_place(p)).collect(), ..c.clone() };
    let curves = panel.curves.iter().map(curve).filter(|c| !c.points.is_empty()).collect();
    Panel { curves, ..panel.clone() }
}

fn draw(area: &Area, panel: &Panel) -> Result<()> {
    let points = panel.curves.iter().flat_map(|c| c.points.iter());
    let range = |value: fn(&(f64, f64)) -> f64| {
        points.clone().map(value).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let wide = |[low, high]: [f64; 2], left: f64, right: f64| {
        let extent = if high > low { high - low } else { 10. * high.abs().max(1e-12) };
        low - left * extent..high + right * extent
    };
    // the legend has its own room on the right
    let (x, y) = (wide(range(|p| p.0), 0.02, 0.25), range(|p| p.1));
    match panel.log_y {
        true => draw_on(area, panel, x, (y[0] / 1.5..y[1] * 1.5).log_scale()),
        false => draw_on(area, panel, x, wide(y, 0.05, 0.05)),
    }
}

fn draw_on<Y>(area: &Area, panel: &Panel, x: std::ops::Range<f64>, y: Y) -> Result<()>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let failed = |e: &dyn std::fmt::Display| not_drawn(e);
    let mut builder = ChartBuilder::on(area);
    builder.margin(12).caption(&panel.title, ("sans-serif", 16)).x_label_area_size(40).y_label_area_size(70);
    let mut chart = builder.build_cartesian_2d(x, y).map_err(|e| failed(&e))?;
    let label = |v: &f64| format!("{}", (v * 1e9).round() / 1e9);
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(&panel.x).y_desc(&panel.y).x_label_formatter(&label).y_label_formatter(&label);
    mesh.light_line_style(TRANSPARENT).draw().map_err(|e| failed(&e))?;
    for (number, curve) in panel.curves.iter().enumerate() {
        let colour = Palette99::pick(number).to_rgba();
        let line = LineSeries::new(curve.points.iter().copied(), colour.stroke_width(2));
        let series = chart.draw_series(line).map_err(|e| failed(&e))?;
        series.label(&curve.name).legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        if curve.dots {
            let dots = curve.points.iter().map(|&p| Circle::new(p, 3, colour.filled()));
            chart.draw_series(dots).map_err(|e| failed(&e))?;
        }
    }
    let mut labels = chart.configure_series_labels();
    labels.background_style(WHITE.mix(0.8)).border_style(BLACK.mix(0.3)).draw().map_err(|e| failed(&e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_names_its_axes_and_curves_and_leaves_out_what_has_no_place() {
        let curve =
            |name: &str, points: &[(f64, f64)]| Curve { name: name.into(), points: points.to_vec(), dots: true };
        let panel = |log_y| Panel {
            title: "motion".into(),
            x: "t [ms]".into(),
            y: "u [mm]".into(),
            log_y,
            curves: vec![
                curve("A & B", &[(0., 1.), (1., f64::NAN), (2., 0.)]),
                curve("nowhere", &[(0., f64::INFINITY)]),
            ],
        };
        let text = svg(&[panel(false), panel(true)]).unwrap();
        for word in ["<svg", "motion", "t [ms]", "u [mm]", "A &amp; B", "</svg>"] {
            assert!(text.contains(word), "{word}");
        }
        assert!(!text.contains("nowhere") && !text.contains("NaN"));
        assert!(svg(&[]).unwrap().contains("<svg"));
    }
}
