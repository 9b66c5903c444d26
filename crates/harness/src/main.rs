//! Compares ways to spread uneven work over threads: proves that all strategies compute the same
//! image, bit for bit, and measures the cost of each.
//!
//! This program is the front of a workspace. Work and strategy know nothing of each other; they
//! meet in the contract:
//!
//! * [`rayweave_contract`]: image, tile, work, strategy and policy. Begin here.
//! * [`rayweave_core`]: the ray tracer, a work. [`rayweave_scene_file`] reads its scenes.
//! * [`rayweave_registry`]: every strategy in one list; each is a crate of its own with one short
//!   file, for example [`rayweave_tile_queue`](../rayweave_tile_queue/index.html).
//! * [`rayweave_measure`]: check, comparison, explanation, overheads and forecasts.
//!   [`rayweave_predict`](../rayweave_predict/index.html) simulates policies for them.
//! * [`rayweave_accuracy`]: speed against error, and hard cases with exact answers.
//! * [`rayweave_output`]: results as tables, JSON, CSV, Markdown and SVG.
//!
//! Each subcommand is one file of `commands`. Only this crate prints: results to standard output,
//! errors and progress to standard error. Exit status: 0 done and every check passed; 1 a check
//! failed; 2 the request or its input was wrong, or the machine cannot meet it; 130 interrupted.

mod commands;
mod deliver;
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

/// Spreads a ray tracer over threads by several strategies, proves that all of them render the same
/// image, and measures the cost of each. Without a command it compares them on the lab report's
/// scene.
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
    /// List the strategies, and the reason if one is unavailable here
    Strategies,
    /// Render an image to a .png, .ppm or .exr file
    Render(render::Arguments),
    /// Prove that all strategies render the same image, bit for bit
    Check(check::Arguments),
    /// Time the strategies in interleaved rounds, and show which are fastest (the default)
    Compare(compare::Arguments),
    /// Measure the overheads of each strategy on synthetic work
    Overhead(overhead::Arguments),
    /// Predict the speed-up on more threads, and check predictions on the threads of this machine
    Predict(predict::Arguments),
    /// Measure one sample of a comparison
    #[command(hide = true)]
    Sample(sample::Arguments),
    /// Measure speed and error of every setting of the tracer, and recommend one
    #[command(alias = "error")]
    Tradeoff(tradeoff::Arguments),
    /// Show where the time of each thread goes, and why a strategy is slow
    Explain(explain::Arguments),
    /// Run hard cases of ray against primitive through the tracer's kernel, and score the answers
    Intersect(intersect::Arguments),
}

/// The end of a command that had a result.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// Every check passed.
    Passed,
    /// A check failed.
    Failed,
    /// The run was interrupted before it was complete.
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

/// Prints the reason why there is no result.
fn complain(message: &str) {
    // If standard error is closed, there is no other place for the message.
    let _ = writeln!(io::stderr(), "error: {message}");
}

/// Prints what is doubtful about a result.
fn warn(message: &str) {
    let _ = writeln!(io::stderr(), "warning: {message}");
}

/// Prints a result. A closed pipe (`rayweave strategies | head -1`) is no failure.
fn print(text: &str) -> Result<(), String> {
    match io::stdout().lock().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}"))
        }
        _ => Ok(()),
    }
}
