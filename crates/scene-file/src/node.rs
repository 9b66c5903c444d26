//! A value of a parsed document and the keys that lead to it. It reads keys and types, and makes
//! the errors that say where they are wrong.

use std::fmt;

use glam::DVec3;
use rayweave_core::scene::SceneFault;
use toml::Spanned;
use toml::de::{DeInteger, DeString, DeTable, DeValue};

use crate::error::{Result, SceneFileError, Source};
use crate::wording;

/// A part of a file that is TOML by itself.
#[derive(Clone, Copy)]
pub(crate) struct Part<'a> {
    pub(crate) file: Source<'a>,
    /// The number of bytes of the file before it.
    pub(crate) start: usize,
    /// Its text, to which spans refer.
    pub(crate) text: &'a str,
}

/// A value: a document, a table, an entry such as `[[sphere]]`, a number.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    part: Part<'a>,
    path: KeyPath<'a>,
    value: &'a Spanned<DeValue<'a>>,
}

/// The path to a value from the outside in. It is spelled out only in a message, so that a value
/// without a fault costs no text.
#[derive(Clone, Copy)]
enum KeyPath<'a> {
    Document,
    Key(&'a KeyPath<'a>, &'a str),
    Index(&'a KeyPath<'a>, usize),
}

/// The way in which a table is written in a part.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Definition {
    /// By a header `[material]`.
    Header,
    /// Inline or by dotted keys such as `material.red`, without a header.
    Keys,
    /// Only by headers of tables in it, such as `[material.red]`.
    Inner,
}

/// A string that may turn out to name nothing.
pub(crate) struct Mention {
    offset: usize,
    key: String,
    /// The string as it is written in the file.
    pub(crate) written: String,
}

impl fmt::Display for KeyPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Document => Ok(()),
            Self::Key(Self::Document, key) => f.write_str(&wording::key(key)),
            Self::Key(parent, key) => write!(f, "{parent}.{}", wording::key(key)),
            Self::Index(parent, index) => write!(f, "{parent}[{index}]"),
        }
    }
}

impl Mention {
    /// Returns an error at the string.
    pub(crate) fn error(self, file: Source, message: &str) -> SceneFileError {
        file.error(self.offset, Some(self.key), message)
    }
}

impl<'a> Node<'a> {
    /// Makes the node of the document that `part` is.
    pub(crate) fn document(part: Part<'a>, document: &'a Spanned<DeValue<'a>>) -> Self {
        Self { part, path: KeyPath::Document, value: document }
    }

    /// Checks that this is a table, and returns its keys.
    pub(crate) fn table(&self) -> Result<&'a DeTable<'a>> {
        self.value.get_ref().as_table().ok_or_else(|| match self.path {
            KeyPath::Index(..) => self.expected("a table"),
            _ => self.expected(&format!("one table [{}]", self.path)),
        })
    }

    /// Checks that this is a table, and refuses the first key in the file that is not `known`.
    pub(crate) fn allow(&self, known: &[&str]) -> Result<()> {
        let unknown = self.table()?.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let message = format!("unknown key; {}", wording::instead(key.get_ref(), known));
        Err(self.key_error(key.span().start, key.get_ref(), &message))
    }

    /// Returns the value of `key`, if this is a table that has one.
    pub(crate) fn get<'s>(&'s self, key: &'s str) -> Option<Node<'s>> {
        let value = self.value.get_ref().get(key)?;
        Some(Node { part: self.part, path: KeyPath::Key(&self.path, key), value })
    }

    /// Returns the value of `key`, whatever its type.
    pub(crate) fn inner<'s>(&'s self, key: &'s str) -> Result<Node<'s>> {
        let start = self.value.span().start;
        self.get(key).ok_or_else(|| self.key_error(start, key, "missing, but required"))
    }

    /// Reads the value of `key`.
    pub(crate) fn require<T: Value>(&self, key: &str) -> Result<T> {
        T::read(&self.inner(key)?)
    }

    /// Reads the value of `key`, or returns `default` without the key.
    pub(crate) fn optional<T: Value>(&self, key: &str, default: T) -> Result<T> {
        self.get(key).map_or(Ok(default), |node| T::read(&node))
    }

    /// Appends to `entries` what `read` makes of every `[[key]]`, in file order.
    pub(crate) fn each<T>(
        &self,
        key: &str,
        entries: &mut Vec<T>,
        mut read: impl FnMut(&Node) -> Result<T>,
    ) -> Result<()> {
        let Some(node) = self.get(key) else { return Ok(()) };
        let DeValue::Array(items) = node.value.get_ref() else {
            return Err(node.expected(&format!("any number of [[{key}]]")));
        };
        entries.reserve(items.len());
        for item in items {
            // Entries count from the beginning of the file, not of this part of it.
            entries.push(read(&node.item(entries.len(), item))?);
        }
        Ok(())
    }

    /// Returns an entry that was read from this table, if `check` finds no fault in it.
    pub(crate) fn checked<T>(
        &self,
        entry: T,
        check: impl Fn(&T) -> Result<(), SceneFault>,
    ) -> Result<T> {
        check(&entry).map(|()| entry).map_err(|fault| {
            // A default is not written in the file. Its error is at the table.
            let value = self.get(fault.key);
            let found = value.map_or(fault.found, |value| value.written());
            let start = value.unwrap_or(*self).value.span().start;
            let message = format!("expected {}, found {found}", fault.expected);
            self.key_error(start, fault.key, &message)
        })
    }

