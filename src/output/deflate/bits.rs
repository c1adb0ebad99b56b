//! A stream of bits, the lowest of each byte first.

use super::huffman::Word;

/// Bits on their way to bytes.
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    /// Bits that do not fill a byte yet; after [`BitWriter::flush`] fewer than eight.
    buffer: u64,
    count: u32,
    /// Bytes of `bytes` that are final.
    position: usize,
}

impl BitWriter {
    /// A writer with room for `capacity` bytes and what the last flush writes beyond.
    pub(super) fn new(capacity: usize) -> BitWriter {
        BitWriter {
            bytes: vec![0; capacity + size_of::<u64>()],
            buffer: 0,
            count: 0,
            position: 0,
        }
    }

    /// Appends bits; no more than 56 may come between two flushes.
    #[inline]
    pub(super) fn put(&mut self, bits: u64, count: u32) {
        self.buffer |= bits << self.count;
        self.count += count;
    }

    #[inline]
    pub(super) fn word(&mut self, word: Word) {
        self.put(word.bits.into(), word.length.into());
    }

    /// Moves all whole bytes on.
    ///
    /// # Panics
    /// If the room is used up.
    #[inline]
    pub(super) fn flush(&mut self) {
        let place = &mut self.bytes[self.position..self.position + 8];
        place.copy_from_slice(&self.buffer.to_le_bytes());
        self.position += (self.count / 8) as usize;
        self.buffer >>= self.count & !7;
        self.count &= 7;
    }

    /// Fills up the last byte with zeros.
    pub(super) fn align(&mut self) {
        self.count = self.count.next_multiple_of(8);
        self.flush();
    }

    /// The bytes so far, which are whole ones.
    pub(super) fn finish(mut self) -> Vec<u8> {
        self.align();
        self.bytes.truncate(self.position);
        self.bytes
    }
}
