//! Canonical bytes of values: what content keys are made of and what the store holds.

use super::memory::Structure;
use crate::key::{Key, KeyHasher};
use crate::node::Kind;
use crate::value::{
    Climate, ColourPattern, Material, Mesh, Partition, Patches, Region, RingSeries, Skeleton, Type,
    Value,
};
use serde::Deserialize;
use std::sync::Arc;

/// The content key of a value.
pub(super) fn key(value: &Value) -> Key {
    let mut key = KeyHasher::new("content", 1);
    match value {
        Value::Field(field) => return field.key(),
        Value::Skeleton(_)
        | Value::ColourPattern(_)
        | Value::Climate(_)
        | Value::RingSeries(_)
        | Value::Mesh(_)
        | Value::Patches(_)
        | Value::Region(_)
        | Value::Partition(_) => {
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
            key.text(maps.format.name()).whole(i64::from(maps.is_view));
            for (channel, range) in &maps.ranges {
                key.text(channel).number(range[0]).number(range[1]);
            }
            maps.channels.iter().for_each(|channel| {
                key.text(channel);
            });
        }
        Value::Table(table) => {
            key.text("table").text(&table.text);
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
    if let Some(surface) = &material.surface {
        surface.add_to_key(key);
    }
}

/// The bytes of a structure; empty for values that are not structures.
fn structure_bytes(value: &Value) -> Vec<u8> {
    let bytes = match value {
        Value::Skeleton(skeleton) => postcard::to_stdvec(&**skeleton),
        Value::ColourPattern(pattern) => postcard::to_stdvec(&**pattern),
        Value::Climate(climate) => postcard::to_stdvec(&**climate),
        Value::RingSeries(series) => postcard::to_stdvec(&**series),
        Value::Mesh(mesh) => postcard::to_stdvec(&**mesh),
        Value::Patches(patches) => postcard::to_stdvec(&**patches),
        Value::Region(region) => postcard::to_stdvec(&**region),
        Value::Partition(partition) => postcard::to_stdvec(&**partition),
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
    let (mut rest, count) = (bytes, kind.outputs.len());
    // Nothing is made of a number in the bytes before it is known to be right.
    if take::<usize>(&mut rest)? != count {
        return None;
    }
    let outputs = kind.outputs.iter();
    let values: Option<Vec<Value>> = outputs
        .map(|output| decode_value(output.value_type, take(&mut rest)?))
        .collect();
    let values = values?;
    let warnings = (0..take::<usize>(&mut rest)?)
        .map(|_| take::<String>(&mut rest).filter(|warning| is_plain(warning)))
        .collect::<Option<Vec<String>>>()?;
    let keys = values.iter().map(key).collect();
    rest.is_empty().then_some(Structure {
        values,
        keys,
        warnings,
        taken: 0,
    })
}

fn take<'b, T: Deserialize<'b>>(bytes: &mut &'b [u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(bytes).ok()?;
    *bytes = rest;
    Some(value)
}

fn decode_value(value_type: Type, bytes: &[u8]) -> Option<Value> {
    match value_type {
        Type::Skeleton => sound(bytes, Skeleton::is_sound).map(Value::Skeleton),
        Type::ColourPattern => sound(bytes, ColourPattern::is_sound).map(Value::ColourPattern),
        Type::Climate => sound(bytes, Climate::is_sound).map(Value::Climate),
        Type::RingSeries => sound(bytes, RingSeries::is_sound).map(Value::RingSeries),
        Type::Mesh => sound(bytes, Mesh::is_sound).map(Value::Mesh),
        Type::Patches => sound(bytes, Patches::is_sound).map(Value::Patches),
        Type::Region => sound(bytes, Region::is_sound).map(Value::Region),
        Type::Partition => sound(bytes, Partition::is_sound).map(Value::Partition),
        _ => None,
    }
}

/// What the bytes hold, if it is what nodes make.
fn sound<'b, T: Deserialize<'b>>(bytes: &'b [u8], is_sound: fn(&T) -> bool) -> Option<Arc<T>> {
    let value = postcard::from_bytes(bytes).ok();
    value.filter(is_sound).map(Arc::new)
}

/// Whether a stored text can be shown: it has no characters that a terminal takes for commands.
pub(super) fn is_plain(text: &str) -> bool {
    !text.contains(|letter: char| letter.is_control() && letter != '\n' && letter != '\t')
}
