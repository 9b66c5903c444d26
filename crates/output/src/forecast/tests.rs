use super::*;
use crate::compare::fixtures::{noise, row};
use rayweave_contract::Image;
use rayweave_measure::forecast::{ForecastCurve, ForecastPoint, Slowdown};
use rayweave_measure::{Comparison, Interval, Measurement};
use rayweave_predict::{Law, Overheads};
use serde_json::Value;

fn forecast() -> Forecast {
    let interval = |median| Interval { median, low: median - 0.1, high: median + 0.1 };
    let point = |threads, predicted, measured: Option<f64>| ForecastPoint {
        threads,
        predicted,
        measured: measured.map(interval),
    };
    let amdahl = Some(Law { serial: 0.02, crosstalk: 0.0, error: 0.011 });
    let usl = Some(Law { serial: 0.01, crosstalk: 0.0001, error: 0.004 });
    let curve = |strategy, points, amdahl, usl| ForecastCurve {
        strategy,
        overheads: Overheads { start: 90.0, ..Overheads::default() },
        points,
        amdahl,
        usl,
    };
    let points =
        vec![point(1, 0.99, Some(1.0)), point(2, 1.8, Some(2.0)), point(1024, 123.4, None)];
    let few = vec![point(1, 0.5, None), point(2, 0.9, None), point(1024, 0.25, None)];
    Forecast {
        curves: vec![curve("queue", points, amdahl, usl), curve("lock", few, None, None)],
        unavailable: vec!["omp: unavailable here: no compiler".to_owned()],
        slowdowns: vec![Slowdown {
            threads: 2,
            factor: Interval { median: 1.05, low: 1.0, high: 1.1 },
        }],
        comparison: Comparison {
            // The reference takes 50 ms; the lock gave another image.
            rows: vec![
                row("alone", 1, "none", 50_000_000),
                Measurement { identical: false, ..row("lock", 1, "per-render", 1) },
            ],
            digest: Image::new(1, 1).expect("an image").digest(),
            rounds: 6,
            interrupted: false,
        },
    }
}

fn with_view<T>(read: impl FnOnce(&ForecastView<'_>) -> T) -> T {
    let (forecast, machine, noise) = (forecast(), Machine::here(), noise());
    read(&ForecastView {
        scene: "room",
        width: 5,
        height: 4,
        tile: 32,
        forecast: &forecast,
        machine: &machine,
        noise: &noise,
    })
}

#[test]
fn the_table_predicts_checks_and_says_what_is_assumed() {
    let table = with_view(|view| view.table());
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<String> = table.lines().map(words).collect();
    let has = |line: &str| assert!(lines.iter().any(|known| known == line), "{line}: {table}");
    has("queue 0.990 1.80 123 0.0200 ±1 % 0.0100 1.0e-4 ±0 % 99");
    has("lock 0.500 0.900 0.250 - - - -");
    has("queue 2 1.80 2.00 [1.90, 2.10] -10.0 %");
    has("1 of 2 predictions within 5 %");
    has("omp: unavailable here: no compiler");
    assert!(table.contains("lock, 1 thread: wrong image (digest "), "{table}");
    assert!(table.contains("1.050 [1.000, 1.100] times as long"), "{table}");
    assert!(table.contains("The reference takes 50.00 ms."), "{table}");
    has(&crate::noise::text(&noise()));
    assert!(ASSUMPTIONS.iter().all(|assumption| table.contains(assumption)), "{table}");
}

#[test]
fn json_has_every_point_and_law() {
    let value: Value = serde_json::from_str(&with_view(|view| view.json())).expect("JSON");
    let result = &value["results"][1];
    assert_eq!((&result["strategy"], &result["threads"]), (&"queue".into(), &2.into()));
    assert_eq!((&result["predicted"], &result["measured"]["low"]), (&1.8.into(), &1.9.into()));
    assert!((result["difference"].as_f64().expect("a number") + 0.1).abs() < 1e-12);
    assert!(value["results"][2]["measured"].is_null());
    assert_eq!(value["results"].as_array().map(Vec::len), Some(6));
    assert_eq!(value["laws"][0]["usl"]["kappa"], 0.0001);
    assert_eq!(value["laws"][0]["overheads"]["start_ns"], 90.0);
    assert!(value["laws"][1]["amdahl"].is_null());
    assert_eq!(value["slowdowns"][0]["factor"]["high"], 1.1);
    assert_eq!(value["reference_median_ns"], 50e6);
    assert_eq!(
        (&value["noise"]["wall_s"], &value["noise"]["disturbed"]),
        (&10.0.into(), &false.into())
    );
}

#[test]
fn the_plot_names_every_strategy() {
    let svg = with_view(|view| view.svg()).expect("a plot");
    for word in ["<svg", "queue", "lock", "room, 5 x 4 pixels", "threads", "ideal speed-up"] {
        assert!(svg.contains(word), "{word}");
    }
    // Two measurements.
    assert_eq!(svg.matches("<circle").count(), 2);
}
