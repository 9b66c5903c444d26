use super::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayweave_contract::{Granularity, Scheduling};

/// Returns a policy. Its granularity has no influence on the simulation but by the costs.
fn policy(scheduling: Scheduling, output: Output) -> Policy {
    Policy { granularity: Granularity::Row, scheduling, output }
}

fn in_place(scheduling: Scheduling) -> Policy {
    policy(scheduling, Output::InPlace)
}

fn free(scheduling: Scheduling, threads: usize, pieces: &[f64]) -> SimulatedRender {
    simulate(in_place(scheduling), threads, pieces, &Overheads::default())
}

const ONE_BY_ONE: Scheduling = Scheduling::Dynamic { chunk: 1 };

const ALL: [Scheduling; 6] = [
    Scheduling::Static,
    ONE_BY_ONE,
    Scheduling::Dynamic { chunk: 3 },
    Scheduling::Guided,
    Scheduling::WorkStealing,
    Scheduling::RecursiveSplit,
];

/// Pieces with a heavy one at the end, as an expensive last row.
const PIECES: [f64; 8] = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 9.0];

#[test]
fn static_blocks_wait_for_the_heaviest() {
    assert_eq!(
        free(Scheduling::Static, 2, &PIECES),
        SimulatedRender { time: 12.0, computed: vec![4.0, 12.0] }
    );
    // Of 8 pieces 3 threads get 2, 3 and 3.
    assert_eq!(free(Scheduling::Static, 3, &PIECES).computed, [2.0, 3.0, 11.0]);
    assert_eq!(free(Scheduling::Static, 16, &PIECES).time, 9.0);
}

#[test]
fn a_shared_counter_serves_free_threads() {
    // Both compute one by one until 3; thread 0 then takes the last but one, thread 1 the last.
    assert_eq!(
        free(ONE_BY_ONE, 2, &PIECES),
        SimulatedRender { time: 12.0, computed: vec![4.0, 12.0] }
    );
    assert_eq!(free(ONE_BY_ONE, 2, &[9.0, 1.0, 1.0, 1.0]).computed, [9.0, 3.0]);
    // Chunks of 3: 0..3 and 3..6 until 3, then thread 0 gets both that are left.
    assert_eq!(free(Scheduling::Dynamic { chunk: 3 }, 2, &PIECES).computed, [13.0, 3.0]);
}

#[test]
fn guided_takes_ever_fewer() {
    // 8 left: thread 0 takes 4; 4 left: thread 1 takes 2, until 2, then one of 2, until 3, then the
    // last, until 12.
    assert_eq!(
        free(Scheduling::Guided, 2, &PIECES),
        SimulatedRender { time: 12.0, computed: vec![4.0, 12.0] }
    );
    let even = [1.0; 8];
    // 4 and 2 at 0; thread 1 takes one at 2 and one at 3.
    assert_eq!(
        free(Scheduling::Guided, 2, &even),
        SimulatedRender { time: 4.0, computed: vec![4.0, 4.0] }
    );
}

#[test]
fn an_idle_thread_steals_half() {
    // Shares of 4. At 4 thread 0 is idle; thread 1 then begins its fourth piece, so there is
    // nothing left to steal.
    assert_eq!(free(Scheduling::WorkStealing, 2, &PIECES).computed, [4.0, 12.0]);
    // All of the load is in the second block: thread 0 takes 2 of the 4 before thread 1 begins.
    let late = [0.0, 0.0, 0.0, 0.0, 5.0, 5.0, 5.0, 5.0];
    assert_eq!(
        free(Scheduling::WorkStealing, 2, &late),
        SimulatedRender { time: 10.0, computed: vec![10.0, 10.0] }
    );
    let overheads = Overheads { steal: 0.5, ..Overheads::default() };
    assert_eq!(simulate(in_place(Scheduling::WorkStealing), 2, &late, &overheads).time, 10.5);
}

