mod cli;

use clap::Parser;
use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::Ordering::Relaxed;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    // Where no handler can be set, Ctrl-C ends the run at once; its files are valid at any moment.
    let _ = ctrlc::set_handler(|| coralpipe::study::run::INTERRUPTED.store(true, Relaxed));
    match cli::execute(cli.command) {
        Ok(text) => {
            // A reader that closed the pipe has seen enough.
            let _ = std::io::stdout().write_all(text.as_bytes());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("coralpipe: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
