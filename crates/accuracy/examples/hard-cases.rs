//! Draws fresh hard cases: `hard-cases --seed 7 --count 100 > cases.jsonl`.

use std::io;
use std::process::ExitCode;

use clap::Parser;
use rayweave_accuracy::{FAMILIES, Family, generate, json_lines};

/// Hard cases of ray against primitive with their exact answers, a JSON object a line.
#[derive(Parser)]
struct Options {
    /// Which cases: the same seed gives the same ones on every machine
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many of each family
    #[arg(long, default_value_t = 20)]
    count: usize,
    /// Only these families
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
            // Whoever reads has read enough.
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => break,
            result => result?,
        }
    }
    Ok(ExitCode::SUCCESS)
}
