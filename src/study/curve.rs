//! A pressure over time drawn in characters, as CSV, as SVG.

use crate::number::fixed;

/// Columns and rows of the drawing in characters.
const SIZE: [usize; 2] = [64, 14];

/// Rows of (t [s], p [Pa]), with a heading that the law "table" reads.
pub fn csv(curve: &[[f64; 2]]) -> String {
    curve.iter().fold("t [s],p [Pa]\n".into(), |text, [t, p]| text + &format!("{t},{p:e}\n"))
}

/// Stars over an axis in ms, pressures in kPa; the curve begins at its largest value and ends at zero.
pub fn text(curve: &[[f64; 2]]) -> String {
    let [columns, rows] = SIZE;
    let [end, top] = extent(curve);
    let mut cells = vec![vec![' '; columns]; rows];
    for column in 0..columns {
        let t = end * column as f64 / (columns - 1) as f64;
        let (level, below) = (height(curve, t) / top, height(curve, t + end / (columns - 1) as f64) / top);
        let row = |level: f64| (((1. - level) * (rows - 1) as f64).round() as usize).min(rows - 1);
        for cell in row(level)..=row(below).saturating_sub(1).max(row(level)) {
            cells[cell][column] = '*';
        }
    }
    let label = |row: usize| match row {
        0 => format!("{:>10}", fixed(4, top / 1e3)),
        row if row == rows - 1 => format!("{:>10}", 0),
        _ => " ".repeat(10),
    };
    let line = |(row, cells): (usize, &Vec<char>)| {
        format!("{} |{}", label(row), cells.iter().collect::<String>()).trim_end().to_string() + "\n"
    };
    let drawn: String = cells.iter().enumerate().map(line).collect();
    let axis = format!(
        "{:>10} +{}\n{:>12}0{:>width$} ms\n",
        "",
        "-".repeat(columns),
        "",
        fixed(4, 1e3 * end),
        width = columns - 1
    );
    format!("{:>10}\n{drawn}{axis}", "kPa")
}

/// A figure of 640 x 400 with both axes' ends written.
pub fn svg(curve: &[[f64; 2]]) -> String {
    let [end, top] = extent(curve);
    let at = |[t, p]: &[f64; 2]| format!("{:.2},{:.2}", 80. + 520. * t / end, 340. - 300. * p / top);
    let points: Vec<String> = curve.iter().map(at).collect();
    let label = |x: f64, y: f64, anchor: &str, words: &str| {
        format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{words}</text>\n")
    };
    let labels = [
        label(72., 45., "end", &format!("{} kPa", fixed(1, top / 1e3))),
        label(72., 345., "end", "0"),
        label(600., 362., "end", &format!("{} ms", fixed(2, 1e3 * end))),
        label(80., 362., "middle", "0"),
        label(340., 385., "middle", "time since the arrival"),
    ];
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"400\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"640\" height=\"400\" fill=\"white\"/>\n\
         <path d=\"M80,40 V340 H600\" fill=\"none\" stroke=\"gray\"/>\n\
         <polyline points=\"{}\" fill=\"none\" stroke=\"navy\" stroke-width=\"2\"/>\n{}</svg>\n",
        points.join(" "),
        labels.concat()
    )
}

/// Last time and largest value.
fn extent(curve: &[[f64; 2]]) -> [f64; 2] {
    curve.iter().fold([f64::MIN_POSITIVE; 2], |[end, top], [t, p]| [end.max(*t), top.max(*p)])
}

/// The value at the point of the curve that is nearest in time; zero after its end.
fn height(curve: &[[f64; 2]], t: f64) -> f64 {
    let after = curve.partition_point(|[ti, _]| *ti < t - 1e-12 * t);
    curve.get(after).map_or(0., |[_, p]| *p)
}
