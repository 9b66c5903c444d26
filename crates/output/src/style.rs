//! The layout of tables, and numbers as text.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Row, Table, TableStyle};
use rayweave_measure::Interval;
use std::ops::RangeInclusive;

const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// Returns a table without a newline at the end. The columns `numbers` are aligned to the right.
pub(crate) fn table<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl Iterator<Item = R>,
    numbers: RangeInclusive<usize>,
) -> String {
    let mut table = Table::new();
    // No colours, and no wrapping to the width of the window: a result reads the same everywhere.
    table.force_no_tty().load_style(STYLE).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header).add_rows(rows);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 1));
        if numbers.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt()
}

/// Returns a median and its interval, as in `1.84 [1.79, 1.90]`.
pub(crate) fn interval(Interval { median, low, high }: Interval) -> String {
    format!("{median:.2} [{low:.2}, {high:.2}]")
}

/// Returns the same with one more decimal, as in `1.841 [1.794, 1.903]`.
pub(crate) fn precise_interval(Interval { median, low, high }: Interval) -> String {
    format!("{median:.3} [{low:.3}, {high:.3}]")
}

/// Returns `value` with three digits, or with all digits before its point if there are more.
pub(crate) fn significant(value: f64) -> String {
    let decimals = match value.abs() {
        100.0.. => 0,
        10.0.. => 1,
        1.0.. => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}
