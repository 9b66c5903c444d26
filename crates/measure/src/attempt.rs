//! Runs a strategy such that whatever it does wrong is an answer.

use rayweave_contract::{StrategyError, panic_message};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of `action`, or why there is none: its error, or a panic that it let through.
///
/// After an error of either kind the caller must not use what `action` was writing.
pub(crate) fn attempt<T>(action: impl FnOnce() -> Result<T, StrategyError>) -> Result<T, String> {
    match catch_unwind(AssertUnwindSafe(action)) {
        Ok(result) => result.map_err(|error| error.to_string()),
        Err(payload) => Err(format!("the strategy panicked: {}", panic_message(&*payload))),
    }
}
