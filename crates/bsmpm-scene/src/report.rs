//! Collects the errors, warnings and chosen values of a case, in the order of the case file.

use crate::error::{Choice, Error, Origin, Place};
use crate::key_path::join;
use crate::source::Source;
use crate::words::RemovedWord;
use bsmpm_messages::{code_of, without_code};
use std::collections::{HashMap, HashSet};

/// Errors that are reported at most; a file with more is no case.
const MOST: usize = 100;

/// Errors, warnings and choices of one case.
#[derive(Debug)]
pub(crate) struct Report<'a> {
    source: &'a Source<'a>,
    overrides: &'a [String],
    errors: Vec<ReportedError>,
    /// paths of keys whose name was guessed
    assumed: Vec<String>,
    warnings: Vec<String>,
    pub(crate) notes: Vec<Choice>,
    renamings: Vec<KeyRenaming>,
}

/// An error with what it is about.
#[derive(Debug)]
struct ReportedError {
    origin: Origin,
    error: Error,
    /// key paths, mostly its own
    about: Vec<String>,
    /// key paths; where another error is about one of them, this one only follows from it
    causes: Vec<String>,
}

/// An earlier name that the case has, the name of now, and the key paths that have it.
#[derive(Debug)]
struct KeyRenaming {
    earlier: String,
    now: String,
    paths: Vec<String>,
}

/// Warnings that differ only in the key that they concern.
struct MergedWarning {
    /// The code and `": "`, or nothing.
    head: String,
    keys: Vec<String>,
    text: String,
}

impl MergedWarning {
    fn line(&self) -> String {
        let Self { head, keys, text } = self;
        match keys.is_empty() {
            true => format!("{head}{text}"),
            false => format!("{head}{}: {text}", listed(keys)),
        }
    }
}

impl<'a> Report<'a> {
    pub(crate) fn new(source: &'a Source<'a>, overrides: &'a [String]) -> Self {
        Self {
            source,
            overrides,
            errors: Vec::new(),
            assumed: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
            renamings: Vec::new(),
        }
    }

    /// Records an error at `origin` that concerns the key path `key`. `message` begins with its code.
    pub(crate) fn error(&mut self, origin: Origin, key: &str, message: impl Into<String>) {
        self.about(origin, key, message, Vec::new());
    }

    /// Records an error at `origin` that concerns the key path `key` and others that it leaves without a value.
    pub(crate) fn about(&mut self, origin: Origin, key: &str, message: impl Into<String>, mut others: Vec<String>) {
        others.push(key.to_owned());
        let error = self.placed(origin, key, message.into(), None);
        self.errors.push(ReportedError {
            origin,
            error,
            about: others,
            causes: Vec::new(),
        });
    }

    /// Records an error that is not printed if another one is about one of the `causes`: it only follows from that.
    pub(crate) fn consequence(&mut self, origin: Origin, key: &str, message: impl Into<String>, causes: &[&str]) {
        let causes = causes.iter().map(|cause| (*cause).to_owned()).collect();
        let error = self.placed(origin, key, message.into(), None);
        self.errors.push(ReportedError {
            origin,
            error,
            about: vec![key.to_owned()],
            causes,
        });
    }

    /// Records that some keys of a table are missing, which may follow from errors about them or about `others`.
    pub(crate) fn missing(&mut self, origin: Origin, table: &str, keys: &[&str], message: String, others: &[&str]) {
        let paths: Vec<String> = keys.iter().map(|key| join(table, key)).collect();
        let causes = paths
            .iter()
            .cloned()
            .chain(others.iter().map(|cause| (*cause).to_owned()))
            .collect();
        let place = if let [key] = &paths[..] { key } else { table };
        let error = self.placed(origin, place, message, None);
        self.errors.push(ReportedError {
            origin,
            error,
            about: paths,
            causes,
        });
    }

    /// Records that the name of a key is wrong, and that its value is taken for that of `assumed`.
    pub(crate) fn slip(&mut self, origin: Origin, key: &str, message: String, assumed: &str) {
        self.assumed.push(assumed.to_owned());
        self.about(origin, key, message, vec![assumed.to_owned()]);
    }

