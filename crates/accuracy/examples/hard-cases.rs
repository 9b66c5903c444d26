//! Draws fresh hard cases: `hard-cases --seed 7 --count 100 > cases.jsonl`.

use std::io;
use std::process::ExitCode;

use clap::Parser;
use rayweave_accuracy::{FAMILIES, Family, generate, json_lines};

/// Draws hard cases of ray against primitive, with exact answers, one JSON object per line.
#[derive(Parser)]
struct Options {
    /// Seed of the random numbers; the same seed gives the same cases on every machine
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of cases per family
    #[arg(long, default_value_t = 20)]
    count: usize,
    /// Families to draw [default: all]
    #[arg(long, value_delimiter = ',', value_parser = known_family)]
    family: Vec<&'static Family>,
}

fn known_family(name: &str) -> Result<&'static Family, String> {
    Family::named(name).ok_or_else(|| {
        let names: Vec<&str> = FAMILIES.iter().map(|family| family.name).collect();
        format!("the families are {}", names.join(", "))
    })
}

fn main() -> io::Result<ExitCode> {
    let options = Options::parse();
    let families =
        if options.family.is_empty() { FAMILIES.iter().collect() } else { options.family };
    let mut target = io::BufWriter::new(io::stdout().lock());
    for family in families {
        match json_lines::write(&mut target, &generate(family, options.seed, options.count)) {
            // The reader has closed the pipe.
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => break,
            result => result?,
        }
    }
    Ok(ExitCode::SUCCESS)
}
