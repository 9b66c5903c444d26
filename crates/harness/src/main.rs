//! `rayweave`: proves that all strategies draw the same picture, and measures what each costs.
//!
//! The glue between the other crates, and the only place that prints: results to standard output,
//! errors and progress to standard error. Exit status: 0 done and every check passed; 1 a check
//! failed; 2 the request or its input was wrong, or the machine cannot meet it; 130 interrupted.

mod commands;
mod files;
mod image_file;
mod input;
mod interrupt;
mod options;
mod progress;
mod subprocess;
mod with_noise;

use clap::{Parser, Subcommand};
use commands::{
    check, compare, explain, intersect, overhead, predict, render, sample, strategies, tradeoff,
};
use std::io::{self, Write};
use std::process::ExitCode;

/// Spreads a ray tracer over threads in several ways, proves that all draw the same picture, and
/// measures what each costs. Without a command: compare on the report's scene.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    compare: compare::Options,
}

#[derive(Subcommand)]
enum Command {
    /// List the strategies, and why one is unavailable here
    Strategies,
    /// Render a picture to a .png, .ppm or .exr file
    Render(render::Arguments),
    /// Prove that all strategies draw the same picture, bit for bit
    Check(check::Arguments),
    /// Time the strategies side by side and print the table (the default)
    Compare(compare::Arguments),
    /// Measure what each strategy costs beside its work
    Overhead(overhead::Arguments),
    /// Predict what more threads would make of a picture, and check it with those that are here
    Predict(predict::Arguments),
    /// One sample of a comparison
    #[command(hide = true)]
    Sample(sample::Arguments),
    /// Measure speed and error of every setting, and say which one to choose
    #[command(alias = "error")]
    Tradeoff(tradeoff::Arguments),
    /// Say why a strategy loses: where the time of its threads goes
    Explain(explain::Arguments),
    /// Send hard cases through the kernel that renders, results as JSON lines
    Intersect(intersect::Arguments),
}

/// The end of a command that had a result.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// Every check passed.
    Passed,
    /// A check failed.
    Failed,
    /// The run was interrupted before all was done.
    Interrupted,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match cli.command {
        Some(Command::Strategies) => strategies::run(),
        Some(Command::Render(arguments)) => render::run(&arguments),
        Some(Command::Check(arguments)) => check::run(&arguments),
        Some(Command::Compare(arguments)) => {
            compare::run(arguments.scene.as_deref(), &arguments.options)
        }
        Some(Command::Overhead(arguments)) => overhead::run(&arguments),
        Some(Command::Predict(arguments)) => predict::run(&arguments),
        Some(Command::Sample(arguments)) => sample::run(&arguments),
        Some(Command::Tradeoff(arguments)) => tradeoff::run(&arguments),
        Some(Command::Explain(arguments)) => explain::run(&arguments),
        Some(Command::Intersect(arguments)) => intersect::run(&arguments),
        None => compare::run(None, &cli.compare),
    };
    match result {
        Ok(Outcome::Passed) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Ok(Outcome::Interrupted) => ExitCode::from(130),
        Err(message) => {
            complain(&message);
            ExitCode::from(2)
        }
    }
}

/// Says why there is no result.
fn complain(message: &str) {
    // Nobody is left to tell if standard error is closed.
    let _ = writeln!(io::stderr(), "error: {message}");
}

/// Prints a result. A reader that has seen enough (`rayweave strategies | head -1`) is no failure.
fn print(text: &str) -> Result<(), String> {
    match io::stdout().lock().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}"))
        }
        _ => Ok(()),
    }
}
