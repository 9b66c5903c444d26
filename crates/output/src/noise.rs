//! The line about other activity on the machine during a measurement.

use rayweave_measure::Noise;

/// Returns one line, and a second one if the noise makes the times doubtful.
pub(crate) fn text(noise: &Noise) -> String {
    let facts = [
        noise
            .share_of_others
            .map(|share| format!("others used {:.1} % of the machine", share * 100.0)),
        noise
            .stolen_s
            .filter(|&seconds| seconds > 0.0)
            .map(|seconds| format!("other virtual machines on the host took {seconds:.1} s of it")),
        noise
            .throttled
            .filter(|&times| times > 0)
            .map(|times| format!("the CPU quota stopped this program {times} times")),
        noise.involuntary_switches.map(|times| format!("{times} involuntary context switches")),
        noise
            .lowest_mhz
            .zip(noise.highest_mhz)
            .map(|(lowest, highest)| format!("{lowest:.0} to {highest:.0} MHz")),
    ];
    let facts: Vec<String> = facts.into_iter().flatten().collect();
    let facts =
        if facts.is_empty() { "unknown on this system".to_owned() } else { facts.join("; ") };
    let verdict =
        if noise.disturbed { "\nDISTURBED: measure again when the machine is quiet." } else { "" };
    format!("noise: {facts}.{verdict}")
}
