//! The message catalogue: a page for each code.

use std::fmt::Write;
use std::sync::LazyLock;

/// An area of the catalogue: its heading, and its pages in Markdown.
struct Area {
    heading: &'static str,
    pages: &'static str,
}

/// The areas in the order of the manual.
const AREAS: [Area; 10] = [
    Area {
        heading: "Reading a case file (00)",
        pages: include_str!("pages/reading.md"),
    },
    Area {
        heading: "Plausibility (01)",
        pages: include_str!("pages/plausibility.md"),
    },
    Area {
        heading: "Grid, bodies and boundaries (02)",
        pages: include_str!("pages/ground.md"),
    },
    Area {
        heading: "Materials and initial stresses (03)",
        pages: include_str!("pages/materials.md"),
    },
    Area {
        heading: "Loads, footings, rigid bodies and contact (04)",
        pages: include_str!("pages/loads.md"),
    },
    Area {
        heading: "Water (05)",
        pages: include_str!("pages/water.md"),
    },
    Area {
        heading: "Analysis, stages, solver and output (06)",
        pages: include_str!("pages/analysis.md"),
    },
    Area {
        heading: "The run (07)",
        pages: include_str!("pages/run.md"),
    },
    Area {
        heading: "Tools (08)",
        pages: include_str!("pages/tools.md"),
    },
    Area {
        heading: "Indicators",
        pages: include_str!("pages/indicators.md"),
    },
];

/// Every text with a code that stands in the sources, a line each; a test compares it with the sources.
const TEXTS: &str = include_str!("texts.txt");

/// What explains one code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// The code, such as `W0206`.
    pub code: &'static str,
    /// The cause in a few words.
    pub title: &'static str,
    /// Meaning, why it matters, what to do and an example, in Markdown.
    pub text: &'static str,
}

impl Page {
    /// Reads `CODE: TITLE` and the text below it.
    fn parse(section: &'static str) -> Self {
        let (heading, text) = section.split_once('\n').unwrap_or((section, ""));
        let (code, title) = heading.split_once(": ").unwrap_or((heading, ""));
        Self {
            code,
            title,
            text: text.trim(),
        }
    }
}

impl Area {
    fn parse(&self) -> Vec<Page> {
        let sections = self.pages.split("\n## ").skip(1);
        sections.map(Page::parse).collect()
    }
}

static PAGES: LazyLock<Vec<Page>> = LazyLock::new(|| AREAS.iter().flat_map(Area::parse).collect());

/// All pages, by area and code.
pub fn pages() -> &'static [Page] {
    &PAGES
}

/// The page of a code in either case of its letter.
pub fn page(code: &str) -> Option<&'static Page> {
    pages().iter().find(|page| page.code.eq_ignore_ascii_case(code))
}

/// Texts that the programs print with a code, with `…` for names and numbers.
pub fn texts(code: &str) -> impl Iterator<Item = &'static str> {
    TEXTS
        .lines()
        .filter_map(move |line| line.strip_prefix(code)?.strip_prefix(": "))
}

/// The catalogue as a page of the manual, in Markdown.
pub fn catalogue() -> String {
    let mut manual = include_str!("pages/introduction.md").to_owned();
    for area in &AREAS {
        let _ = write!(manual, "\n## {}\n", area.heading);
        for Page { code, title, text } in area.parse() {
            let _ = write!(manual, "\n### {code}: {title}\n\n{text}\n");
        }
    }
    manual
}
