//! One ordered slice that names every strategy.
