//! Reads the XML of `.vtu` and `.pvd` files.

/// One tag, with the text that follows it up to the next one.
pub(crate) struct Tag<'a> {
    /// The name; that of a closing tag begins with `/`.
    pub name: &'a str,
    attributes: &'a str,
    /// What stands between this tag and the next.
    pub text: &'a str,
}

impl<'a> Tag<'a> {
    /// The value of `key="value"`.
    pub fn attribute(&self, key: &str) -> Option<&'a str> {
        let mut rest = self.attributes;
        loop {
            let (name, after) = rest.split_once("=\"")?;
            let (value, tail) = after.split_once('"')?;
            if name.trim() == key {
                return Some(value);
            }
            rest = tail;
        }
    }
}

/// The tags of a document, in order.
pub(crate) fn tags(document: &str) -> impl Iterator<Item = Tag<'_>> {
    document.split('<').skip(1).map(|piece| {
        let (tag, text) = piece.split_once('>').unwrap_or((piece, ""));
        let tag = tag.strip_suffix('/').unwrap_or(tag);
        let (name, attributes) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
        Tag { name, attributes, text }
    })
}
