//! The lessons of a comparison: sentences that its own figures carry.

use super::ranking::{Section, is_static, rank};
use super::screen::{longer, names};
use super::{Record, Subject};
use rayweave_contract::{Granularity, Output, Scheduling};

/// The imbalance below which the cost counts as even.
pub(super) const EVEN: f64 = 1.1;

/// The largest number of lessons.
const MOST: usize = 3;

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
    let lessons = [work(group), shares(section), dispatch(section), locks(section)];
    lessons.into_iter().flatten().take(MOST).map(|lesson| format!("{on}{lesson}")).collect()
}

/// Returns whether pixels of a piece share samples.
pub(super) fn samples_are_shared(subject: &Subject) -> bool {
    let has_lattice = subject.antialiasing > 0 && subject.sampling == "lattice";
    has_lattice && (subject.share_samples || subject.adaptive)
}

/// Returns by how much the work of the strategies differs, if it does.
fn work(group: &[Record]) -> Option<String> {
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
                kinds.iter().map(|(kind, figure)| format!("{figure:.digits$}{unit} by {kind}s"));
            format!("{name} {}", kinds.collect::<Vec<_>>().join(", "))
        })
    };
    let rays = |record: &Record| {
        let pixels = f64::from(record.subject.width) * f64::from(record.subject.height);
        Some(record.measurement.primary_rays? as f64 / pixels)
    };
    let lanes = |record: &Record| record.lanes_in_use().map(|share| share * 100.0);
    let figures = [figure("rays a pixel:", &rays, "", 1), figure("lanes in use:", &lanes, " %", 0)];
    let figures: Vec<String> = figures.into_iter().flatten().collect();
    (!figures.is_empty()).then(|| format!("Not threading alone: {}.", figures.join("; ")))
}

/// Returns what is gained by giving the next piece to whoever is free.
fn shares(section: &Section<'_>) -> Option<String> {
    let best = |is_fixed: bool| section.rows.iter().find(|row| is_static(row) == is_fixed);
    let (fixed, free) = (best(true)?, best(false)?);
    if !is_same_work(fixed, free) {
        return None;
    }
    let is_even = free.imbalance.map(|imbalance| imbalance < EVEN);
    if let Some(ratio) = section.slower(fixed, free) {
        let uneven = free.imbalance.filter(|_| is_even == Some(false));
        let why = uneven.map(|imbalance| {
            let (threads, share) =
                (section.threads as f64, imbalance * 100.0 / section.threads as f64);
            if section.threads == 2 {
                format!(": the dearer half of this image has {share:.0} % of its cost")
            } else {
                format!(
                    ": the dearest of {threads} shares of this image has {share:.0} % of its cost"
                )
            }
        });
        return Some(format!(
            "Deal out at run time: equal shares, fixed beforehand, take {} longer here{}.",
            longer(ratio.median),
            why.unwrap_or_default()
        ));
    }
    let even = "this image's cost is even";
    if let Some(ratio) = section.slower(free, fixed) {
        let why = if is_even == Some(true) { format!(": {even}") } else { String::new() };
        return Some(format!(
            "Equal shares do better here, dealing out at run time takes {} longer{why}.",
            longer(ratio.median)
        ));
    }
    (is_even == Some(true)).then(|| format!("Equal shares do as well here: {even}."))
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
    let (alike, behind) = rank(&rows, section.trust);
    let Some(most) = behind.iter().map(|(_, ratio)| ratio.median).reduce(f64::max) else {
        let ways: Vec<&str> = ways.iter().map(|(name, _)| *name).collect();
        return Some(format!(
            "How the next piece is taken ({}) makes no difference to be seen here.",
            ways.join(", ")
        ));
    };
    let slower: Vec<&Record> = behind.iter().map(|(row, _)| *row).collect();
    let (verb, most) = match slower.len() {
        1 => ("takes", longer(most)),
        _ => ("take", format!("up to {}", longer(most))),
    };
    let rest = if alike.len() > 1 { "; between the others no difference is seen" } else { "" };
    Some(format!(
        "Among those dealt out at run time {} {verb} {most} longer than {}{rest}.",
        names(&slower),
        first.measurement.strategy
    ))
}

/// Returns what a lock for each row and for each pixel costs.
fn locks(section: &Section<'_>) -> Option<String> {
    let best = |output: Output, kinds: &[Granularity]| {
        section.rows.iter().copied().find(|row| {
            let granularity = &row.measurement.granularity;
            is_static(row)
                && row.measurement.output == output.to_string()
                && kinds.iter().any(|kind| kind.to_string() == *granularity)
        })
    };
    let free = best(Output::InPlace, &[Granularity::Row, Granularity::Band]);
    let row = best(Output::Mutex, &[Granularity::Row]);
    let pixel = best(Output::Mutex, &[Granularity::Pixel]);
    let cost = |locked: Option<&Record>, than: Option<&Record>| {
        let (locked, than) = locked.zip(than).filter(|(a, b)| is_same_work(a, b))?;
        Some(match section.slower(locked, than) {
            None => "costs nothing to be seen".to_owned(),
            Some(ratio) => {
                let (locked, than) = (&locked.measurement.strategy, &than.measurement.strategy);
                format!("costs {} ({locked} against {than})", longer(ratio.median))
            }
        })
    };
    match (cost(row, free), cost(pixel, row.or(free))) {
        (None, None) => None,
        (Some(row), None) => Some(format!("A lock a row {row} here.")),
        (None, Some(pixel)) => Some(format!("A lock a pixel {pixel} here.")),
        (Some(row), Some(pixel)) if row == pixel => {
            Some(format!("A lock a row or a pixel {row} here."))
        }
        (Some(row), Some(pixel)) => {
            Some(format!("A lock a row {row} here; a lock a pixel {pixel}."))
        }
    }
}

/// Returns whether two rows traced the same number of rays in the same number of packets.
fn is_same_work(a: &Record, b: &Record) -> bool {
    let counts =
        |record: &Record| (record.measurement.primary_rays, record.measurement.primary_packets);
    counts(a) == counts(b)
}
