//! Tests that no crate has circular imports between its files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const CRATES: [&str; 6] = [
    "bsmpm",
    "bsmpm-scene",
    "bsmpm-io",
    "bsmpm-ranks",
    "bsmpm-par",
    "bsmpm-tools",
];
/// Words before the name of an item.
const ITEMS: [&str; 8] = ["struct", "enum", "union", "trait", "type", "fn", "const", "static"];
/// Names for names that are followed; one that leads back to itself ends here.
const MOST_NAMES: usize = 32;

/// Segments of a path; those of a module are from the root.
type Segments = Vec<String>;
/// Texts by their paths in `src`.
type Sources = BTreeMap<String, String>;
/// Which module uses which, and the paths by which it does.
type Arrows = BTreeMap<(Segments, Segments), BTreeSet<String>>;

/// The words and signs of a source without comments, texts, characters and lifetimes; `::` is one sign.
fn tokens(text: &str) -> Vec<&str> {
    let word_of = |text: &str| {
        text.find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(text.len())
    };
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let up_to = |end: &str, from: usize| rest[from..].find(end).map_or(rest.len(), |at| from + at + end.len());
        let word = word_of(rest);
        let marks = rest[word..].len() - rest[word..].trim_start_matches('#').len();
        let is_raw = ["r", "br", "cr"].contains(&&rest[..word]) && rest[word + marks..].starts_with('"');
        let is_character = c == '\'' && (rest[1..].starts_with('\\') || rest.chars().nth(2) == Some('\''));
        let (is_kept, length) = match c {
            _ if is_raw => (false, up_to(&format!("\"{}", "#".repeat(marks)), word + marks + 1)),
            _ if rest.starts_with("//") => (false, up_to("\n", 2)),
            _ if rest.starts_with("/*") => (false, up_to("*/", 2)), // no comment of ours holds another
            _ if c == '"' || is_character => (false, quoted(rest, c)),
            '\'' => (false, 1 + word_of(&rest[1..])),
            _ if rest.starts_with("::") => (true, 2),
            _ => (!c.is_whitespace(), word.max(c.len_utf8())),
        };
        found.extend(is_kept.then_some(&rest[..length]));
        rest = &rest[length..];
    }
    found
}

/// Length of the text or character at the beginning.
fn quoted(text: &str, quote: char) -> usize {
    let mut is_escaped = false;
    let mut ends = |c: char| {
        let is_end = c == quote && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        is_end
    };
    text.char_indices()
        .skip(1)
        .find(|(_, c)| ends(*c))
        .map_or(text.len(), |(at, _)| at + 1)
}

/// The tokens but for items under `#[cfg(test)]`, or under `all(test, ..)`.
fn without_tests<'a>(mut tokens: &[&'a str]) -> Vec<&'a str> {
    let mut kept = Vec::new();
    while let [token, rest @ ..] = tokens {
        let is_test = |words: &str| tokens.starts_with(&words.split(' ').collect::<Vec<_>>());
        if !(is_test("# [ cfg ( test") || is_test("# [ cfg ( all ( test")) {
            kept.push(*token);
            tokens = rest;
            continue;
        }
        let mut depth = 0;
        let ends = |token: &&str| {
            depth += i32::from(["(", "[", "{"].contains(token)) - i32::from([")", "]", "}"].contains(token));
            depth <= 0 && ["}", ";"].contains(token)
        };
        tokens = tokens.iter().position(ends).map_or(&[], |end| &tokens[end + 1..]);
    }
    kept
}

/// Takes a `use` tree: its paths, each with the name that it gets (`*`: all names there). Gives the sign after it.
fn leaves<'a>(rest: &mut &[&'a str], head: &[String], found: &mut Vec<(String, Segments)>) -> &'a str {
    let mut path = head.to_vec();
    let mut name = None;
    let mut is_leaf = true;
    while let Some(token) = rest.split_off_first() {
        match *token {
            "::" => {}
            "as" => name = rest.split_off_first().map(|name| (*name).to_owned()),
            "{" => {
                while leaves(rest, &path, found) == "," {}
                is_leaf = false;
            }
            end @ ("," | "}" | ";") => {
                if is_leaf && path.len() > head.len() {
                    path.pop_if(|last| last == "self");
                    let name = name.or(path.last().cloned()).unwrap_or_default();
                    path.pop_if(|last| last == "*");
                    found.push((name, path));
                }
                return end;
            }
            segment => path.push(segment.to_owned()),
        }
    }
    ""
}

/// A file: the modules and items that it declares, what it gives a name by `use`, and every path in it.
#[derive(Default)]
struct Module {
    modules: Vec<String>,
    items: BTreeSet<String>,
    names: BTreeMap<String, Segments>,
    globs: Vec<Segments>,
    paths: Vec<Segments>,
}

