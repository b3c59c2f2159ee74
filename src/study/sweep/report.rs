//! What a sweep tells while it goes on and in the end, and its table, which is rewritten on the way.

use super::group::Ended;
use super::job::Failure;
use super::shelf::Shelf;
use super::table::{self, Row};
use crate::escape::one_line;
use crate::study::run::interrupted;
use crate::study::screen::{Screen, show_copy};
use crate::{Error, Result};
use serde_json::json;
use std::time::{Duration, Instant};

pub struct Report<'a> {
    screen: &'a Screen,
    shelf: &'a Shelf,
    rows: Vec<Row>,
    failures: Vec<Failure>,
    /// runs that ended by now, and those to come
    ended: usize,
    to_do: usize,
    started: Instant,
    saved: Instant,
}

/// The table is not rewritten more often.
const PAUSE: Duration = Duration::from_secs(1);

impl<'a> Report<'a> {
    /// Writes the table as it stands. Errors: it cannot be written.
    pub fn start(screen: &'a Screen, shelf: &'a Shelf, rows: Vec<Row>, to_do: usize) -> Result<Report<'a>> {
        let now = Instant::now();
        let report = Report { screen, shelf, rows, failures: vec![], ended: 0, to_do, started: now, saved: now };
        report.save()?;
        Ok(report)
    }

    /// A batch has ended.
    pub fn take(&mut self, batch: Ended) {
        for (job, outcome) in batch {
            match outcome {
                Ok(summary) => {
                    self.rows[job.number].take(&json!(summary));
                    let warned = table::warned(summary.warnings.len());
                    self.tell(&job.name, &if warned.is_empty() { "done".into() } else { format!("done, {warned}") });
                    summary.warnings.iter().for_each(|w| self.screen.warn(w));
                }
                Err(Error::Interrupted(_)) => self.rows[job.number].status = "interrupted".into(),
                Err(why) => {
                    self.tell(&job.name, &why.to_string());
                    self.fail(Failure { number: job.number, why });
                }
            }
        }
        self.tell_time_left();
        if self.saved.elapsed() > PAUSE {
            self.saved = Instant::now();
            // The table is written once more in the end, and an error told then.
            let _ = self.save();
        }
    }

    fn tell(&mut self, name: &str, how: &str) {
        self.ended += 1;
        self.screen.say(&format!("{} of {}, {name}: {how}", self.ended, self.to_do));
    }

    fn tell_time_left(&self) {
        let left = self.to_do - self.ended;
        if left > 0 && self.ended > 0 && !interrupted() {
            let seconds = self.started.elapsed().as_secs_f64() / self.ended as f64 * left as f64;
            self.screen.say(&format!("{left} left, about {seconds:.0} s"));
        }
    }

    /// A run cannot come to its end.
    pub fn fail(&mut self, failure: Failure) {
        let status = if let Error::NoConvergence(_) = failure.why { "no_convergence" } else { "refused" };
        self.rows[failure.number].status = status.into();
        self.failures.push(failure);
    }

    fn save(&self) -> Result<()> {
        self.shelf.write_table(&table::csv(&self.rows))
    }

    /// The last table: what goes to stdout. `stopped`: what kept the sweep from going on.
    ///
    /// Errors: it was stopped or interrupted, some runs failed, the table cannot be written; stdout has the table then,
    /// too.
    pub fn close(mut self, stopped: Result<()>) -> Result<String> {
        let saved = self.save();
        let (count, done) = (self.rows.len(), self.rows.iter().filter(|row| row.is_done()).count());
        let folder = self.shelf.path().display().to_string();
        let folder = one_line(&folder);
        let table = table::text(&self.rows) + &format!("results in {folder}\n");
        let goes_on =
            format!("{done} of {count} runs are done and stay in {folder}: the same command goes on with the others");
        self.failures.sort_by_key(|failure| failure.number);
        let error = match self.failures.first() {
            _ if stopped.is_err() => stopped.err().map(|why| Error::input(format!("{why}; {goes_on}"))),
            _ if interrupted() && done < count => Some(Error::Interrupted(format!("interrupted; {goes_on}"))),
            Some(Failure { number, why }) => {
                let sentence = match count {
                    1 => why.to_string(),
                    _ => format!(
                        "{} of {count} runs did not get to their end, the first of them {}: {why}; {done} are done, in {folder}",
                        self.failures.len(),
                        self.rows[*number].name
                    ),
                };
                let unsettled = self.failures.iter().any(|failure| matches!(failure.why, Error::NoConvergence(_)));
                Some(if unsettled { Error::NoConvergence(sentence) } else { Error::Input(sentence) })
            }
            None => saved.err(),
        };
        match error {
            None => Ok(table),
            Some(error) => {
                show_copy(&table);
                Err(error)
            }
        }
    }
}
