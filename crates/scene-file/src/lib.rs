//! Reads scene files: TOML to a scene, every fault with its file, line, column and key.
