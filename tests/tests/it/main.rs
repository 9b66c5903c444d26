//! All tests of this folder in one program, which is linked once.

mod acne;
mod agreement;
mod arbitrary;
mod boundaries;
mod broken_strategies;
mod bvh;
mod contributing;
mod culling;
mod errata;
mod executions;
mod geometry;
mod golden;
mod gradient;
mod hard_scenes;
mod identity;
mod invariance;
mod lab;
mod model;
mod precision;
mod real_strategies;
mod textbook;
mod tidy;
mod tradeoff;
mod watertight;
mod workspace_copy;
