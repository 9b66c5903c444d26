//! One rayon item a pixel, in a pool of its own.
