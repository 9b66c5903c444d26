//! Runs a strategy and returns its error or its panic as a message.

use rayweave_contract::{StrategyError, panic_message};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Returns the result of `action`; its error or its panic as a message.
///
/// After either the caller must not use what `action` was writing.
pub(crate) fn catch_panic<T>(
    action: impl FnOnce() -> Result<T, StrategyError>,
) -> Result<T, String> {
    match catch_unwind(AssertUnwindSafe(action)) {
        Ok(result) => result.map_err(|error| error.to_string()),
        Err(payload) => Err(format!("the strategy panicked: {}", panic_message(&*payload))),
    }
}
