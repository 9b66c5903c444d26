//! Tests of the explanation with fake strategies on a work that only fills.

use super::*;
use crate::fakes::{GREY, Grey, SIDE, complete, skip};
use crate::timeline::{Piece, TimelineLane};
use rayweave_contract::{Rect, RenderError, Strategy, Threads};
use std::time::Duration;

static ALL: Strategy = complete("all", Threads::PerRender);
static ALONE: Strategy = complete("alone", Threads::None);
static ALL_BUT_ONE: Strategy = Strategy { name: "all-but-one", prepare: &|_| skip(1), ..ALL };
static REFUSES: Strategy =
    Strategy { name: "refuses", prepare: &|_| Err(RenderError::Unavailable("not today")), ..ALL };

const EXPERIMENT: ExplainExperiment<'_> = ExplainExperiment {
    work: &Grey,
    size: (5, 4),
    tile: SIDE,
    reference: ALL,
    protocol: Protocol {
        min_rounds: 3,
        max_rounds: 3,
        budget: Duration::ZERO,
        goal: None,
        seed: 1,
    },
};

/// Explains `strategies` with two threads each.
fn explain(strategies: &[Strategy<'_>]) -> Result<Explanation, ExplainError> {
    EXPERIMENT.run(strategies, NonZeroUsize::new(2).expect("not 0"), |_| ())
}

#[test]
fn each_strategy_has_a_row_and_its_pieces() {
    let explanation = explain(&[ALL, ALL]).expect("explained");
    assert_eq!((explanation.rounds, explanation.reference), (3, "all"));
    assert_eq!(explanation.digest, Image::filled(5, 4, GREY).expect("an image").digest());
    assert_eq!(explanation.rows.len(), 2);
    for row in &explanation.rows {
        assert_eq!((row.strategy, row.threads), ("all", 2));
        let areas: Vec<_> =
            row.timeline.lanes[0].pieces.iter().map(|p| (p.rect.x, p.rect.y)).collect();
        assert_eq!(areas, [(0, 0), (2, 0), (4, 0), (0, 2), (2, 2), (4, 2)]);
        // Whatever the times, the second thread has no work.
        assert_eq!(row.timeline.lanes.len(), 1);
        assert_eq!(row.lost_ns, 2.0 * row.wall_ns - explanation.reference_ns);
    }
}

/// Catches a second thread that waits where there is none.
#[test]
fn a_strategy_without_threads_has_one_whatever_it_is_given() {
    let explanation = explain(&[ALONE]).expect("explained");
    let row = &explanation.rows[0];
    assert_eq!((row.strategy, row.threads), ("alone", 1));
    assert_eq!(row.lost_ns, row.wall_ns - explanation.reference_ns);
}

/// Catches figures of a strategy that gives another image, or none.
#[test]
fn a_wrong_strategy_is_not_explained() {
    let wrong = explain(&[ALL, ALL_BUT_ONE]).expect_err("another image");
    assert!(matches!(wrong, ExplainError::Different { strategy: "all-but-one" }), "{wrong}");
    let failed = explain(&[REFUSES]).expect_err("no image");
    assert_eq!(failed.to_string(), "refuses: unavailable here: not today");
}

/// Catches pieces that are kept although they are not shown, or with memory for more.
#[test]
fn only_shown_pieces_are_kept() {
    let free = RecordingCost { inside_ns: 0.0, outside_ns: 0.0 };
    let kept = |recording| {
        let mut series = Series::new(ALL, NonZeroUsize::MIN, recording);
        let mut image = Image::new(5, 4).expect("an image");
        for counts in [false, true] {
            series.render(&EXPERIMENT, free, &mut image, counts).expect("drawn");
        }
        series.quickest.map(|quickest| quickest.timeline)
    };
    assert_eq!(kept(Recording::Off), None);
    assert_eq!(kept(Recording::Breakdown), Some(Timeline { wall_ns: 0, lanes: Vec::new() }));
    let timeline = kept(Recording::Timeline).expect("recorded");
    let pieces = &timeline.lanes[0].pieces;
    assert_eq!((pieces.len(), pieces.capacity()), (6, 6));
}

#[test]
fn a_long_gap_is_longer_than_999_of_1000() {
    let mut end = 0;
    let mut after = |gap: u64| {
        let begin = end + gap;
        end = begin + 5;
        Piece { rect: Rect { x: 0, y: 0, width: 1, height: 1 }, begin_ns: begin, end_ns: end }
    };
    // The first has no gap before it.
    let pieces = std::iter::once(50_000).chain((1..=2000).rev()).map(&mut after).collect();
    let timeline = Timeline { wall_ns: 0, lanes: vec![TimelineLane { name: None, pieces }] };
    // Two of the 2000 gaps are as long as that or longer.
    assert_eq!(long_gap_ns(&timeline), 1999.0);
    assert_eq!(long_gap_ns(&Timeline::default()), 0.0);
}
