//! The first screen of made-up lists: figures that carry a sentence or a lesson, and others that do
//! not.

use super::fixtures::{digest, failed, machine, noise, record, records, row};
use super::lessons;
use super::ranking::Section;
use super::verdict::trust;
use super::*;

/// A strategy's name, its time in milliseconds, and its granularity, scheduling and output.
type Given<'a> = (&'a str, u64, [&'a str; 3]);

const BY_ROWS: [&str; 3] = ["row", "dynamic", "in-place"];

/// On the uneven image of these, scheduling at run time pays, and locks for pixels cost.
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
             fast as one thread; the others take 10 to 80 % longer.",
        ),
        (
            &[alone, counter, bands],
            "Fastest on 2 threads: halves, 2.2 times as fast as one thread; the others take 12 to \
             67 % longer.",
        ),
        (
            &[alone, counter, ("again", 1010, BY_ROWS)],
            "Fastest on 2 threads: halves, 2.2 times as fast as one thread; the others take 12 % \
             longer.",
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
            "On 2 threads no strategy is seen to be faster than the plain loop on one thread; the \
             highest median is counter, 0.95 (0.91-1.01).",
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
        "On 1 thread the strategies are 0.90 to 2.00 times as fast as the plain loop."
    );
    one.results.pop();
    assert_eq!(first_sentence(&one), "On 1 thread halves is 2.00 times as fast as the plain loop.");
    // Without an image of the reference there are no figures.
    let mut broken = list(&[halves], 1.0);
    broken.results[2].measurement = failed(broken.results[2].measurement.clone(), "gone");
    assert_eq!(first_sentence(&broken), "On 2 threads no strategy gave figures to compare.");
}

/// Catches a sentence that contradicts the chart: the first row may be slower than one thread, but
/// the second is not.
#[test]
fn a_wide_first_row_does_not_hide_that_another_pays_off() {
    let [_, halves, counter, ..] = UNEVEN;
    let mut wide = list(&[halves, counter], 1.0);
    let uncertain = Some(Interval { median: 2.21, low: 0.91, high: 4.14 });
    wide.results[2].measurement.speedup = uncertain;
    assert_eq!(
        first_sentence(&wide),
        "On 2 threads no difference is seen between the 2 strategies: they are 2.0 to 2.2 times as \
         fast as one thread."
    );
    wide.results[3].measurement.speedup = uncertain;
    let sentence = first_sentence(&wide);
    assert!(sentence.ends_with(" the highest median is halves, 2.21 (0.91-4.14)."), "{sentence}");
}

/// Catches one of many rows that is called slower by chance: its interval of 95 % lies just above
/// 1, which is enough for one row but not for one of ten.
#[test]
fn many_rows_need_more_evidence_than_one() {
    let [_, halves, ..] = UNEVEN;
    let given = |others| [vec![halves], vec![("maybe", 1100, BY_ROWS); others]].concat();
    let alike = |others| {
        let mut list = list(&given(others), 1.0);
        for (record, number) in list.results[2..].iter_mut().zip(0..) {
            let steps = if number == 1 { [90, 95, 103, 104, 105, 106, 107, 108] } else { [100; 8] };
            let rounds = (0..3).flat_map(|_| steps).map(|step| step * 10_000_000);
            record.measurement.samples_ns = rounds.collect();
        }
        Section::all(&list.results)[0].ranked().0.len()
    };
    assert_eq!((alike(1), alike(9)), (1, 10));
}

/// Catches a claim of equal bits although an image is wrong or missing.
#[test]
fn equal_bits_are_claimed_only_where_they_are() {
    let right = list(&UNEVEN, 1.0).screen(&[]).replace('\n', " ");
    assert!(
        right.contains("7 strategies, all with the same bits") && !right.contains("NOT"),
        "{right}"
    );
    let mut wrong = list(&UNEVEN, 1.0);
    wrong.results[4].measurement.identical = false;
    wrong.results[4].measurement.speedup = None;
    let wrong = wrong.screen(&[]).replace('\n', " ");
    assert!(wrong.contains("7 strategies, NOT all with the same bits"), "{wrong}");
    assert!(wrong.contains("  counter     WRONG IMAGE "), "{wrong}");
}

