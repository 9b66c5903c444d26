//! The layout of tables, and numbers as text.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Row, Table, TableStyle};
use rayweave_measure::Interval;

const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// The columns that a line of the default output takes at most, so that it fits any terminal.
pub(crate) const WIDTH: usize = 80;

/// Returns a table without a newline at the end. The columns `numbers` are aligned to the right.
pub(crate) fn table<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl Iterator<Item = R>,
    numbers: impl IntoIterator<Item = usize>,
) -> String {
    let mut table = Table::new();
    // No colours, and no wrapping to the width of the window: a result reads the same everywhere.
    table.force_no_tty().load_style(STYLE).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(header).add_rows(rows);
    for column in table.column_iter_mut() {
        column.set_padding((0, 1));
    }
    for number in numbers {
        if let Some(column) = table.column_mut(number) {
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

/// Returns `text` in lines of at most 80 columns, without a newline at the end. Lines break between
/// words; a word that is longer than a line is cut. All lines but the first begin with `indent`.
#[must_use]
pub fn wrapped(text: &str, indent: &str) -> String {
    let length = |text: &str| text.chars().count();
    let mut lines: Vec<String> = Vec::new();
    // A number stays with its sign.
    let words = text.replace(" %", "\u{2060}%");
    for word in words.split_whitespace().map(|word| word.replace('\u{2060}', " ")) {
        let letters: Vec<char> = word.chars().collect();
        for part in letters.chunks(WIDTH - length(indent)) {
            let part: String = part.iter().collect();
            match lines.last_mut() {
                Some(line) if length(line) + 1 + length(&part) <= WIDTH => {
                    line.push(' ');
                    line.push_str(&part);
                }
                Some(_) => lines.push(format!("{indent}{part}")),
                None => lines.push(part),
            }
        }
    }
    lines.join("\n")
}

/// Returns the first characters of `text`, and two dots if there are more than `length`.
pub(crate) fn clipped(text: &str, length: usize) -> String {
    if text.chars().count() <= length {
        return text.to_owned();
    }
    text.chars().take(length.saturating_sub(2)).chain("..".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a cut word that loses a letter, and a number that is parted from its sign.
    #[test]
    fn lines_break_between_words_and_long_words_are_cut() {
        let word = "x".repeat(100);
        assert_eq!(wrapped(&word, "  "), format!("{}\n  {}", &word[..78], &word[78..]));
        let text = format!("{} 35 % of it", "y".repeat(76));
        assert_eq!(wrapped(&text, ""), format!("{}\n35 % of it", "y".repeat(76)));
        assert_eq!(wrapped("a\n b", ""), "a b");
        assert_eq!(
            (clipped("name", 4), clipped("names", 4)),
            ("name".to_owned(), "na..".to_owned())
        );
    }
}
