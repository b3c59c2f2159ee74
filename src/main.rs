mod cli;

use clap::Parser;
use coralpipe::study::{run, screen::tell};
use coralpipe::{Error, Result};
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    // Where no handler can be set, Ctrl-C ends the run at once; its files are valid at any moment.
    let _ = ctrlc::set_handler(run::interrupt);
    match cli::execute(cli.command).and_then(|text| print(&text)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tell(&format!("coralpipe: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// To stdout. A reader that closed the pipe has seen enough.
fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::input(format!("stdout cannot be written: {e}"))),
        _ => Ok(()),
    }
}