impl Module {
    fn read(text: &str) -> Self {
        let mut module = Self::default();
        let mut before = "";
        let mut depth = 0;
        let mut inline = Vec::new(); // of braces, and of those around inline modules
        let tokens = without_tests(&tokens(text));
        let mut rest = &tokens[..];
        while let Some(&token) = rest.split_off_first() {
            let mut uses = Vec::new();
            let mut path = vec![token.to_owned()];
            match (token, rest) {
                ("{", _) => depth += 1,
                ("}", _) => {
                    inline.pop_if(|begin| *begin == depth);
                    depth -= 1;
                }
                ("mod", [_, "{", ..]) => inline.push(depth + 1),
                ("mod", [name, ";", ..]) => module.modules.push((*name).to_owned()),
                ("use", [next, ..]) if *next != "<" => drop(leaves(&mut rest, &[], &mut uses)),
                (_, ["::", ..]) if before != "::" => {
                    while let ["::", segment, after @ ..] = rest
                        && *segment != "<"
                    {
                        path.push((*segment).to_owned());
                        rest = after;
                    }
                    module.paths.push(outside(path, inline.len()));
                }
                _ if ITEMS.contains(&before) => drop(module.items.insert(token.to_owned())),
                _ => {}
            }
            for (name, path) in uses {
                let path = outside(path, inline.len());
                module.paths.push(path.clone());
                if name == "*" {
                    module.globs.push(path)
                } else {
                    drop(module.names.insert(name, path))
                }
            }
            before = token;
        }
        module
    }
}

/// A path from within so many inline modules as it is from their file.
fn outside(mut path: Segments, inline: usize) -> Segments {
    let supers = path
        .iter()
        .take(inline)
        .take_while(|segment| *segment == "super")
        .count();
    path.splice(..supers, (supers > 0).then(|| "self".to_owned()));
    path
}

/// The modules of a library or of a program, each with its file.
#[derive(Default)]
struct Tree(BTreeMap<Segments, (String, Module)>);

impl Tree {
    /// The modules from a file on; its own are in `folder`.
    fn load(&mut self, sources: &Sources, (path, file, folder): (Segments, String, &str)) {
        let module = Module::read(&sources[&file]);
        for name in &module.modules {
            let files = [format!("{folder}{name}.rs"), format!("{folder}{name}/mod.rs")];
            let found = files.into_iter().find(|file| sources.contains_key(file));
            let found = found.unwrap_or_else(|| panic!("{file} declares {name}, which is not there"));
            self.load(
                sources,
                (
                    [path.clone(), vec![name.clone()]].concat(),
                    found,
                    &format!("{folder}{name}/"),
                ),
            );
        }
        self.0.insert(path, (file, module));
    }

    /// The module that a path in module `at` leads to, and whether all of the path is modules. Where nothing is known
    /// of its beginning, as of other crates, that is `at`.
    fn owner(&self, at: &[String], path: &[String], names: usize) -> (Segments, bool) {
        let here = |is_module| (at.to_vec(), is_module);
        let Some((first, rest)) = path.split_first() else {
            return here(true);
        };
        let module = &self.0[at].1;
        let child = [at, &path[..1]].concat();
        match first.as_str() {
            "crate" => self.owner(&[], rest, names),
            "self" => self.owner(at, rest, names),
            "super" => self.owner(&at[..at.len().saturating_sub(1)], rest, names),
            _ if self.0.contains_key(&child) => self.owner(&child, rest, names),
            _ if names == 0 => here(false),
            _ if module.names.contains_key(first) => self.owner(at, &[&module.names[first], rest].concat(), names - 1),
            _ if module.items.contains(first) => here(false),
            _ => {
                let globs = module.globs.iter().map(|glob| self.owner(at, glob, names - 1));
                let mut holders = globs.filter(|(glob, is_module)| *is_module && glob != at && self.holds(glob, first));
                holders
                    .next()
                    .map_or(here(false), |(glob, _)| self.owner(&glob, path, names - 1))
            }
        }
    }

    fn holds(&self, at: &[String], name: &String) -> bool {
        let module = &self.0[at].1;
        module.modules.contains(name) || module.names.contains_key(name) || module.items.contains(name)
    }

    fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for (from, (_, module)) in &self.0 {
            for path in &module.paths {
                let (to, _) = self.owner(from, path, MOST_NAMES);
                if !(from.starts_with(&to) || to.starts_with(from)) {
                    arrows.entry((from.clone(), to)).or_default().insert(path.join("::"));
                }
            }
        }
        arrows
    }
}

/// The circles, each with its files and arrows in a text of its own.
fn circles(sources: &Sources) -> Vec<String> {
    let is_root = |file: &str| ["lib.rs", "main.rs"].contains(&file) || file.starts_with("bin/");
    sources
        .keys()
        .filter(|file| is_root(file))
        .flat_map(|root| circles_from(sources, root))
        .collect()
}

