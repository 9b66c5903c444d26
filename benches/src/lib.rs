//! cargo bench over the registry.