    /// Records that the value of `key` is a word that this version does not have any more.
    pub(crate) fn removed(&mut self, origin: Origin, key: &str, word: &'static RemovedWord) {
        let RemovedWord { last, remedy, .. } = word;
        let message = format!(
            "E0018: the value {} does not exist any more; the last version with this value was {last}. {remedy}",
            word.value()
        );
        let error = self.placed(origin, key, message, Some(word));
        self.errors.push(ReportedError {
            origin,
            error,
            about: vec![key.to_owned()],
            causes: Vec::new(),
        });
    }

    fn placed(&self, origin: Origin, key: &str, message: String, removed: Option<&'static RemovedWord>) -> Error {
        let (place, excerpt) = match origin {
            Origin::Text(offset) => {
                let (place, excerpt) = self.source.locate(offset);
                (place, Some(excerpt))
            }
            Origin::Override(number) => (Place::Override(shortened(&self.overrides[number])), None),
            Origin::Nowhere => (Place::File, None),
        };
        let file = self.source.name.to_owned();
        let key = shortened(key);
        let code = code_of(&message).map(str::to_owned);
        let message = without_code(&message).to_owned();
        Error {
            file,
            place,
            key,
            code,
            message,
            removed,
            excerpt,
        }
    }

    /// Records a warning: its code, the key that it concerns if there is one, and the text (`W0001: KEY: TEXT`).
    pub(crate) fn warn(&mut self, message: impl Into<String>) {
        self.warnings.push(message.into());
    }

    /// Hands over the warnings. Warnings that differ only in the key that they begin with are one, with all these keys.
    pub(crate) fn take_warnings(&mut self) -> Vec<String> {
        let mut merged: Vec<MergedWarning> = Vec::new();
        let mut numbers: HashMap<String, usize> = HashMap::new();
        for warning in std::mem::take(&mut self.warnings) {
            let head = code_of(&warning).map_or_else(String::new, |code| format!("{code}: "));
            let words = without_code(&warning);
            let Some((key, text)) = words.split_once(": ").filter(|(key, _)| !key.contains(' ')) else {
                merged.push(MergedWarning {
                    head,
                    keys: Vec::new(),
                    text: words.to_owned(),
                });
                continue;
            };
            let number = *numbers.entry(format!("{head}{text}")).or_insert(merged.len());
            if number == merged.len() {
                merged.push(MergedWarning {
                    head,
                    keys: Vec::new(),
                    text: text.to_owned(),
                });
            }
            merged[number].keys.push(key.to_owned());
        }
        merged.iter().map(MergedWarning::line).collect()
    }

    pub(crate) fn note(&mut self, key: impl Into<String>, value: impl Into<String>, reason: impl Into<String>) {
        self.notes.push(Choice {
            key: key.into(),
            value: value.into(),
            reason: reason.into(),
        });
    }

    /// Records that the case has an earlier name at a key path.
    pub(crate) fn renamed(&mut self, earlier: &str, now: &str, path: &str) {
        let known = self
            .renamings
            .iter_mut()
            .find(|known| known.earlier == earlier && known.now == now);
        match known {
            Some(known) if known.paths.iter().any(|other| other == path) => {}
            Some(known) => known.paths.push(path.to_owned()),
            None => self.renamings.push(KeyRenaming {
                earlier: earlier.to_owned(),
                now: now.to_owned(),
                paths: vec![path.to_owned()],
            }),
        }
    }

    pub(crate) fn has_renamings(&self) -> bool {
        !self.renamings.is_empty()
    }

    /// Hands over what earlier names the case has: one sentence for each.
    pub(crate) fn take_renamings(&mut self) -> Vec<String> {
        let renamings = std::mem::take(&mut self.renamings).into_iter();
        let sentences = renamings.map(|KeyRenaming { earlier, now, paths }| {
            format!(
                "{}: `{earlier}` is now called `{now}`. Replace the earlier name, which is still read.",
                listed(&paths)
            )
        });
        sentences.collect()
    }

