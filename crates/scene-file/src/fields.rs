//! A cursor over a parsed document: it asks for a key and a type, and knows how to complain.

use std::fmt;
use std::ops::Range;

use glam::DVec3;
use rayweave_core::scene::Fault;
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

use crate::error::Problem;
use crate::phrase;

/// The way to a value from the outside in. It is spelled out only in a message, so a value that is
/// right costs no text.
#[derive(Clone, Copy)]
enum Path<'a> {
    Document,
    Key(&'a Path<'a>, &'a str),
    Index(&'a Path<'a>, usize),
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Document => Ok(()),
            Self::Key(Self::Document, key) => f.write_str(&phrase::key(key)),
            Self::Key(parent, key) => write!(f, "{parent}.{}", phrase::key(key)),
            Self::Index(parent, index) => write!(f, "{parent}[{index}]"),
        }
    }
}

/// Text that was parsed by itself, and where in the file it begins.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    /// The text, to which spans refer.
    pub(crate) text: &'a str,
    /// The bytes of the file before it.
    pub(crate) start: usize,
}

/// The keys of one table: the document, `[camera]`, one `[[sphere]]`.
pub(crate) struct Fields<'a> {
    source: Source<'a>,
    path: Path<'a>,
    /// The table's header, or its key or braces where it has none.
    span: Range<usize>,
    table: &'a DeTable<'a>,
}

/// One value of a table or of an array.
pub(crate) struct Field<'a> {
    source: Source<'a>,
    path: Path<'a>,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Fields<'a> {
    /// The keys at the top of the document that `source` is.
    pub(crate) fn of_document(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        Self { source, path: Path::Document, span: 0..0, table }
    }

    /// A complaint about `key` of this table, which starts at `offset` of the source.
    fn problem(&self, offset: usize, key: &str, message: String) -> Problem {
        Problem::of_key(self.source.start + offset, Path::Key(&self.path, key).to_string(), message)
    }

    /// Refuses the first key in the file that is not among `known`.
    pub(crate) fn allow(&self, known: &[&str]) -> Result<(), Problem> {
        let unknown = self.table.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let name = key.get_ref();
        let message = format!("unknown key; {}", phrase::instead(name, known.iter().copied()));
        Err(self.problem(key.span().start, name, message))
    }

    /// The value of `key`, if there is one.
    pub(crate) fn get<'s>(&'s self, key: &'s str) -> Option<Field<'s>> {
        let value = self.table.get(key)?;
        Some(Field { source: self.source, path: Path::Key(&self.path, key), value })
    }

    /// The value of `key`, whatever its type.
    pub(crate) fn field<'s>(&'s self, key: &'s str) -> Result<Field<'s>, Problem> {
        self.get(key)
            .ok_or_else(|| self.problem(self.span.start, key, "missing, but required".into()))
    }

    /// The value of `key`.
    pub(crate) fn require<T: Value>(&self, key: &str) -> Result<T, Problem> {
        T::read(&self.field(key)?)
    }

    /// The value of `key`, or `default` without the key.
    pub(crate) fn optional<T: Value>(&self, key: &str, default: T) -> Result<T, Problem> {
        self.get(key).map_or(Ok(default), |field| T::read(&field))
    }

    /// Appends to `entries` what `read` makes of every `[[key]]`, in file order.
    pub(crate) fn each<T>(
        &self,
        key: &str,
        entries: &mut Vec<T>,
        mut read: impl FnMut(&Fields) -> Result<T, Problem>,
    ) -> Result<(), Problem> {
        let Some(field) = self.get(key) else { return Ok(()) };
        let DeValue::Array(items) = field.value.get_ref() else {
            return Err(field.expected(&format!("any number of [[{}]]", field.path)));
        };
        entries.reserve(items.len());
        for item in &items[..] {
            // Entries count from the beginning of the file, not of this part of it.
            entries.push(read(&field.item(entries.len(), item).table()?)?);
        }
        Ok(())
    }

    /// Every key of this table with its value, for tables whose keys are names.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&str, Field<'_>)> {
        self.table.iter().map(|(key, value)| {
            let name = key.get_ref().as_ref();
            (name, Field { source: self.source, path: Path::Key(&self.path, name), value })
        })
    }

    /// The complaint that `key`, which is here, stands further up in the file as well: in the words
    /// of the TOML parser, which sees only one of them.
    pub(crate) fn duplicate(&self, key: &str) -> Problem {
        let offset =
            self.table.get_key_value(key).map_or(self.span.start, |(key, _)| key.span().start);
        let message = format!("not valid TOML: duplicate key, found `{}`", phrase::shortened(key));
        Problem::at(self.source.start + offset, message)
    }

    /// Gives the entry that was read from these keys, or the fault that `check` found in it a
    /// place.
    pub(crate) fn checked<T>(
        &self,
        entry: T,
        check: impl Fn(&T) -> Result<(), Fault>,
    ) -> Result<T, Problem> {
        check(&entry).map(|()| entry).map_err(|fault| {
            // As it is written in the file; a default is not, and stands for its table.
            let (offset, found) = match self.get(fault.key) {
                Some(field) => (field.value.span().start, field.written()),
                None => (self.span.start, fault.found),
            };
            self.problem(offset, fault.key, format!("expected {}, found {found}", fault.expected))
        })
    }
}

