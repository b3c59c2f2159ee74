//! Many loads at once: `coralpipe sweep` over 16 cases of one mesh beside 16 runs one after the other.

use super::case::{CASE, DEFAULT};
use super::clock::{Samples, seconds as time};
use super::program::{run, start};
use super::table::{Row, seconds};
use serde_json::json;

const ROUNDS: usize = 3;
const PEAKS: [&str; 4] = ["-50 kPa", "100 kPa", "150 kPa", "200 kPa"];
const FRICTIONS: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
/// The first state and the last one only, for both.
const NO_FRAMES: &str = "100 ms";

pub fn rows() -> Vec<Row> {
    let plan = json!({
        "case": CASE,
        "frames": true,
        "set": {
            "loads.surface.pressure.peak": PEAKS,
            "interfaces.interface_left.friction": FRICTIONS,
            "output.every": [NO_FRAMES],
        },
    });
    std::fs::write("plan.json", plan.to_string()).expect("the folder can be written to");
    let (mut together, mut one_by_one, mut counts) = (Samples(vec![]), Samples(vec![]), [0; 2]);
    for round in 0..ROUNDS {
        let folder = format!("cases_{round}");
        let _ = std::fs::remove_dir_all(&folder);
        together.0.push(time(|| {
            let mut sweep = start(&["sweep", "plan.json", "--quiet", "--out", &folder]);
            assert!(sweep.wait().is_ok_and(|status| status.success()), "the sweep failed");
        }));
        let _ = std::fs::remove_dir_all(&folder);
        one_by_one.0.push(time(|| {
            for (peak, friction) in PEAKS.iter().flat_map(|peak| FRICTIONS.iter().map(move |f| (peak, f))) {
                let sets = [
                    format!("loads.surface.pressure.peak={peak}"),
                    format!("interfaces.interface_left.friction={friction}"),
                    format!("output.every={NO_FRAMES}"),
                ];
                let done = run(&DEFAULT, &sets.each_ref().map(String::as_str), false);
                counts = [done.count("unknowns"), 2 * done.count("joints")];
            }
        }));
    }
    vec![Row {
        what: "sweep of 16 cases",
        unknowns: counts[0],
        joint_points: counts[1],
        value: seconds(together.median()),
        beside: "16 runs".into(),
        reference: seconds(one_by_one.median()),
        ratio: together.over(&one_by_one),
        goal: Some(0.3),
    }]
}