    pub(crate) fn failed(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Drops errors that only follow from others, unless nothing would be left.
    fn drop_consequences(&mut self) {
        let all = KeyCounts::of(self.errors.iter().flat_map(|reported| &reported.about));
        let is_dropped = self.errors.iter().map(|reported| {
            let own = KeyCounts::of(reported.about.iter());
            let mut causes = reported.causes.iter();
            self.is_of_guess(&reported.error.key) || causes.any(|cause| all.concerned(cause) > own.concerned(cause))
        });
        let is_dropped: Vec<bool> = is_dropped.collect();
        if is_dropped.iter().all(|dropped| *dropped) {
            return;
        }
        let mut dropped = is_dropped.into_iter();
        self.errors.retain(|_| !dropped.next().unwrap_or(false));
    }

    /// Whether a key path is that of a value, or of an item of it, whose key's name was guessed.
    fn is_of_guess(&self, path: &str) -> bool {
        self.assumed.iter().any(|assumed| {
            let rest = path.strip_prefix(assumed.as_str());
            rest.is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit() || c == '.'))
        })
    }

    /// The errors in the order of the file, without repetitions and without those that only follow from others; those
    /// of overrides last.
    pub(crate) fn into_errors(mut self) -> Vec<Error> {
        self.drop_consequences();
        self.errors.sort_by_key(|reported| reported.origin);
        let mut seen = HashSet::new();
        let mut errors: Vec<Error> = self.errors.into_iter().map(|reported| reported.error).collect();
        errors.retain(|error| seen.insert((format!("{:?}", error.place), error.key.clone(), error.message.clone())));
        if errors.len() > MOST {
            let more = errors.len() - MOST;
            errors.truncate(MOST);
            let message =
                format!("E0009: {more} more errors are not shown. Correct the errors above, and check the case again.");
            errors.push(Error::of_file(self.source.name, &message));
        }
        errors
    }
}

/// How often key paths occur, by themselves and as the beginning of others.
#[derive(Default)]
struct KeyCounts<'a> {
    whole: HashMap<&'a str, usize>,
    beginning: HashMap<&'a str, usize>,
}

impl<'a> KeyCounts<'a> {
    fn of(paths: impl Iterator<Item = &'a String>) -> Self {
        let mut counts = Self::default();
        for path in paths {
            *counts.whole.entry(path).or_default() += 1;
            beginnings(path).for_each(|part| *counts.beginning.entry(part).or_default() += 1);
        }
        counts
    }

    /// Number of paths that are this one, a part of it, or the table of the file that it is in.
    fn concerned(&self, path: &str) -> usize {
        let count = |counts: &HashMap<&str, usize>, path: &str| counts.get(path).copied().unwrap_or(0);
        let table = beginnings(path).next();
        count(&self.whole, path) + count(&self.beginning, path) + table.map_or(0, |table| count(&self.whole, table))
    }
}

/// The tables and lists that a key path lies in, by their paths.
fn beginnings(path: &str) -> impl Iterator<Item = &str> {
    path.match_indices('.').map(|(at, _)| &path[..at])
}

/// Names in words: all of up to three, of more the first and the number of the others.
pub(crate) fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] if names.len() <= 3 => format!("{} and {last}", others.join(", ")),
        [first, others @ ..] => format!("{first} and {} others", others.len()),
    }
}

/// Text of a case made safe to print: no control characters, at most 60 characters.
pub(crate) fn shortened(text: &str) -> String {
    const LENGTH: usize = 60;
    let safe = text.chars().take(LENGTH).flat_map(|c| {
        let plain = matches!(c, '"' | '\'' | '\\');
        if plain { vec![c] } else { c.escape_debug().collect() }
    });
    let mut safe: String = safe.collect();
    if text.chars().nth(LENGTH).is_some() {
        safe.push_str("...");
    }
    safe
}
