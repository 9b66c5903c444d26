//! Results to terminal, JSON and CSV.