fn circles_from(sources: &Sources, root: &str) -> Vec<String> {
    let mut tree = Tree::default();
    tree.load(
        sources,
        (
            Vec::new(),
            root.to_owned(),
            if root.starts_with("bin/") { "bin/" } else { "" },
        ),
    );
    let arrows = tree.arrows();
    let reached = |from: &Segments| {
        let mut reached = BTreeSet::new();
        let mut next = vec![from.clone()];
        while let Some(at) = next.pop() {
            let ways = arrows.keys().filter(|(from, _)| *from == at).map(|(_, to)| to.clone());
            next.extend(ways.filter(|to| reached.insert(to.clone())));
        }
        reached
    };
    let reached: BTreeMap<&Segments, _> = tree.0.keys().map(|from| (from, reached(from))).collect();
    let of = |at: &Segments| {
        reached[at]
            .iter()
            .filter(|to| reached[to].contains(at))
            .cloned()
            .collect()
    };
    let parts: BTreeSet<BTreeSet<Segments>> = tree
        .0
        .keys()
        .map(of)
        .filter(|part: &BTreeSet<_>| !part.is_empty())
        .collect();
    let file = |at: &Segments| tree.0[at].0.as_str();
    let describe = |part: BTreeSet<Segments>| {
        let within = arrows
            .iter()
            .filter(|((from, to), _)| part.contains(from) && part.contains(to));
        let arrow = |((from, to), paths): (&(Segments, Segments), &BTreeSet<String>)| {
            let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
            format!("\n  {} -> {}: {}", file(from), file(to), paths.join(", "))
        };
        let files: Vec<&str> = part.iter().map(file).collect();
        format!(
            "circle of {}{}",
            files.join(", "),
            within.map(arrow).collect::<String>()
        )
    };
    parts.into_iter().map(describe).collect()
}

/// Takes the sources below a folder.
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
    let found = CRATES.iter().flat_map(|name| {
        let mut sources = Sources::new();
        collect(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src"),
            "",
            &mut sources,
        );
        assert!(sources.contains_key("lib.rs"), "{name} has no lib.rs");
        circles(&sources)
            .into_iter()
            .map(move |circle| format!("{name}: {circle}"))
    });
    let found: Vec<String> = found.collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// The circles of made-up files.
fn made(files: &[(&str, &str)]) -> Vec<String> {
    circles(
        &files
            .iter()
            .map(|(file, text)| ((*file).to_owned(), (*text).to_owned()))
            .collect(),
    )
}

const LIB: (&str, &str) = ("lib.rs", "mod a;\nmod b;\n");

#[test]
fn a_circle_is_found_with_its_arrows() {
    let c = (
        "b/c.rs",
        "pub fn f<'a>(x: &'a str) -> char { let _ = crate::a::A::<u8>::new(x); '\"' }",
    );
    let found = made(&[
        LIB,
        ("a.rs", "use crate::{b::{self, B as Other}};\npub struct A;"),
        ("b.rs", "mod c; use c::*;"),
        c,
    ]);
    assert!(
        found.is_empty(),
        "from a to b, from c to a, but not from b to c: {found:?}"
    );
    let found = made(&[
        LIB,
        ("a.rs", "use crate::b::c::f;\npub struct A;"),
        ("b.rs", "pub mod c;"),
        c,
    ]);
    let expected = "circle of a.rs, b/c.rs\n  a.rs -> b/c.rs: crate::b::c::f\n  b/c.rs -> a.rs: crate::a::A";
    assert_eq!(found, [expected]);
}

#[test]
fn parent_and_child_are_no_circle() {
    assert!(
        made(&[
            ("lib.rs", "mod a;"),
            ("a.rs", "mod b; pub use b::B; struct A;"),
            ("a/b.rs", "use super::A;")
        ])
        .is_empty()
    );
}

#[test]
fn a_re_export_leads_to_the_file_that_defines() {
    for export in ["pub use c::C;", "pub use c::*;"] {
        let b = format!("mod c; {export}");
        let files = [LIB, ("a.rs", "use crate::b::C; pub struct A;"), ("b.rs", &b)];
        let circle = made(&[&files[..], &[("b/c.rs", "use crate::a::A; pub struct C;")]].concat());
        assert!(
            circle.len() == 1 && circle[0].starts_with("circle of a.rs, b/c.rs\n"),
            "{export}: {circle:?}"
        );
        let none = made(&[&files[..], &[("b/c.rs", "pub struct C;")]].concat());
        assert!(none.is_empty(), "{export}: {none:?}");
    }
}

#[test]
fn a_variant_is_no_module() {
    let a = "use crate::b::Kind;\npub enum Way { b, B }\nfn f() { let _ = (Way::b, Kind::a, Kind::B); }";
    assert!(
        made(&[
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
    assert!(made(&[LIB, ("a.rs", "use crate::b::T;"), ("b.rs", b)]).is_empty());
    assert_eq!(
        made(&[
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
    assert_eq!(made(&[LIB, ("a.rs", "use super::b::X;"), ("b.rs", b)]).len(), 1);
}
