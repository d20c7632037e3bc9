//! Tests that no crate has circular imports between its files.
//!
//! A file imports another where one of its `use` items or paths leads there. Modules and re-exports that it declares do
//! not count, nor does what a file takes from the files above it (`step/nodes.rs` from `step.rs`): a parent and its
//! child are one subject. What a file takes from its children counts.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemUse, Macro, UseTree, Visibility};

const CRATES: [&str; 7] = [
    "bsmpm",
    "bsmpm-scene",
    "bsmpm-shapes",
    "bsmpm-io",
    "bsmpm-ranks",
    "bsmpm-par",
    "bsmpm-tools",
];
/// Largest number of imported names that are followed one after the other, since a name can lead back to itself.
const MOST_NAMES: usize = 32;

/// Segments of a path; the path of a module begins at the root of its crate.
type Segments = Vec<String>;
/// Texts of the source files by their paths in `src`.
type Sources = BTreeMap<String, String>;

/// A name that a `use` item brings into a file, and the path that it stands for.
struct Import {
    name: String, // `*`: all names there
    path: Segments,
}

/// Appends the imports of a `use` tree that stands below the path `head`.
fn append_imports(tree: &UseTree, head: &[String], imports: &mut Vec<Import>) {
    let below = |name: String| [head, &[name]].concat();
    match tree {
        UseTree::Path(path) => append_imports(&path.tree, &below(path.ident.to_string()), imports),
        UseTree::Group(group) => group.items.iter().for_each(|tree| append_imports(tree, head, imports)),
        UseTree::Glob(_) => imports.push(Import {
            name: "*".to_owned(),
            path: head.to_vec(),
        }),
        UseTree::Name(leaf) if leaf.ident == "self" => imports.push(Import {
            name: head.last().cloned().unwrap_or_default(),
            path: head.to_vec(),
        }),
        UseTree::Name(leaf) => imports.push(Import {
            name: leaf.ident.to_string(),
            path: below(leaf.ident.to_string()),
        }),
        UseTree::Rename(leaf) => imports.push(Import {
            name: leaf.rename.to_string(),
            path: if leaf.ident == "self" {
                head.to_vec()
            } else {
                below(leaf.ident.to_string())
            },
        }),
    }
}

/// Whether an item is compiled for tests only: `#[cfg(test)]` or `#[cfg(all(test, ..))]`.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let condition = attribute.meta.require_list().map(|list| list.tokens.to_string());
        attribute.path().is_ident("cfg")
            && condition.is_ok_and(|condition| condition == "test" || condition.starts_with("all (test"))
    })
}

/// Name of an item that other files can import, and its attributes.
struct Description<'a> {
    name: Option<String>,
    attributes: &'a [Attribute],
}

impl<'a> Description<'a> {
    fn of(item: &'a Item) -> Self {
        let (name, attributes) = match item {
            Item::Const(item) => (Some(&item.ident), &item.attrs),
            Item::Enum(item) => (Some(&item.ident), &item.attrs),
            Item::Fn(item) => (Some(&item.sig.ident), &item.attrs),
            Item::Impl(item) => (None, &item.attrs),
            Item::Macro(item) => (item.ident.as_ref(), &item.attrs),
            Item::Mod(item) => (None, &item.attrs),
            Item::Static(item) => (Some(&item.ident), &item.attrs),
            Item::Struct(item) => (Some(&item.ident), &item.attrs),
            Item::Trait(item) => (Some(&item.ident), &item.attrs),
            Item::Type(item) => (Some(&item.ident), &item.attrs),
            Item::Union(item) => (Some(&item.ident), &item.attrs),
            Item::Use(item) => (None, &item.attrs),
            _ => {
                return Self {
                    name: None,
                    attributes: &[],
                };
            }
        };
        Self {
            name: name.map(ToString::to_string),
            attributes,
        }
    }
}

/// What a file declares, what it imports, and every path in it.
#[derive(Default)]
struct Module {
    modules: Vec<String>,
    items: BTreeSet<String>,
    names: BTreeMap<String, Segments>,
    globs: Vec<Segments>,
    paths: Vec<Segments>,
    /// Number of inline modules around the place that is being read.
    inline: usize,
}

impl Module {
    fn read(text: &str) -> Self {
        let mut module = Self::default();
        module.visit_file(&syn::parse_file(text).expect("a Rust file"));
        module
    }

