//! Keys: the hashes by which Yosegi knows whether two things are the same.
//!
//! A key is blake3 over canonical bytes: strings with their length, numbers as the bits of a
//! 64-bit float with -0 written as 0. Recipe text, names of nodes and time stamps never enter one.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::{self, Read};

/// The hash that identifies a value, a field or an output.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Key([u8; 32]);

impl Key {
    /// The key of plain bytes, for example the contents of a file.
    pub fn of_bytes(bytes: &[u8]) -> Key {
        Key(*blake3::hash(bytes).as_bytes())
    }

    /// The key of the bytes that a stream gives, with their number.
    ///
    /// # Errors
    /// Whatever the stream says.
    pub fn of_stream(stream: &mut dyn Read) -> io::Result<(Key, u64)> {
        let mut hasher = blake3::Hasher::new();
        let mut buffer = vec![0; 1 << 16];
        let mut length = 0;
        loop {
            let read = match stream.read(&mut buffer) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read?,
            };
            if read == 0 {
                return Ok((Key(*hasher.finalize().as_bytes()), length));
            }
            hasher.update(&buffer[..read]);
            length += read as u64;
        }
    }

    /// The 64 hexadecimal digits of the key, as written into maps and names of cache entries.
    pub fn hexadecimal(&self) -> String {
        blake3::Hash::from_bytes(self.0).to_hex().to_string()
    }

    /// The key with these hexadecimal digits; `None` if it is not 64 of them.
    pub fn from_hexadecimal(digits: &str) -> Option<Key> {
        blake3::Hash::from_hex(digits)
            .ok()
            .map(|hash| Key(*hash.as_bytes()))
    }

    /// The first eight bytes as a number, where a short hash is enough.
    pub fn short(&self) -> u64 {
        let [a, b, c, d, e, f, g, h, ..] = self.0;
        u64::from_le_bytes([a, b, c, d, e, f, g, h])
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", &self.hexadecimal()[..12])
    }
}

impl fmt::Display for Key {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.hexadecimal())
    }
}

/// Collects canonical bytes and hashes them into a [`Key`].
#[derive(Clone)]
pub struct KeyHasher(blake3::Hasher);

impl KeyHasher {
    /// Starts a key for the thing called `what`, in its `version`.
    pub fn new(what: &str, version: u32) -> KeyHasher {
        let mut hasher = KeyHasher(blake3::Hasher::new());
        hasher.text(what).whole(i64::from(version));
        hasher
    }

    /// Adds text, with its length.
    pub fn text(&mut self, text: &str) -> &mut KeyHasher {
        self.bytes(text.as_bytes())
    }

    /// Adds bytes, with their length.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut KeyHasher {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
        self
    }

    /// Adds bytes without their length: nothing but more of the same kind may follow.
    pub fn part(&mut self, bytes: &[u8]) -> &mut KeyHasher {
        self.0.update(bytes);
        self
    }

    /// Adds a number; -0 and 0 are the same.
    pub fn number(&mut self, number: f64) -> &mut KeyHasher {
        self.0.update(&(number + 0.0).to_bits().to_le_bytes());
        self
    }

    /// Adds a whole number.
    pub fn whole(&mut self, number: i64) -> &mut KeyHasher {
        self.0.update(&number.to_le_bytes());
        self
    }

    /// Adds another key.
    pub fn key(&mut self, key: Key) -> &mut KeyHasher {
        self.0.update(&key.0);
        self
    }

    /// The finished key.
    pub fn finish(&self) -> Key {
        Key(*self.0.finalize().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_read_back_from_its_digits() {
        let key = Key::of_bytes(b"wood");
        assert_eq!(Key::from_hexadecimal(&key.hexadecimal()), Some(key));
        assert_eq!(Key::from_hexadecimal(&key.hexadecimal()[1..]), None);
        assert_eq!(Key::from_hexadecimal(&"x".repeat(64)), None);
    }

    #[test]
    fn zero_has_one_key_and_lengths_keep_texts_apart() {
        let key = |number: f64| KeyHasher::new("test", 1).number(number).finish();
        assert_eq!(key(0.0), key(-0.0));
        assert_ne!(key(1.0), key(f64::from_bits(1.0f64.to_bits() + 1)));
        let texts = |a: &str, b: &str| KeyHasher::new("test", 1).text(a).text(b).finish();
        assert_ne!(texts("ab", "c"), texts("a", "bc"));
    }
}