#[test]
fn halves_are_stolen_whole_and_halved_again() {
    // Two splits: parts 0..2, 2..4 and 4..8 lie in thread 0's queue; thread 1 steals the largest,
    // halves it twice as well, and computes 4, then 5, then 6..8.
    let even = [1.0; 8];
    assert_eq!(
        free(Scheduling::RecursiveSplit, 2, &even),
        SimulatedRender { time: 4.0, computed: vec![4.0, 4.0] }
    );
    // Two pieces of 6 each are one part: it is not divided, though the other thread is idle from 2
    // on.
    let pieces = [6.0, 6.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(
        free(Scheduling::RecursiveSplit, 2, &pieces),
        SimulatedRender { time: 12.0, computed: vec![12.0, 2.0] }
    );
    // Under stealing it would be.
    assert_eq!(free(Scheduling::WorkStealing, 2, &pieces).computed, [6.0, 8.0]);
}

#[test]
fn threads_begin_one_after_the_other() {
    let overheads = Overheads { start: 10.0, next_start: 2.0, piece: 0.5, ..Overheads::default() };
    let run = simulate(in_place(Scheduling::Static), 3, &[1.0; 3], &overheads);
    assert_eq!(run.time, 10.0 + 2.0 * 2.0 + 1.5);
    // Thread 0 has taken all before thread 1 begins.
    let run = simulate(in_place(ONE_BY_ONE), 2, &[0.5; 2], &overheads);
    assert_eq!(run.computed, [1.0, 0.0]);
}

#[test]
fn a_lock_serves_one_thread_at_a_time() {
    let locked = policy(Scheduling::Static, Output::Mutex);
    let overheads =
        |hold, handover| Overheads { deliver: Access { hold, handover }, ..Overheads::default() };
    // Both ask at 1, 2 ...: thread 1 waits for thread 0, and is one hold later from then on.
    assert_eq!(
        simulate(locked, 2, &[1.0; 4], &overheads(0.25, 0.0)).time,
        1.0 + 0.25 + 0.25 + 1.0 + 0.25
    );
    // Where the lock is all there is, threads do not help: 8 pieces one after the other.
    let pieces = [0.0; 8];
    assert_eq!(simulate(locked, 4, &pieces, &overheads(1.0, 0.0)).time, 8.0);
    assert_eq!(simulate(locked, 1, &pieces, &overheads(1.0, 3.0)).time, 8.0, "no handover");
    // Each access but the first is a handover, because the threads alternate.
    assert_eq!(simulate(locked, 4, &pieces, &overheads(1.0, 3.0)).time, 8.0 + 7.0 * 3.0);
}

#[test]
fn a_counter_serves_one_thread_at_a_time() {
    let overheads = Overheads { take: Access { hold: 1.0, handover: 1.0 }, ..Overheads::default() };
    let run = |scheduling| simulate(in_place(scheduling), 2, &[0.0; 4], &overheads).time;
    assert_eq!(run(ONE_BY_ONE), 1.0 + 2.0 + 2.0 + 2.0);
    assert_eq!(run(Scheduling::Dynamic { chunk: 2 }), 1.0 + 2.0);
    assert_eq!(run(Scheduling::Static), 0.0, "nothing is shared");
}

#[test]
fn a_sender_does_not_wait() {
    let sent = policy(Scheduling::Static, Output::Channel);
    let overheads =
        Overheads { deliver: Access { hold: 3.0, handover: 0.0 }, ..Overheads::default() };
    // The owner receives at 1, 4, 7 and 10, when the threads have ended.
    assert_eq!(simulate(sent, 2, &[1.0; 4], &overheads).time, 1.0 + 4.0 * 3.0);
    // Few and large: only the last receipt is added.
    assert_eq!(simulate(sent, 2, &[10.0; 4], &overheads).time, 20.0 + 2.0 * 3.0);
}

#[test]
fn no_pieces_take_only_the_start() {
    let overheads = Overheads { start: 7.0, ..Overheads::default() };
    for scheduling in ALL {
        assert_eq!(
            simulate(in_place(scheduling), 3, &[], &overheads),
            SimulatedRender { time: 7.0, computed: vec![0.0; 3] }
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), ..Default::default() })]

    /// Catches pieces that are lost or computed twice, and a speed-up above the number of threads.
    /// Whole numbers add up exactly.
    #[test]
    fn work_is_conserved_and_n_threads_are_at_most_n_times_as_fast(
        pieces in prop::collection::vec(0_u32..1000, 1..200),
        threads in 1_usize..40,
        output in prop::sample::select(vec![Output::InPlace, Output::Mutex, Output::Channel]),
        overhead in 0_u32..50,
    ) {
        let pieces: Vec<f64> = pieces.into_iter().map(f64::from).collect();
        let total: f64 = pieces.iter().sum();
        let piece = f64::from(overhead);
        let access = Access { hold: piece, handover: piece };
        let overheads =
            Overheads { piece, take: access, deliver: access, ..Overheads::default() };
        for scheduling in ALL {
            let run = simulate(policy(scheduling, output), threads, &pieces, &overheads);
            prop_assert_eq!(run.computed.iter().sum::<f64>(), total, "{:?}", scheduling);
            prop_assert!(run.time >= run.computed.iter().copied().fold(0.0, f64::max));
            prop_assert!(run.time * threads as f64 >= total + piece * pieces.len() as f64);
        }
    }

    /// A list scheduler is never worse than this (Graham, "Bounds on multiprocessing timing
    /// anomalies", 1969). So more threads may be slower, but by no more than it allows.
    #[test]
    fn a_list_scheduler_is_within_grahams_bound(
        pieces in prop::collection::vec(0_u32..1000, 1..200),
        threads in 1_usize..40,
    ) {
        let pieces: Vec<f64> = pieces.into_iter().map(f64::from).collect();
        let total: f64 = pieces.iter().sum();
        let longest = pieces.iter().copied().fold(0.0, f64::max);
        let inverse = 1.0 / threads as f64;
        let bound = total * inverse + longest * (1.0 - inverse);
        for scheduling in [ONE_BY_ONE, Scheduling::WorkStealing] {
            let time = free(scheduling, threads, &pieces).time;
            prop_assert!(time <= bound * (1.0 + 1e-12), "{scheduling:?}: {time} is above {bound}");
        }
    }
}
