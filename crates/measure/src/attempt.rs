//! Runs a strategy such that whatever it does wrong is an answer.

use rayweave_core::StrategyError;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of `action`, or why there is none: its error, or a panic that it let through.
///
/// After an error of either kind the caller must not use what `action` was writing.
pub(crate) fn attempt<T>(action: impl FnOnce() -> Result<T, StrategyError>) -> Result<T, String> {
    match catch_unwind(AssertUnwindSafe(action)) {
        Ok(result) => result.map_err(|error| error.to_string()),
        Err(payload) => {
            let text = payload.downcast_ref::<&str>().copied();
            let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
            Err(format!("the strategy panicked: {}", text.unwrap_or("(a panic without a message)")))
        }
    }
}
