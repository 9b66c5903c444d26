//! The lessons of a comparison: sentences that its own figures carry.

use super::Record;
use super::ranking::{LARGEST_ERROR, Section, is_static, percent_up, rank};
use super::verdict::{names, percent_longer};
use rayweave_contract::{Granularity, Output, Scheduling};
use rayweave_measure::statistics::{median, ratio_interval};

/// The imbalance below which the cost counts as even.
pub(super) const EVEN_IMBALANCE: f64 = 1.1;

/// The factor by which the imbalance may be off, because the costs of tiles are measured once.
const IMBALANCE_ERROR: f64 = 1.1;

/// The largest number of lessons.
const MAX_LESSONS: usize = 3;

/// Returns what a subject's records teach, the most important lesson first.
pub(super) fn of(group: &[Record], sections: &[Section<'_>], available: usize) -> Vec<String> {
    // The machine cannot compute on more threads than it has.
    let usable = sections.iter().filter(|section| (2..=available).contains(&section.threads));
    let Some(section) = usable.max_by_key(|section| section.threads) else { return Vec::new() };
    let on = if sections.len() > 1 {
        format!("On {} threads: ", section.threads)
    } else {
        String::new()
    };
    if !section.is_certain() {
        return Vec::new();
    }
    let lessons = [work_differs(group), shares(section), dispatch(section), locks(section)];
    lessons.into_iter().flatten().take(MAX_LESSONS).map(|lesson| format!("{on}{lesson}")).collect()
}

/// Returns by how much the work of the strategies differs, if it does.
fn work_differs(group: &[Record]) -> Option<String> {
    let figure = |name: &str, of: &dyn Fn(&Record) -> Option<f64>, unit: &str, digits: usize| {
        let kinds = [Granularity::Tile, Granularity::Band, Granularity::Row, Granularity::Pixel];
        let kinds = kinds.into_iter().filter_map(|kind| {
            let of_kind =
                group.iter().filter(|row| row.measurement.granularity == kind.to_string());
            let figure = of_kind.filter_map(of).reduce(f64::max)?;
            Some((kind, figure))
        });
        let kinds: Vec<_> = kinds.collect();
        let [least, most] = [f64::min, f64::max]
            .map(|by| kinds.iter().map(|(_, figure)| *figure).reduce(by).unwrap_or(1.0));
        (most > 1.05 * least).then(|| {
            let kinds =
                kinds.iter().map(|(kind, figure)| format!("{figure:.digits$}{unit} in {kind}s"));
            format!("{name} are {}", kinds.collect::<Vec<_>>().join(", "))
        })
    };
    let rays = |record: &Record| {
        let pixels = f64::from(record.subject.width) * f64::from(record.subject.height);
        Some(record.measurement.primary_rays? as f64 / pixels)
    };
    let lanes = |record: &Record| record.lanes_in_use().map(|share| share * 100.0);
    let figures =
        [figure("primary rays per pixel", &rays, "", 1), figure("lanes in use", &lanes, " %", 0)];
    let figures: Vec<String> = figures.into_iter().flatten().collect();
    (!figures.is_empty()).then(|| format!("The work differs: {}.", figures.join("; ")))
}

/// Returns what is gained by scheduling at run time. The median of each group stands for it: the
/// best of many rows would be luckier than the best of few.
fn shares(section: &Section<'_>) -> Option<String> {
    let first = *section.rows.first()?;
    let rows_of = |is_fixed: bool| -> Vec<&Record> {
        let rows = section.rows.iter().copied();
        rows.filter(|row| is_static(row) == is_fixed && is_same_work(row, first)).collect()
    };
    let (fixed, free) = (rows_of(true), rows_of(false));
    if fixed.is_empty() || free.is_empty() {
        return None;
    }
    let (fixed, free) = (median_times(&fixed), median_times(&free));
    let is_even = first.imbalance.map(|imbalance| imbalance < EVEN_IMBALANCE);
    if let Some(ratio) = section.longer(&fixed, &free) {
        // The largest share makes equal shares take this many times as long, and locks add to it.
        // A tile larger than a share tells nothing of shares that cut through it.
        let cuts = first.largest_tile.is_some_and(|tile| tile * section.threads as f64 > 1.0);
        let explains = |imbalance: &f64| {
            is_even == Some(false) && !cuts && ratio.low <= *imbalance * IMBALANCE_ERROR
        };
        let uneven = first.imbalance.filter(explains);
        let why = uneven.map(|imbalance| {
            let share = imbalance * 100.0 / section.threads as f64;
            let which = match section.threads {
                2 => "more expensive half".to_owned(),
                threads => format!("most expensive of {threads} shares"),
            };
            format!(", because the {which} of this image has {share:.0} % of its cost")
        });
        return Some(format!(
            "Schedule at run time: equal shares take {} % longer here{}.",
            percent_longer(ratio.median),
            why.unwrap_or_default()
        ));
    }
    if let Some(ratio) = section.longer(&free, &fixed) {
        let why = if is_even == Some(true) { ", because this image's cost is even" } else { "" };
        return Some(format!(
            "Equal shares are faster here: scheduling at run time takes {} % longer{why}.",
            percent_longer(ratio.median)
        ));
    }
    (is_even == Some(true)).then(|| {
        "No difference is seen between equal shares and scheduling at run time: this image's cost \
         is even."
            .to_owned()
    })
}

/// Returns the median time of the rows in each round.
fn median_times(rows: &[&Record]) -> Vec<u64> {
    let rounds = rows.iter().map(|row| row.measurement.samples_ns.len()).min().unwrap_or(0);
    let time = |round| {
        let times: Vec<f64> =
            rows.iter().map(|row| row.measurement.samples_ns[round] as f64).collect();
        median(&times).map(|time| time as u64)
    };
    (0..rounds).filter_map(time).collect()
}

/// Returns whether it matters how a free thread gets its next piece.
fn dispatch(section: &Section<'_>) -> Option<String> {
    let in_place = Output::InPlace.to_string();
    let mut rows = section.rows.clone();
    rows.retain(|row| !is_static(row) && row.measurement.output == in_place);
    let first = *rows.first()?;
    rows.retain(|row| is_same_work(row, first));
    let mut ways = vec![
        ("counter or queue", Scheduling::Dynamic { chunk: 1 }),
        ("shrinking chunks", Scheduling::Guided),
        ("stealing", Scheduling::WorkStealing),
        ("halving as rayon does", Scheduling::RecursiveSplit),
    ];
    ways.retain(|(_, way)| rows.iter().any(|row| row.measurement.scheduling == way.to_string()));
    if ways.len() < 2 {
        return None;
    }
    let (alike, behind) = rank(&rows, section.control_error);
    let Some(most) = behind.iter().map(|(_, ratio)| ratio.median).reduce(f64::max) else {
        let ways: Vec<&str> = ways.iter().map(|(name, _)| *name).collect();
        return Some(format!(
            "How the next piece is taken ({}) makes no visible difference here.",
            ways.join(", ")
        ));
    };
    let slower: Vec<&Record> = behind.iter().map(|(row, _)| *row).collect();
    let (verb, most) = match slower.len() {
        1 => ("takes", percent_longer(most)),
        _ => ("take", format!("up to {}", percent_longer(most))),
    };
    let rest = if alike.len() > 1 { "; between the others no difference is seen" } else { "" };
    Some(format!(
        "Among the strategies that schedule at run time, {} {verb} {most} % longer than {}{rest}.",
        names(&slower),
        first.measurement.strategy
    ))
}

/// Returns the cost of a lock for each row, against rows or bands without one, and the cost of
/// single pixels with locks against rows with locks.
fn locks(section: &Section<'_>) -> Option<String> {
    let best = |output: Output, kinds: &[Granularity]| {
        section.rows.iter().copied().find(|row| {
            let granularity = &row.measurement.granularity;
            is_static(row)
                && row.measurement.output == output.to_string()
                && kinds.iter().any(|kind| kind.to_string() == *granularity)
        })
    };
    let rows = best(Output::Mutex, &[Granularity::Row])?;
    let same_work = |other: &&Record| is_same_work(other, rows);
    let free = best(Output::InPlace, &[Granularity::Row, Granularity::Band]).filter(same_work);
    let pixels = best(Output::Mutex, &[Granularity::Pixel]).filter(same_work);
    let cost = free.and_then(|free| row_lock(section, rows, free));
    let pixels = pixels.and_then(|pixels| section.slower(pixels, rows)).map(|ratio| {
        let percent = percent_longer(ratio.median);
        format!(
            "Single pixels with a lock each take {percent} % longer than rows with a lock each."
        )
    });
    let lessons: Vec<String> = cost.into_iter().chain(pixels).collect();
    (!lessons.is_empty()).then(|| lessons.join(" "))
}

/// Returns the cost of a lock for each row, or its upper limit if none is seen.
fn row_lock(section: &Section<'_>, locked: &Record, free: &Record) -> Option<String> {
    if let Some(ratio) = section.slower(locked, free) {
        let percent = percent_longer(ratio.median);
        let (locked, free) = (&locked.measurement, &free.measurement);
        // Where the other strategy computes bands, the rows differ in more than the lock.
        return Some(format!(
            "{} takes {percent} % longer than {}: rows, each copied under the lock, against {}s \
             in place.",
            locked.strategy, free.strategy, free.granularity
        ));
    }
    let ratio = ratio_interval(&locked.measurement.samples_ns, &free.measurement.samples_ns)?;
    let limit = section.control_error.max(ratio.high - 1.0);
    (limit <= LARGEST_ERROR).then(|| {
        format!("One lock per row has no visible cost here (below {}).", percent_up(limit))
    })
}

/// Returns whether two rows traced the same number of rays in the same number of packets.
fn is_same_work(a: &Record, b: &Record) -> bool {
    let counts =
        |record: &Record| (record.measurement.primary_rays, record.measurement.primary_packets);
    counts(a) == counts(b)
}
