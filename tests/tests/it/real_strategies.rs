//! The strategies of the registry pass every check, and survive work that panics.

use crate::gradient::{Gradient, PATIENCE, Panics, threads, tile};
use rayweave_contract::{Image, Plan, RenderError, Strategy, StrategyError, Threads, Tile, Work};
use rayweave_measure::{Check, CheckCase};
use rayweave_registry::{available, reference};
use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

const THREADS: [usize; 6] = [1, 2, 3, 5, 8, 64];

/// Catches a check that finds faults in sound strategies, and progress that is not counted right.
#[test]
fn the_real_strategies_agree() {
    let sizes = [(1, 1), (1, 500), (500, 1), (7, 3), (97, 61)];
    let case = |(width, height)| CheckCase {
        name: "gradient".to_owned(),
        width,
        height,
        work: Box::new(Gradient),
    };
    let check = Check {
        reference: reference(),
        strategies: &available(),
        cases: &sizes.map(case),
        threads: &THREADS.map(threads),
        tiles: &[1, 8, 32, 1000].map(tile),
        timeout: Some(PATIENCE),
    };
    let mut told = 0;
    let verdict = check
        .run(|progress| {
            if progress.is_counting {
                return;
            }
            assert_eq!(progress.done, told);
            told += 1;
            assert!(told <= progress.total);
        })
        .expect("a reference image");
    assert_eq!(verdict.findings, []);
    let alone = available().iter().filter(|s| s.threads == Threads::None).count();
    let settings = ((available().len() - alone) * THREADS.len() + alone) * 4;
    assert_eq!(verdict.compared, settings * sizes.len() * 2);
    assert_eq!(verdict.compared, told);
}

/// Catches a strategy that hangs, aborts, names the wrong tile or is not usable after a panic.
#[test]
fn the_real_strategies_survive_work_that_panics() {
    let (done, finished) = mpsc::channel();
    let survive = move || {
        for strategy in available() {
            for count in THREADS {
                survives(strategy, threads(count));
            }
        }
        let _ = done.send(());
    };
    let watched = thread::spawn(survive);
    let result = finished.recv_timeout(Duration::from_secs(120));
    assert_ne!(result, Err(mpsc::RecvTimeoutError::Timeout), "a strategy hangs");
    watched.join().expect("every strategy survives");
}

fn survives(strategy: Strategy<'_>, threads: NonZeroUsize) {
    let context = format!("{}, {threads} threads", strategy.name);
    let mut renderer = strategy.prepare(Plan { threads, tile: tile(8) }).expect(&context);
    let mut image = Image::new(97, 61).expect("an image");
    for (x, y) in [(0, 0), (50, 30), (96, 60)] {
        let error =
            renderer.render(&Panics { work: Gradient, x, y }, &mut image).expect_err(&context);
        let StrategyError { strategy: name, error: RenderError::Panicked { tile, message } } =
            error
        else {
            panic!("{context}: {error}");
        };
        assert_eq!((name, message.as_str()), (strategy.name, "injected"), "{context}");
        assert!(tile.contains(x, y), "{context}: ({x}, {y}) is not in {tile}");

        image.fill([0.0; 3]);
        renderer.render(&Gradient, &mut image).expect(&context);
        let right = (0..61).flat_map(|y| (0..97).map(move |x| Gradient::color(x, y)));
        assert!(
            image.pixels().iter().copied().eq(right),
            "{context}: a wrong image after the panic"
        );
    }
}

/// Catches a strategy that hangs where every tile panics.
#[test]
fn work_that_always_panics_ends() {
    struct AlwaysPanics;
    impl Work for AlwaysPanics {
        fn render(&self, _: &mut Tile<'_>) {
            resume_unwind(Box::new(String::from("always")));
        }
    }
    let mut image = Image::new(97, 61).expect("an image");
    for strategy in available() {
        let plan = Plan { threads: threads(8), tile: tile(8) };
        let mut renderer = strategy.prepare(plan).expect("a renderer");
        let error = renderer.render(&AlwaysPanics, &mut image).expect_err("a panic").to_string();
        assert!(error.starts_with(strategy.name) && error.ends_with(": always"), "{error}");
    }
}
