//! The two lines about machine and program that end every result.

use rayweave_measure::Machine;

/// Returns one line on processor, cores and limits, and one on compiler, build and commit.
#[must_use]
pub fn text(machine: &Machine) -> String {
    let Machine {
        cpu, logical_cores, available_threads, os, arch, compiler, profile, commit, ..
    } = machine;
    let quota =
        machine.quota_cores.map(|cores| format!(", quota {cores} cores")).unwrap_or_default();
    let warning = if profile == "release" { "" } else { " (times mean little)" };
    format!(
        "machine: {cpu}, {logical_cores} logical cores, {available_threads} available{quota}, \
         {os} {arch}\nprogram: {compiler}, {profile} build{warning}, commit {commit}"
    )
}

/// Returns the same facts in a few words.
pub(crate) fn short(machine: &Machine) -> String {
    let Machine { cpu, available_threads, compiler, profile, commit, .. } = machine;
    let warning = if profile == "release" { "" } else { ": times mean little" };
    format!("{cpu}, {available_threads} threads; {compiler}, {profile} build{warning}; {commit}.")
}