impl<'a> Field<'a> {
    /// A table of its own, be it under a header or inline.
    pub(crate) fn table(&self) -> Result<Fields<'_>, Problem> {
        match self.value.get_ref() {
            DeValue::Table(table) => {
                Ok(Fields { source: self.source, path: self.path, span: self.value.span(), table })
            }
            _ if matches!(self.path, Path::Index(..)) => Err(self.expected("a table")),
            _ => Err(self.expected(&format!("one table [{}]", self.path))),
        }
    }

    /// A string.
    pub(crate) fn string(&self) -> Result<&str, Problem> {
        self.value.get_ref().as_str().ok_or_else(|| self.expected("a string"))
    }

    /// The complaint that this value is not what it should be, with its type where that matters.
    pub(crate) fn expected(&self, expected: &str) -> Problem {
        let source = self.written();
        let found = match self.value.get_ref() {
            DeValue::String(_) => format!("the string {source}"),
            DeValue::Integer(_) => format!("the integer {source}"),
            DeValue::Float(_) => format!("the float {source}"),
            DeValue::Boolean(_) => format!("the boolean {source}"),
            DeValue::Datetime(_) => format!("the date or time {source}"),
            // The source of these is the first header.
            DeValue::Array(items) if items.iter().any(|item| item.get_ref().is_table()) => {
                "an array of tables".into()
            }
            DeValue::Array(_) => format!("the array {source}"),
            DeValue::Table(_) => "a table".into(),
        };
        self.problem(format!("expected {expected}, found {found}"))
    }

    /// A complaint about this value.
    pub(crate) fn problem(&self, message: String) -> Problem {
        Problem::of_key(self.source.start + self.value.span().start, self.path.to_string(), message)
    }

    /// The value as it is written in the file, fit for a message.
    pub(crate) fn written(&self) -> String {
        phrase::shortened(self.text())
    }

    /// Whether a table or array is not written inline, so that headers may add to it.
    pub(crate) fn is_under_headers(&self) -> bool {
        match self.value.get_ref() {
            DeValue::Array(_) => self.text().starts_with("[["),
            DeValue::Table(_) => !self.text().starts_with('{'),
            _ => false,
        }
    }

    fn text(&self) -> &'a str {
        self.source.text.get(self.value.span()).unwrap_or_default()
    }

    fn triple<T: Value>(&self, expected: &str) -> Result<[T; 3], Problem> {
        let items = self.value.get_ref().as_array().map(|items| &items[..]);
        let Some([a, b, c]) = items else { return Err(self.expected(expected)) };
        Ok([T::read(&self.item(0, a))?, T::read(&self.item(1, b))?, T::read(&self.item(2, c))?])
    }

    fn item<'s>(&'s self, index: usize, value: &'s Spanned<DeValue<'s>>) -> Field<'s> {
        Field { source: self.source, path: Path::Index(&self.path, index), value }
    }
}

/// A type that a value of the file can have.
pub(crate) trait Value: Sized {
    /// The value of this type that `field` holds.
    fn read(field: &Field) -> Result<Self, Problem>;
}

/// An integer, for keys whose range ends below `u32::MAX`.
///
/// What a `u32` cannot hold is in no such range either. `u32::MAX` stands for it: the check of the
/// range refuses that, names the range, and shows what is written in the file.
impl Value for u32 {
    fn read(field: &Field) -> Result<Self, Problem> {
        let DeValue::Integer(integer) = field.value.get_ref() else {
            return Err(field.expected("an integer"));
        };
        Ok(of_64_bits(integer).and_then(|integer| integer.try_into().ok()).unwrap_or(Self::MAX))
    }
}

/// A float, or the integer that stands for one. It may still be infinite or no number.
impl Value for f64 {
    fn read(field: &Field) -> Result<Self, Problem> {
        let number = match field.value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            // To the nearest float, as the same digits with a point would be.
            DeValue::Integer(integer) => of_64_bits(integer).map(|integer| integer as Self),
            _ => return Err(field.expected("a number")),
        };
        number.ok_or_else(|| field.expected("a float or an integer of 64 bits"))
    }
}

/// A point, a direction or a colour.
impl Value for DVec3 {
    fn read(field: &Field) -> Result<Self, Problem> {
        field.triple("an array of three numbers").map(Self::from_array)
    }
}

/// The corners of a triangle.
impl Value for [DVec3; 3] {
    fn read(field: &Field) -> Result<Self, Problem> {
        field.triple("an array of three points")
    }
}

/// An integer of the range that TOML promises to keep.
fn of_64_bits(integer: &DeInteger) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
