//! `bsmpm explain`: pages of the message catalogue.

use std::fmt::Write;

use bsmpm_messages::{Page, catalogue, page, pages, texts};
use clap::Args;

use crate::Error;

/// Which messages are explained.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Exit codes: 0 printed; 2 no such code, or the command line.

Examples:
  bsmpm explain W0201
  bsmpm explain               (lists all codes)")]
pub struct ExplainArguments {
    /// Codes of messages, such as W0201; without one all codes are listed
    #[arg(value_name = "CODE")]
    pub codes: Vec<String>,
    /// Print the whole catalogue, the page of the manual, in Markdown
    #[arg(long, conflicts_with = "codes")]
    pub all: bool,
}

/// The pages of the codes, the list of all codes, or the whole catalogue.
///
/// # Errors
/// [`Error::Usage`] if there is no such code.
pub fn run(arguments: &ExplainArguments) -> Result<String, Error> {
    if arguments.all {
        return Ok(catalogue());
    }
    if arguments.codes.is_empty() {
        return Ok(pages().iter().map(line).collect());
    }
    let explained: Result<Vec<String>, Error> = arguments.codes.iter().map(|code| explained(code)).collect();
    Ok(explained?.join("\n"))
}

fn line(Page { code, title, .. }: &Page) -> String {
    format!("{code}  {title}\n")
}

fn explained(code: &str) -> Result<String, Error> {
    let Some(Page { code, title, text }) = page(code) else {
        let reason = format!("E0849: there is no message with the code `{code}`. List all codes with `bsmpm explain`.");
        return Err(Error::Usage { reason });
    };
    let mut explanation = format!("{code}: {title}\n\n{}\n\nThe program prints:\n", text.replace("**", ""));
    for printed in texts(code) {
        let _ = writeln!(explanation, "  {printed}");
    }
    Ok(explanation)
}

#[cfg(test)]
mod tests {
    use super::{ExplainArguments, run};

    fn printed(codes: &[&str], all: bool) -> Result<String, crate::Error> {
        run(&ExplainArguments {
            codes: codes.iter().map(|&code| code.to_owned()).collect(),
            all,
        })
    }

    #[test]
    fn each_code_is_listed_and_explained() {
        let list = printed(&[], false).unwrap();
        for line in list.lines() {
            let (code, title) = line.split_once("  ").unwrap();
            let explanation = printed(&[&code.to_lowercase()], false).unwrap();
            assert!(
                explanation.contains(title) && explanation.contains("What to do."),
                "{explanation}"
            );
        }
        let catalogue = printed(&[], true).unwrap();
        assert_eq!(catalogue.matches("\n### ").count(), list.lines().count());
    }

    #[test]
    fn an_unknown_code_is_an_error() {
        assert!(printed(&["W9999"], false).is_err());
    }
}
