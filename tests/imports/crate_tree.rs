//! Modules of a crate, what they define and name.

use crate::tokens::tokens;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// No name of a crate is behind more re-exports.
const DOORS: usize = 8;

/// The modules of a crate and their files. The first module is the root.
#[derive(Default)]
pub struct CrateTree {
    pub files: Vec<PathBuf>,
    modules: Vec<Module>,
}

#[derive(Default)]
struct Module {
    file: usize,
    parent: usize,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
    /// Paths in its code, a single name included.
    paths: BTreeSet<Vec<String>>,
}

/// A leaf of a `use`: a path, and the name by which the module knows it, `*` for all names behind the path.
struct Use {
    path: Vec<String>,
    name: String,
    public: bool,
}

/// What a path means.
#[derive(Clone, Copy)]
enum Meaning<'a> {
    Module(usize),
    Item { name: &'a str, file: usize },
}

impl CrateTree {
    pub fn read(root: &Path) -> Self {
        let mut tree = Self::default();
        tree.read_file(root.to_owned(), root.parent().unwrap(), 0);
        tree
    }

    /// For each file, the names that it takes from which others.
    pub fn imports(&self) -> Vec<BTreeMap<usize, BTreeSet<String>>> {
        let mut imports = vec![BTreeMap::<_, BTreeSet<_>>::new(); self.files.len()];
        for (index, module) in self.modules.iter().enumerate() {
            let taken = module
                .uses
                .iter()
                .filter(|leaf| !leaf.public && leaf.name != "*")
                .map(|leaf| &leaf.path);
            for meaning in
                taken.chain(&module.paths).flat_map(|path| self.resolve(index, path, DOORS))
            {
                if let Meaning::Item { name, file } = meaning
                    && file != module.file
                {
                    imports[module.file].entry(file).or_default().insert(name.to_owned());
                }
            }
        }
        imports
    }

    /// Reads a file whose modules lie in `folder`.
    fn read_file(&mut self, path: PathBuf, folder: &Path, parent: usize) -> usize {
        let source = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        self.files.push(path);
        self.read_module(&tokens(&source), &mut 0, self.files.len() - 1, folder, parent)
    }

    /// Reads to the end of the file or to the brace that closes the module.
    fn read_module(
        &mut self,
        tokens: &[&str],
        at: &mut usize,
        file: usize,
        folder: &Path,
        parent: usize,
    ) -> usize {
        let index = self.modules.len();
        self.modules.push(Module { file, parent, ..Default::default() });
        let token = |at: usize| tokens.get(at).copied().unwrap_or_default();
        let mut depth = 0;
        while *at < tokens.len() {
            let before = token(at.wrapping_sub(1));
            match (token(*at), token(*at + 1)) {
                ("{", _) => depth += 1,
                ("}", _) if depth == 0 => break,
                ("}", _) => depth -= 1,
                ("use", next) if next != "<" => {
                    *at += 1;
                    let public = ["pub", ")"].contains(&before);
                    read_use(tokens, at, &[], &mut |path, name| {
                        self.modules[index].uses.push(Use { path, name, public });
                    });
                }
                ("mod", name) => {
                    let folder = folder.join(name);
                    *at += 2;
                    let child = if token(*at) == "{" {
                        *at += 1;
                        self.read_module(tokens, at, file, &folder, index)
                    } else {
                        let path = folder.with_extension("rs");
                        let path = if path.exists() { path } else { folder.join("mod.rs") };
                        self.read_file(path, &folder, index)
                    };
                    self.modules[index].children.insert(name.to_owned(), child);
                }
                ("fn" | "struct" | "enum" | "trait" | "type" | "const" | "static", name)
                    if depth == 0 =>
                {
                    self.modules[index].items.insert(name.to_owned());
                }
                ("macro_rules", "!") => {
                    self.modules[index].items.insert(token(*at + 2).to_owned());
                }
                (word, _)
                    if is_word(word)
                        && (word == "crate" || ![".", "::", "$", "'"].contains(&before)) =>
                {
                    let mut path = vec![word.to_owned()];
                    while token(*at + 1) == "::" && is_word(token(*at + 2)) {
                        *at += 2;
                        path.push(token(*at).to_owned());
                    }
                    self.modules[index].paths.insert(path);
                }
                _ => {}
            }
            *at += 1;
        }
        index
    }

    /// What a path in a module means, at most `doors` re-exports away.
    fn resolve(&self, module: usize, path: &[String], doors: usize) -> Vec<Meaning<'_>> {
        let mut meanings = vec![Meaning::Module(module)];
        for name in path {
            let behind = |meaning| match (meaning, name.as_str()) {
                (Meaning::Item { .. }, _) | (_, "self") => vec![meaning],
                (Meaning::Module(_), "crate") => vec![Meaning::Module(0)],
                (Meaning::Module(module), "super") => {
                    vec![Meaning::Module(self.modules[module].parent)]
                }
                (Meaning::Module(module), name) => self.find(module, name, doors),
            };
            meanings = meanings.into_iter().flat_map(behind).collect();
        }
        meanings
    }

    fn find(&self, module: usize, name: &str, doors: usize) -> Vec<Meaning<'_>> {
        let Module { file, children, items, uses, .. } = &self.modules[module];
        let child = children.get(name).map(|&child| Meaning::Module(child));
        let item = items.get(name).map(|name| Meaning::Item { name, file: *file });
        let mut meanings = Vec::from_iter(child.into_iter().chain(item));
        if doors > 0 {
            let behind = |leaf: &Use| self.resolve(module, &leaf.path, doors - 1);
            meanings.extend(uses.iter().filter(|leaf| leaf.name == name).flat_map(behind));
            if meanings.is_empty() {
                let opened = uses.iter().filter(|leaf| leaf.name == "*").flat_map(behind);
                meanings.extend(opened.flat_map(|meaning| match meaning {
                    Meaning::Module(module) => self.find(module, name, doors - 1),
                    Meaning::Item { .. } => Vec::new(),
                }));
            }
        }
        meanings
    }
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Reads one tree of a `use` behind `path`, up to the sign that ends it; `leaf` is told each path and its name.
fn read_use(
    tokens: &[&str],
    at: &mut usize,
    path: &[String],
    leaf: &mut impl FnMut(Vec<String>, String),
) {
    let mut path = path.to_owned();
    let mut name = None;
    loop {
        match tokens[*at] {
            "{" => {
                while tokens[*at] != "}" {
                    *at += 1;
                    if tokens[*at] != "}" {
                        read_use(tokens, at, &path, leaf);
                    }
                }
                *at += 1;
                return;
            }
            "," | "}" | ";" => break,
            "as" => {
                *at += 1;
                name = Some(tokens[*at].to_owned());
            }
            "*" => name = Some("*".to_owned()),
            "::" => {}
            segment => path.push(segment.to_owned()),
        }
        *at += 1;
    }
    let name = name
        .unwrap_or_else(|| path.iter().rfind(|&name| name != "self").cloned().unwrap_or_default());
    leaf(path, name);
}
