//! The settings as tables, and the recommendation.

use super::{TradeoffView, sampling_name};
use crate::machine;
use crate::style::{self, interval};
use rayweave_accuracy::metrics::psnr;
use rayweave_accuracy::tradeoff::{ArithmeticCost, TradeoffRow, reference_rays_per_pixel};

const HEADER: [&str; 14] = [
    "",
    "formulas",
    "",
    "sampling",
    "rays a\npixel",
    "bounces",
    "ms",
    "speed-up over\nthe lab report",
    "PSNR\ndB",
    "largest\nerror",
    "off by\n> 1/255",
    "FLIP",
    "arithmetic\ndB",
    "sampling\ndB",
];

/// The columns of numbers.
const NUMBERS: std::ops::RangeInclusive<usize> = 4..=13;

const COST_HEADER: [&str; 4] =
    ["cost", "robust / textbook\nin f32", "robust / textbook\nin f64", "f64 / f32\nrobust"];

pub(super) fn text(view: &TradeoffView<'_>) -> String {
    let study = view.study;
    let mut rows: Vec<&TradeoffRow> = study.rows.iter().collect();
    rows.sort_by(|a, b| a.median_ns.total_cmp(&b.median_ns));
    let front = view.front();
    [
        heading(view),
        style::table(HEADER, rows.into_iter().map(cells), NUMBERS),
        notes(view),
        "Pareto front: the settings that no other setting beats in both time and error.".to_owned(),
        style::table(HEADER, front.into_iter().map(cells), NUMBERS),
        choice(view),
        style::table(COST_HEADER, study.costs.iter().map(cost_cells), 1..=3),
        machine::text(view.machine),
    ]
    .join("\n\n")
}

fn heading(view: &TradeoffView<'_>) -> String {
    let TradeoffView { scene, width, height, study, .. } = view;
    format!(
        "{scene}, {width} x {height} pixels, one thread; {} settings in {} interleaved rounds",
        study.rows.len(),
        study.rounds
    )
}

fn cells(row: &TradeoffRow) -> [String; HEADER.len()] {
    let TradeoffRow { setting, speedup, error, .. } = row;
    [
        if row.in_front { "*" } else { "" }.to_owned(),
        setting.arithmetic.formulas.to_string(),
        setting.arithmetic.precision.to_string(),
        sampling_name(setting),
        setting.rays_per_pixel().to_string(),
        setting.max_reflections.to_string(),
        milliseconds(row.median_ns),
        interval(*speedup),
        decibels(error.psnr()),
        format!("{:.3}", error.max),
        format!("{:.1} %", 100.0 * error.share_off),
        format!("{:.4}", error.flip),
        decibels(psnr(row.arithmetic_rmse)),
        decibels(psnr(row.sampling_rmse)),
    ]
}

fn cost_cells(cost: &ArithmeticCost) -> [String; COST_HEADER.len()] {
    [
        cost.part.to_owned(),
        interval(cost.robust_f32),
        interval(cost.robust_f64),
        interval(cost.f64_robust),
    ]
}

fn notes(view: &TradeoffView<'_>) -> String {
    let study = view.study;
    let own_error = study.reference.uncertainty;
    let smallest = study.rows.iter().map(|row| row.error.rmse).fold(1.0, f64::min);
    let (decibels, share) = (decibels(psnr(own_error)), own_error / smallest);
    let verdict = if own_error == 0.0 {
        "The two halves of the reference are equal.".to_owned()
    } else if share <= 0.1 {
        format!(
            "Its own error is about {decibels} dB, {share:.2} of the smallest error here: exact \
             enough for every setting."
        )
    } else {
        format!("Its own error is about {decibels} dB: too large to rank the most exact settings.")
    };
    let repeatable = if study.repeatable {
        "Every timed image was verified."
    } else {
        "A TIMED IMAGE CHANGED FROM ONE ROUND TO ANOTHER."
    };
    format!(
        "*: on the Pareto front. Errors are measured against robust f64 with {} rays a pixel.\n\
         {verdict}\n\
         arithmetic: error against the same rays in robust f64. sampling: error that remains in \
         robust f64\nwith all bounces. Most of the error is at edges: an image of twice the side \
         has half the share of\nedge pixels, and its PSNR is about 3 dB higher. Settings whose \
         intervals overlap may change places\nin another run. {repeatable}",
        reference_rays_per_pixel()
    )
}

/// Returns the recommended setting for the target, beside the lab report's and a robust one.
fn choice(view: &TradeoffView<'_>) -> String {
    let (study, target) = (view.study, view.target_psnr);
    let own = study.report_row();
    let own_psnr = decibels(own.error.psnr());
    let Some(row) = study.fastest_with(target) else {
        return format!(
            "No setting reaches {target} dB here; the lab report's own setting has {own_psnr} dB."
        );
    };
    let like = study.fastest_report_like(target).map_or_else(
        || "With its formulas, lattice and bounces no number of rays here reaches it.".to_owned(),
        |like| {
            format!(
                "With its formulas, lattice and bounces it takes {} rays a pixel and {:.2} times \
                 as long.",
                like.setting.rays_per_pixel(),
                row.speedup.median / like.speedup.median
            )
        },
    );
    // The fastest formulas here may be wrong on another scene, so name a robust setting too.
    let robust = study.fastest_robust(target).filter(|robust| robust.setting != row.setting);
    let robust = robust.map_or_else(String::new, |robust| {
        let speedup = interval(robust.speedup);
        format!("\nWith robust formulas choose {}: {speedup} times as fast.", robust.setting)
    });
    format!(
        "For {target} dB choose {}: {} dB in {} ms.\n\
         It is {} times as fast as the lab report's own setting, which has {own_psnr} dB.\n\
         {like}{robust}",
        row.setting,
        decibels(row.error.psnr()),
        milliseconds(row.median_ns),
        interval(row.speedup)
    )
}

fn milliseconds(nanoseconds: f64) -> String {
    let milliseconds = nanoseconds / 1e6;
    let digits = if milliseconds < 10.0 { 2 } else { usize::from(milliseconds < 100.0) };
    format!("{milliseconds:.digits$}")
}

fn decibels(psnr: f64) -> String {
    if psnr.is_infinite() { "exact".to_owned() } else { format!("{psnr:.1}") }
}
