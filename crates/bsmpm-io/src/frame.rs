//! A frame: all material points at one time.

use std::path::Path;

use crate::Error;

/// All material points at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Number of accepted steps so far.
    pub step: u64,
    /// Time (s, or the pseudo-time of a quasi-static analysis).
    pub time: f64,
    /// Position of each point (m); the third coordinate is 0 in a plane.
    pub position: Vec<[f64; 3]>,
    /// Quantities, each with one entry per point.
    pub fields: Vec<Field>,
}

/// Frame whose points are supplied in parts, so that not all of them are in memory at once.
pub struct Parts<'a> {
    /// Step, time and fields, without points.
    pub head: Frame,
    /// Total number of points.
    pub points: usize,
    /// Names for the numbers in a field (e.g. of materials), by the name of the list. The file contains them for
    /// readers.
    pub names: &'a [(String, Vec<String>)],
    /// Returns the next points, with the same step, time and fields; `None` after the last ones.
    pub next: &'a mut dyn FnMut() -> Option<Frame>,
}

/// One quantity of all points.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name that ParaView shows: letters, digits, `_`, `-` and `.`.
    pub name: String,
    /// Count of numbers per point: 1, 3 (x, y, z) or 6 (XX YY ZZ XY YZ XZ).
    pub components: usize,
    /// Numbers, point by point.
    pub values: FieldValues,
}

/// Numbers of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldValues {
    /// Physical quantities in SI units.
    F64(Vec<f64>),
    /// Ids of points.
    U64(Vec<u64>),
    /// Numbers of materials.
    U16(Vec<u16>),
}

impl FieldValues {
    /// Returns an empty list of the same type.
    fn without_points(&self) -> Self {
        match self {
            Self::F64(_) => Self::F64(Vec::new()),
            Self::U64(_) => Self::U64(Vec::new()),
            Self::U16(_) => Self::U16(Vec::new()),
        }
    }

    /// Returns the count of numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::U64(values) => values.len(),
            Self::U16(values) => values.len(),
        }
    }

    /// Returns whether there are no numbers.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Field {
    /// Creates a physical quantity with `components` numbers per point, in SI units.
    pub fn real(name: &str, components: usize, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            components,
            values: FieldValues::F64(values),
        }
    }
}

impl Frame {
    /// Returns the numbers of the physical quantity `name` with `components` per point, if the frame has it.
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

    /// Returns the numbers of the field `name` of ids, if the frame has it.
    pub fn numbers(&self, name: &str) -> Option<&[u64]> {
        match &self.fields.iter().find(|field| field.name == name)?.values {
            FieldValues::U64(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Returns the same frame without its points.
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

    /// Checks whether the frame may be written to `path`.
    ///
    /// # Errors
    /// [`Error::Name`] for a name that XML or ParaView cannot represent; [`Error::Length`] for a field without numbers
    /// for every point; [`Error::PointNotFinite`] for the first number that is not finite; [`Error::NotFinite`] for the
    /// time.
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
