//! The parts that tests of several crates are made of.

/// Random numbers, and what follows from them alone.
pub(crate) mod draw;
/// The places where the report that this project starts from is wrong, as cases.
pub mod errata;
/// Images that no strategy computed.
pub mod image;
/// Scenes of many primitives.
pub mod many_primitives;
/// Closed meshes.
pub mod meshes;
/// The image model in `f64`, slow and plain: the truth.
pub mod model;
/// Scenes that use everything in the model, drawn by seed.
pub mod random_scene;
/// The scenes of the repository, and short ways to build others.
pub mod scenes;
/// Scenes enlarged, moved and mirrored.
pub mod transform;
