//! The strategy: who computes which tile, when, on which thread.

use crate::image::Image;
use crate::policy::{Policy, Threads};
use crate::tile::{Rect, Tile};
use crate::work::Work;
use std::any::Any;
use std::fmt;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// A way to spread work over threads: a value that describes it, and the function that prepares it.
///
/// ```
/// use rayweave_contract::*;
///
/// /// One tile after the other on the caller's thread.
/// static ALONE: Strategy = Strategy {
///     name: "alone",
///     summary: "one tile after the other",
///     threads: Threads::None,
///     policy: Policy::new(Granularity::Tile, Scheduling::Static, Output::InPlace),
///     unavailable: None,
///     prepare: &|plan| renderer(move |work, image| render(plan, work, image)),
/// };
///
/// fn render(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
///     image.tiles(plan.tile).iter_mut().try_for_each(|tile| render_tile(work, tile))
/// }
///
/// assert_eq!(ALONE.policy.scheduling.to_string(), "static");
/// ```
#[derive(Clone, Copy)]
pub struct Strategy<'a> {
    /// The name on the command line and in every table: lower case, words joined by `-`.
    pub name: &'static str,
    /// One line that says how the strategy spreads the work.
    pub summary: &'static str,
    /// The place where the strategy starts its threads.
    pub threads: Threads,
    /// The decisions of the strategy. A simulation goes by them alone.
    pub policy: Policy,
    /// The thing that is missing on this machine, or was missing when the program was built, and
    /// how to get it; `None` if the strategy can be prepared.
    pub unavailable: Option<&'static str>,
    /// The function behind [`Strategy::prepare`].
    pub prepare: &'a Prepare<'a>,
}

/// The function of a [`Strategy`]: it prepares to render with exactly `plan.threads` computing
/// threads. A pool is built here. [`renderer`] makes its result.
pub type Prepare<'a> = dyn Fn(Plan) -> Result<RenderFn, RenderError> + Sync + 'a;

/// The loop of a prepared strategy: it fills every pixel of the image with what the work computes
/// for it. After an error the image is incomplete, and the loop may be called again.
pub type RenderFn = Box<dyn FnMut(&dyn Work, &mut Image) -> Result<(), RenderError>>;

/// Returns `render` as the result of a [`Prepare`] function: always `Ok`.
pub fn renderer(
    render: impl FnMut(&dyn Work, &mut Image) -> Result<(), RenderError> + 'static,
) -> Result<RenderFn, RenderError> {
    Ok(Box::new(render))
}

impl Strategy<'_> {
    /// Prepares to render with exactly `plan.threads` computing threads.
    ///
    /// # Errors
    ///
    /// [`RenderError::Spawn`] if a pool cannot be built, [`RenderError::Unavailable`] if the
    /// strategy is unavailable.
    pub fn prepare(&self, plan: Plan) -> Result<Renderer, StrategyError> {
        let strategy = self.name;
        let prepared = match self.unavailable {
            Some(reason) => Err(RenderError::Unavailable(reason)),
            None => (self.prepare)(plan),
        };
        match prepared {
            Ok(render) => Ok(Renderer { strategy, render }),
            Err(error) => Err(StrategyError { strategy, error }),
        }
    }
}

impl fmt::Debug for Strategy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Strategy").field(&self.name).finish()
    }
}

/// A prepared strategy, which renders as often as asked.
///
/// ```
/// use rayweave_contract::{Image, Renderer, Tile, Work};
///
/// struct Grey;
///
/// impl Work for Grey {
///     fn render(&self, tile: &mut Tile<'_>) {
///         tile.rows().for_each(|(_, row)| row.fill([0.5; 3]));
///     }
/// }
///
/// let mut nothing = Renderer::new("nothing", |_, _| Ok(()));
/// assert!(nothing.render(&Grey, &mut Image::new(2, 2)?).is_ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Renderer {
    strategy: &'static str,
    render: RenderFn,
}

impl Renderer {
    /// Returns a renderer for errors that name `strategy`.
    pub fn new(
        strategy: &'static str,
        render: impl FnMut(&dyn Work, &mut Image) -> Result<(), RenderError> + 'static,
    ) -> Self {
        Self { strategy, render: Box::new(render) }
    }

    /// Fills every pixel of `image` with what `work` computes for it.
    ///
    /// # Errors
    ///
    /// [`RenderError::Panicked`] if the work panicked, [`RenderError::Spawn`] if a thread could not
    /// be started. The image is then incomplete, and the renderer may be used again.
    pub fn render(&mut self, work: &dyn Work, image: &mut Image) -> Result<(), StrategyError> {
        let strategy = self.strategy;
        (self.render)(work, image).map_err(|error| StrategyError { strategy, error })
    }
}

impl fmt::Debug for Renderer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Renderer").field(&self.strategy).finish()
    }
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

/// The failure of a strategy.
///
/// ```
/// use rayweave_contract::{RenderError, StrategyError};
///
/// let error = StrategyError { strategy: "loop", error: RenderError::Unavailable("no compiler") };
/// assert_eq!(error.to_string(), "loop: unavailable here: no compiler");
/// ```
#[derive(Debug, Error)]
#[error("{strategy}: {error}")]
pub struct StrategyError {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The reason.
    pub error: RenderError,
}

/// The reason why there is no image.
///
/// ```
/// use rayweave_contract::{RenderError, Tile, Work, render_tile};
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
/// let error = render_tile(&Faulty, &mut Tile::pixel(3, 4, &mut color)).unwrap_err();
/// assert!(matches!(error, RenderError::Panicked { .. }));
/// assert_eq!(error.to_string(), "the work panicked in the tile 1x1 at (3, 4): no value");
/// ```
#[derive(Debug, Error)]
pub enum RenderError {
    /// The work panicked; the other threads stopped at their next tile.
    #[error("the work panicked in the tile {tile}: {message}")]
    Panicked {
        /// The tile that was being computed.
        tile: Rect,
        /// The panic's message.
        message: String,
    },
    /// The strategy needs something that is missing here: the thing, and how to get it.
    #[error("unavailable here: {0}")]
    Unavailable(&'static str),
    /// A thread could not be started; those that were started have ended.
    #[error("cannot start {threads} threads: {source}; use fewer (--threads)")]
    Spawn {
        /// The number of threads asked for.
        threads: usize,
        /// The reason given by the operating system or the library.
        source: io::Error,
    },
}

/// Renders one tile; a panic of the work becomes an error that names the tile.
///
/// # Errors
///
/// [`RenderError::Panicked`].
pub fn render_tile(work: &dyn Work, tile: &mut Tile<'_>) -> Result<(), RenderError> {
    // After a panic nobody reads the tile as a result: the whole rendering is an error.
    catch_unwind(AssertUnwindSafe(|| work.render(tile))).map_err(|payload| RenderError::Panicked {
        tile: tile.rect(),
        message: panic_message(&*payload),
    })
}

/// Returns a panic's message, given the payload from `catch_unwind` or `join`.
#[must_use]
pub fn panic_message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("(a panic without a message)").to_owned()
}
