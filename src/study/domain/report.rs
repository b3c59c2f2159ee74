//! The study's table, CSV, JSON and plot.

use super::alike::core_names;
use super::{Row, Size, Study};
use crate::Result;
use crate::number::{self, decimal};
use crate::results::csv::cell;
use crate::results::plot::{Curve, Panel, svg};
use crate::study::history::History;
use serde_json::{Value, json};

/// At most three digits behind the point.
pub fn short(x: f64) -> String {
    number::short((1e3 * x).round() / 1e3)
}

/// In per cent, three digits.
fn per_cent(x: f64) -> String {
    match 100. * x {
        p if p >= 10. => format!("{p:.1}"),
        p if p >= 0.1 => format!("{p:.2}"),
        p if p > 0. => format!("{p:.1e}"),
        _ => "0".into(),
    }
}

/// The quantity that changed most, and by how much; `window` 0 is the whole, 1 until the first return.
fn worst(row: &Row, window: usize) -> (usize, f64) {
    let changes = row.changes.iter().map(|c| c[window].history).enumerate();
    changes.fold((0, 0.), |most, next| if next.1 > most.1 { next } else { most })
}

impl Study<'_> {
    /// The bound, a line for each size, and the values asked for at the last sizes compared.
    pub fn table(&self, rows: &[Row]) -> String {
        let first = &rows[0];
        let beta = first.member.number("rayleigh.beta");
        let mut text = first.returns.as_ref().map_or(String::new(), |r| self.bound(first.size, r, beta) + "\n");
        let Self { options, until, .. } = self;
        text += &format!(
            "change = max |new - old| / max |new| of the quantity that changes most; tolerance {} %\n{:>9} {:>9} {:>9} {:>24} \
             {:>30} {:>9}\n",
            number::short(100. * self.tolerance),
            options.width,
            options.height,
            "unknowns",
            format!("change to {} ms [%]", short(1e3 * until)),
            "change before the return [%]",
            "run [s]"
        );
        text += &rows.iter().map(|row| self.line(row)).collect::<String>();
        if !self.inner_mesh_is_kept {
            let [width, height] = core_names(options);
            text += &format!(
                "  the script has no constants {width} and {height}: each size has another mesh inside too, which counts as change\n"
            );
        }
        text += "\npeak of each quantity at each size, and the change of its history from the size it grew from [%]\n";
        for (i, quantity) in self.quantities.iter().enumerate() {
            text += &format!("  {quantity} [{}]\n", quantity.unit());
            for row in rows {
                let peak = row.histories[i].peak();
                let change = row.changes.get(i).map_or("-".into(), |[whole, _]| per_cent(whole.history));
                let size = row.size.map(short).join(" x ");
                text += &format!("{size:>20} {:>13.4e} at {:>7.2} ms {change:>9}\n", peak.value, 1e3 * peak.time);
            }
        }
        text
    }

    fn line(&self, row: &Row) -> String {
        let change = |window: usize| {
            let (i, change) = worst(row, window);
            format!("{} {}", per_cent(change), self.quantities[i])
        };
        let [whole, before] = match row.from {
            None => ["-".into(), "-".into()],
            Some(_) if row.first_return >= self.until => [change(0), "no return".into()],
            Some(_) => [change(0), format!("{} ({} ms)", change(1), short((1e4 * row.first_return).round() / 10.))],
        };
        format!(
            "{:>9} {:>9} {:>9} {whole:>24} {before:>30} {:>9.2}\n",
            short(row.size[0]),
            short(row.size[1]),
            row.member.unknowns(),
            row.member.number("timing.total_s")
        )
    }

    pub fn verdict(&self, [width, height]: Size) -> String {
        let grown = |x: f64| short(self.grown(x));
        format!(
            "large enough: {} = {}, {} = {}: growing it to {} x {} changes nothing asked for by more than {} %\n",
            self.options.width,
            short(width),
            self.options.height,
            short(height),
            grown(width),
            grown(height),
            number::short(100. * self.tolerance)
        )
    }

    pub fn csv(&self, rows: &[Row]) -> String {
        let mut text = String::from(
            "width,height,from_width,from_height,unknowns,seconds,quantity,unit,peak,peak_time,change,change_of_peak,\
             first_return,change_before_return\n",
        );
        for row in rows {
            for (i, quantity) in self.quantities.iter().enumerate() {
                let peak = row.histories[i].peak();
                let from = row.from.map_or([String::new(), String::new()], |size| size.map(|x| x.to_string()));
                let change = row.changes.get(i).map_or(String::from(",,,"), |[whole, before]| {
                    format!("{:e},{:e},{},{:e}", whole.history, whole.peak, decimal(row.first_return), before.history)
                });
                text += &format!(
                    "{},{},{},{},{},{},{},{},{:e},{},{change}\n",
                    row.size[0],
                    row.size[1],
                    from[0],
                    from[1],
                    row.member.unknowns(),
                    row.member.number("timing.total_s"),
                    cell(&quantity.to_string()),
                    quantity.unit(),
                    peak.value,
                    decimal(peak.time)
                );
            }
        }
        text
    }

    pub fn json(&self, rows: &[Row]) -> String {
        let of_quantity = |row: &Row, i: usize| {
            let changes = row.changes.get(i);
            json!({
                "peak": row.histories[i].peak(),
                "change": changes.map(|c| c[0].history),
                "change_of_peak": changes.map(|c| c[0].peak),
                "change_before_return": changes.map(|c| c[1].history),
            })
        };
        let of_row = |row: &Row| {
            let quantities = self.quantities.iter().enumerate();
            let values: serde_json::Map<String, Value> =
                quantities.map(|(i, q)| (q.to_string(), of_quantity(row, i))).collect();
            json!({
                "size": row.size, "from": row.from, "folder": row.member.folder, "unknowns": row.member.unknowns(),
                "seconds": row.member.number("timing.total_s"), "rayleigh": row.member.summary["rayleigh"],
                "first_return_s": row.first_return, "returns": row.returns.as_ref().map(returns), "quantities": values,
            })
        };
        let sizes: Vec<Value> = rows.iter().map(of_row).collect();
        let study = json!({
            "constants": [self.options.width, self.options.height], "tolerance": self.tolerance, "until_s": self.until,
            "sizes": sizes,
        });
        format!("{study:#}\n")
    }

    /// The quantity that changed most, for every size, and the changes.
    pub fn svg(&self, rows: &[Row]) -> Result<String> {
        let most = rows.iter().map(|row| worst(row, 0)).fold((0, 0.), |m, n| if n.1 > m.1 { n } else { m }).0;
        let quantity = &self.quantities[most];
        let axis = component(&rows[0].histories[most]);
        let curve = |row: &Row| Curve {
            name: format!("{} x {}", short(row.size[0]), short(row.size[1])),
            points: row.histories[most]
                .times
                .iter()
                .zip(&row.histories[most].values)
                .map(|(t, v)| (1e3 * t, v[axis]))
                .collect(),
            dots: false,
        };
        let changes = |window: usize, name: &str| Curve {
            name: name.into(),
            points: (1..rows.len()).map(|i| (i as f64, 100. * worst(&rows[i], window).1)).collect(),
            dots: true,
        };
        let across = [1., (rows.len().max(3) - 1) as f64];
        let tolerance = across.map(|x| (x, 100. * self.tolerance)).to_vec();
        svg(&[
            Panel {
                title: format!(
                    "{quantity}{} for each {} x {}",
                    component_name(&rows[0].histories[most], axis),
                    self.options.width,
                    self.options.height
                ),
                x: "t [ms]".into(),
                y: format!("[{}]", quantity.unit()),
                log_y: false,
                curves: rows.iter().map(curve).collect(),
            },
            Panel {
                title: "change by growing, largest of the quantities compared".into(),
                x: "size".into(),
                y: "[%]".into(),
                log_y: true,
                curves: vec![
                    changes(0, "whole window"),
                    changes(1, "before the first return"),
                    Curve { name: "tolerance".into(), points: tolerance, dots: false },
                ],
            },
        ])
    }
}

