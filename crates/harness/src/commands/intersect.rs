//! `rayweave intersect`: runs hard cases through the tracer's kernel and scores the answers.

use crate::files::{PendingFile, distinct_files};
use crate::options::FormulasOption;
use crate::{Outcome, print};
use clap::{Args, ValueEnum};
use rayweave_accuracy::kernel::{self, Prepared};
use rayweave_accuracy::{FamilyScore, HardCase, json_lines, score};
use rayweave_core::{Arithmetic, Precision};
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::PathBuf;

#[derive(Args)]
pub struct Arguments {
    /// File of cases, one JSON object a line
    cases: PathBuf,
    /// Number type of the kernel
    #[arg(long, value_enum, default_value_t = KernelPrecision::F32)]
    precision: KernelPrecision,
    /// Formulas of the kernel
    #[arg(long, value_enum, default_value_t)]
    formulas: FormulasOption,
    /// Write the results to this file and the table to standard output [default: the results to
    /// standard output, the table to standard error]
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The number type of the kernel. There is no `auto`, because single rays have no scene.
#[derive(Clone, Copy, ValueEnum)]
enum KernelPrecision {
    /// Single precision, 24 bits
    F32,
    /// Double precision, 53 bits
    F64,
}

pub fn run(arguments: &Arguments) -> Result<Outcome, String> {
    distinct_files(&[&Some(arguments.cases.clone()), &arguments.json])?;
    let out = arguments.json.as_deref().map(PendingFile::create).transpose()?;
    let name = arguments.cases.display();
    let file = File::open(&arguments.cases).map_err(|e| format!("{name}: cannot be read: {e}"))?;
    let cases: Vec<HardCase> =
        json_lines::read(BufReader::new(file)).map_err(|e| format!("{name}: {e}"))?;
    let precision = match arguments.precision {
        KernelPrecision::F32 => Precision::F32,
        KernelPrecision::F64 => Precision::F64,
    };
    let arithmetic = Arithmetic { formulas: arguments.formulas.into(), precision };

    let prepared: Vec<Prepared> =
        cases.iter().map(|case| Prepared::new(case, arithmetic)).collect();
    let found: Vec<_> = prepared.iter().map(Prepared::outcome).collect();
    let mut lines = Vec::new();
    json_lines::write(&mut lines, &found)
        .map_err(|e| format!("the results cannot be written: {e}"))?;
    let scores = score(&cases, &found);
    let time = |score: &FamilyScore| {
        let family = cases.iter().zip(&prepared).filter(|(case, _)| case.family == score.family);
        kernel::nanoseconds_per_ray(&family.map(|(_, prepared)| prepared).collect::<Vec<_>>())
    };
    let times: Vec<Option<f64>> = scores.iter().map(time).collect();
    let table = rayweave_output::accuracy::table(&scores, &times);
    match out {
        Some(file) => {
            file.finish(&lines)?;
            print(&table)?;
        }
        None => {
            print(&String::from_utf8_lossy(&lines))?;
            // The table is additional: a closed standard error is no failure.
            let _ = write!(io::stderr(), "{table}");
        }
    }
    let wrong =
        scores.iter().any(|score| score.wrong > 0 || score.leaks > 0 || score.non_finite > 0);
    Ok(if wrong { Outcome::Failed } else { Outcome::Passed })
}
