//! Simulates a loop of 5,000 independent items on 8 threads and prints README's table: the speed-up
//! of each way to deal out the items, in several orders.
//!
//! The costs are spread evenly on a logarithmic scale, from 20 us to 40 ms; in the last column a
//! sixteenth of the items takes 40 ms, the others 20 us. The overheads are assumed. For comparison:
//! `rayweave overhead` measured 17 to 44 ns an item on an AMD EPYC.

use rayweave_contract::{Granularity, Output, Policy, Scheduling};
use rayweave_predict::{Access, Overheads, simulate};

const THREADS: usize = 8;
const ITEMS: usize = 5_000;
const ORDERS: usize = 99;

/// Costs in nanoseconds.
const CHEAPEST: f64 = 20e3;
const MOST_EXPENSIVE: f64 = 40e6;

const OVERHEADS: Overheads = Overheads {
    start: 200e3,
    next_start: 100e3,
    piece: 50.0,
    take: Access { hold: 20.0, handover: 100.0 },
    deliver: Access { hold: 0.0, handover: 0.0 },
    steal: 1e3,
};

const WAYS: [(&str, Scheduling); 4] = [
    ("equal shares, fixed beforehand", Scheduling::Static),
    ("the next 64 items to a free thread", Scheduling::Dynamic { chunk: 64 }),
    ("the next item to a free thread", Scheduling::Dynamic { chunk: 1 }),
    ("rayon's `par_iter`", Scheduling::RecursiveSplit),
];

/// Returns the speed-up over one thread without overheads.
fn speedup(scheduling: Scheduling, costs: &[f64]) -> f64 {
    let policy = Policy { granularity: Granularity::Row, scheduling, output: Output::InPlace };
    costs.iter().sum::<f64>() / simulate(policy, THREADS, costs, &OVERHEADS).time
}

/// Shuffles the costs (Fisher and Yates) with a 64-bit linear congruential generator.
fn shuffle(costs: &mut [f64], state: &mut u64) {
    for last in (1..costs.len()).rev() {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        costs.swap(last, (*state >> 33) as usize % (last + 1));
    }
}

/// Returns the table in Markdown. The figure of the random orders is their median.
pub fn table() -> String {
    let ratio = (MOST_EXPENSIVE / CHEAPEST).powf(1.0 / (ITEMS - 1) as f64);
    let sorted: Vec<f64> = (0..ITEMS).map(|item| CHEAPEST * ratio.powi(item as i32)).collect();
    let expensive = |item| if item < ITEMS / 16 { MOST_EXPENSIVE } else { CHEAPEST };
    let together: Vec<f64> = (0..ITEMS).map(expensive).collect();
    let mut text = [
        "| who gets which item | random order | sorted by cost | the expensive ones first |\n",
        "|---|---|---|---|\n",
    ]
    .concat();
    for (name, scheduling) in WAYS {
        let (mut costs, mut state) = (sorted.clone(), 1);
        let mut random: Vec<f64> = (0..ORDERS)
            .map(|_| {
                shuffle(&mut costs, &mut state);
                speedup(scheduling, &costs)
            })
            .collect();
        random.sort_by(f64::total_cmp);
        let (median, sorted) = (random[ORDERS / 2], speedup(scheduling, &sorted));
        let together = speedup(scheduling, &together);
        text += &format!("| {name} | {median:.2} | {sorted:.2} | {together:.2} |\n");
    }
    text
}

#[allow(clippy::print_stdout)] // Its purpose.
fn main() {
    print!("{}", table());
}
