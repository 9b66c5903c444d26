//! How tables look.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Row, Table, TableStyle};
use rayweave_measure::Interval;
use std::ops::RangeInclusive;

const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// A table without a newline at the end; the columns `numbers` line up at their right.
pub(crate) fn table<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl Iterator<Item = R>,
    numbers: RangeInclusive<usize>,
) -> String {
    let mut table = Table::new();
    // Neither colours nor a wrapping that depends on the window: a result reads the same
    // everywhere.
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

/// As in `1.84 [1.79, 1.90]`.
pub(crate) fn interval(Interval { median, low, high }: Interval) -> String {
    format!("{median:.2} [{low:.2}, {high:.2}]")
}

/// As in `1.841 [1.794, 1.903]`: where a change of a percent is to be seen.
pub(crate) fn precise_interval(Interval { median, low, high }: Interval) -> String {
    format!("{median:.3} [{low:.3}, {high:.3}]")
}

/// A number with three digits, or with all before its point if these are more.
pub(crate) fn significant(value: f64) -> String {
    let decimals = match value.abs() {
        100.0.. => 0,
        10.0.. => 1,
        1.0.. => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}
