//! Walks through the manual as a reader does: writes every file, runs every command, and compares exit codes, printed
//! lines and pictures with the text. `scripts/book --check` and `--full` start this walk with the programs on the PATH.
//!
//! Usage: `walk [--full] [--only CHAPTER]`
//!
//! Without `--full`, cases have the coarse values of their fences, pictures need only exist, and outputs that are
//! marked `full` are not compared. With `--full`, cases run as printed, and the pictures of the manual are renewed.
//! `--only` walks through one chapter, for example `tutorials/slope`.

use bsmpm_book::{Block, Chapter, Picture, blocks, chapters, normalised, pictures, repository};
use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fs, io};
use tempfile::TempDir;

/// Options of the command line.
#[derive(Default)]
struct Options {
    is_full: bool,
    only: Option<String>,
}

impl Options {
    fn from_command_line() -> Result<Options, String> {
        let mut options = Options::default();
        let mut arguments = env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--full" => options.is_full = true,
                "--only" => options.only = Some(arguments.next().ok_or("--only needs the name of a chapter")?),
                other => return Err(format!("unknown argument {other}")),
            }
        }
        Ok(options)
    }

    /// Whether this chapter is walked through: all are, or the one that is named with or without `.md`.
    fn includes(&self, chapter: &Chapter) -> bool {
        let stem = chapter.file.trim_end_matches(".md");
        self.only
            .as_ref()
            .is_none_or(|name| name.trim_end_matches(".md") == stem)
    }
}

/// Numbers of blocks and pictures that passed and failed, and the blocks that were not run.
#[derive(Default)]
struct Counts {
    passed: usize,
    failed: usize,
    not_run: Vec<String>,
    only_full: usize,
}

impl Counts {
    /// Counts a check, and prints the fault and what was printed before it.
    fn add(&mut self, place: &str, fault: Option<String>, printed: &str) {
        match fault {
            None => self.passed += 1,
            Some(fault) => {
                self.failed += 1;
                println!("{place}: {fault}\n--- the commands printed\n{printed}---");
            }
        }
    }

    fn print(&self) {
        println!("not run: {} block(s)", self.not_run.len());
        for block in &self.not_run {
            println!("  {block}");
        }
        if self.only_full > 0 {
            println!("compared only in a full run: {} output(s)", self.only_full);
        }
        println!("{} passed, {} failed", self.passed, self.failed);
    }
}

