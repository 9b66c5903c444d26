//! How work is spread: who computes which tile, when, on which thread.

use crate::image::Image;
use crate::policy::Rule;
use crate::tile::{Area, Tile};
use crate::work::Work;
use std::any::Any;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// A way to spread work over threads.
pub trait Strategy: Sync {
    /// Its name on the command line and in every table: lower case, words joined by `-`.
    fn name(&self) -> &'static str;

    /// One line: what it decides.
    fn summary(&self) -> &'static str;

    /// Where its threads are started, and so which figure contains that cost.
    fn threads_start(&self) -> ThreadsStart;

    /// How it deals out the work: what a simulation of it goes by.
    fn rule(&self) -> Rule;

    /// What is missing on this machine, or was when it was built, and how to get it; nothing if it
    /// can be prepared.
    fn unavailable(&self) -> Option<&'static str> {
        None
    }

    /// Makes ready to render with exactly `plan.threads` computing threads; a thread pool is built
    /// here.
    ///
    /// # Errors
    ///
    /// A pool that cannot be built; [`StrategyError::Unavailable`] if the strategy is
    /// [unavailable](Self::unavailable).
    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError>;
}

/// A prepared strategy: renders as often as asked.
pub trait Renderer {
    /// Fills every pixel of `image` with what `work` computes for it.
    ///
    /// # Errors
    ///
    /// Work that panicked, or a thread that could not be started. The picture is then incomplete,
    /// and the renderer may be used again.
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError>;
}

/// What a strategy is prepared for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The number of computing threads, whether or not the caller's is one of them. What a strategy
    /// deals out has to give each of them something in a picture of twice as many tiles.
    pub threads: NonZeroUsize,
    /// The side of a tile in pixels, for the strategies that deal in tiles. Each tile takes memory:
    /// some 40 bytes, and 16 a row.
    pub tile: NonZeroU32,
}

/// Where a strategy starts its threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadsStart {
    /// It has none of its own: the caller's thread computes, alone, whatever the plan says.
    Never,
    /// While it is prepared: a pool, whose start is not part of a rendering's time.
    Prepare,
    /// At the start of every rendering, and so within its time.
    Render,
}

impl ThreadsStart {
    /// The number of threads that compute where `asked` are asked for.
    #[must_use]
    pub fn computing_threads(self, asked: NonZeroUsize) -> NonZeroUsize {
        if self == Self::Never { NonZeroUsize::MIN } else { asked }
    }
}

/// Why a strategy gave no picture.
#[derive(Debug, Error)]
pub enum StrategyError {
    /// The work panicked; the other threads stopped at their next tile.
    #[error("{strategy}: the work panicked in the tile {tile}: {message}")]
    Panicked {
        /// The strategy's name.
        strategy: &'static str,
        /// The tile that was being computed.
        tile: Area,
        /// What the panic said.
        message: String,
    },
    /// What it is made of is not there.
    #[error("{strategy}: unavailable here: {reason}")]
    Unavailable {
        /// The strategy's name.
        strategy: &'static str,
        /// What is missing, and how to get it.
        reason: &'static str,
    },
    /// A thread could not be started; those that could have ended.
    #[error("{strategy}: cannot start {threads} threads: {source}; use fewer (--threads)")]
    Spawn {
        /// The strategy's name.
        strategy: &'static str,
        /// The number asked for.
        threads: usize,
        /// The operating system's or the library's reason.
        source: io::Error,
    },
}

/// Renders one tile; a panic of the work becomes an error that names strategy and tile.
///
/// # Errors
///
/// [`StrategyError::Panicked`].
pub fn render_tile(
    strategy: &'static str,
    work: &dyn Work,
    tile: &mut Tile<'_>,
) -> Result<(), StrategyError> {
    // After a panic nobody reads the tile as a result: the whole rendering is an error.
    catch_unwind(AssertUnwindSafe(|| work.render(tile))).map_err(|payload| {
        StrategyError::Panicked { strategy, tile: tile.area(), message: panic_message(&*payload) }
    })
}

/// What a panic said, from what `catch_unwind` or `join` gave.
#[must_use]
pub fn panic_message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("(a panic without a message)").to_owned()
}
