//! Samples of a comparison, each from a process of its own: this program, started again with
//! `sample`.
//!
//! So no pool that still waits, no spinning team and no warmed allocator of one strategy meets
//! another.

use crate::interrupt::Interrupt;
use crate::options::{SceneOptions, SharingOption};
use rayweave_contract::Digest;
use rayweave_measure::compare::{Entry, Executor, Rays, Rendering, Sample};
use serde::{Deserialize, Serialize};
use std::env;
use std::ffi::OsString;
use std::io::Read;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// A process counts as stuck when it has taken so many times as long as the slowest before it,
const PATIENCE: u32 = 100;

/// and no less than this.
const LEAST_PATIENCE: Duration = Duration::from_secs(60);

/// What `sample` prints: one line of JSON.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// It rendered.
    Rendered(Rendered),
    /// It could not, for this reason.
    Failed(String),
}

/// The times and the pictures of a process.
#[derive(Debug, Serialize, Deserialize)]
pub struct Rendered {
    prepare_ns: u64,
    one_shot_ns: Option<u64>,
    render_ns: u64,
    cpu_ns: Option<u64>,
    digest: String,
    first_digest: Option<String>,
    primary_rays: Option<u64>,
    redundant_rays: Option<u64>,
}

impl From<(Rendering, Option<Rays>)> for Rendered {
    fn from((rendering, rays): (Rendering, Option<Rays>)) -> Self {
        let Sample { prepare_ns, render_ns, one_shot_ns, cpu_ns } = rendering.sample;
        Self {
            prepare_ns,
            one_shot_ns,
            render_ns,
            cpu_ns,
            digest: rendering.digest.to_string(),
            first_digest: rendering.first_digest.map(|digest| digest.to_string()),
            primary_rays: rays.map(|rays| rays.primary),
            redundant_rays: rays.map(|rays| rays.redundant),
        }
    }
}

impl Rendered {
    fn read(self) -> Result<(Rendering, Option<Rays>), String> {
        let Self { prepare_ns, one_shot_ns, render_ns, cpu_ns, digest, first_digest, .. } = self;
        let parse = |digest: String| digest.parse::<Digest>().map_err(|e| format!("{digest}: {e}"));
        let sample = Sample { prepare_ns, render_ns, one_shot_ns, cpu_ns };
        let (digest, first_digest) = (parse(digest)?, first_digest.map(parse).transpose()?);
        let rays = self.primary_rays.zip(self.redundant_rays);
        let rays = rays.map(|(primary, redundant)| Rays { primary, redundant });
        Ok((Rendering { sample, digest, first_digest }, rays))
    }
}

/// The executor that starts a process for each rendering of one scene.
pub struct Children {
    program: PathBuf,
    /// The same for all.
    arguments: Vec<OsString>,
    begin: Instant,
    /// Of those that answered.
    slowest: Option<Duration>,
    interrupt: Interrupt,
}

impl Children {
    /// Will render the scene at `path`, or the report's, by tiles of `tile` pixels a side, samples
    /// shared or not.
    pub fn new(
        path: Option<&Path>,
        options: &SceneOptions,
        share_samples: bool,
        tile: NonZeroU32,
        interrupt: &Interrupt,
    ) -> Result<Self, String> {
        let program =
            env::current_exe().map_err(|e| format!("cannot find this program's own file: {e}"))?;
        let share_samples = if share_samples { SharingOption::On } else { SharingOption::Off };
        let words = SceneOptions { share_samples, ..*options }.words();
        let mut arguments: Vec<OsString> =
            vec!["sample".into(), "--tile".into(), tile.to_string().into()];
        arguments.extend(words.into_iter().map(OsString::from));
        // Last, and where even a name that begins with `-` is a path.
        arguments.extend(path.into_iter().flat_map(|path| [OsString::from("--"), path.into()]));
        Ok(Self {
            program,
            arguments,
            begin: Instant::now(),
            slowest: None,
            interrupt: interrupt.clone(),
        })
    }

