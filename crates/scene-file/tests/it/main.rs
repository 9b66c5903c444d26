//! One program of all tests here: each more would be linked anew.

mod hostile;
mod long;
mod malformed;
mod meshes;
mod scenes;
