//! Walks through the book as a reader does: every file is written, every command is run, and what the book says that
//! they print and end with is compared. `scripts/book --check` starts it with the programs on the PATH.

use bsmpm_book::{Block, Chapter, blocks, chapters};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{fs, io};

/// What became of the blocks.
#[derive(Default)]
struct Counts {
    passed: usize,
    failed: usize,
    not_run: Vec<String>,
}

fn main() -> io::Result<ExitCode> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let mut counts = Counts::default();
    let directory = tempfile::tempdir()?;
    clone_into(directory.path(), &repository)?;
    for chapter in chapters()? {
        let start = Instant::now();
        let before = counts.passed + counts.failed;
        walk(&chapter, directory.path(), &mut counts)?;
        let blocks = counts.passed + counts.failed - before;
        if blocks > 0 {
            println!("{:<20} {blocks:>3} blocks {:>6.1} s", chapter.file, start.elapsed().as_secs_f64());
        }
    }
    println!("not run: {} block(s)", counts.not_run.len());
    for block in &counts.not_run {
        println!("  {block}");
    }
    println!("{} passed, {} failed", counts.passed, counts.failed);
    Ok(if counts.failed == 0 && counts.passed > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Walks through a chapter in the reader's directory.
fn walk(chapter: &Chapter, directory: &Path, counts: &mut Counts) -> io::Result<()> {
    let mut printed = String::new();
    for block in blocks(&chapter.text) {
        let place = format!("{}:{}", chapter.file, block.line);
        let wrong = match block.language.as_str() {
            "sh" if block.is("not-run") => {
                counts.not_run.push(format!("{place}: {}", block.text.lines().next().unwrap_or_default()));
                continue;
            }
            "sh" => run(&block, directory, &mut printed)?,
            "text" if block.is("output") => missing(&block.text, &printed),
            _ => {
                write(&block, directory)?;
                continue;
            }
        };
        match wrong {
            None => counts.passed += 1,
            Some(wrong) => {
                counts.failed += 1;
                println!("{place}: {wrong}\n--- the commands printed\n{printed}---");
            }
        }
    }
    Ok(())
}

/// What a reader's clone has: its cases, and its scripts, which find the clone by their own place.
fn clone_into(directory: &Path, repository: &Path) -> io::Result<()> {
    let cases = Command::new("cp").arg("-r").arg(repository.join("cases")).arg(directory).status()?;
    if !cases.success() {
        return Err(io::Error::other("the cases could not be copied"));
    }
    fs::create_dir(directory.join("scripts"))?;
    let run = format!("exec \"{}\" \"$@\"\n", repository.join("scripts/run").display());
    fs::write(directory.join("scripts/run"), format!("#!/usr/bin/env bash\n{run}"))?;
    let allowed = Command::new("chmod").args(["+x", "scripts/run"]).current_dir(directory).status()?;
    if allowed.success() { Ok(()) } else { Err(io::Error::other("chmod failed")) }
}

/// Runs the commands of a block; what is wrong with their end.
fn run(block: &Block, directory: &Path, printed: &mut String) -> io::Result<Option<String>> {
    let output = Command::new("bash").args(["-euo", "pipefail", "-c", &block.text]).current_dir(directory).output()?;
    *printed = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    let expected = block.value("exit").map_or(Some(0), |code| code.parse().ok());
    let code = output.status.code();
    Ok((code != expected || code.is_none()).then(|| format!("exit code {code:?}, the book says {expected:?}")))
}

/// The first line of `text` that no line of `printed` is, whatever the spaces between words.
fn missing(text: &str, printed: &str) -> Option<String> {
    let matches = |line: &str, pattern: &str| {
        let mut rest = line;
        let mut pieces = pattern.split("...").enumerate();
        let last = pattern.split("...").count() - 1;
        pieces.all(|(number, piece)| match rest.find(piece) {
            Some(at) if number > 0 || at == 0 => {
                rest = &rest[at + piece.len()..];
                number < last || piece.is_empty() || rest.is_empty()
            }
            _ => false,
        })
    };
    let spaced = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let printed: Vec<String> = printed.lines().map(spaced).collect();
    let absent = |pattern: &&str| !printed.iter().any(|line| matches(line, &spaced(pattern)));
    let line = text.lines().filter(|line| !line.trim().is_empty()).find(absent)?;
    Some(format!("no line \"{line}\" was printed"))
}

/// Writes a block that is a file of the reader's.
fn write(block: &Block, directory: &Path) -> io::Result<()> {
    let path = |name: &str| -> PathBuf { directory.join(name) };
    if let Some(name) = block.value("file") {
        fs::write(path(name), &block.text)?;
    } else if let Some(name) = block.value("append") {
        fs::OpenOptions::new().append(true).open(path(name))?.write_all(block.text.as_bytes())?;
    }
    Ok(())
}
