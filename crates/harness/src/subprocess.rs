//! Measures each sample of a comparison in a process of its own: this program, started as `sample`
//! with a job.
//!
//! Thus no waiting pool, spinning team or warm allocator of one strategy affects another.

use crate::interrupt::Interrupt;
use crate::options::SceneOptions;
use rayweave_measure::compare::{Entry, Executor};
use rayweave_measure::measurement::Sample;
use serde::{Deserialize, Serialize};
use std::env;
use std::ffi::OsString;
use std::io::Read;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// A process counts as stuck after this many times the time of the slowest process before it.
const PATIENCE: u32 = 100;

/// The shortest time after which a process counts as stuck.
const LEAST_PATIENCE: Duration = Duration::from_secs(60);

/// A request for one rendering: the argument of `sample`, as JSON.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Job {
    /// The scene file with any name that the system allows; `None` is the lab report's scene.
    pub scene: Option<OsString>,
    /// The options of the scene.
    pub options: SceneOptions,
    /// The side of a tile in pixels.
    pub tile: NonZeroU32,
    /// The strategy's name.
    pub strategy: String,
    /// The number of computing threads.
    pub threads: NonZeroUsize,
    /// True to render once and count the rays, instead of twice with all times.
    pub count_rays: bool,
}

/// The answer that `sample` prints as JSON: a sample, or the reason why there is none.
pub type Answer = Result<Sample, String>;

/// The executor that starts a process for each rendering of one scene.
pub struct SubprocessExecutor {
    program: PathBuf,
    /// The part of the job that is the same for all strategies, threads and purposes.
    job: Job,
    begin: Instant,
    /// The longest time that a process took to answer.
    slowest: Option<Duration>,
    interrupt: Interrupt,
}

impl SubprocessExecutor {
    /// Returns an executor of jobs like `job`.
    pub fn new(job: Job, interrupt: &Interrupt) -> Result<Self, String> {
        let program =
            env::current_exe().map_err(|e| format!("cannot find this program's own file: {e}"))?;
        let (begin, interrupt) = (Instant::now(), interrupt.clone());
        Ok(Self { program, job, begin, slowest: None, interrupt })
    }

    fn ask(&mut self, entry: &Entry<'_>, count_rays: bool) -> Answer {
        let begin = Instant::now();
        let strategy = entry.strategy.name.to_owned();
        let job = Job { strategy, threads: entry.threads, count_rays, ..self.job.clone() };
        let job = serde_json::to_string(&job).map_err(|e| e.to_string())?;
        let patience = self.slowest.map(|slowest| (slowest * PATIENCE).max(LEAST_PATIENCE));
        let text = output(Command::new(&self.program).args(["sample", &job]), patience)?;
        let answer: Answer = serde_json::from_str(&text)
            .map_err(|e| format!("the answer of its process is not valid: {e}"))?;
        if answer.is_ok() {
            self.slowest = self.slowest.max(Some(begin.elapsed()));
        }
        answer
    }
}

impl Executor for SubprocessExecutor {
    fn render(&mut self, entry: &Entry<'_>) -> Answer {
        self.ask(entry, false)
    }

    fn warm_up(&mut self, entry: &Entry<'_>) -> Answer {
        self.ask(entry, true)
    }

    fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    /// Ctrl-C in a terminal also ends the child process, so the current rendering returns at once.
    fn is_interrupted(&self) -> bool {
        self.interrupt.happened()
    }
}

/// A child process that is killed when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // An error means that it has ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns the standard output of a process, or the reason why there is none. The process is killed
/// after `patience`.
fn output(command: &mut Command, patience: Option<Duration>) -> Result<String, String> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
    let mut child = Running(child.map_err(|e| format!("its process cannot be started: {e}"))?);
    let mut stdout = child.0.stdout.take();
    let (sender, receiver) = mpsc::channel();
    let read = move || {
        let mut text = String::new();
        let read = stdout.as_mut().map_or(Ok(0), |stdout| stdout.read_to_string(&mut text));
        // After `patience` there is no receiver.
        let _ = sender.send(read.map(|_| text));
    };
    // The reader sleeps until the process writes or ends, so it does not disturb the measured
    // threads.
    let reader = thread::Builder::new().spawn(read);
    reader.map_err(|e| format!("the output of its process cannot be read: {e}"))?;
    let read = match patience {
        Some(patience) => receiver.recv_timeout(patience),
        None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
    };
    match read {
        Ok(Ok(text)) if !text.is_empty() => Ok(text),
        Err(RecvTimeoutError::Timeout) => {
            let seconds = patience.unwrap_or_default().as_secs();
            Err(format!("no answer after {seconds} s, perhaps a deadlock: its process was killed"))
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

    /// Catches a process that keeps running after the program stops waiting for it.
    #[test]
    fn a_stuck_process_is_ended() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let file = folder.path().join("pid");
        let script = format!("echo $$ > {}; exec sleep 1000", file.display());
        let error = shell(&script, Some(Duration::from_secs(1))).expect_err("stuck");
        assert_eq!(error, "no answer after 1 s, perhaps a deadlock: its process was killed");
        let pid = std::fs::read_to_string(&file).expect("its number").trim().to_owned();
        let alive = Command::new("sh").args(["-c", &format!("kill -0 {pid} 2>/dev/null")]).status();
        assert!(!alive.expect("a shell").success(), "{pid} is alive");
    }
}
