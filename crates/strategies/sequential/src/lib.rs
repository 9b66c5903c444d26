//! The reference: one thread, tile after tile.