    fn ask(
        &mut self,
        entry: &Entry<'_>,
        count_rays: bool,
    ) -> Result<(Rendering, Option<Rays>), String> {
        let begin = Instant::now();
        let mut command = Command::new(&self.program);
        command.args(&self.arguments[..1]);
        command.args([
            "--strategy",
            entry.strategy.name(),
            "--threads",
            &entry.threads.to_string(),
        ]);
        command.args(count_rays.then_some("--count-rays")).args(&self.arguments[1..]);
        let patience = self.slowest.map(|slowest| (slowest * PATIENCE).max(LEAST_PATIENCE));
        let text = output(&mut command, patience)?;
        let answer: Answer =
            serde_json::from_str(&text).map_err(|e| format!("its process said nonsense: {e}"))?;
        match answer {
            Answer::Failed(reason) => Err(reason),
            Answer::Rendered(rendered) => {
                self.slowest = self.slowest.max(Some(begin.elapsed()));
                rendered.read()
            }
        }
    }
}

impl Executor for Children {
    fn render(&mut self, entry: &Entry<'_>) -> Result<Rendering, String> {
        self.ask(entry, false).map(|(rendering, _)| rendering)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Result<(Rendering, Option<Rays>), String> {
        self.ask(entry, true)
    }

    fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    /// A terminal interrupts the process that renders too, so that none is waited for.
    fn is_interrupted(&self) -> bool {
        self.interrupt.happened()
    }
}

/// A process that does not outlive its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself: then there is nothing to kill, and nothing to be done about
        // an error.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What a process prints until it ends, or why there is nothing; it is ended after `patience`.
fn output(command: &mut Command, patience: Option<Duration>) -> Result<String, String> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
    let mut child = Running(child.map_err(|e| format!("its process cannot be started: {e}"))?);
    let mut stdout = child.0.stdout.take();
    let (sender, receiver) = mpsc::channel();
    let read = move || {
        let mut text = String::new();
        let read = stdout.as_mut().map_or(Ok(0), |stdout| stdout.read_to_string(&mut text));
        // Nobody listens any more when patience has ended.
        let _ = sender.send(read.map(|_| text));
    };
    // Sleeps until the process writes or ends: the measured threads do not notice it.
    let reader = thread::Builder::new().spawn(read);
    reader.map_err(|e| format!("its process cannot be listened to: {e}"))?;
    let read = match patience {
        Some(patience) => receiver.recv_timeout(patience),
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
    };
    match read {
        Ok(Ok(text)) if !text.is_empty() => Ok(text),
        Err(RecvTimeoutError::Timeout) => {
            let seconds = patience.unwrap_or_default().as_secs();
            Err(format!("no answer after {seconds} s: a deadlock? Its process was ended"))
        }
        Ok(_) | Err(RecvTimeoutError::Disconnected) => Err(match child.0.wait() {
            Ok(status) => format!("its process ended without an answer: {status}"),
            Err(error) => format!("its process is lost: {error}"),
        }),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str, patience: Option<Duration>) -> Result<String, String> {
        output(Command::new("sh").args(["-c", script]), patience)
    }

    #[test]
    fn what_a_process_says_and_how_it_ends() {
        assert_eq!(shell("echo words", None), Ok("words\n".to_owned()));
        assert_eq!(
            shell("exit 3", None),
            Err("its process ended without an answer: exit status: 3".to_owned())
        );
        let killed = shell("kill -9 $$", Some(LEAST_PATIENCE)).expect_err("killed");
        assert!(killed.starts_with("its process ended without an answer: signal: 9"), "{killed}");
        let missing = output(&mut Command::new("/no/such/program"), None).expect_err("missing");
        assert!(missing.starts_with("its process cannot be started: "), "{missing}");
    }

    /// Catches a process that goes on after nobody waits for it any more.
    #[test]
    fn a_stuck_process_is_ended() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let file = folder.path().join("pid");
        let script = format!("echo $$ > {}; exec sleep 1000", file.display());
        let error = shell(&script, Some(Duration::from_secs(1))).expect_err("stuck");
        assert_eq!(error, "no answer after 1 s: a deadlock? Its process was ended");
        let pid = std::fs::read_to_string(&file).expect("its number").trim().to_owned();
        let alive = Command::new("sh").args(["-c", &format!("kill -0 {pid} 2>/dev/null")]).status();
        assert!(!alive.expect("a shell").success(), "{pid} is alive");
    }
}
