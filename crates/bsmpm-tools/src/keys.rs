//! `bsmpm keys`: the reference of the keys of a case file.

mod json_schema;

use clap::Args;
pub use json_schema::json_schema;

/// In which form the keys are printed.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Exit codes: 0 printed; 2 the command line.

Examples:
  bsmpm keys
  bsmpm keys --json-schema > bsmpm.schema.json")]
pub struct KeysArguments {
    /// Print a JSON Schema (draft 7) for editors in place of the Markdown page
    #[arg(long)]
    pub json_schema: bool,
}

/// The reference as a page in Markdown or as a JSON Schema.
pub fn run(arguments: &KeysArguments) -> String {
    if arguments.json_schema {
        json_schema()
    } else {
        bsmpm_scene::reference()
    }
}
