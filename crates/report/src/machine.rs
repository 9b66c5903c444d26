//! The facts about a machine, as they stand under every result.

use rayweave_measure::Machine;
use serde::Serialize;

/// Two lines for people: processor, cores and limits; compiler, kind of build and commit.
#[must_use]
pub fn text(machine: &Machine) -> String {
    let Machine {
        cpu, logical_cores, available_threads, os, arch, compiler, profile, commit, ..
    } = machine;
    let quota = machine.quota.map(|cores| format!(", quota {cores} cores")).unwrap_or_default();
    let warning = if *profile == "release" { "" } else { " (times mean little)" };
    format!(
        "machine: {cpu}, {logical_cores} logical cores, {available_threads} available{quota}, {os} {arch}\n\
         program: {compiler}, {profile} build{warning}, commit {commit}"
    )
}

/// The same for other programs.
#[derive(Serialize)]
pub(crate) struct Facts<'a> {
    cpu: &'a str,
    logical_cores: usize,
    available_threads: usize,
    /// Absent limits are null.
    quota_cores: Option<f64>,
    os: &'a str,
    arch: &'a str,
    target_features: &'a [&'a str],
    compiler: &'a str,
    profile: &'a str,
    commit: &'a str,
}

impl<'a> Facts<'a> {
    pub(crate) fn new(machine: &'a Machine) -> Self {
        Self {
            cpu: &machine.cpu,
            logical_cores: machine.logical_cores,
            available_threads: machine.available_threads,
            quota_cores: machine.quota,
            os: machine.os,
            arch: machine.arch,
            target_features: &machine.target_features,
            compiler: machine.compiler,
            profile: machine.profile,
            commit: machine.commit,
        }
    }
}
