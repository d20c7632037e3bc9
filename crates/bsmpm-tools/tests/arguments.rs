//! Tests that every argument of a function has a name: no parameter is a tuple.

use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{FnArg, ItemMod, Signature, Type};

/// Functions of a file that have a tuple as a parameter.
#[derive(Default)]
struct TupleParameters {
    functions: Vec<String>,
}

impl<'ast> Visit<'ast> for TupleParameters {
    /// Skips the modules of unit tests.
    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        let is_test = module.attrs.iter().any(|attribute| attribute.path().is_ident("cfg"));
        if !is_test {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_signature(&mut self, signature: &'ast Signature) {
        let has_tuple = signature.inputs.iter().any(is_tuple_parameter);
        if has_tuple {
            self.functions.push(signature.ident.to_string());
        }
        visit::visit_signature(self, signature);
    }
}

fn is_tuple_parameter(parameter: &FnArg) -> bool {
    match parameter {
        FnArg::Typed(parameter) => is_tuple(&parameter.ty),
        FnArg::Receiver(_) => false,
    }
}

/// Whether a type is a tuple of two or more, or a reference to one.
fn is_tuple(kind: &Type) -> bool {
    match kind {
        Type::Tuple(tuple) => tuple.elems.len() >= 2,
        Type::Reference(reference) => is_tuple(&reference.elem),
        _ => false,
    }
}

/// The Rust files below a directory.
fn rust_files(directory: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).expect("a directory") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// Two numbers of a tuple that are exchanged in a call still compile; arguments with names are seen in an editor.
#[test]
fn no_function_has_a_tuple_as_a_parameter() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for entry in fs::read_dir(crates).expect("the crates") {
        let source = entry.expect("a crate").path().join("src");
        if !source.is_dir() {
            continue;
        }
        for file in rust_files(&source) {
            let text = fs::read_to_string(&file).expect("a text");
            let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let mut tuples = TupleParameters::default();
            tuples.visit_file(&parsed);
            let named = |function: &String| format!("{}: {function}", file.display());
            found.extend(tuples.functions.iter().map(named));
        }
    }
    assert!(found.is_empty(), "tuples as parameters: {found:#?}");
}

#[test]
fn a_tuple_as_a_parameter_is_found() {
    let source = "impl Grid { fn step(&self, (t, dt): (f64, f64)) {} fn at(x: &(f64, f64)) {} fn unit(_: ()) {} }";
    let mut tuples = TupleParameters::default();
    tuples.visit_file(&syn::parse_file(source).unwrap());
    assert_eq!(tuples.functions, ["step", "at"]);
}
