//! The machine that a result was measured on, and the program that measured it.

use serde::{Deserialize, Serialize};
use std::env::consts::{ARCH, OS};
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// The folder of control groups on Linux.
const GROUPS: &str = "/sys/fs/cgroup";

/// Facts about this machine and this program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Machine {
    /// The processor's model, or "unknown".
    pub cpu: String,
    /// Logical cores that the machine has, whether or not this process may use them.
    pub logical_cores: usize,
    /// Threads that can run at the same time under this process's affinity and quota.
    pub available_threads: usize,
    /// The control group's limit in cores, where there is one.
    pub quota_cores: Option<f64>,
    /// Operating system: "linux", "macos", ...
    pub os: String,
    /// Architecture: "x86_64", "aarch64", ...
    pub arch: String,
    /// Instruction sets that the program was compiled for.
    pub target_features: Vec<String>,
    /// The compiler's own name for its version, or "unknown".
    pub compiler: String,
    /// "release" or "debug": the kind of build.
    pub profile: String,
    /// The commit, "-dirty" added if the sources differ from it, or "unknown".
    pub commit: String,
}

impl Machine {
    /// Returns the facts about this machine; those that cannot be found out are unknown.
    #[must_use]
    pub fn here() -> Self {
        let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let available_threads = thread::available_parallelism().map_or(1, usize::from);
        Self {
            cpu: cpu_model(&cpuinfo).unwrap_or("unknown").to_owned(),
            logical_cores: logical_cores(&cpuinfo).unwrap_or(available_threads),
            available_threads,
            quota_cores: quota(),
            os: OS.to_owned(),
            arch: ARCH.to_owned(),
            target_features: env!("RAYWEAVE_TARGET_FEATURES")
                .split(',')
                .filter(|name| !name.is_empty())
                .map(str::to_owned)
                .collect(),
            compiler: env!("RAYWEAVE_COMPILER").to_owned(),
            profile: env!("RAYWEAVE_PROFILE").to_owned(),
            commit: env!("RAYWEAVE_COMMIT").to_owned(),
        }
    }
}

/// Returns the value of the first "model name : value" line of `/proc/cpuinfo`.
fn cpu_model(cpuinfo: &str) -> Option<&str> {
    let model = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    model.split_once(':').map(|(_, value)| value.trim())
}

fn logical_cores(cpuinfo: &str) -> Option<usize> {
    let count = cpuinfo.lines().filter(|line| line.starts_with("processor")).count();
    (count > 0).then_some(count)
}

/// Returns the tightest limit of the control groups that this process is in, in cores.
fn quota() -> Option<f64> {
    cpu_groups()
        .iter()
        .filter_map(|(version, folder)| limit(*version, folder))
        .min_by(f64::total_cmp)
}

/// Returns the folders of the control groups that limit this process: its own and their parents.
pub(crate) fn cpu_groups() -> Vec<(Version, PathBuf)> {
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let inside = |folder: &&Path| folder.starts_with(GROUPS);
    let around = |(version, folder): (Version, PathBuf)| -> Vec<(Version, PathBuf)> {
        folder.ancestors().take_while(inside).map(|folder| (version, folder.to_owned())).collect()
    };
    groups.lines().filter_map(cpu_group).flat_map(around).collect()
}

/// The two forms of control groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    /// One hierarchy for each controller.
    V1,
    /// One hierarchy for all.
    V2,
}

/// Returns the version and the folder of the CPU's group in a line "number:controllers:/path" of
/// `/proc/self/cgroup`.
fn cpu_group(line: &str) -> Option<(Version, PathBuf)> {
    let mut parts = line.splitn(3, ':').skip(1);
    let (controllers, path) = (parts.next()?, parts.next()?.trim_start_matches('/'));
    if controllers.is_empty() {
        Some((Version::V2, Path::new(GROUPS).join(path)))
    } else if controllers.split(',').any(|name| name == "cpu") {
        Some((Version::V1, Path::new(GROUPS).join("cpu").join(path)))
    } else {
        None
    }
}

fn limit(version: Version, folder: &Path) -> Option<f64> {
    let read = |file| fs::read_to_string(folder.join(file)).ok();
    match version {
        Version::V1 => {
            cores(&format!("{} {}", read("cpu.cfs_quota_us")?, read("cpu.cfs_period_us")?))
        }
        Version::V2 => cores(&read("cpu.max")?),
    }
}

/// Returns the cores of "quota period", both in the same unit; `None` for "max" or -1, which mean
/// no limit.
fn cores(text: &str) -> Option<f64> {
    let mut numbers = text.split_whitespace().map(str::parse::<f64>);
    let (quota, period) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
    (quota > 0.0 && period > 0.0).then(|| quota / period)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn here_has_a_compiler_and_threads() {
        let machine = Machine::here();
        assert!(machine.compiler.starts_with("rustc "), "{}", machine.compiler);
        assert!(machine.available_threads >= 1 && machine.logical_cores >= 1);
        assert!(!machine.commit.is_empty());
    }

    #[test]
    fn cpuinfo() {
        let text = "processor\t: 0\nmodel name\t: Some CPU: 2 GHz\n\n\
                    processor\t: 1\nmodel name\t: other\n";
        assert_eq!(cpu_model(text), Some("Some CPU: 2 GHz"));
        assert_eq!(logical_cores(text), Some(2));
        assert_eq!((cpu_model(""), logical_cores("")), (None, None));
    }

    #[test]
    fn groups_of_both_versions() {
        let v2 = |path: &str| Some((Version::V2, PathBuf::from(path)));
        let v1 = |path: &str| Some((Version::V1, PathBuf::from(path)));
        assert_eq!(cpu_group("0::/a/b"), v2("/sys/fs/cgroup/a/b"));
        assert_eq!(cpu_group("0::/"), v2("/sys/fs/cgroup/"));
        assert_eq!(cpu_group("4:cpu,cpuacct:/docker/x:y"), v1("/sys/fs/cgroup/cpu/docker/x:y"));
        assert_eq!(cpu_group("3:cpuset:/"), None);
        assert_eq!(cpu_group("nonsense"), None);
    }

    #[test]
    fn quotas() {
        assert_eq!(cores("150000 100000\n"), Some(1.5));
        assert_eq!(cores("max 100000\n"), None);
        assert_eq!(cores("-1\n 100000\n"), None);
        assert_eq!(cores("200000"), None);
        assert_eq!(cores(""), None);
    }
}
