//! The first screen of made-up lists: figures that carry a sentence or a lesson, and others that do
//! not.

use super::fixtures::{digest, failed, machine, noise, record, records, row, subject};
use super::lessons;
use super::ranking::Section;
use super::*;

/// A strategy's name, its time in milliseconds, and its granularity, scheduling and output.
type Given<'a> = (&'a str, u64, [&'a str; 3]);

const BY_ROWS: [&str; 3] = ["row", "dynamic", "in-place"];

/// On the uneven image of these, dealing out at run time pays, and locks for pixels cost.
const UNEVEN: [Given<'_>; 6] = [
    ("bands", 1500, ["band", "static", "in-place"]),
    ("halves", 1000, ["row", "recursive-split", "in-place"]),
    ("counter", 1010, BY_ROWS),
    ("channel", 1100, ["row", "dynamic", "channel"]),
    ("row-locks", 1510, ["row", "static", "mutex"]),
    ("pixel-locks", 1800, ["pixel", "static", "mutex"]),
];

/// Returns a list on two threads with equal work. The reference takes two seconds, and one thread
/// against itself is 0.99 to 1.02.
fn list(given: &[Given<'_>], imbalance: f64) -> Results {
    let control = Some(Interval { median: 1.0, low: 0.99, high: 1.02 });
    let reference = row("sequential", 1, "none", 2_000_000_000);
    let control = Measurement { control: true, speedup: control, ..reference.clone() };
    let rows = given.iter().map(|&(name, ms, [granularity, scheduling, output])| Measurement {
        granularity: granularity.to_owned(),
        scheduling: scheduling.to_owned(),
        output: output.to_owned(),
        ..row(name, 2, "per-render", ms * 1_000_000)
    });
    let rows = [reference, control].into_iter().chain(rows).map(|measurement| {
        let mut record = Record { imbalance: Some(imbalance), ..record(measurement) };
        (record.subject.lanes, record.subject.share_samples) = (1, false);
        record.measurement.primary_packets = record.measurement.primary_rays;
        record
    });
    Results::new(machine(), noise(), rows.collect())
}

fn first_sentence(results: &Results) -> String {
    let text = results.screen(&[]);
    text.split("\n\n").next().unwrap_or_default().replace('\n', " ")
}

fn lessons_of(results: &Results) -> Vec<String> {
    let sections = Section::all(&results.results);
    lessons::of(&results.results, &sections, results.machine.available_threads)
}

#[test]
fn screen_as_a_whole() {
    let mut list = list(&UNEVEN, 1.56);
    let wrong = Measurement { scheduling: "static".to_owned(), ..records()[3].measurement.clone() };
    let many = failed(row("many", 2, "pool", 1), "cannot start 9000 threads");
    for mut row in [wrong, many] {
        row.primary_packets = row.primary_rays;
        list.results.push(Record { subject: list.results[0].subject.clone(), ..record(row) });
    }
    let text = list.screen(&["a note".to_owned()]);
    let text = text.replace(&digest(1.0).short(), "THE-RIGHT-DIGEST");
    let text = text.replace(&digest(0.5).short(), "THE-WRONG-DIGEST");
    assert_eq!(text + "\n", include_str!("screen.txt"));
}

/// Catches a lead that the figures do not show, and one that they show and the sentence does not.
#[test]
fn the_sentence_names_the_fastest_and_those_like_it() {
    let [bands, halves, counter, ..] = UNEVEN;
    let alone = ("halves", 900, halves.2);
    let slow = ("counter", 2100, BY_ROWS);
    for (given, expected) in [
        (
            &UNEVEN[..],
            "Fastest on 2 threads: halves and counter, which cannot be told apart: 2.0 times as \
             fast as one thread; the others take at least 10 % longer.",
        ),
        (
            &[alone, counter, bands],
            "Fastest on 2 threads: halves, 2.2 times as fast as one thread; the others take at \
             least 12 % longer.",
        ),
        (
            &[alone, counter],
            "Fastest on 2 threads: halves, 2.2 times as fast as one thread; counter takes 12 % \
             longer.",
        ),
        (
            &[halves, counter],
            "On 2 threads no difference is seen between the 2 strategies: they are 2.0 times as \
             fast as one thread.",
        ),
        (&[halves], "On 2 threads halves is 2.0 times as fast as one thread."),
        (
            &[slow],
            "On 2 threads no strategy is seen to be faster than the plain loop on one thread: the \
             best, counter, is 0.95 times as fast.",
        ),
        (&[], "Only sequential was measured, so nothing is compared."),
    ] {
        assert_eq!(first_sentence(&list(given, 1.0)), expected);
    }

    // A difference of 1 % is real, but not if one thread differs from itself by 2 %.
    let mut sure = list(&[halves, counter], 1.0);
    sure.results[1].measurement.speedup = Some(Interval { median: 1.0, low: 0.995, high: 1.002 });
    let sentence = first_sentence(&sure);
    assert!(sentence.ends_with("; counter takes 1 % longer."), "{sentence}");

    // One thread gains nothing.
    let mut one = list(&[halves, counter], 1.0);
    one.results[2..].iter_mut().for_each(|record| record.measurement.threads = 1);
    one.results[3].measurement.speedup = Some(Interval { median: 0.9, low: 0.8, high: 1.0 });
    assert_eq!(
        first_sentence(&one),
        "On 1 thread nothing is to be gained: 0.9 to 2.0 times as fast as the plain loop."
    );

    // Without an image of the reference there are no figures.
    let mut broken = list(&[halves], 1.0);
    broken.results[2].measurement = failed(broken.results[2].measurement.clone(), "gone");
    assert_eq!(first_sentence(&broken), "On 2 threads no strategy gave figures to compare.");
}

/// Catches a claim of equal bits although an image is wrong or missing.
#[test]
fn equal_bits_are_claimed_only_where_they_are() {
    let right = list(&UNEVEN, 1.0).screen(&[]).replace('\n', " ");
    assert!(right.contains("all gave the same bits") && !right.contains("NOT"), "{right}");
    let mut wrong = list(&UNEVEN, 1.0);
    wrong.results[4].measurement.identical = false;
    wrong.results[4].measurement.speedup = None;
    let wrong = wrong.screen(&[]).replace('\n', " ");
    assert!(wrong.contains("NOT all") && !wrong.contains("all gave the same bits"), "{wrong}");
    assert!(wrong.contains("  counter     WRONG IMAGE "), "{wrong}");
}

#[test]
fn shares_fixed_beforehand_lose_where_the_cost_is_uneven() {
    let [bands, halves, ..] = UNEVEN;
    let even = ("bands", 1010, bands.2);
    let better = ("bands", 900, bands.2);
    let lesson = |given: &[Given<'_>], imbalance| lessons_of(&list(given, imbalance));
    let longer = "Deal out at run time: equal shares, fixed beforehand, take 50 % longer here";
    let half = ": the dearer half of this image has 78 % of its cost.";
    assert_eq!(lesson(&[bands, halves], 1.56), [format!("{longer}{half}")]);
    assert_eq!(lesson(&[bands, halves], 1.05), [format!("{longer}.")], "another cause");
    let as_well = ["Equal shares do as well here: this image's cost is even."];
    assert_eq!(lesson(&[even, halves], 1.05), as_well);
    assert_eq!(lesson(&[even, halves], 1.56), [""; 0], "nothing that the figures carry");
    let better_here = "Equal shares do better here, dealing out at run time takes 11 % longer";
    let reason = ": this image's cost is even.";
    assert_eq!(lesson(&[better, halves], 1.05), [format!("{better_here}{reason}")]);

    let mut four = list(&[bands, halves], 1.56);
    four.machine.available_threads = 4;
    four.results[2..].iter_mut().for_each(|record| record.measurement.threads = 4);
    let share = ": the dearest of 4 shares of this image has 39 % of its cost.";
    assert_eq!(lessons_of(&four), [format!("{longer}{share}")]);
    four.machine.available_threads = 2;
    assert_eq!(lessons_of(&four), [""; 0], "more threads than the machine has");
}

#[test]
fn who_deals_out_matters_only_if_the_figures_say_so() {
    let [_, halves, counter, channel, ..] = UNEVEN;
    let slow = ("slow", 1200, ["tile", "guided", "in-place"]);
    let slower = ("slower", 1300, ["tile", "work-stealing", "in-place"]);
    let lesson = |given: &[Given<'_>]| lessons_of(&list(given, 1.56));
    let none = "How the next piece is taken (counter or queue, halving as rayon does) makes no \
                difference to be seen here.";
    assert_eq!(lesson(&[halves, counter, channel]), [none]);
    assert_eq!(lesson(&[halves, channel]), [""; 0], "a channel does more than deal out");
    assert_eq!(
        lesson(&[halves, counter, slow]),
        ["Among those dealt out at run time slow takes 20 % longer than halves; between the \
             others no difference is seen."]
    );
    assert_eq!(
        lesson(&[halves, slow, slower]),
        ["Among those dealt out at run time slow and slower take up to 30 % longer than halves."]
    );
    // An error of 11 % hides too much.
    let mut uncertain = list(&[halves, counter], 1.56);
    uncertain.results[1].measurement.speedup = Some(Interval { median: 1.0, low: 0.89, high: 1.0 });
    assert_eq!(lessons_of(&uncertain), [""; 0]);
    let sentence = first_sentence(&uncertain);
    assert!(sentence.ends_with(" The figures are too uncertain to rely on, see below."));
}

#[test]
fn locks_cost_what_the_figures_say() {
    let [bands, _, _, _, row_locks, pixel_locks] = UNEVEN;
    let (dear, cheap) = (("row-locks", 1650, row_locks.2), ("pixel-locks", 1515, pixel_locks.2));
    for (given, expected) in [
        (&[bands, row_locks][..], "A lock a row costs nothing to be seen here."),
        (
            &[bands, row_locks, pixel_locks],
            "A lock a row costs nothing to be seen here; a lock a pixel costs 19 % (pixel-locks \
             against row-locks).",
        ),
        (&[bands, row_locks, cheap], "A lock a row or a pixel costs nothing to be seen here."),
        (&[bands, dear], "A lock a row costs 10 % (row-locks against bands) here."),
        (&[bands, pixel_locks], "A lock a pixel costs 20 % (pixel-locks against bands) here."),
    ] {
        assert_eq!(lessons_of(&list(given, 1.56)), [expected]);
    }
    assert_eq!(lessons_of(&list(&[row_locks], 1.56)), [""; 0], "nothing to compare with");
}

/// Catches a lesson on threading from rows that traced different rays.
#[test]
fn unequal_work_is_told_first() {
    let mut list = list(&UNEVEN, 1.56);
    for record in &mut list.results {
        record.subject.lanes = 8;
        record.measurement.primary_packets = Some(113_000);
    }
    let pixels = &mut list.results[7].measurement;
    (pixels.primary_rays, pixels.primary_packets) = (Some(5_000_000), Some(1_250_000));
    let lessons = lessons_of(&list);
    assert_eq!(
        lessons[0],
        "Not threading alone: rays a pixel: 4.4 by tiles, 4.4 by bands, 4.4 by rows, 25.0 by \
         pixels; lanes in use: 97 % by tiles, 97 % by bands, 97 % by rows, 50 % by pixels."
    );
    assert!(lessons.iter().all(|lesson| !lesson.contains("a lock a pixel")), "{lessons:?}");
    let text = list.screen(&[]);
    assert!(text.contains("   5.7 x the rays, 50 %"), "{text}");
}

#[test]
fn the_control_says_which_differences_to_trust() {
    let told = |low, high| {
        let mut list = list(&UNEVEN, 1.0);
        list.results[1].measurement.speedup = Some(Interval { median: 1.0, low, high });
        let text = list.screen(&[]).replace('\n', " ");
        let place = text.find("Trust").or(text.find("One thread against")).expect("the line");
        text[place..].split(" A CPU").next().unwrap_or_default().to_owned()
    };
    assert_eq!(
        told(0.992, 1.021),
        "Trust differences above 3 % (one thread against itself: 0.99-1.02)."
    );
    assert_eq!(
        told(0.9, 1.0),
        "Trust differences above 10 % (one thread against itself: 0.90-1.00). Measure longer \
         (--time-limit) or on a quieter machine."
    );
    assert_eq!(
        told(0.95, 0.98),
        "One thread against itself is 0.95-0.98, which is not 1: measure again."
    );
}

/// Catches a line that a terminal of 80 columns would fold.
#[test]
fn no_line_is_longer_than_80_columns() {
    let mut lists = vec![list(&UNEVEN, 1.56), list(&[], 1.0)];
    lists.push(Results::new(machine(), noise(), records()));
    let disturbed = Noise { share_of_others: Some(0.25), disturbed: true, ..noise() };
    lists.push(Results::new(machine(), disturbed, records()));
    let long = "a-long-name-without-a-space/".repeat(9);
    // Long names, many threads, several numbers of threads, errors without spaces.
    let mut threads = list(&UNEVEN, 1.56);
    let many: Vec<Record> = [2, 4, 1024]
        .into_iter()
        .flat_map(|threads| {
            let mut rows = list(&UNEVEN, 1.56).results.split_off(2);
            rows.iter_mut().for_each(|record| record.measurement.threads = threads);
            rows
        })
        .collect();
    threads.results.truncate(2);
    threads.results.extend(many);
    for (record, number) in threads.results[2..].iter_mut().zip(0..) {
        record.measurement.strategy = format!("{number}-{long}");
        if number % 5 == 0 {
            record.measurement = failed(record.measurement.clone(), &long);
        }
    }
    threads.results.iter_mut().for_each(|record| record.subject.scene.clone_from(&long));
    threads.machine.cpu = "CPU ".repeat(40);
    threads.precision_goal = Some(0.01);
    lists.push(threads.clone());
    let changed = threads.clone().compared_with(&threads);
    assert!(changed.changes.is_some());
    lists.push(changed);
    // Both ways of sharing, and six scenes.
    let mut unshared = records();
    unshared.iter_mut().for_each(|record| record.subject.share_samples = false);
    lists.push(Results::new(machine(), noise(), [records(), unshared].concat()));
    let scenes = (0..6).flat_map(|number| {
        let mut records = threads.results.clone();
        records.iter_mut().for_each(|record| {
            record.subject.scene = format!("{long}{number}-{}.toml", "scene".repeat(30));
        });
        records
    });
    let mut scenes = Results::new(machine(), noise(), scenes.collect());
    scenes.not_measured = vec![long.clone()];
    lists.push(scenes);

    for list in lists {
        let text = list.screen(&[format!("note: {long}")]);
        let longest = text.lines().max_by_key(|line| line.chars().count()).unwrap_or_default();
        assert!(longest.chars().count() <= 80, "{longest}\nin\n{text}");
        assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text}");
    }
    assert_eq!(subject().lanes, 8, "the screen of unequal work is among them");
}

#[test]
fn chosen_columns_are_those_of_the_whole_table() {
    let results = list(&UNEVEN, 1.0);
    let columns = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        let text = results.table(&names);
        let row = text.lines().find(|line| line.starts_with("counter")).unwrap_or_default();
        row.split_whitespace().map(str::to_owned).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(columns(&["strategy", "identical", "median"]), "counter yes 1010");
    assert_eq!(columns(&["strategy", "lanes"]), "counter 100 %");
    let all: Vec<&str> = column_names().collect();
    assert_eq!(columns(&all), columns(&[]));
    assert_eq!(all.len(), 11);
}
