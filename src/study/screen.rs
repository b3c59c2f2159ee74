//! What a run tells on stderr: sentences, warnings, and a progress bar on a terminal or plain lines in a log.

use crate::escape;
use crate::{Error, Result};
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeSet;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::Mutex;

pub struct Screen {
    quiet: bool,
}

pub enum Progress {
    Quiet,
    Bar(ProgressBar),
    /// a line each tenth
    Lines {
        steps: usize,
    },
}

impl Screen {
    pub fn new(quiet: bool) -> Screen {
        Screen { quiet }
    }

    pub fn say(&self, sentence: &str) {
        if !self.quiet {
            tell(sentence);
        }
    }

    /// Warnings are told even to those who want quiet; each once, however many runs of a study give it.
    pub fn warn(&self, sentence: &str) {
        static TOLD: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
        if TOLD.lock().is_ok_and(|mut told| told.insert(sentence.into())) {
            tell(&format!("warning: {sentence}"));
        }
    }

    pub fn progress(&self, steps: usize) -> Progress {
        match (self.quiet, std::io::stderr().is_terminal()) {
            (true, _) => Progress::Quiet,
            (false, false) => Progress::Lines { steps },
            (false, true) => {
                let style = ProgressStyle::with_template("{bar:40} step {pos}/{len}, {eta} left");
                let bar = ProgressBar::new(steps as u64);
                Progress::Bar(style.map_or_else(|_| bar.clone(), |s| bar.clone().with_style(s)))
            }
        }
    }
}

impl Progress {
    /// The step of this number is done.
    pub fn step(&self, number: usize) {
        match self {
            Progress::Quiet => {}
            Progress::Bar(bar) => bar.set_position(number as u64),
            Progress::Lines { steps } => {
                let tenth = |n: usize| 10 * n / steps;
                if tenth(number) > tenth(number - 1) {
                    tell(&format!("step {number} of {steps}"));
                }
            }
        }
    }
}

/// Prints what is on disk as well: that stdout does not take it is a message, and no error.
pub fn show_copy(text: &str) {
    if let Err(why) = show(text) {
        tell(&format!("coralpipe: {why}; the results are on disk"));
    }
}

/// Prints what stands nowhere else, control characters but line breaks as escapes. A reader that closed the pipe has seen
/// enough.
///
/// Error: stdout cannot be written.
pub fn show(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout();
    match stdout.write_all(escape::lines(text).as_bytes()).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::input(format!("stdout cannot be written: {e}"))),
        _ => Ok(()),
    }
}

/// One line on stderr, control characters and line breaks in it as escapes. That nobody reads it (`2>&1 | head`) is no
/// reason to stop.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", escape::one_line(line));
}
