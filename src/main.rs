mod cli;
mod memory;

use clap::Parser;
use coralpipe::escape;
use coralpipe::study::{run, screen::tell};
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: memory::Telling = memory::Telling;

fn main() -> ExitCode {
    let cli = match cli::Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) => explain(usage),
    };
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

/// Ends with help, the version, or what is wrong with the arguments, which cannot do anything to the terminal.
fn explain(usage: clap::Error) -> ! {
    let safe = |argument: std::ffi::OsString| escape::one_line(&argument.to_string_lossy()).into_owned();
    cli::Cli::try_parse_from(std::env::args_os().map(safe)).err().unwrap_or(usage).exit()
}
