//! The bytes of an entry: a header that says what it is, and what is stored.
//!
//! The header is text: the layout, the checksum of all that follows from it, the key, the family and the
//! number of bytes stored. A file that is not exactly that is no entry.

use super::family::Family;
use crate::key::{Key, KeyHasher};
use crate::world::World;
use std::io::{self, Read};
use std::path::Path;

/// Raised when the layout of entries changes.
const LAYOUT: &[u8; 8] = b"yosegi02";

/// What every layout begins with.
const LAYOUT_NAME: &[u8] = b"yosegi";

/// Places of the header's parts: after the layout 64 digits of the checksum, 64 of the key, the family's name
/// filled up with spaces, and 16 digits of the length.
const KEY: usize = LAYOUT.len() + 64;
const HEADER: usize = KEY + 64 + 16 + 16;

/// What is found where an entry should be.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// The entry; this is what is stored in it.
    Whole(Vec<u8>),
    /// Nothing that can be read, or nothing of ours.
    Nothing,
    /// An entry of ours that is damaged.
    Damaged,
}

/// The header of an entry.
pub(super) fn header(family: Family, key: &Key, payload: &[u8]) -> Vec<u8> {
    let checksum = KeyHasher::new(family.name(), 2)
        .key(*key)
        .bytes(payload)
        .finish();
    let mut header = LAYOUT.to_vec();
    header.extend_from_slice(checksum.hexadecimal().as_bytes());
    header.extend_from_slice(&rest(family, key, payload.len() as u64));
    header
}

/// The header behind the checksum.
fn rest(family: Family, key: &Key, length: u64) -> Vec<u8> {
    format!("{}{:16}{length:016x}", key.hexadecimal(), family.name()).into_bytes()
}

/// The size of an entry with so many bytes stored in it.
pub(super) fn whole_size(payload: usize) -> u64 {
    HEADER as u64 + payload as u64
}

/// Reads the entry at `path`. No more is read than its header says and its family may have.
pub(super) fn read(world: &dyn World, path: &Path, family: Family, key: &Key) -> Found {
    let Ok(mut stream) = world.open(path) else {
        return Found::Nothing;
    };
    let mut start = vec![];
    if take(&mut *stream, HEADER as u64, &mut start).is_err() {
        return Found::Nothing;
    }
    if !start.starts_with(LAYOUT) {
        return if is_lost(&start) {
            Found::Damaged
        } else {
            Found::Nothing
        };
    }
    let Some(length) = stored_length(&start, family, key) else {
        return Found::Damaged;
    };
    let mut payload = vec![];
    // One byte more tells whether something follows.
    match take(&mut *stream, length + 1, &mut payload) {
        Err(_) => Found::Nothing,
        Ok(_) if payload.len() as u64 != length => Found::Damaged,
        Ok(_) if start != header(family, key, &payload) => Found::Damaged,
        Ok(_) => Found::Whole(payload),
    }
}

/// Whether the header at `path` is that of an entry; what follows it is not looked at.
pub(super) fn is_begun(world: &dyn World, path: &Path, family: Family, key: &Key) -> bool {
    let start = world.read_start(path, HEADER);
    start.is_ok_and(|start| stored_length(&start, family, key).is_some())
}

/// The number of bytes stored, if the header is one of this family and key.
fn stored_length(header: &[u8], family: Family, key: &Key) -> Option<u64> {
    let digits = header.get(HEADER - 16..HEADER)?;
    let length = u64::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
    let is_one = header.starts_with(LAYOUT) && header[KEY..HEADER] == rest(family, key, length);
    (is_one && length <= family.most_bytes()).then_some(length)
}

/// Whether a file with the name of an entry was begun as one, in any layout, or has lost its contents when
/// the power failed.
pub(super) fn is_ours(world: &dyn World, path: &Path) -> bool {
    let start = world.read_start(path, LAYOUT.len());
    start.is_ok_and(|start| start.starts_with(LAYOUT_NAME) || is_lost(&start))
}

