//! Finds links and pictures in the text of a chapter, and replaces them.

use crate::{events, line_at};
use pulldown_cmark::{Event, Tag};
use std::ops::Range;

/// A link or a picture in the text of a chapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// Line of its target, from 1.
    pub line: usize,
    /// Path or address, with its anchor.
    pub target: String,
}

impl Link {
    /// The link with this target at this byte of a text.
    pub fn at(text: &str, start: usize, target: &str) -> Link {
        Link {
            line: line_at(text, start),
            target: target.to_owned(),
        }
    }

    /// Whether it leads to another site.
    pub fn is_external(&self) -> bool {
        self.target.contains("://")
    }

    /// Path of the file without the anchor; empty for an anchor of the same page.
    pub fn path(&self) -> &str {
        self.target.split('#').next().unwrap_or_default()
    }

    /// Anchor without `#`; empty without one.
    pub fn anchor(&self) -> &str {
        self.target.split_once('#').map_or("", |(_, anchor)| anchor)
    }
}

/// A picture that the commands of a chapter draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Line of its target, from 1.
    pub line: usize,
    /// Place of the picture in the manual, relative to the chapter.
    pub target: String,
    /// File that the commands write, relative to the reader's directory.
    pub drawn: String,
}

/// A link or a picture with its places in the text, in bytes.
struct PlacedLink {
    link: Link,
    /// All of it, as `[words](target)`.
    whole: Range<usize>,
    /// What is between its parentheses.
    target: Range<usize>,
    /// The paragraph that it belongs to, or the last one before it.
    paragraph: Range<usize>,
}

/// Links and pictures of the form `[words](target)`, in the order of their targets.
fn placed_links(text: &str) -> Vec<PlacedLink> {
    let mut found = Vec::new();
    let mut paragraph = 0..0;
    for (event, whole) in events(text) {
        match event {
            Event::Start(Tag::Paragraph) => paragraph = whole,
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                let inside = text[whole.clone()].strip_suffix(')');
                let Some(words) = inside.and_then(|inside| inside.rfind("](")) else {
                    continue;
                };
                let start = whole.start + words + 2;
                let link = Link::at(text, start, &dest_url);
                let target = start..whole.end - 1;
                found.push(PlacedLink {
                    link,
                    whole,
                    target,
                    paragraph: paragraph.clone(),
                });
            }
            _ => {}
        }
    }
    found.sort_by_key(|placed| placed.target.start);
    found
}

/// Links and pictures outside of code.
pub fn links(text: &str) -> Vec<Link> {
    placed_links(text).into_iter().map(|placed| placed.link).collect()
}

/// The text with the targets of its links and pictures replaced.
pub fn relinked(text: &str, replace: impl Fn(&Link) -> String) -> String {
    let mut relinked = text.to_owned();
    for PlacedLink { link, target, .. } in placed_links(text).into_iter().rev() {
        relinked.replace_range(target, &replace(&link));
    }
    relinked
}

/// The pictures that are followed by a comment with the file that the commands draw.
pub fn pictures(text: &str) -> Vec<Picture> {
    let mut found = Vec::new();
    for PlacedLink { link, whole, .. } in placed_links(text) {
        let comment = text[whole.end..]
            .trim_start()
            .strip_prefix("<!--")
            .and_then(|rest| rest.split_once("-->"));
        if let Some((drawn, _)) = comment
            && text[whole].starts_with('!')
        {
            found.push(Picture {
                line: link.line,
                target: link.target,
                drawn: drawn.trim().to_owned(),
            });
        }
    }
    found
}

/// The text with the caption of each picture below it, as the built manual shows it: a picture that is a paragraph
/// (with or without a comment) is followed by its caption in a paragraph of the class `caption`.
pub fn captioned(text: &str) -> String {
    let mut captioned = text.to_owned();
    for PlacedLink {
        whole,
        target,
        paragraph,
        ..
    } in placed_links(text).into_iter().rev()
    {
        let after = text.get(whole.end..paragraph.end).unwrap_or_default().trim_end();
        let is_alone = after.is_empty() || after.trim_start().starts_with("<!--") && after.ends_with("-->");
        if is_alone && whole.start == paragraph.start && text[whole.clone()].starts_with('!') {
            let caption = &text[whole.start + 2..target.start - 2];
            let below = format!("\n\n<div class=\"caption\">\n\n{caption}\n\n</div>\n");
            captioned.insert_str(whole.end + after.len(), &below);
        }
    }
    captioned
}
