//! The decisions of a strategy: the granularity of its pieces, their scheduling, and their output.

use std::fmt;
use std::num::NonZeroUsize;

/// The decisions of a strategy. A simulation goes by the policy alone.
///
/// ```
/// use rayweave_contract::{Granularity, Output, Policy, Scheduling};
///
/// // OpenMP's `schedule(dynamic, 4)` over rows that are written in place.
/// let scheduling = Scheduling::Dynamic { chunk: 4 };
/// let policy = Policy::new(Granularity::Row, scheduling, Output::InPlace);
/// assert_eq!(policy.scheduling.to_string(), "dynamic,4");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Policy {
    /// The piece that a thread computes at once; pixels of one piece can share samples.
    pub granularity: Granularity,
    /// The rule by which threads get pieces.
    pub scheduling: Scheduling,
    /// The way of a finished piece into the image.
    pub output: Output,
}

impl Policy {
    /// Returns the policy with these decisions.
    #[must_use]
    pub const fn new(granularity: Granularity, scheduling: Scheduling, output: Output) -> Self {
        Self { granularity, scheduling, output }
    }
}

/// The piece that a thread computes at once.
///
/// ```
/// assert_eq!(rayweave_contract::Granularity::Tile.to_string(), "tile");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Granularity {
    /// One pixel.
    Pixel,
    /// One row of the image.
    Row,
    /// A tile of [`Plan::tile`](crate::Plan::tile) pixels a side.
    Tile,
    /// The consecutive rows that one thread computes at once.
    Band,
}

/// The rule by which threads get pieces, in OpenMP's words. Pieces are numbered from the top left,
/// row by row.
///
/// ```
/// use rayweave_contract::Scheduling;
///
/// let words = [Scheduling::Static, Scheduling::Dynamic { chunk: 1 }, Scheduling::RecursiveSplit];
/// assert_eq!(words.map(|word| word.to_string()), ["static", "dynamic", "recursive-split"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduling {
    /// Each thread gets one of N equal ranges, fixed beforehand.
    Static,
    /// A free thread takes the next `chunk` pieces, in order.
    Dynamic {
        /// Pieces taken at a time, 1 or more.
        chunk: usize,
    },
    /// A free thread takes the remaining pieces divided by the number of threads, in order: chunks
    /// get smaller towards the end.
    Guided,
    /// Each thread has a range of its own; an idle thread takes half of another's.
    WorkStealing,
    /// One thread halves the whole range until there are about twice as many parts as threads. A
    /// part that an idle thread steals is halved again as often; within a part nothing is stolen.
    /// This is what rayon's loops do.
    RecursiveSplit,
}

/// The way of a finished piece into the image.
///
/// ```
/// assert_eq!(rayweave_contract::Output::InPlace.to_string(), "in-place");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// It is computed in its place.
    InPlace,
    /// It is copied while holding a mutex around the image.
    Mutex,
    /// It is sent through a channel to the thread that owns the image, which copies it.
    Channel,
}

/// The place where a strategy starts its threads. The time of that place includes the cost.
///
/// ```
/// use rayweave_contract::Threads;
/// use std::num::NonZeroUsize;
///
/// let four = NonZeroUsize::new(4).unwrap();
/// assert_eq!(Threads::Pool.computing_threads(four), four);
/// assert_eq!(Threads::None.computing_threads(four).get(), 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// It starts none: the caller's thread computes alone, whatever the plan says.
    None,
    /// A pool is started by `prepare`, outside of a rendering's time.
    Pool,
    /// Threads are started by every `render`, within its time.
    PerRender,
}

impl Threads {
    /// Returns the number of threads that compute when `requested` are asked for.
    #[must_use]
    pub fn computing_threads(self, requested: NonZeroUsize) -> NonZeroUsize {
        if self == Self::None { NonZeroUsize::MIN } else { requested }
    }
}

/// The words of results and tables: `pixel`, `row`, `tile`, `band`.
impl fmt::Display for Granularity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Pixel => "pixel",
            Self::Row => "row",
            Self::Tile => "tile",
            Self::Band => "band",
        })
    }
}

/// OpenMP's words where it has one: `static`, `dynamic` or `dynamic,4`, `guided`, `work-stealing`,
/// `recursive-split`.
impl fmt::Display for Scheduling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Static => "static",
            Self::Dynamic { chunk: 1 } => "dynamic",
            Self::Dynamic { chunk } => return write!(f, "dynamic,{chunk}"),
            Self::Guided => "guided",
            Self::WorkStealing => "work-stealing",
            Self::RecursiveSplit => "recursive-split",
        })
    }
}

/// The words of results and tables: `in-place`, `mutex`, `channel`.
impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::InPlace => "in-place",
            Self::Mutex => "mutex",
            Self::Channel => "channel",
        })
    }
}

/// The words of results and tables: `none`, `pool`, `per-render`.
impl fmt::Display for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::None => "none",
            Self::Pool => "pool",
            Self::PerRender => "per-render",
        })
    }
}