#[test]
fn shares_fixed_beforehand_lose_where_the_cost_is_uneven() {
    let [bands, halves, ..] = UNEVEN;
    let even = ("bands", 1010, bands.2);
    let better = ("bands", 900, bands.2);
    let lesson = |given: &[Given<'_>], imbalance| lessons_of(&list(given, imbalance));
    let longer = "Schedule at run time: equal shares take 50 % longer here";
    let half = ", because the more expensive half of this image has 78 % of its cost.";
    assert_eq!(lesson(&[bands, halves], 1.56), [format!("{longer}{half}")]);
    assert_eq!(lesson(&[bands, halves], 1.05), [format!("{longer}.")], "another cause");
    assert_eq!(lesson(&[bands, halves], 1.3), [format!("{longer}.")], "more than the cause");
    let as_well = ["No difference is seen between equal shares and scheduling at run time: this \
                    image's cost is even."];
    assert_eq!(lesson(&[even, halves], 1.05), as_well);
    assert_eq!(lesson(&[even, halves], 1.56), [""; 0], "nothing that the figures carry");
    let better_here = "Equal shares are faster here: scheduling at run time takes 11 % longer";
    let reason = ", because this image's cost is even.";
    assert_eq!(lesson(&[better, halves], 1.05), [format!("{better_here}{reason}")]);

    let mut four = list(&[bands, halves], 1.56);
    four.machine.available_threads = 4;
    four.results[2..].iter_mut().for_each(|record| record.measurement.threads = 4);
    let share = ", because the most expensive of 4 shares of this image has 39 % of its cost.";
    assert_eq!(lessons_of(&four), [format!("{longer}{share}")]);
    four.machine.available_threads = 2;
    assert_eq!(lessons_of(&four), [""; 0], "more threads than the machine has");
}

/// Catches the best of many rows against the best of few: of equally good groups the larger one has
/// the luckier best row.
#[test]
fn the_medians_of_the_groups_are_compared() {
    let [bands, ..] = UNEVEN;
    let free = |name, ms| (name, ms, ["row", "dynamic", "channel"]);
    let given = [free("lucky", 900), free("a", 1500), free("b", 1600), bands];
    assert_eq!(lessons_of(&list(&given, 1.56)), [""; 0]);
    let given = [free("lucky", 900), free("a", 1000), free("b", 1600), bands];
    let lessons = lessons_of(&list(&given, 1.56));
    assert!(lessons[0].contains("equal shares take 50 % longer"), "{lessons:?}");
}

#[test]
fn the_next_piece_matters_only_if_the_figures_say_so() {
    let [_, halves, counter, channel, ..] = UNEVEN;
    let slow = ("slow", 1200, ["tile", "guided", "in-place"]);
    let slower = ("slower", 1300, ["tile", "work-stealing", "in-place"]);
    let lesson = |given: &[Given<'_>]| lessons_of(&list(given, 1.56));
    let none = "How the next piece is taken (counter or queue, halving as rayon does) makes no \
                visible difference here.";
    assert_eq!(lesson(&[halves, counter, channel]), [none]);
    assert_eq!(lesson(&[halves, channel]), [""; 0], "a channel does more than schedule");
    assert_eq!(
        lesson(&[halves, counter, slow]),
        ["Among the strategies that schedule at run time, slow takes 20 % longer than halves; \
             between the others no difference is seen."]
    );
    assert_eq!(
        lesson(&[halves, slow, slower]),
        ["Among the strategies that schedule at run time, slow and slower take up to 30 % longer \
             than halves."]
    );
    // An error of 11 % hides too much.
    let mut uncertain = list(&[halves, counter], 1.56);
    uncertain.results[1].measurement.speedup = Some(Interval { median: 1.0, low: 0.89, high: 1.0 });
    assert_eq!(lessons_of(&uncertain), [""; 0]);
    let sentence = first_sentence(&uncertain);
    let why = "too uncertain to rely on (one thread against itself: 0.89-1.00).";
    assert!(sentence.ends_with(why), "{sentence}");
}

#[test]
fn locks_cost_what_the_figures_say() {
    let [bands, _, _, _, row_locks, pixel_locks] = UNEVEN;
    let (slow, fast) = (("row-locks", 1650, row_locks.2), ("pixel-locks", 1515, pixel_locks.2));
    let none = "One lock per row has no visible cost here (below 2 %).";
    let rows = "row-locks takes 10 % longer than bands: rows, each copied under the lock, against \
                bands in place.";
    let pixels = "Single pixels with a lock each take 19 % longer than rows with a lock each.";
    for (given, expected) in [
        (&[bands, row_locks][..], none.to_owned()),
        (&[bands, row_locks, pixel_locks], format!("{none} {pixels}")),
        (&[row_locks, pixel_locks], pixels.to_owned()),
        (&[bands, row_locks, fast], none.to_owned()),
        (&[bands, slow], rows.to_owned()),
    ] {
        assert_eq!(lessons_of(&list(given, 1.56)), [expected]);
    }
    assert_eq!(lessons_of(&list(&[row_locks], 1.56)), [""; 0], "nothing to compare with");
    assert_eq!(lessons_of(&list(&[bands, pixel_locks], 1.56)), [""; 0], "more than the lock");
    // The cost may be as large as its interval allows.
    let within = |highest| {
        let mut list = list(&[bands, row_locks], 1.56);
        let [bands, locks] = &mut list.results[2..] else { panic!("two rows") };
        bands.measurement.samples_ns = vec![1000; 8];
        locks.measurement.samples_ns = [vec![980; 4], vec![highest; 4]].concat();
        lessons_of(&list)
    };
    assert_eq!(within(1070), ["One lock per row has no visible cost here (below 7 %)."]);
    assert_eq!(within(1200), [""; 0]);
}

#[test]
fn an_expensive_tile_is_a_reason_only_for_those_that_have_it() {
    let tiles = ["tile", "dynamic", "in-place"];
    let [fast_rows, slow_tiles] = [("counter", 1000, BY_ROWS), ("tiles", 1200, tiles)];
    let fast_tiles = ("fast-tiles", 1005, tiles);
    let told = |given: &[Given<'_>], share, certain: bool| {
        let mut list = list(given, 1.0);
        list.results.iter_mut().for_each(|record| record.largest_tile = Some(share));
        if !certain {
            let wide = Interval { median: 1.0, low: 0.89, high: 1.0 };
            list.results[1].measurement.speedup = Some(wide);
        }
        list.screen(&[]).contains("\n  tiles: one tile has 52 % of the cost\n")
    };
    assert!(told(&[fast_rows, slow_tiles], 0.52, true));
    assert!(!told(&[fast_rows, slow_tiles], 0.49, true), "two threads can share the rest");
    assert!(!told(&[fast_rows, fast_tiles, slow_tiles], 0.52, true), "a fast row has it too");
    assert!(!told(&[fast_rows, fast_tiles], 0.52, true), "no row is slower");
    assert!(!told(&[fast_rows, slow_tiles], 0.52, false), "the figures are uncertain");
    let mut list = list(&[fast_rows, ("channel", 1200, UNEVEN[3].2)], 1.0);
    assert!(list.screen(&[]).contains("copies each row"));
    list.results[1].measurement.speedup = Some(Interval { median: 1.0, low: 0.89, high: 1.0 });
    assert!(!list.screen(&[]).contains("copies each row"), "the figures are uncertain");
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
        "The work differs: primary rays per pixel are 4.4 in tiles, 4.4 in bands, 4.4 in rows, \
         25.0 in pixels; lanes in use are 97 % in tiles, 97 % in bands, 97 % in rows, 50 % in \
         pixels."
    );
    assert!(lessons.iter().all(|lesson| !lesson.contains("Single pixels")), "{lessons:?}");
    let text = list.screen(&[]);
    assert!(text.contains("   5.7 x the rays, 50 %"), "{text}");
}

#[test]
fn the_control_says_which_differences_to_trust() {
    let told = |low, high| {
        let control = Interval { median: 1.0, low, high };
        let mut list = list(&UNEVEN, 1.0);
        list.results[1].measurement.speedup = Some(control);
        let line = trust(control);
        assert!(list.screen(&[]).replace('\n', " ").contains(&line), "{line}");
        assert!(list.table(&[]).contains(&format!("\n{line}\n")), "{line}");
        line
    };
    let rule = |percent, range| {
        format!(
            "Ignore differences below {percent} % (one thread against itself: {range}); for larger \
             ones compare the intervals."
        )
    };
    assert_eq!(told(0.992, 1.021), rule(3, "0.99-1.02"));
    let measure = " Measure longer (--time-limit) or on a quieter machine.";
    assert_eq!(told(0.9, 1.0), rule(10, "0.90-1.00") + measure);
    assert_eq!(
        told(0.95, 0.98),
        "One thread against itself is 0.95-0.98, which does not contain 1: measure again. On a \
         quiet machine at most one run in twenty does this by chance."
    );
}

#[test]
fn the_image_has_a_name_for_readers() {
    let named = |scene: &str| {
        let mut list = list(&UNEVEN, 1.0);
        list.results.iter_mut().for_each(|record| record.subject.scene = scene.to_owned());
        let text = list.screen(&[]).replace('\n', " ");
        let (name, _) = text.split_once(", 500 x 400 pixels with 25 rays each; ").expect("image");
        name.rsplit("  ").next().unwrap_or_default().to_owned()
    };
    assert_eq!(named(BUILT_IN_SCENE), "The lab report's scene");
    assert_eq!(named("scenes/room.toml"), "room.toml");
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

    let mut works = [false; 2];
    for list in lists {
        let text = list.screen(&[format!("note: {long}")]);
        let longest = text.lines().max_by_key(|line| line.chars().count()).unwrap_or_default();
        assert!(longest.chars().count() <= 80, "{longest}\nin\n{text}");
        assert!(text.lines().all(|line| line == line.trim_end()), "{text}");
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text}");
        works[0] |= text.contains("Equal work: ");
        works[1] |= text.contains("Not equal work: ");
    }
    assert_eq!(works, [true; 2], "screens of equal and of unequal work are among them");
}

#[test]
fn chosen_columns_are_those_of_the_whole_table() {
    let results = list(&UNEVEN, 1.0);
    let columns = |names: &[&str]| {
        let text = results.table(&names.iter().map(ToString::to_string).collect::<Vec<_>>());
        let row = text.lines().find(|line| line.starts_with("counter")).unwrap_or_default();
        row.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(columns(&["strategy", "identical", "median"]), "counter yes 1010");
    assert_eq!(columns(&["strategy", "lanes"]), "counter 100 %");
    let all: Vec<&str> = column_names().collect();
    assert_eq!(columns(&all), columns(&[]));
    assert_eq!(all.len(), 11);
}
