//! What no single crate can test, and what such tests are made of.

/// The places where the report that this project starts from is wrong, as cases.
pub mod errata;
/// Images that no strategy had a hand in.
pub mod image;
/// Scenes of many primitives.
pub mod many_primitives;
/// Closed meshes.
pub mod meshes;
/// How far an image is from the truth.
pub mod metrics;
/// The truth: the image model in wide arithmetic, slow and plain.
pub mod model;
/// Scenes that use everything in the model, drawn by seed.
pub mod random_scene;
/// The scenes of the repository.
pub mod scenes;
/// Scenes enlarged, moved and mirrored.
pub mod transform;
