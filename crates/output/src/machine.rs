//! The facts about a machine in two lines, as they stand under every result.

use rayweave_measure::Machine;

/// Returns two lines: processor, cores and limits; compiler, kind of build and commit.
#[must_use]
pub fn text(machine: &Machine) -> String {
    let Machine {
        cpu, logical_cores, available_threads, os, arch, compiler, profile, commit, ..
    } = machine;
    let quota =
        machine.quota_cores.map(|cores| format!(", quota {cores} cores")).unwrap_or_default();
    let warning = if profile == "release" { "" } else { " (times mean little)" };
    format!(
        "machine: {cpu}, {logical_cores} logical cores, {available_threads} available{quota}, {os} {arch}\n\
         program: {compiler}, {profile} build{warning}, commit {commit}"
    )
}
