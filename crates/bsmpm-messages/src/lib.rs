//! The codes of messages, and their catalogue.
#![doc = include_str!("../README.md")]

mod code;
mod page;

pub use code::{Kind, code_of, headed, with_context, without_code};
pub use page::{Page, catalogue, page, pages, texts};
