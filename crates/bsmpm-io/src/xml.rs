//! Reads the XML of `.vtu` and `.pvd` files.

/// XML tag, with the text up to the next tag.
pub(crate) struct Tag<'a> {
    /// Name; that of a closing tag begins with `/`.
    pub name: &'a str,
    attributes: &'a str,
    /// Text between this tag and the next.
    pub text: &'a str,
}

impl<'a> Tag<'a> {
    /// Returns the value of `key="value"`.
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

/// Iterates over the tags of a document.
pub(crate) fn tags(document: &str) -> impl Iterator<Item = Tag<'_>> {
    document.split('<').skip(1).map(|piece| {
        let (tag, text) = piece.split_once('>').unwrap_or((piece, ""));
        let tag = tag.strip_suffix('/').unwrap_or(tag);
        let (name, attributes) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
        Tag { name, attributes, text }
    })
}
