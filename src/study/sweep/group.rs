//! Runs that share their matrices: assembled, factored and their modes found once, then marched in batches by as many
//! threads as there are processors. Only the batches under way are in memory.

use super::batch;
use super::job::Job;
use crate::results::grid::Grid;
use crate::results::summary::Summary;
use crate::solve::step::MOST_TOGETHER;
use crate::study::prepare::Prepared;
use crate::study::run::{interrupted, new_march};
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::num::NonZero;
use std::sync::{Arc, Mutex};

/// How runs ended.
pub type Ended<'a> = Vec<(&'a Job, Result<Summary>)>;

/// Is told of each batch when it has ended.
pub type Tell<'a> = &'a (dyn Fn(Ended) + Sync);

/// In order of first appearance.
pub fn groups(jobs: Vec<Job>) -> Vec<Vec<Job>> {
    let mut groups: Vec<Vec<Job>> = Vec::new();
    let mut place_of = BTreeMap::new();
    for job in jobs {
        let place = *place_of.entry(job.matrices()).or_insert(groups.len());
        if place == groups.len() {
            groups.push(vec![]);
        }
        groups[place].push(job);
    }
    groups
}

/// Solves all, each into its folder.
///
/// # Errors
/// Results cannot be written, as on a full disk. What keeps single runs from their end is told.
pub fn solve(jobs: &[Job], frames: bool, tell: Tell) -> Result<()> {
    // A run that cannot start by itself says why; the others cannot for what they share.
    let none_can = |shared: Error| {
        tell(jobs.iter().map(|job| (job, Err(job.model().err().unwrap_or_else(|| shared.clone())))).collect());
        Ok(())
    };
    let lead = match lead(jobs) {
        Ok(lead) => lead,
        Err(why) => return none_can(why),
    };
    let march = match new_march(&lead) {
        Ok(march) => march,
        Err(why) => return none_can(why),
    };
    let grid = frames.then(|| Arc::new(Grid::new(&lead.model, &lead.system)));
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let queue = Mutex::new(jobs.chunks(jobs.len().div_ceil(threads).min(MOST_TOGETHER)));
    let work = || {
        while !interrupted() {
            let Some(batch) = queue.lock().expect("no thread panics with it").next() else { break };
            if let Err(why) = batch::solve(batch, &lead, &march, grid.as_ref(), tell) {
                *queue.lock().expect("likewise") = [].chunks(1);
                return Err(why);
            }
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|w| w.join().expect("a worker returns its errors"))
    })
}

/// What all share, found from the first that has a model.
fn lead(jobs: &[Job]) -> Result<Prepared> {
    let mut models = jobs.iter().map(|job| (job, job.model()));
    match models.find(|(_, model)| model.is_ok()).or_else(|| jobs.first().map(|job| (job, job.model()))) {
        Some((job, model)) => Prepared::beside(&job.meshed.path, model?),
        None => Err(Error::input("a group without runs")),
    }
}
