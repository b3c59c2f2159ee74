//! How much a run will write, told before it begins where that is more than anyone has a use, or a disk, for.

use crate::model::resolve::Model;
use crate::number::short_to;

/// At 30 a second such a film runs for more than five minutes. The series' index is written anew with each frame: 80
/// bytes for each before it, 4 GB for so many.
const MANY_FRAMES: usize = 10_000;
/// [bytes] A hundred times what the default case writes; a million unknowns write that in 100 frames.
const MUCH: f64 = 10e9;

/// Bytes of a frame, as taken from runs: of the XML that holds its numbers, and for each point and each cell.
const FORM: f64 = 8e3;
const PLACE: f64 = 90.;
/// of a row in `rings.csv`, of which each joint has one a frame
const RING: f64 = 220.;
/// of a number in `histories.csv`
const NUMBER: f64 = 22.;
/// of a line in `run.sta`
const STATUS: f64 = 190.;

/// Says so where a run writes very many frames, or very much.
pub fn warning(model: &Model) -> Option<String> {
    let frames = 1 + model.time.steps.div_ceil(model.time.steps_per_frame);
    let places = model.mesh.points.len() + model.faces().count() + model.joints.len();
    let frame = FORM + PLACE * places as f64 + RING * model.joints.len() as f64;
    let step = STATUS + NUMBER * (1 + 6 * model.probes.len()) as f64;
    let bytes = frames as f64 * frame + model.time.steps as f64 * step;
    (frames > MANY_FRAMES || bytes > MUCH).then(|| {
        format!(
            "the run writes {frames} frames, and about {} GB in all, most of it {}",
            short_to(2, bytes / 1e9),
            match frames as f64 * frame > model.time.steps as f64 * step {
                true => "for frames: a longer output.every makes fewer",
                false => "for steps: a longer time.step makes fewer",
            }
        )
    })
}
