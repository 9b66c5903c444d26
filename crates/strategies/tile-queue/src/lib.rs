//! Threads that pop tiles from a crossbeam queue and write their rows without locks.
