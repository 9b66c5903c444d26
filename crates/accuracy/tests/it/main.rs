//! One program of all tests here: each more would be linked anew.

mod corpus;
mod families;
mod format;
mod kernel;
mod oracle;
mod oracle_properties;
