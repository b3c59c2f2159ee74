mod cli;
mod memory;

use clap::Parser;
use coralpipe::study::{run, screen::tell};
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: memory::Telling = memory::Telling;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    // Where no handler can be set, Ctrl-C ends the run at once; its files are valid at any moment.
    let _ = ctrlc::set_handler(run::interrupt);
    match cli::execute(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tell(&format!("coralpipe: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}