/// The component, or the ray, whose magnitude is largest.
fn component(history: &History) -> usize {
    let largest = |axis: usize| history.values.iter().map(|v| v[axis].abs()).fold(0., f64::max);
    let axes = 0..history.values.first().map_or(0, Vec::len);
    axes.max_by(|&a, &b| largest(a).total_cmp(&largest(b))).unwrap_or(0)
}

/// What the component is called in a title.
fn component_name(history: &History, axis: usize) -> String {
    match (history.angles.get(axis), history.values.first().map_or(0, Vec::len)) {
        (Some(angle), _) => format!(" at {} degrees", short(*angle)),
        (None, 2) => [", horizontal", ", vertical"][axis].into(),
        _ => String::new(),
    }
}

fn returns(r: &crate::model::arrival::Returns) -> Value {
    let list = |list: &[crate::model::arrival::Return]| -> serde_json::Map<String, Value> {
        let times =
            |r: &crate::model::arrival::Return| json!({ "ground_s": r.through_ground, "bound_s": r.not_before });
        list.iter().map(|r| (r.probe.clone(), times(r))).collect()
    };
    json!({ "base": list(&r.base), "sides": list(&r.sides), "base_is_held": r.base_is_held,
            "sides_carry_free_field": r.sides_carry_free_field })
}
