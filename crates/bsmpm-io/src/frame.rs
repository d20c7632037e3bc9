//! A frame: all material points at one time.

use std::path::Path;

use crate::Error;

/// All points at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The number of accepted steps that led here.
    pub step: u64,
    /// s, or the pseudo-time of a quasi-static analysis.
    pub time: f64,
    /// m  place of each point; the third coordinate is 0 in a plane.
    pub position: Vec<[f64; 3]>,
    /// The quantities, each with one entry per point.
    pub fields: Vec<Field>,
}

/// A frame whose points come part by part, so that nobody needs to hold all of them.
pub struct Parts<'a> {
    /// Step, time and fields; without points.
    pub head: Frame,
    /// How many points come.
    pub points: usize,
    /// Names of what fields number, each list under its own name; kept in the file for readers.
    pub names: &'a [(String, Vec<String>)],
    /// The next points, with the same step, time and fields; `None` after the last ones.
    pub next: &'a mut dyn FnMut() -> Option<Frame>,
}

/// One quantity of all points.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The name that ParaView shows: letters, digits, `_`, `-` and `.`.
    pub name: String,
    /// How many numbers a point has: 1, 3 (x, y, z) or 6 (XX YY ZZ XY YZ XZ).
    pub components: usize,
    /// The numbers, the components of a point together.
    pub values: FieldValues,
}

/// The numbers of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldValues {
    /// Physical quantities in SI units.
    F64(Vec<f64>),
    /// Numbers of points.
    U64(Vec<u64>),
    /// Numbers of materials.
    U16(Vec<u16>),
}

impl FieldValues {
    /// No numbers, of the same kind.
    fn without_points(&self) -> Self {
        match self {
            Self::F64(_) => Self::F64(Vec::new()),
            Self::U64(_) => Self::U64(Vec::new()),
            Self::U16(_) => Self::U16(Vec::new()),
        }
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::U64(values) => values.len(),
            Self::U16(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Field {
    /// A physical quantity with `components` numbers per point, in SI units.
    pub fn real(name: &str, components: usize, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            components,
            values: FieldValues::F64(values),
        }
    }
}

impl Frame {
    /// The numbers of the physical quantity `name` with `components` per point, if the frame has it.
    pub fn real(&self, name: &str, components: usize) -> Option<&[f64]> {
        let field = self
            .fields
            .iter()
            .find(|field| field.name == name && field.components == components)?;
        match &field.values {
            FieldValues::F64(values) => Some(values),
            _ => None,
        }
    }

    /// The numbers of the field `name` that numbers points, if the frame has it.
    pub fn numbers(&self, name: &str) -> Option<&[u64]> {
        match &self.fields.iter().find(|field| field.name == name)?.values {
            FieldValues::U64(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// The same without its points.
    pub fn without_points(&self) -> Self {
        let fields = self.fields.iter();
        let fields = fields.map(|field| Field {
            values: field.values.without_points(),
            name: field.name.clone(),
            ..*field
        });
        Self {
            position: Vec::new(),
            fields: fields.collect(),
            ..*self
        }
    }

    /// Whether the frame may be written to `path`.
    ///
    /// # Errors
    /// [`Error::Name`] for a name that XML or ParaView cannot take, [`Error::Length`] for a field that does not have
    /// its numbers for every point, [`Error::PointNotFinite`] for the first number that is infinite or none.
    pub fn check(&self, path: &Path) -> Result<(), Error> {
        if !self.time.is_finite() {
            return Err(Error::NotFinite {
                path: path.to_owned(),
                item: "time".to_owned(),
                value: self.time,
            });
        }
        self.check_finite(path, "position", 3, self.position.as_flattened())?;
        for (index, field) in self.fields.iter().enumerate() {
            self.check_name(path, index)?;
            let expected = self.position.len() * field.components;
            if field.values.len() != expected || field.components == 0 {
                let item = field.name.clone();
                let found = field.values.len();
                return Err(Error::Length {
                    path: path.to_owned(),
                    item,
                    expected,
                    found,
                });
            }
            if let FieldValues::F64(values) = &field.values {
                self.check_finite(path, &field.name, field.components, values)?;
            }
        }
        Ok(())
    }

    fn check_name(&self, path: &Path, index: usize) -> Result<(), Error> {
        let name = &self.fields[index].name;
        let is_plain = name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
        let reason = if name.is_empty() || !is_plain {
            "has characters other than letters, digits, `_`, `-` and `.`"
        } else if self.fields[..index].iter().any(|other| other.name == *name) {
            "is used for two fields"
        } else {
            return Ok(());
        };
        Err(Error::Name {
            path: path.to_owned(),
            name: name.clone(),
            reason,
        })
    }

    fn check_finite(&self, path: &Path, field: &str, components: usize, values: &[f64]) -> Result<(), Error> {
        let Some(bad) = values.iter().position(|value| !value.is_finite()) else {
            return Ok(());
        };
        Err(Error::PointNotFinite {
            path: path.to_owned(),
            field: field.to_owned(),
            component: bad % components,
            point: self.id(bad / components),
            value: values[bad],
        })
    }

    fn id(&self, index: usize) -> u64 {
        let ids = self
            .fields
            .iter()
            .find(|field| field.name == "id")
            .map(|field| &field.values);
        match ids {
            Some(FieldValues::U64(ids)) => ids.get(index).copied().unwrap_or(index as u64),
            _ => index as u64,
        }
    }
}
