//! Forks N scoped threads and joins them: what the hand-threaded strategies share.
