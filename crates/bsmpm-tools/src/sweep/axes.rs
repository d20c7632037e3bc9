//! Forms all combinations of the keys and values that a sweep varies.

/// Settings of a sweep at most; more is a mistake in a list.
const MOST: usize = 10_000;

/// A key with its values, in the syntax of `--set`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SweepAxis {
    pub key: String,
    pub values: Vec<String>,
}

/// A value for each axis; none where the case's own stays.
pub(super) type SweepSetting = Vec<Option<String>>;

impl SweepAxis {
    /// `KEY=V1,V2,...`; a comma within brackets, braces or quotes belongs to a value.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::read(text).map_err(|why| {
            format!(
                "E0838: --vary {text} is invalid: {why}. Give a key and its values as KEY=V1,V2,..., each \
                value once."
            )
        })
    }

    /// As [`SweepAxis::parse`]; the error says in a few words what is wrong.
    fn read(text: &str) -> Result<Self, String> {
        let (key, values) = text.split_once('=').ok_or("`=` is missing")?;
        let key = key.trim().to_owned();
        let values = split(values);
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err("the key or a value is empty".to_owned());
        }
        match (1..values.len()).find(|&index| values[..index].contains(&values[index])) {
            Some(twice) => Err(format!("the value {} occurs twice", values[twice])),
            None => Ok(Self { key, values }),
        }
    }
}

/// The parts between the commas that stand in no bracket, brace or quote.
pub(crate) fn split(text: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut depth = 0_usize;
    let mut quote = None;
    for c in text.chars() {
        match (c, quote) {
            ('"' | '\'', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth = depth.saturating_sub(1),
            _ => {}
        }
        match parts.last_mut() {
            Some(part) if !(c == ',' && depth == 0 && quote.is_none()) => part.push(c),
            _ => parts.push(String::new()),
        }
    }
    parts.iter().map(|part| part.trim().to_owned()).collect()
}

/// Every combination of the axes' values, the last axis fastest; or the case's own values with one of them replaced at
/// a time.
///
/// # Errors
/// Says that a key is varied twice, or that there are too many.
pub(super) fn settings(axes: &[SweepAxis], one_at_a_time: bool) -> Result<Vec<SweepSetting>, String> {
    if let Some(twice) = (1..axes.len()).find(|&index| axes[..index].iter().any(|axis| axis.key == axes[index].key)) {
        return Err(format!(
            "E0838: --vary is given twice for the key {}. Give all values of this key in one option, as KEY=V1,V2,...",
            axes[twice].key
        ));
    }
    let count = axes
        .iter()
        .fold(1_usize, |count, axis| count.saturating_mul(axis.values.len()));
    if count > MOST && !one_at_a_time {
        return Err(format!(
            "E0839: the sweep has {count} combinations of values (limit: {MOST}). Give fewer values, or use \
             --one-at-a-time."
        ));
    }
    let own: SweepSetting = vec![None; axes.len()];
    let mut settings = vec![own.clone()];
    for (index, axis) in axes.iter().enumerate() {
        let bases = if one_at_a_time {
            vec![own.clone()]
        } else {
            std::mem::take(&mut settings)
        };
        for base in &bases {
            for value in &axis.values {
                let mut setting = base.clone();
                setting[index] = Some(value.clone());
                settings.push(setting);
            }
        }
    }
    Ok(settings)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> SweepAxis {
        SweepAxis::parse(text).unwrap()
    }

    #[test]
    fn values_keep_their_syntax() {
        assert_eq!(axis("grid.cell=10 mm, 5mm").values, ["10 mm", "5mm"]);
        assert_eq!(
            axis("grid.cell=[1, 2],[\"1 m\", 0.5]").values,
            ["[1, 2]", "[\"1 m\", 0.5]"]
        );
        assert_eq!(axis("title=\"a, b\"").values, ["\"a, b\""]);
        assert_eq!(axis("a.b={c = 1, d = [2, 3]},{c = 2}").values.len(), 2);
        for text in ["grid.cell", "=1", "a=", "a=1,,2", "a=1,1"] {
            assert!(SweepAxis::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn settings_are_the_product_or_one_at_a_time() {
        let axes = [axis("a=1,2"), axis("b=x,y,z")];
        let shown = |one| {
            let settings = settings(&axes, one).unwrap();
            let word = |value: &Option<String>| value.clone().unwrap_or_else(|| "-".into());
            settings
                .iter()
                .map(|setting| setting.iter().map(word).collect::<String>())
                .collect::<Vec<_>>()
        };
        assert_eq!(shown(false), ["1x", "1y", "1z", "2x", "2y", "2z"]);
        assert_eq!(shown(true), ["--", "1-", "2-", "-x", "-y", "-z"]);
        assert!(settings(&[axis("a=1"), axis("a=2")], false).is_err());
        let long = SweepAxis {
            key: "a".into(),
            values: (0..200).map(|value| value.to_string()).collect(),
        };
        assert!(
            settings(
                &[
                    long.clone(),
                    SweepAxis {
                        key: "b".into(),
                        ..long
                    }
                ],
                false
            )
            .is_err()
        );
    }
}
