//! The strategy: who computes which tile, when, on which thread.

use crate::image::Image;
use crate::policy::{Policy, Threads};
use crate::tile::{Rect, Tile};
use crate::work::Work;
use std::any::Any;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// A way to spread work over threads.
///
/// ```
/// use rayweave_contract::{
///     Granularity, Image, Output, Plan, Policy, Renderer, Scheduling, Strategy, StrategyError,
///     Threads, Work, render_tile,
/// };
/// use std::num::NonZeroU32;
///
/// /// One tile after the other on the caller's thread.
/// struct Alone;
///
/// impl Strategy for Alone {
///     fn name(&self) -> &'static str {
///         "alone"
///     }
///
///     fn summary(&self) -> &'static str {
///         "one tile after the other"
///     }
///
///     fn threads(&self) -> Threads {
///         Threads::None
///     }
///
///     fn policy(&self) -> Policy {
///         let (granularity, output) = (Granularity::Tile, Output::InPlace);
///         Policy { granularity, scheduling: Scheduling::Static, output }
///     }
///
///     fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError> {
///         Ok(Box::new(Tiles(plan.tile)))
///     }
/// }
///
/// struct Tiles(NonZeroU32);
///
/// impl Renderer for Tiles {
///     fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
///         image.tiles(self.0).iter_mut().try_for_each(|tile| render_tile("alone", work, tile))
///     }
/// }
///
/// assert_eq!(Alone.policy().scheduling.to_string(), "static");
/// ```
pub trait Strategy: Sync {
    /// Returns the name on the command line and in every table: lower case, words joined by `-`.
    fn name(&self) -> &'static str;

    /// Returns one line that says what the strategy decides.
    fn summary(&self) -> &'static str;

    /// Returns where the strategy starts its threads.
    fn threads(&self) -> Threads;

    /// Returns what the strategy decides; a simulation of it goes by this alone.
    fn policy(&self) -> Policy;

    /// Returns what is missing on this machine, or was missing when the program was built, and how
    /// to get it; `None` if the strategy can be prepared.
    fn unavailable(&self) -> Option<&'static str> {
        None
    }

    /// Prepares to render with exactly `plan.threads` computing threads; a pool is built here.
    ///
    /// # Errors
    ///
    /// [`StrategyError::Spawn`] if a pool cannot be built, [`StrategyError::Unavailable`] if the
    /// strategy is [unavailable](Self::unavailable).
    fn prepare(&self, plan: Plan) -> Result<Box<dyn Renderer>, StrategyError>;
}

/// A prepared strategy, which renders as often as asked. [`Strategy`] has an example.
pub trait Renderer {
    /// Fills every pixel of `image` with what `work` computes for it.
    ///
    /// # Errors
    ///
    /// [`StrategyError::Panicked`] if the work panicked, [`StrategyError::Spawn`] if a thread could
    /// not be started. The image is then incomplete, and the renderer may be used again.
    fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError>;
}

/// The parameters that a strategy is prepared with.
///
/// ```
/// use rayweave_contract::Plan;
/// use std::num::{NonZeroU32, NonZeroUsize};
///
/// let plan = Plan { threads: NonZeroUsize::new(8).unwrap(), tile: NonZeroU32::new(32).unwrap() };
/// assert_eq!(plan.threads.get(), 8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The number of computing threads, whether or not the caller's is one of them. A strategy has
    /// to give each of them something to do in an image of twice as many tiles.
    pub threads: NonZeroUsize,
    /// The side of a tile in pixels, for strategies that hand out tiles. Each tile takes about 40
    /// bytes of memory, and 16 a row.
    pub tile: NonZeroU32,
}

/// The reason why a strategy gave no image.
///
/// ```
/// use rayweave_contract::{StrategyError, Tile, Work, render_tile};
///
/// struct Faulty;
///
/// impl Work for Faulty {
///     fn render(&self, _: &mut Tile<'_>) {
///         panic!("no value");
///     }
/// }
///
/// let mut color = [0.0; 3];
/// let error = render_tile("loop", &Faulty, &mut Tile::pixel(3, 4, &mut color)).unwrap_err();
/// assert!(matches!(error, StrategyError::Panicked { .. }));
/// assert_eq!(error.to_string(), "loop: the work panicked in the tile 1x1 at (3, 4): no value");
/// ```
#[derive(Debug, Error)]
pub enum StrategyError {
    /// The work panicked; the other threads stopped at their next tile.
    #[error("{strategy}: the work panicked in the tile {tile}: {message}")]
    Panicked {
        /// The strategy's name.
        strategy: &'static str,
        /// The tile that was being computed.
        tile: Rect,
        /// The panic's message.
        message: String,
    },
    /// The strategy needs something that is missing here.
    #[error("{strategy}: unavailable here: {reason}")]
    Unavailable {
        /// The strategy's name.
        strategy: &'static str,
        /// The missing thing, and how to get it.
        reason: &'static str,
    },
    /// A thread could not be started; those that were started have ended.
    #[error("{strategy}: cannot start {threads} threads: {source}; use fewer (--threads)")]
    Spawn {
        /// The strategy's name.
        strategy: &'static str,
        /// The number of threads asked for.
        threads: usize,
        /// The reason given by the operating system or the library.
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
        StrategyError::Panicked { strategy, tile: tile.rect(), message: panic_message(&*payload) }
    })
}

/// Returns a panic's message, given the payload from `catch_unwind` or `join`.
#[must_use]
pub fn panic_message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("(a panic without a message)").to_owned()
}
