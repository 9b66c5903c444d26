//! What else went on, for people and for programs.

use rayweave_measure::Noise;
use serde::Serialize;

/// One line, two if the times are to be doubted.
pub(crate) fn text(noise: &Noise) -> String {
    let share = noise
        .share_of_others()
        .map(|share| format!("others had {:.1} % of the machine", share * 100.0));
    let stolen = noise.stolen.filter(|stolen| !stolen.is_zero());
    let stolen = stolen.map(|stolen| {
        format!("{:.1} s of it other machines on the same host", stolen.as_secs_f64())
    });
    let switches = noise.involuntary_switches.map(|times| format!("{times} involuntary switches"));
    let throttled = noise.throttled.filter(|&times| times > 0);
    let throttled = throttled.map(|times| format!("stopped {times} times by the group's limit"));
    let clock = noise
        .megahertz
        .as_ref()
        .map(|range| format!("{:.0} to {:.0} MHz", range.start(), range.end()));
    let known: Vec<String> =
        [share, stolen, throttled, switches, clock].into_iter().flatten().collect();
    let known =
        if known.is_empty() { "this system does not tell".to_owned() } else { known.join("; ") };
    let verdict = if noise.is_disturbing() {
        "\nDISTURBED: measure again when the machine is quiet."
    } else {
        ""
    };
    format!("noise: {known}.{verdict}")
}

/// What is unknown is null.
#[derive(Serialize)]
pub(crate) struct Object {
    wall_s: f64,
    foreign_cpu_s: Option<f64>,
    stolen_s: Option<f64>,
    share_of_others: Option<f64>,
    throttled: Option<u64>,
    involuntary_switches: Option<u64>,
    lowest_mhz: Option<f64>,
    highest_mhz: Option<f64>,
    disturbed: bool,
}

impl From<&Noise> for Object {
    fn from(noise: &Noise) -> Self {
        Self {
            wall_s: noise.wall.as_secs_f64(),
            foreign_cpu_s: noise.foreign.map(|time| time.as_secs_f64()),
            stolen_s: noise.stolen.map(|time| time.as_secs_f64()),
            share_of_others: noise.share_of_others(),
            throttled: noise.throttled,
            involuntary_switches: noise.involuntary_switches,
            lowest_mhz: noise.megahertz.as_ref().map(|range| *range.start()),
            highest_mhz: noise.megahertz.as_ref().map(|range| *range.end()),
            disturbed: noise.is_disturbing(),
        }
    }
}