/// Whether a file begins as one does whose contents never reached the disk.
fn is_lost(start: &[u8]) -> bool {
    let start = &start[..start.len().min(LAYOUT.len())];
    start.iter().all(|byte| *byte == 0)
}

fn take(stream: &mut dyn Read, most: u64, bytes: &mut Vec<u8>) -> io::Result<usize> {
    stream.take(most).read_to_end(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Memory;

    const PATH: &str = "entry";

    fn key() -> Key {
        Key::of_bytes(b"key")
    }

    fn whole(family: Family, payload: &[u8]) -> Vec<u8> {
        [&header(family, &key(), payload)[..], payload].concat()
    }

    fn found(bytes: Vec<u8>) -> Found {
        let world = Memory::default();
        world.insert(PATH, bytes);
        read(&world, Path::new(PATH), Family::Plan, &key())
    }

    #[test]
    fn an_entry_is_read_back_and_has_the_size_that_is_counted() {
        for payload in [&b""[..], b"payload", &[0; 1000]] {
            let entry = whole(Family::Plan, payload);
            assert_eq!(entry.len() as u64, whole_size(payload.len()));
            assert_eq!(found(entry), Found::Whole(payload.to_vec()));
        }
    }

    #[test]
    fn an_entry_that_is_cut_short_or_goes_on_is_none() {
        let entry = whole(Family::Plan, b"payload");
        for length in 0..entry.len() {
            let found = found(entry[..length].to_vec());
            // A piece of the layout's name could be anything.
            let is_ours = length == 0 || length >= LAYOUT.len();
            let expected = if is_ours {
                Found::Damaged
            } else {
                Found::Nothing
            };
            assert_eq!(found, expected, "{length}");
        }
        for more in [&b"\0"[..], b"x", &[7; 100]] {
            assert_eq!(found([&entry, more].concat()), Found::Damaged);
        }
    }

    #[test]
    fn an_entry_with_any_bit_turned_is_none() {
        let entry = whole(Family::Plan, b"payload");
        for bit in 0..8 * entry.len() {
            let mut turned = entry.clone();
            turned[bit / 8] ^= 1 << (bit % 8);
            assert!(!matches!(found(turned), Found::Whole(_)), "{bit}");
        }
    }

    #[test]
    fn entries_of_another_key_family_or_layout_are_none() {
        let entry = whole(Family::Plan, b"payload");
        let other = Key::of_bytes(b"other");
        let other = [&header(Family::Plan, &other, b"payload")[..], b"payload"].concat();
        assert_eq!(found(other), Found::Damaged);
        assert_eq!(found(whole(Family::Run, b"payload")), Found::Damaged);
        for layout in [b"yosegi01", b"yosegi03", b"foreign!"] {
            let other = [layout, &entry[LAYOUT.len()..]].concat();
            assert_eq!(found(other), Found::Nothing);
        }
        assert_eq!(found(vec![0; entry.len()]), Found::Damaged);
    }

    #[test]
    fn no_more_is_read_than_a_family_may_have() {
        let length = Family::Map.most_bytes() + 1;
        let mut entry = LAYOUT.to_vec();
        entry.extend([b'0'; 64]);
        entry.extend(rest(Family::Map, &key(), length));
        assert_eq!(stored_length(&entry, Family::Map, &key()), None);
        let world = Memory::default();
        world.insert(PATH, entry);
        let path = Path::new(PATH);
        assert!(!is_begun(&world, path, Family::Map, &key()));
        world.insert(PATH, whole(Family::Map, b"payload"));
        assert!(is_begun(&world, path, Family::Map, &key()));
        assert!(!is_begun(&world, path, Family::File, &key()));
    }

    #[test]
    fn what_begins_as_an_entry_of_any_layout_is_ours() {
        let world = Memory::default();
        for (bytes, expected) in [
            (&b"yosegi01 and more"[..], true),
            (b"yosegi99", true),
            (b"", true),
            (&[0; 100], true),
            (b"yose", false),
            (b"\0\0mine", false),
            (b"a picture", false),
        ] {
            world.insert(PATH, bytes);
            assert_eq!(is_ours(&world, Path::new(PATH)), expected, "{bytes:?}");
        }
    }
}
