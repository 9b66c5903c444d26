//! Text from the file made fit for a message: on one line, short, and with a better word for a
//! typo.

/// The number of characters of an echoed value.
const LONGEST: usize = 60;
/// The number of names in a list of what would be right.
const MOST_NAMES: usize = 10;

/// `text` without anything that a terminal would obey or hide.
pub(crate) fn escaped(text: &str) -> String {
    text.chars().flat_map(pieces).collect()
}

/// [`escaped`], and cut to a length that leaves a message readable.
pub(crate) fn shortened(text: &str) -> String {
    let mut short = String::new();
    let mut length = 0;
    for character in text.chars() {
        let piece: String = pieces(character).collect();
        length += piece.chars().count();
        if length > LONGEST {
            short.push_str("...");
            break;
        }
        short.push_str(&piece);
    }
    short
}

/// A key as it is spelled in a path of keys: bare if it can be, else in quotes.
pub(crate) fn key(name: &str) -> String {
    let bare = |character: char| character.is_ascii_alphanumeric() || "-_".contains(character);
    let short = shortened(name);
    if !name.is_empty() && name.chars().all(bare) { short } else { format!("\"{short}\"") }
}

/// What to write instead of the unknown `name`: the `known` one that is most like it, else some.
pub(crate) fn instead<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    if let Some(meant) = nearest(name, &known) {
        return format!("did you mean `{}`?", key(meant));
    }
    let mut names: Vec<String> =
        known.iter().take(MOST_NAMES).map(|name| format!("`{}`", key(name))).collect();
    if known.len() > MOST_NAMES {
        names.push(format!("... ({} in all)", known.len()));
    }
    if names.is_empty() { "known: none".into() } else { format!("known: {}", names.join(", ")) }
}

/// The printable form of a character. Quotes and backslashes are left alone: nobody parses it.
fn pieces(character: char) -> impl Iterator<Item = char> {
    let plain = matches!(character, '"' | '\'' | '\\').then_some(character);
    let escape = plain.is_none().then(|| character.escape_debug());
    plain.into_iter().chain(escape.into_iter().flatten())
}

fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    // Two slips, as many as it takes to swap two letters, but one in a short word: what is further
    // off is another word.
    let slips = |candidate: &str| if candidate.chars().count() < 5 { 1 } else { 2 };
    known
        .iter()
        .map(|&candidate| (distance(name, candidate), candidate))
        .filter(|&(distance, candidate)| distance <= slips(candidate))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The letters to insert, delete or replace to make one name of the other, large and small alike
/// (Levenshtein, 1966). Very long names are like no other.
fn distance(a: &str, b: &str) -> usize {
    // The time is the product of the lengths.
    if a.len().max(b.len()) > LONGEST {
        return usize::MAX;
    }
    let b: Vec<char> = b.chars().collect();
    // row[j]: from the part of `a` so far to the first j letters of `b`.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(!from.eq_ignore_ascii_case(to));
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
