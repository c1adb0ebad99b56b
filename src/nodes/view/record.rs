//! Reads parts of records by name.

use crate::value::Value;
use glam::DVec3;

/// A record that a recipe wrote; empty if it wrote none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record<'a>(&'a [(&'static str, Value)]);

impl<'a> Record<'a> {
    /// The record in a value.
    pub(super) fn of(value: Option<&'a Value>) -> Record<'a> {
        match value {
            Some(Value::Record(parts)) => Record(parts),
            _ => Record(&[]),
        }
    }

    fn part(&self, name: &str) -> Option<&'a Value> {
        let found = self.0.iter().find(|(part, _)| *part == name);
        found.map(|(_, value)| value)
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.part(name)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    pub(super) fn vector(&self, name: &str) -> Option<DVec3> {
        match self.part(name)? {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        }
    }

    pub(super) fn colour(&self, name: &str) -> Option<[f64; 3]> {
        match self.part(name)? {
            Value::Colour(colour) => Some(*colour),
            _ => None,
        }
    }

    pub(super) fn choice(&self, name: &str) -> Option<&'static str> {
        match self.part(name)? {
            Value::Choice(name) => Some(name),
            _ => None,
        }
    }
}
