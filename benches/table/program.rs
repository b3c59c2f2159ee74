//! Runs of the program itself, as a user starts it.

use super::case::{CASE, Size};
use serde_json::Value;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A finished run.
pub struct Finished {
    pub summary: Value,
    /// from the start of the process to its end [s]
    pub wall: f64,
    /// most memory it ever held [MiB]; none where the system does not tell
    pub memory: Option<f64>,
}

impl Finished {
    /// Time of the steps over their number [s]: equations, ledger, histories, frames handed over.
    pub fn step(&self) -> f64 {
        self.summary["timing"]["steps_s"].as_f64().expect("a summary has it")
            / self.summary["steps"].as_f64().expect("a summary has it")
    }

    pub fn count(&self, what: &str) -> usize {
        self.summary["counts"][what].as_u64().expect("a summary has it") as usize
    }
}

/// `coralpipe run` with the settings `sets`, its results thrown away.
pub fn run(size: &Size, sets: &[&str], bonded: bool) -> Finished {
    let constants: Vec<String> = size.constants().iter().map(|(name, value)| format!("{name}={value}")).collect();
    let mut arguments = vec!["run", CASE, "--quiet", "--out", "run"];
    arguments.extend(constants.iter().flat_map(|constant| ["--geo", constant]));
    arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
    arguments.extend(bonded.then_some("--bonded"));
    let started = Instant::now();
    let mut child = start(&arguments);
    let memory = watch(&mut child);
    let wall = started.elapsed().as_secs_f64();
    assert!(child.wait().is_ok_and(|status| status.success()), "{arguments:?} failed");
    let text = std::fs::read_to_string("run/summary.json").expect("a run that is done has its summary");
    Finished { summary: serde_json::from_str(&text).expect("summary.json is JSON"), wall, memory }
}

pub fn start(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_coralpipe"));
    command.args(arguments).stdout(Stdio::null()).spawn().expect("cargo built the program")
}

/// Waits for the end; the system's own high-water mark only rises, so its last value counts.
fn watch(child: &mut Child) -> Option<f64> {
    let status = format!("/proc/{}/status", child.id());
    let mut highest = None;
    while child.try_wait().is_ok_and(|ended| ended.is_none()) {
        highest = std::fs::read_to_string(&status).ok().and_then(|text| high_water(&text)).or(highest);
        std::thread::sleep(Duration::from_millis(10));
    }
    highest
}

/// From `VmHWM:   123456 kB`, in MiB.
fn high_water(status: &str) -> Option<f64> {
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse::<f64>().ok().map(|kib| kib / 1024.)
}
