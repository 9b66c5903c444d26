//! Hand-spawned threads, a static share of the pixels each, one lock around the picture.