    /// Adds a path in the text as it reads outside the inline modules around it. A single name is local, or imported.
    fn add_path(&mut self, path: Segments) {
        if path.len() > 1 {
            let path = self.outside(path);
            self.paths.push(path);
        }
    }

    fn outside(&self, mut path: Segments) -> Segments {
        let around = path.iter().take(self.inline);
        let supers = around.take_while(|segment| *segment == "super").count();
        path.splice(..supers, (supers > 0).then(|| "self".to_owned()));
        path
    }

    /// Adds the paths in the arguments of a macro, which are not syntax yet.
    fn add_paths_of_tokens(&mut self, tokens: TokenStream) {
        let mut path = Segments::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(word) if colons == 2 => path.push(word.to_string()),
                TokenTree::Punct(sign) if sign.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                other => {
                    self.add_path(std::mem::take(&mut path));
                    match other {
                        TokenTree::Ident(word) => path.push(word.to_string()),
                        TokenTree::Group(group) => self.add_paths_of_tokens(group.stream()),
                        _ => {}
                    }
                }
            }
            colons = 0;
        }
        self.add_path(path);
    }
}

impl<'ast> Visit<'ast> for Module {
    fn visit_item(&mut self, item: &'ast Item) {
        let description = Description::of(item);
        if is_test(description.attributes) {
            return;
        }
        self.items.extend(description.name);
        match item {
            Item::Mod(module) if module.content.is_none() => self.modules.push(module.ident.to_string()),
            Item::Mod(_) => {
                self.inline += 1;
                visit::visit_item(self, item);
                self.inline -= 1;
            }
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut imports = Vec::new();
        append_imports(&item.tree, &[], &mut imports);
        let is_re_export = !matches!(item.vis, Visibility::Inherited);
        for Import { name, path } in imports {
            let path = self.outside(path);
            if !is_re_export {
                self.paths.push(path.clone());
            }
            if name == "*" {
                self.globs.push(path);
            } else {
                self.names.insert(name, path);
            }
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments = path.segments.iter().map(|segment| segment.ident.to_string());
        self.add_path(segments.collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        self.add_paths_of_tokens(call.tokens.clone());
        visit::visit_macro(self, call);
    }
}

/// A file and what it declares and imports.
struct SourceFile {
    file: String,
    module: Module,
}

/// Place to which a path leads.
struct Place {
    module: Segments,
    /// Whether the path names the module itself and not an item in it.
    is_module: bool,
}

/// An import of one module by another.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Arrow {
    from: Segments,
    to: Segments,
}

/// Modules of a library or of a program.
#[derive(Default)]
struct Tree(BTreeMap<Segments, SourceFile>);

impl Tree {
    /// Reads the modules from a file on, whose own modules are in `folder`.
    fn load(&mut self, sources: &Sources, path: &[String], file: &str, folder: &str) {
        let module = Module::read(&sources[file]);
        for name in &module.modules {
            let files = [format!("{folder}{name}.rs"), format!("{folder}{name}/mod.rs")];
            let child = files.iter().find(|file| sources.contains_key(*file));
            let child = child.unwrap_or_else(|| panic!("{file} declares {name}, which is not there"));
            self.load(
                sources,
                &[path, std::slice::from_ref(name)].concat(),
                child,
                &format!("{folder}{name}/"),
            );
        }
        let file = file.to_owned();
        self.0.insert(path.to_vec(), SourceFile { file, module });
    }

    /// Returns where a path in module `at` leads; that is `at` where the tree does not know its beginning, as of other
    /// crates. At most `names` imported names are followed.
    fn place(&self, at: &[String], path: &[String], names: usize) -> Place {
        let here = |is_module| Place {
            module: at.to_vec(),
            is_module,
        };
        let Some((first, rest)) = path.split_first() else {
            return here(true);
        };
        let module = &self.0[at].module;
        let child = [at, &path[..1]].concat();
        match first.as_str() {
            "crate" => self.place(&[], rest, names),
            "self" => self.place(at, rest, names),
            "super" => self.place(&at[..at.len().saturating_sub(1)], rest, names),
            _ if self.0.contains_key(&child) => self.place(&child, rest, names),
            _ if names == 0 => here(false),
            _ if module.names.contains_key(first) => self.place(at, &[&module.names[first], rest].concat(), names - 1),
            _ if module.items.contains(first) => here(false),
            _ => {
                let known = module.globs.iter().filter(|glob| self.knows(at, glob));
                let globs = known.map(|glob| self.place(at, glob, names - 1));
                let mut holders = globs.filter(|place| place.is_module && self.declares(&place.module, at, first));
                let holder = holders.next();
                holder.map_or(here(false), |holder| self.place(&holder.module, path, names - 1))
            }
        }
    }

    /// Whether the beginning of a path in module `at` is known there; that of another crate is not.
    fn knows(&self, at: &[String], path: &[String]) -> bool {
        let Module { names, items, .. } = &self.0[at].module;
        let first = &path[0];
        let is_keyword = ["crate", "self", "super"].contains(&first.as_str());
        let is_declared = names.contains_key(first) || items.contains(first);
        is_keyword || is_declared || self.0.contains_key(&[at, &path[..1]].concat())
    }

    /// Whether another module than `at` declares a name.
    fn declares(&self, module: &[String], at: &[String], name: &String) -> bool {
        let Module {
            modules, names, items, ..
        } = &self.0[module].module;
        module != at && (modules.contains(name) || names.contains_key(name) || items.contains(name))
    }

    /// Returns which module imports which, each with the paths by which it does.
    fn arrows(&self) -> BTreeMap<Arrow, BTreeSet<String>> {
        let mut arrows: BTreeMap<Arrow, BTreeSet<String>> = BTreeMap::new();
        for (from, SourceFile { module, .. }) in &self.0 {
            for path in &module.paths {
                let to = self.place(from, path, MOST_NAMES).module;
                if !from.starts_with(&to) {
                    let from = from.clone();
                    arrows.entry(Arrow { from, to }).or_default().insert(path.join("::"));
                }
            }
        }
        arrows
    }
}

/// Returns the modules that arrows lead to from a module.
fn reached<'a>(arrows: impl Iterator<Item = &'a Arrow> + Clone, from: &Segments) -> BTreeSet<Segments> {
    let mut reached = BTreeSet::new();
    let mut next = vec![from.clone()];
    while let Some(at) = next.pop() {
        let ways = arrows.clone().filter(|arrow| arrow.from == at).map(|arrow| &arrow.to);
        next.extend(ways.filter(|to| reached.insert((*to).clone())).cloned());
    }
    reached
}

/// Returns the circles of all libraries and programs of a crate, each with its files and arrows in a text of its own.
fn circles(sources: &Sources) -> Vec<String> {
    let is_root = |file: &&String| ["lib.rs", "main.rs"].contains(&file.as_str()) || file.starts_with("bin/");
    let roots = sources.keys().filter(is_root);
    roots.flat_map(|root| circles_from(sources, root)).collect()
}

fn circles_from(sources: &Sources, root: &str) -> Vec<String> {
    let mut tree = Tree::default();
    let folder = if root.starts_with("bin/") { "bin/" } else { "" };
    tree.load(sources, &[], root, folder);
    let arrows = tree.arrows();
    let reached: BTreeMap<_, _> = tree.0.keys().map(|from| (from, reached(arrows.keys(), from))).collect();
    let mut circles = BTreeSet::new();
    for (from, to) in &reached {
        let back = to.iter().filter(|to| reached[to].contains(*from));
        circles.insert(back.collect::<BTreeSet<_>>());
    }
    circles.remove(&BTreeSet::new());
    circles.iter().map(|circle| describe(&tree, &arrows, circle)).collect()
}

fn describe(tree: &Tree, arrows: &BTreeMap<Arrow, BTreeSet<String>>, circle: &BTreeSet<&Segments>) -> String {
    let file = |module: &Segments| tree.0[module].file.as_str();
    let files: Vec<&str> = circle.iter().map(|module| file(module)).collect();
    let mut text = format!("circle of {}", files.join(", "));
    for (Arrow { from, to }, paths) in arrows {
        if circle.contains(from) && circle.contains(to) {
            let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
            text += &format!("\n  {} -> {}: {}", file(from), file(to), paths.join(", "));
        }
    }
    text
}

/// Adds the sources below a folder.
fn collect(folder: &Path, name: &str, sources: &mut Sources) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{name}{}", path.file_name().unwrap().to_str().unwrap());
        if path.is_dir() {
            collect(&path, &format!("{name}/"), sources);
        } else if name.ends_with(".rs") {
            sources.insert(name, fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn no_files_of_a_crate_go_round_in_a_circle() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for name in CRATES {
        let mut sources = Sources::new();
        collect(&crates.join(name).join("src"), "", &mut sources);
        assert!(sources.contains_key("lib.rs"), "{name} has no lib.rs");
        found.extend(circles(&sources).iter().map(|circle| format!("{name}: {circle}")));
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Returns the circles of files that are given by path and text.
fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
    let texts = files
        .iter()
        .map(|(file, text)| ((*file).to_owned(), (*text).to_owned()));
    circles(&texts.collect())
}

const LIB: (&str, &str) = ("lib.rs", "mod a;\nmod b;\n");

#[test]
fn a_circle_is_found_with_its_arrows() {
    let c = (
        "b/c.rs",
        "pub fn f<'a>(x: &'a str) -> char { let _ = crate::a::A::<u8>::new(x); '\"' }",
    );
    let a = ("a.rs", "use crate::{b::{self, B as Other}};\npub struct A;");
    let found = circles_of(&[LIB, a, ("b.rs", "mod c; pub use c::*; pub struct B;"), c]);
    assert!(found.is_empty(), "b re-exports c and does not import it: {found:?}");
    let found = circles_of(&[
        LIB,
        ("a.rs", "use crate::b::c::f;\npub struct A;"),
        ("b.rs", "pub mod c;"),
        c,
    ]);
    let expected = "circle of a.rs, b/c.rs\n  a.rs -> b/c.rs: crate::b::c::f\n  b/c.rs -> a.rs: crate::a::A::new";
    assert_eq!(found, [expected]);
}

#[test]
fn parent_and_child_are_no_circle() {
    assert!(
        circles_of(&[
            ("lib.rs", "mod a;"),
            ("a.rs", "mod b; pub use b::B; struct A;"),
            ("a/b.rs", "use super::A;")
        ])
        .is_empty()
    );
}

#[test]
fn a_circle_through_a_child_is_found() {
    let b = ("b.rs", "mod c; use c::C; pub struct B;");
    let c = ("b/c.rs", "pub struct C(crate::a::A);");
    let found = circles_of(&[LIB, ("a.rs", "use crate::b::B; pub struct A;"), b, c]);
    assert!(
        found.len() == 1 && found[0].starts_with("circle of a.rs, b.rs, b/c.rs\n"),
        "{found:?}"
    );
}

#[test]
fn a_re_export_leads_to_the_file_that_defines() {
    for export in ["pub use c::C;", "pub use c::*;"] {
        let b = format!("mod c; {export}");
        let files = [LIB, ("a.rs", "use crate::b::C; pub struct A;"), ("b.rs", &b)];
        let circle = circles_of(&[&files[..], &[("b/c.rs", "use crate::a::A; pub struct C;")]].concat());
        assert!(
            circle.len() == 1 && circle[0].starts_with("circle of a.rs, b/c.rs\n"),
            "{export}: {circle:?}"
        );
        let none = circles_of(&[&files[..], &[("b/c.rs", "pub struct C;")]].concat());
        assert!(none.is_empty(), "{export}: {none:?}");
    }
}

#[test]
fn a_variant_is_no_module() {
    let a = "use crate::b::Kind;\npub enum Way { b, B }\nfn f() { let _ = (Way::b, Kind::a, Kind::B); }";
    assert!(
        circles_of(&[
            LIB,
            ("a.rs", a),
            ("b.rs", "pub enum Kind { a, B }\nfn f() { let _ = Kind::a; }")
        ])
        .is_empty()
    );
}

#[test]
fn tests_comments_and_texts_do_not_count() {
    let b = r##"// crate::a::A
        /* use crate::a::A; */ const T: &str = r#" " crate::a::A"#; const U: &str = "\" use crate::a::A; ";
        #[cfg(all(test, unix))] use crate::a::{A, B};
        #[cfg(test)] #[allow(unused)] mod tests { use crate::a::A; fn f() { let _ = [1; 2]; } }"##;
    assert!(circles_of(&[LIB, ("a.rs", "use crate::b::T;"), ("b.rs", b)]).is_empty());
    assert_eq!(
        circles_of(&[
            LIB,
            ("a.rs", "use crate::b::T;"),
            ("b.rs", &format!("{b} use crate::a::A;"))
        ])
        .len(),
        1
    );
}

#[test]
fn an_inline_module_is_part_of_its_file() {
    let b = "mod inner { use super::X; mod d { use super::super::super::a::A; } } use self::inner::Y;";
    assert_eq!(circles_of(&[LIB, ("a.rs", "use super::b::X;"), ("b.rs", b)]).len(), 1);
}