fn main() -> io::Result<ExitCode> {
    let options = match Options::from_command_line() {
        Ok(options) => options,
        Err(fault) => {
            eprintln!("walk: {fault}");
            return Ok(ExitCode::from(2));
        }
    };
    let mut counts = Counts::default();
    let shared = reader_directory(options.is_full)?;
    let chapters: Vec<Chapter> = chapters()?
        .into_iter()
        .filter(|chapter| options.includes(chapter))
        .collect();
    if chapters.is_empty() {
        println!(
            "SUMMARY.md has no chapter {}",
            options.only.as_deref().unwrap_or_default()
        );
    }
    for chapter in &chapters {
        let start = Instant::now();
        let before = counts.passed + counts.failed;
        if chapter.is_tutorial() {
            walk(
                chapter,
                reader_directory(options.is_full)?.path(),
                &options,
                &mut counts,
            )?;
        } else {
            walk(chapter, shared.path(), &options, &mut counts)?;
        }
        let checks = counts.passed + counts.failed - before;
        if checks > 0 {
            println!(
                "{:<32} {checks:>3} checks {:>6.1} s",
                chapter.file,
                start.elapsed().as_secs_f64()
            );
        }
    }
    counts.print();
    Ok(if counts.failed == 0 && counts.passed > 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Walks through a chapter in the reader's directory.
fn walk(chapter: &Chapter, directory: &Path, options: &Options, counts: &mut Counts) -> io::Result<()> {
    let mut printed = String::new();
    for block in blocks(&chapter.text) {
        let place = format!("{}:{}", chapter.file, block.line);
        match block.language.as_str() {
            "sh" if block.is("not-run") => {
                let command = block.text.lines().next().unwrap_or_default();
                counts.not_run.push(format!("{place}: {command}"));
            }
            "sh" => {
                let fault = run(&block, directory, &mut printed)?;
                counts.add(&place, fault, &printed);
            }
            "text" if block.is("output") && block.is("full") && !options.is_full => counts.only_full += 1,
            "text" if block.is("output") => counts.add(&place, missing_line(&block.text, &printed), &printed),
            _ => {
                if let Some(fault) = write(&block, directory, options)? {
                    counts.add(&place, Some(fault), "");
                }
            }
        }
    }
    for picture in pictures(&chapter.text) {
        let place = format!("{}:{}", chapter.file, picture.line);
        counts.add(&place, check_picture(&picture, chapter, directory, options)?, &printed);
    }
    Ok(())
}

/// Makes a directory with what a reader's clone has: its cases, and `scripts/run`, which finds the clone by its place.
/// Without `is_full`, `scripts/run` takes the coarse preset of a case.
fn reader_directory(is_full: bool) -> io::Result<TempDir> {
    let repository = repository();
    let directory = tempfile::tempdir()?;
    let cases = Command::new("cp")
        .arg("-r")
        .arg(repository.join("cases"))
        .arg(directory.path())
        .status()?;
    if !cases.success() {
        return Err(io::Error::other("the cases could not be copied"));
    }
    fs::create_dir(directory.path().join("scripts"))?;
    let coarse = if is_full { "" } else { " --set accuracy=draft" };
    let run = format!("exec \"{}\" \"$@\"{coarse}\n", repository.join("scripts/run").display());
    fs::write(
        directory.path().join("scripts/run"),
        format!("#!/usr/bin/env bash\n{run}"),
    )?;
    let allowed = Command::new("chmod")
        .args(["+x", "scripts/run"])
        .current_dir(directory.path())
        .status()?;
    if allowed.success() {
        Ok(directory)
    } else {
        Err(io::Error::other("chmod failed"))
    }
}

/// Runs the commands of a block and returns the fault of their exit code.
fn run(block: &Block, directory: &Path, printed: &mut String) -> io::Result<Option<String>> {
    let output = Command::new("bash")
        .args(["-euo", "pipefail", "-c", &block.text])
        .current_dir(directory)
        .output()?;
    *printed = [output.stdout, output.stderr]
        .map(|text| String::from_utf8_lossy(&text).into_owned())
        .concat();
    let expected = block.value("exit").map_or(Some(0), |code| code.parse().ok());
    let code = output.status.code();
    let is_right = code.is_some() && code == expected;
    Ok((!is_right).then(|| format!("exit code {code:?}, the manual says {expected:?}")))
}

/// Reports the first line of `text` that was not printed, whatever the spaces between words.
fn missing_line(text: &str, printed: &str) -> Option<String> {
    let spaced = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let printed: Vec<String> = printed.lines().map(spaced).collect();
    let is_absent = |pattern: &&str| !printed.iter().any(|line| matches_pattern(line, &spaced(pattern)));
    let line = text.lines().filter(|line| !line.trim().is_empty()).find(is_absent)?;
    Some(format!("no line \"{line}\" was printed"))
}

/// Whether a line is the pattern, in which `...` matches anything.
fn matches_pattern(line: &str, pattern: &str) -> bool {
    let Some((first, others)) = pattern.split_once("...") else {
        return line == pattern;
    };
    let Some(mut rest) = line.strip_prefix(first) else {
        return false;
    };
    let mut pieces: Vec<&str> = others.split("...").collect();
    let last = pieces.pop().unwrap_or_default();
    for piece in pieces {
        match rest.split_once(piece) {
            Some((_, after)) => rest = after,
            None => return false,
        }
    }
    rest.ends_with(last)
}

/// Writes a block that is a file of the reader and returns the fault of its coarse values.
fn write(block: &Block, directory: &Path, options: &Options) -> io::Result<Option<String>> {
    let text = match block.coarse_text() {
        Err(fault) => return Ok(Some(fault)),
        Ok(_) if options.is_full => block.text.clone(),
        Ok(coarse) => coarse,
    };
    if let Some(name) = block.value("file") {
        fs::write(directory.join(name), text)?;
    } else if let Some(name) = block.value("append") {
        fs::OpenOptions::new()
            .append(true)
            .open(directory.join(name))?
            .write_all(text.as_bytes())?;
    }
    Ok(None)
}

/// Reports a picture that the commands did not draw. A full run copies the others into the manual.
fn check_picture(
    picture: &Picture,
    chapter: &Chapter,
    directory: &Path,
    options: &Options,
) -> io::Result<Option<String>> {
    let drawn = directory.join(&picture.drawn);
    if !drawn.is_file() {
        return Ok(Some(format!("no command wrote the picture {}", picture.drawn)));
    }
    if options.is_full {
        let place = normalised(&chapter.folder().join(&picture.target));
        fs::create_dir_all(place.parent().unwrap_or(&place))?;
        fs::copy(drawn, place)?;
    }
    Ok(None)
}
