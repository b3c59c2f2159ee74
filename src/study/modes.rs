//! `coralpipe modes`: natural frequencies with the interfaces closed and sticking, and their shapes.

use super::prepare::Prepared;
use super::run::{Loaded, Request, load_structure};
use super::screen::Screen;
use crate::escape::one_line;
use crate::results::file;
use crate::results::folder::claim;
use crate::results::foreign::refuse_foreign;
use crate::results::frame::Frame;
use crate::results::grid::Grid;
use crate::solve::system::State;
use crate::{Error, Result};

/// Lanczos keeps three vectors a mode, each made orthogonal to all before it.
const MOST_MODES: usize = 500;

/// Prints a table and writes `modes/NAME_mode_1.vtu` ... into the results folder; shapes have phi'M phi = 1.
pub fn command(request: &Request, count: usize) -> Result<String> {
    if count == 0 {
        return Err(Error::input("-n 0: ask for at least one mode"));
    }
    let screen = Screen::new(request.quiet);
    let Loaded { case, meshed, model } = load_structure(request)?;
    screen.say(&meshed.told);
    model.warnings.iter().for_each(|w| screen.warn(w));
    let prepared = Prepared::beside(&meshed.path, model)?;
    let count = count.min(prepared.system.unknowns.count);
    if count > MOST_MODES {
        return Err(Error::input(format!(
            "-n {count}: at most {MOST_MODES} modes; their vectors are kept all at once"
        )));
    }
    let modes = prepared.natural_modes(count)?;

    let folder = request.folder(&case);
    refuse_foreign(&folder)?;
    let folder = folder.join("modes");
    file::create_folder(&folder)?;
    let _lock = claim(&folder)?;
    let rest = State::at_rest(&prepared.system);
    let grid = Grid::of_modes(&prepared.model, &prepared.system);
    let mut table = String::from("mode  frequency [Hz]  file\n");
    for (i, mode) in modes.iter().enumerate() {
        let shape = State { q: mode.shape.clone(), ..rest.clone() };
        let path = folder.join(format!("{}_mode_{}.vtu", case.name(), i + 1));
        file::replace(&path, &grid.vtu(&Frame::of(&prepared.model, &prepared.system, &shape), &rest.q)?)?;
        table += &one_line(&format!("{:4}  {:14.6}  {}", i + 1, mode.frequency, path.display()));
        table.push('\n');
    }
    Ok(table)
}
