//! What else went on, in a line.

use rayweave_measure::Noise;

/// Returns one line, two if the times are to be doubted.
pub(crate) fn text(noise: &Noise) -> String {
    let share = noise
        .share_of_others
        .map(|share| format!("others had {:.1} % of the machine", share * 100.0));
    let stolen = noise.stolen_s.filter(|&seconds| seconds > 0.0);
    let stolen =
        stolen.map(|seconds| format!("{seconds:.1} s of it other machines on the same host"));
    let switches = noise.involuntary_switches.map(|times| format!("{times} involuntary switches"));
    let throttled = noise.throttled.filter(|&times| times > 0);
    let throttled = throttled.map(|times| format!("stopped {times} times by the group's limit"));
    let clock = noise.lowest_mhz.zip(noise.highest_mhz);
    let clock = clock.map(|(lowest, highest)| format!("{lowest:.0} to {highest:.0} MHz"));
    let known: Vec<String> =
        [share, stolen, throttled, switches, clock].into_iter().flatten().collect();
    let known =
        if known.is_empty() { "this system does not tell".to_owned() } else { known.join("; ") };
    let verdict =
        if noise.disturbed { "\nDISTURBED: measure again when the machine is quiet." } else { "" };
    format!("noise: {known}.{verdict}")
}
