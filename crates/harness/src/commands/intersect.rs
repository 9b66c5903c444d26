//! `rayweave intersect`: runs hard cases through the tracer's kernel and scores the answers.

use crate::deliver;
use crate::files::{PendingFile, distinct_files};
use crate::options::FormulasOption;
use crate::{Outcome, print};
use clap::{Args, ValueEnum};
use rayweave_accuracy::kernel::{self, Prepared};
use rayweave_accuracy::{FamilyScore, HardCase, json_lines, score};
use rayweave_core::{Arithmetic, Precision};
use std::collections::HashSet;
use std::io::{self, Write};
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
    let bytes = rayweave_scene_file::bytes_of(&arguments.cases, &name.to_string())
        .map_err(|e| e.to_string())?;
    let cases: Vec<HardCase> = json_lines::read(&bytes[..]).map_err(|e| format!("{name}: {e}"))?;
    if cases.is_empty() {
        return Err(format!("{name}: there is no case in it: expected one JSON object a line"));
    }
    if let Some(id) = id_used_twice(&cases) {
        return Err(format!("{name}: the id {id:?} is used twice: give each case one of its own"));
    }
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
        Some(file) => deliver::all([file.finish(&lines), print(&table)])?,
        None => {
            print(&String::from_utf8_lossy(&lines))?;
            // The table is additional: a closed standard error is no failure.
            let _ = write!(io::stderr(), "{table}");
        }
    }
    let faults = |score: &FamilyScore| score.wrong + score.far + score.leaks + score.non_finite;
    let passed = scores.iter().all(|score| faults(score) == 0);
    Ok(if passed { Outcome::Passed } else { Outcome::Failed })
}

/// Returns the first id that an earlier case has too: answers are found by their id.
fn id_used_twice(cases: &[HardCase]) -> Option<&str> {
    let mut ids = HashSet::new();
    cases.iter().map(|case| &*case.id).find(|id| !ids.insert(*id))
}
