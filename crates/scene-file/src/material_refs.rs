//! The materials that primitives refer to by name.

use std::collections::BTreeMap;

use rayweave_core::scene::Material;

use crate::error::{Result, Source};
use crate::node::{Mention, Node};
use crate::wording;

/// The names of materials, numbered in the order in which they are first mentioned: the material
/// itself may come further down in the file.
#[derive(Default)]
pub(crate) struct MaterialRefs {
    numbers: BTreeMap<String, usize>,
    /// The first mention of each.
    mentions: Vec<Mention>,
}

impl MaterialRefs {
    /// Returns the number of the material of a `primitive`.
    pub(crate) fn number_in(&mut self, primitive: &Node) -> Result<usize> {
        let node = primitive.inner("material")?;
        let name = node.string()?;
        if let Some(&number) = self.numbers.get(name) {
            return Ok(number);
        }
        let number = self.mentions.len();
        self.mentions.push(node.mention());
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    /// Returns for each number the index of its material in `materials`.
    pub(crate) fn resolve(
        self,
        materials: &BTreeMap<String, Material>,
        file: Source,
    ) -> Result<Vec<usize>> {
        let known: Vec<&str> = materials.keys().map(String::as_str).collect();
        let mut names: Vec<(String, usize)> = self.numbers.into_iter().collect();
        names.sort_unstable_by_key(|&(_, number)| number);
        let index = |((name, _), mention): (&(String, usize), Mention)| {
            known.binary_search(&name.as_str()).map_err(|_| {
                let instead = wording::instead(name, &known);
                let written = &mention.written;
                let message =
                    format!("expected the name of a material, found {written}; {instead}");
                mention.error(file, &message)
            })
        };
        names.iter().zip(self.mentions).map(index).collect()
    }
}
