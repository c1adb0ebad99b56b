//! Canonical bytes of values: what content keys are made of and what the store holds.

use super::memory::Structure;
use crate::key::{Key, KeyHasher};
use crate::node::Kind;
use crate::value::{Material, Type, Value};
use std::sync::Arc;

/// The content key of a value.
pub(super) fn key(value: &Value) -> Key {
    let mut key = KeyHasher::new("content", 1);
    match value {
        Value::Field(field) => return field.key(),
        Value::Skeleton(_) | Value::ColourPattern(_) => {
            key.text(value.type_name()).bytes(&structure_bytes(value));
        }
        Value::Material(material) => add_material(&mut key, material),
        Value::Maps(maps) => {
            add_material(key.text("maps"), &maps.material);
            maps.pixels.iter().for_each(|side| {
                key.whole(i64::from(*side));
            });
            maps.size.iter().for_each(|length| {
                key.number(*length);
            });
            key.text(maps.format.name());
            for (channel, range) in &maps.ranges {
                key.text(channel).number(range[0]).number(range[1]);
            }
            maps.channels.iter().for_each(|channel| {
                key.text(channel);
            });
        }
        literal => literal.add_to_key(&mut key),
    }
    key.finish()
}

fn add_material(key: &mut KeyHasher, material: &Material) {
    key.text("material").text(&material.domain.to_string());
    for (name, field) in &material.channels {
        key.text(name).key(field.key());
    }
    material.size.iter().flatten().for_each(|length| {
        key.number(*length);
    });
}

/// The bytes of a structure; empty for values that are not structures.
fn structure_bytes(value: &Value) -> Vec<u8> {
    let bytes = match value {
        Value::Skeleton(skeleton) => postcard::to_stdvec(&**skeleton),
        Value::ColourPattern(pattern) => postcard::to_stdvec(&**pattern),
        _ => Ok(vec![]),
    };
    bytes.expect("plain data always has bytes")
}

/// The outputs of a structure node, and what it warned of, as bytes.
pub(super) fn encode(values: &[Value], warnings: &[String]) -> Vec<u8> {
    let parts: Vec<Vec<u8>> = values.iter().map(structure_bytes).collect();
    postcard::to_stdvec(&(parts, warnings)).expect("plain data always has bytes")
}

/// The outputs of a node of `kind` from bytes; `None` if they are not what [`encode`] writes.
pub(super) fn decode(kind: &Kind, bytes: &[u8]) -> Option<Structure> {
    let (parts, warnings): (Vec<Vec<u8>>, Vec<String>) = postcard::from_bytes(bytes).ok()?;
    if parts.len() != kind.outputs.len() {
        return None;
    }
    let decode = |(output, bytes): (&crate::node::Output, &Vec<u8>)| match output.value_type {
        Type::Skeleton => postcard::from_bytes(bytes)
            .ok()
            .map(|value| Value::Skeleton(Arc::new(value))),
        Type::ColourPattern => postcard::from_bytes(bytes)
            .ok()
            .map(|value| Value::ColourPattern(Arc::new(value))),
        _ => None,
    };
    let values: Option<Vec<Value>> = kind.outputs.iter().zip(&parts).map(decode).collect();
    let values = values?;
    let keys = values.iter().map(key).collect();
    Some(Structure {
        values,
        keys,
        warnings,
        taken: 0,
    })
}