    /// Reads a string.
    pub(crate) fn string(&self) -> Result<&str> {
        self.value.get_ref().as_str().ok_or_else(|| self.expected("a string"))
    }

    /// Notes the string that this is, for an error later on.
    pub(crate) fn mention(&self) -> Mention {
        Mention {
            offset: self.part.start + self.value.span().start,
            key: self.path.to_string(),
            written: self.written(),
        }
    }

    /// Returns the error that this value is not what it should be, with its type.
    fn expected(&self, expected: &str) -> SceneFileError {
        let found = match self.value.get_ref() {
            // Its text is only the first header.
            DeValue::Array(items) if items.iter().any(|item| item.get_ref().is_table()) => {
                "an array of tables".into()
            }
            DeValue::Table(_) => "a table".into(),
            DeValue::Datetime(_) => format!("the date or time {}", self.written()),
            value => format!("the {} {}", value.type_str(), self.written()),
        };
        self.mention().error(self.part.file, &format!("expected {expected}, found {found}"))
    }

    /// Returns an error at `key` of this table, which starts at `offset` of the part.
    fn key_error(&self, offset: usize, key: &str, message: &str) -> SceneFileError {
        let key = KeyPath::Key(&self.path, key).to_string();
        self.part.file.error(self.part.start + offset, Some(key), message)
    }

    /// Returns the error that `key` of this table is further up in the file as well. Its words are
    /// those of the TOML parser, which sees only one of the two parts.
    pub(crate) fn duplicate(&self, key: &Spanned<DeString>) -> SceneFileError {
        let name = wording::shortened(key.get_ref());
        let message = format!("not valid TOML: duplicate key, found `{name}`");
        self.part.file.error(self.part.start + key.span().start, None, &message)
    }

    /// Returns the value as it is written in the file, fit for a message.
    fn written(&self) -> String {
        wording::shortened(self.text())
    }

    /// Returns true for a table or array that is not written inline: headers may add to it.
    pub(crate) fn is_under_headers(&self) -> bool {
        match self.value.get_ref() {
            DeValue::Array(_) => self.text().starts_with("[["),
            DeValue::Table(_) => !self.text().starts_with('{'),
            _ => false,
        }
    }

    /// Returns how this table is written.
    pub(crate) fn definition(&self) -> Definition {
        // The span is that of the header if there is one, else that of a key or a value.
        let before = self.part.text.get(..self.value.span().start).unwrap_or_default();
        if self.text().starts_with('[') {
            Definition::Header
        } else if before.trim_end().ends_with('[') {
            Definition::Inner
        } else {
            Definition::Keys
        }
    }

    fn text(&self) -> &'a str {
        self.part.text.get(self.value.span()).unwrap_or_default()
    }

    fn triple<T: Value>(&self, expected: &str) -> Result<[T; 3]> {
        let items = self.value.get_ref().as_array().map(|items| &items[..]);
        let Some([a, b, c]) = items else { return Err(self.expected(expected)) };
        Ok([T::read(&self.item(0, a))?, T::read(&self.item(1, b))?, T::read(&self.item(2, c))?])
    }

    fn item<'s>(&'s self, index: usize, value: &'s Spanned<DeValue<'s>>) -> Node<'s> {
        Node { part: self.part, path: KeyPath::Index(&self.path, index), value }
    }
}

/// A type that a value of the file can have.
pub(crate) trait Value: Sized {
    /// Reads the value that `node` is.
    fn read(node: &Node) -> Result<Self>;
}

/// An integer, for keys whose range ends below `u32::MAX`.
///
/// `u32::MAX` stands for what a `u32` cannot hold: the check of the range refuses it, names the
/// range, and shows what is written in the file.
impl Value for u32 {
    fn read(node: &Node) -> Result<Self> {
        let DeValue::Integer(integer) = node.value.get_ref() else {
            return Err(node.expected("an integer"));
        };
        Ok(of_64_bits(integer).and_then(|integer| integer.try_into().ok()).unwrap_or(Self::MAX))
    }
}

/// A float, or the integer that stands for one. It may still be infinite or NaN.
impl Value for f64 {
    fn read(node: &Node) -> Result<Self> {
        let number = match node.value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            // To the nearest float, as the same digits with a point would be.
            DeValue::Integer(integer) => of_64_bits(integer).map(|integer| integer as Self),
            _ => return Err(node.expected("a number")),
        };
        number.ok_or_else(|| node.expected("a float or an integer of 64 bits"))
    }
}

/// A point, a direction or a colour.
impl Value for DVec3 {
    fn read(node: &Node) -> Result<Self> {
        node.triple("an array of three numbers").map(Self::from_array)
    }
}

/// The corners of a triangle.
impl Value for [DVec3; 3] {
    fn read(node: &Node) -> Result<Self> {
        node.triple("an array of three points")
    }
}

/// Returns an integer of the range that TOML promises to keep.
fn of_64_bits(integer: &DeInteger) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
