//! The study's table, CSV, JSON and plot.

use super::{Finding, Ladder, USELESS, rounded};
use crate::Result;
use crate::number::decimal;
use crate::results::csv::cell;
use crate::results::histories::Peak;
use crate::results::plot::{Curve, Panel, svg};
use crate::study::quantity::listed;
use crate::study::richardson::Estimate;
use crate::study::series::Series;
use serde_json::{Value, json};

impl Finding {
    fn line(&self, ladders: &[Ladder; 2], i: usize) -> String {
        let Finding { quantity, value, estimates, .. } = self;
        let unit = quantity.unit();
        if let Some((limit, error)) = self.limit().filter(|_| self.converges()) {
            let share = if error == 0. { 0. } else { 100. * error / value.abs() };
            let [mesh, step] = estimates.map(|e| words(&e, *value));
            return format!(
                "  {quantity:<16} {value:>11.4e} +- {error:.1e} {unit} ({share:.2} %); extrapolated {limit:.4e}; mesh {mesh}; step \
                 {step}\n"
            );
        }
        let too_large = || {
            let (limit, error) = self.limit()?;
            let [share, most] = [error / value.abs(), USELESS].map(|x| 100. * x);
            Some(format!(" to better than {most:.0} %: its error is {share:.0} %, extrapolated {limit:.4e}"))
        };
        let why = match self.hopeless {
            Some(why) => format!(" ({why})"),
            None => too_large().unwrap_or_default(),
        };
        let refined = ladders.iter().map(|ladder| {
            let values = ladder.peaks[i].map(|p| format!("{:.4e}", p.value)).join(", ");
            format!("{values} {unit} as the {} is refined", ladder.name)
        });
        format!("  {quantity:<16} does not converge{why}: {}\n", refined.collect::<Vec<_>>().join("; "))
    }
}

fn words(estimate: &Estimate, value: f64) -> String {
    match *estimate {
        Estimate::Ordered { limit, order, .. } => format!("{:+.1e}, order {order:.1}", value - limit),
        Estimate::Settling { error, .. } => format!("within {error:.1e}, no order seen"),
        Estimate::Diverging => "diverges".into(),
    }
}

/// The runs, and a line for each quantity.
pub fn table(ladders: &[Ladder; 2], findings: &[Finding]) -> String {
    let mut text = String::from("runs\n");
    for ladder in ladders {
        for (k, member) in ladder.members.iter().enumerate() {
            text += &format!(
                "  {} / {:<8} {:>9} unknowns {:>7} steps {:>8.2} s\n",
                ladder.name,
                rounded(ladder.ratio.powi(k as i32)),
                member.unknowns(),
                member.number("steps"),
                member.number("timing.total_s")
            );
        }
    }
    let moved = moved_probes(&ladders[0]);
    if !moved.is_empty() {
        text += &format!("  probes at another node of another mesh, which counts as error: {}\n", listed(&moved));
    }
    text += "peaks of the case, with the error that its mesh and its step leave (difference from the extrapolated value, order)\n";
    text += &findings.iter().enumerate().map(|(i, f)| f.line(ladders, i)).collect::<String>();
    if findings.iter().any(|f| f.only_damping_bounds_it) {
        text += "  accelerations: the load begins with a jump, and only stiffness-proportional damping spreads its front over more than \
                 an element\n";
    }
    text
}

/// Probes whose node is not at the same place in all meshes.
fn moved_probes(ladder: &Ladder) -> Vec<&str> {
    let probes = |k: usize| ladder.members[k].summary["probes"].as_array().map_or(&[][..], Vec::as_slice);
    let at = |probe: &Value| ["x", "y"].map(|axis| probe[axis].as_f64().unwrap_or(f64::NAN));
    let stays = |i: usize| {
        let [x, y] = at(&probes(0)[i]);
        (1..3).all(|k| probes(k).get(i).map(at).is_some_and(|[u, v]| (u - x).hypot(v - y) < 1e-6))
    };
    (0..probes(0).len()).filter(|&i| !stays(i)).filter_map(|i| probes(0)[i]["name"].as_str()).collect()
}

/// The files; a line that names them.
pub fn write(series: &Series, ladders: &[Ladder; 2], findings: &[Finding]) -> Result<String> {
    let names = [
        series.write("converge.csv", &csv(ladders, findings))?,
        series.write("converge.json", &json(ladders, findings))?,
        series.write("converge.svg", &plot(ladders, findings)?)?,
    ];
    Ok(format!("written: {}\n", names.join(", ")))
}

fn csv(ladders: &[Ladder; 2], findings: &[Finding]) -> String {
    let mut text = String::from("refined,by,unknowns,steps,seconds,quantity,unit,peak,peak_time\n");
    for ladder in ladders {
        for (k, member) in ladder.members.iter().enumerate() {
            for (finding, peaks) in findings.iter().zip(&ladder.peaks) {
                text += &format!(
                    "{},{},{},{},{},{},{},{:e},{}\n",
                    ladder.name,
                    rounded(ladder.ratio.powi(k as i32)),
                    member.unknowns(),
                    member.number("steps"),
                    member.number("timing.total_s"),
                    cell(&finding.quantity.to_string()),
                    finding.quantity.unit(),
                    peaks[k].value,
                    decimal(peaks[k].time)
                );
            }
        }
    }
    text
}

fn json(ladders: &[Ladder; 2], findings: &[Finding]) -> String {
    let estimate = |e: &Estimate| match *e {
        Estimate::Ordered { limit, order, error } => json!({ "limit": limit, "order": order, "error": error }),
        Estimate::Settling { limit, error } => json!({ "limit": limit, "order": null, "error": error }),
        Estimate::Diverging => Value::Null,
    };
    let finding = |f: &Finding| {
        let limit = f.limit();
        let content = json!({
            "unit": f.quantity.unit(), "value": f.value, "converges": f.converges(), "extrapolated": limit.map(|l| l.0),
            "error": limit.map(|l| l.1), "mesh": estimate(&f.estimates[0]), "step": estimate(&f.estimates[1]),
        });
        (f.quantity.to_string(), content)
    };
    let folders = ladders.each_ref().map(|l| l.members.iter().map(|m| m.folder.clone()).collect::<Vec<_>>());
    let quantities: serde_json::Map<String, Value> = findings.iter().map(finding).collect();
    format!("{:#}\n", json!({ "mesh": folders[0], "step": folders[1], "quantities": quantities }))
}

/// Each peak over its value in the case, against the size of elements or steps.
fn plot(ladders: &[Ladder; 2], findings: &[Finding]) -> Result<String> {
    let panel = |ladder: &Ladder| {
        let curve = |(finding, peaks): (&Finding, &[Peak; 3])| Curve {
            name: finding.quantity.to_string(),
            points: (0..3).map(|k| (ladder.ratio.powi(-(k as i32)), peaks[k].value / finding.value)).collect(),
            dots: true,
        };
        Panel {
            title: format!("peaks as the {} is refined", ladder.name),
            x: format!("{} size over the case's", if ladder.name == "mesh" { "element" } else { "step" }),
            y: "peak over the case's [-]".into(),
            log_y: false,
            curves: findings.iter().zip(&ladder.peaks).map(curve).collect(),
        }
    };
    svg(&ladders.each_ref().map(panel))
}
