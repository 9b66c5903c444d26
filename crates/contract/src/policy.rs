//! What a strategy decides, in OpenMP's words: how large a piece is, who gets it, how it gets into
//! the image.

/// How a strategy deals out the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// What is computed at once, and so may share samples.
    pub piece: Piece,
    /// Who gets which pieces.
    pub dealing: Dealing,
    /// How a finished piece comes into the picture.
    pub delivery: Delivery,
}

/// What a thread computes at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// One pixel.
    Pixel,
    /// One row of the picture.
    Row,
    /// A tile of [`Plan::tile`].
    Tile,
    /// All rows that a thread gets.
    Band,
}

/// Who gets which pieces; these are numbered from the top left, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dealing {
    /// Beforehand: each thread one of as many equal ranges of them.
    Equal,
    /// Whoever is free takes the next `chunk` of them, in order.
    Shared {
        /// Pieces taken at a time, 1 or more.
        chunk: usize,
    },
    /// Whoever is free takes, in order, those that are left over the number of threads: ever fewer.
    Guided,
    /// Each thread has a range of its own; whoever is idle takes half of another's.
    Stealing,
    /// One thread halves the whole range until there are about twice as many parts as threads; a
    /// part that an idle thread takes from another is halved again as often. Within a part nothing
    /// is taken. So rayon's loops do.
    Halving,
}

/// How a finished piece comes into the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// It was written there.
    InPlace,
    /// It is copied under a lock that all threads share.
    Locked,
    /// It is sent to the thread that owns the picture, which copies it.
    Sent,
}
