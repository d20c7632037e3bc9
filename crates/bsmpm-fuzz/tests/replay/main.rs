//! Executes each fuzz target on stored inputs (corpora) and on random changes of these inputs.

mod mutation;

use bsmpm_fuzz::{TARGETS, Target};
use mutation::Mutator;
use std::path::Path;

/// Mutations of each target.
const MUTATIONS: usize = 2000;
/// Files and bytes of a corpus at most.
const MOST: (usize, usize) = (40, 100_000);

/// The files of a corpus in the order of their names.
fn corpus(target: &Target) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let read = |entry: std::fs::DirEntry| {
        (
            entry.file_name().to_string_lossy().into_owned(),
            std::fs::read(entry.path()).expect("a file that can be read"),
        )
    };
    let mut files: Vec<_> = entries
        .map(|entry| read(entry.expect("a folder that can be read")))
        .collect();
    files.sort();
    files
}

fn target(name: &str) -> Target {
    bsmpm_fuzz::named(name).expect("a target")
}

fn replay(name: &str) {
    let target = target(name);
    let files = corpus(&target);
    assert!(!files.is_empty());
    for (file, data) in &files {
        println!("{name}/{file}");
        (target.run)(data);
    }
    let mut mutator = Mutator::new(files.into_iter().map(|(_, data)| data).collect());
    for number in 0..MUTATIONS {
        println!("{name}, mutation {number}");
        (target.run)(&mutator.next());
    }
}

macro_rules! replays {
    ($($name:ident),*) => {
        $(#[test]
        fn $name() {
            replay(stringify!($name));
        })*

        #[test]
        fn every_target_is_replayed_on_a_small_corpus() {
            assert_eq!([$(stringify!($name)),*], TARGETS.map(|target| target.name));
            for target in TARGETS {
                let files = corpus(&target);
                let bytes: usize = files.iter().map(|(_, data)| data.len()).sum();
                assert!(files.len() <= MOST.0 && bytes <= MOST.1, "{}: {} files, {bytes} bytes", target.name, files.len());
            }
        }
    };
}
replays!(case, record, manifest, table, step, material, spline);
