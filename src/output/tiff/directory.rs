//! The directory of a TIFF: what stands in front of its strips, written and read.

use crate::output::strips::Division;
use crate::output::{CHANNEL_NAME, KEY_NAME, MapKind, MapRequest, SOFTWARE};

const DESCRIPTION: u16 = 270;
const STRIP_OFFSETS: u16 = 273;
const STRIP_BYTES: u16 = 279;

/// Types of values, and the bytes of each.
const ASCII: u16 = 2;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const LONG8: u16 = 16;

/// Adobe's number for the streams of RFC 1950.
const DEFLATE: u16 = 8;

/// White and the primaries of ITU-R BT.709, in ten-thousandths: white, then red, green and blue.
const WHITE: [u32; 2] = [3127, 3290];
const PRIMARIES: [u32; 6] = [6400, 3300, 3000, 6000, 1500, 600];

/// The one directory of a file.
pub(super) struct Directory {
    /// Sorted by tag, without those of the strips.
    fields: Vec<Field>,
    offsets: Vec<u64>,
    lengths: Vec<u64>,
    /// Whether offsets take 64 bits, as in BigTIFF.
    is_big: bool,
}

/// A tag with its values, little-endian.
struct Field {
    tag: u16,
    value_type: u16,
    count: u64,
    values: Vec<u8>,
}

impl Field {
    fn shorts(tag: u16, values: &[u16]) -> Field {
        Field {
            tag,
            value_type: SHORT,
            count: values.len() as u64,
            values: values.iter().flat_map(|it| it.to_le_bytes()).collect(),
        }
    }

    fn long(tag: u16, value: u32) -> Field {
        Field {
            tag,
            value_type: LONG,
            count: 1,
            values: value.to_le_bytes().to_vec(),
        }
    }

    fn text(tag: u16, text: &str) -> Field {
        let values = [text.as_bytes(), &[0]].concat();
        Field {
            tag,
            value_type: ASCII,
            count: values.len() as u64,
            values,
        }
    }

    fn fractions(tag: u16, numerators: &[u32], denominator: u32) -> Field {
        let parts = numerators.iter().flat_map(|it| [*it, denominator]);
        Field {
            tag,
            value_type: RATIONAL,
            count: numerators.len() as u64,
            values: parts.flat_map(u32::to_le_bytes).collect(),
        }
    }

    /// A table with a place for every strip, in 32 or 64 bits.
    fn table(tag: u16, values: &[u64], is_big: bool) -> Field {
        let bytes = |value: &u64| {
            let wide = value.to_le_bytes();
            wide[..if is_big { 8 } else { 4 }].to_vec()
        };
        Field {
            tag,
            value_type: if is_big { LONG8 } else { LONG },
            count: values.len() as u64,
            values: values.iter().flat_map(bytes).collect(),
        }
    }
}

impl Directory {
    /// The directory of a file with strips whose places are not known yet. It is a BigTIFF where the samples
    /// alone might pass 4 GiB, however well they are compressed: the size of the picture decides.
    pub(super) fn new(request: &MapRequest, division: Division) -> Directory {
        // No strip grows by more than 5 bytes for every 65,535 and some.
        let pixels = division.row_bytes as u64 * division.height as u64;
        let most = pixels + pixels / 8192 + 64 * division.count as u64 + (1 << 16);
        Directory::with_offsets(request, division, most > u64::from(u32::MAX))
    }

    /// As [`Directory::new`], with offsets of 64 bits if `is_big`, or of 32.
    pub(super) fn with_offsets(
        request: &MapRequest,
        division: Division,
        is_big: bool,
    ) -> Directory {
        Directory {
            fields: fields(request, division),
            offsets: vec![0; division.count],
            lengths: vec![0; division.count],
            is_big,
        }
    }

    /// Enters where a strip lies.
    pub(super) fn place(&mut self, strip: usize, offset: u64, length: u64) {
        self.offsets[strip] = offset;
        self.lengths[strip] = length;
    }

    /// The start of the file: header, directory, values that do not fit into it. The tables of the strips are
    /// last, so that everything else lies within the first thousand bytes.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let offsets = Field::table(STRIP_OFFSETS, &self.offsets, self.is_big);
        let lengths = Field::table(STRIP_BYTES, &self.lengths, self.is_big);
        let values = Values::new(self.is_big, self.fields.len() + 2);
        let mut entries: Vec<(u16, Vec<u8>)> = vec![];
        let mut values = values;
        for field in self.fields.iter().chain([&offsets, &lengths]) {
            entries.push((field.tag, values.entry(field)));
        }
        entries.sort();
        values.head(&entries)
    }
}

/// Values behind the directory while it is put together.
struct Values {
    is_big: bool,
    /// Bytes in front of them.
    start: usize,
    bytes: Vec<u8>,
}

impl Values {
    fn new(is_big: bool, entries: usize) -> Values {
        Values {
            is_big,
            start: if is_big {
                16 + 8 + 20 * entries + 8
            } else {
                8 + 2 + 12 * entries + 4
            },
            bytes: vec![],
        }
    }

    /// A number in the width of offsets.
    fn offset(&self, value: u64) -> Vec<u8> {
        value.to_le_bytes()[..if self.is_big { 8 } else { 4 }].to_vec()
    }

    /// The entry of a field; values that do not fit into it go behind the directory.
    fn entry(&mut self, field: &Field) -> Vec<u8> {
        let mut entry = [field.tag, field.value_type].map(u16::to_le_bytes).concat();
        entry.extend(self.offset(field.count));
        let mut place = self.offset(0);
        if field.values.len() <= place.len() {
            place[..field.values.len()].copy_from_slice(&field.values);
        } else {
            place = self.offset((self.start + self.bytes.len()) as u64);
            self.bytes.extend_from_slice(&field.values);
            // Offsets are even; those of 64 bits are kept whole.
            self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        }
        entry.extend(place);
        entry
    }

    /// Everything in its order, with no further directory.
    fn head(self, entries: &[(u16, Vec<u8>)]) -> Vec<u8> {
        let mut head = b"II".to_vec();
        if self.is_big {
            head.extend([43, 0, 8, 0, 0, 0]);
            head.extend(16u64.to_le_bytes());
            head.extend((entries.len() as u64).to_le_bytes());
        } else {
            head.extend([42, 0, 8, 0, 0, 0]);
            head.extend((entries.len() as u16).to_le_bytes());
        }
        entries.iter().for_each(|(_, entry)| head.extend(entry));
        head.extend(self.offset(0));
        head.extend(self.bytes);
        head
    }
}

/// Everything but the strips.
///
/// TIFF has no tag for the sRGB curve; the primaries are stated, whole samples of colours follow the curve and
/// floats are linear, as readers take them to be.
fn fields(request: &MapRequest, division: Division) -> Vec<Field> {
    let samples = request.kind.samples();
    let sample_type = request.format.sample_type();
    let [width, height] = request.pixels;
    let each = |value: u16| vec![value; samples];
    let text = format!(
        "{KEY_NAME} {}\n{CHANNEL_NAME} {}",
        request.key.hexadecimal(),
        request.channel
    );
    let (float, predictor) = if sample_type.is_float() {
        (3, 3)
    } else {
        (1, 2)
    };
    let mut fields = vec![
        Field::long(256, width),
        Field::long(257, height),
        Field::shorts(258, &each(sample_type.bytes() as u16 * 8)),
        Field::shorts(259, &[DEFLATE]),
        Field::shorts(262, &[if samples == 1 { 1 } else { 2 }]),
        Field::text(DESCRIPTION, &text),
        Field::shorts(277, &[samples as u16]),
        Field::long(278, division.rows as u32),
        Field::shorts(284, &[1]),
        Field::text(305, SOFTWARE),
        Field::shorts(317, &[predictor]),
        Field::shorts(339, &each(float)),
    ];
    if let Some(density) = request.density() {
        // Pixels per cm in thousandths, rounded to nearest; the conversion clamps.
        let [across, down] = density.map(|it| (it * 10_000.0 + 0.5) as u32);
        fields.push(Field::fractions(282, &[across], 1000));
        fields.push(Field::fractions(283, &[down], 1000));
        fields.push(Field::shorts(296, &[3]));
    }
    if request.kind == MapKind::Colour {
        fields.push(Field::fractions(318, &WHITE, 10_000));
        fields.push(Field::fractions(319, &PRIMARIES, 10_000));
    }
    fields
}

/// What stands behind `name` in the description of a TIFF that may be cut off after it.
pub(in crate::output) fn read_text(start: &[u8], name: &str) -> Option<String> {
    let description = String::from_utf8(description(start)?.to_vec()).ok()?;
    let lines = description.trim_end_matches('\0').lines();
    let mut values = lines.filter_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    values.next().map(str::to_owned)
}

/// The bytes of the description.
fn description(start: &[u8]) -> Option<&[u8]> {
    let number = |at: usize, length: usize| -> Option<usize> {
        let bytes = start.get(at..at.checked_add(length)?)?;
        let number = bytes
            .iter()
            .rev()
            .fold(0, |all, byte| all << 8 | u64::from(*byte));
        usize::try_from(number).ok()
    };
    // Where the directory is, the width of its count, of an offset and of an entry.
    let (directory, count_bytes, offset_bytes, entry_bytes) = match number(2, 2)? {
        42 => (number(4, 4)?, 2, 4, 12),
        43 => (number(8, 8)?, 8, 8, 20),
        _ => return None,
    };
    let first = directory.checked_add(count_bytes)?;
    for index in 0..number(directory, count_bytes)?.min(start.len() / entry_bytes) {
        let entry = first.checked_add(index * entry_bytes)?;
        if number(entry, 2)? == usize::from(DESCRIPTION) {
            let length = number(entry + 4, offset_bytes)?;
            // No description of ours is so short that it lies within its entry.
            let place = number(entry + 4 + offset_bytes, offset_bytes)?;
            return start.get(place..place.checked_add(length)?);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::key::Key;
    use crate::value::MapFormat;
    use std::io::Cursor;
    use tiff::decoder::Decoder;
    use tiff::tags::Tag;

    fn directory(side: u32) -> Directory {
        let request = MapRequest {
            pixels: [side; 2],
            size_mm: [1000.0; 2],
            kind: MapKind::Colour,
            format: MapFormat::Tiff16,
            key: Key::of_bytes(b"a large board"),
            channel: "bark".to_owned(),
        };
        Directory::new(&request, Division::new(request.row_bytes(), side as usize))
    }

    #[test]
    fn offsets_are_wide_where_a_file_may_pass_four_gibibytes() {
        // Six bytes a pixel.
        for (side, is_big) in [
            (26_000, false),
            (26_700, false),
            (26_760, true),
            (65_536, true),
        ] {
            assert_eq!(directory(side).is_big, is_big, "{side}");
        }
    }

    #[test]
    fn a_directory_of_either_width_is_read_and_begins_with_its_key() {
        for side in [500, 26_000, 65_536] {
            let mut directory = directory(side);
            let count = directory.offsets.len();
            directory.place(count - 1, 123_456, 789);
            let bytes = directory.bytes();
            let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
            assert_eq!(decoder.dimensions().unwrap(), (side, side));
            assert_eq!(decoder.strip_count().unwrap() as usize, count);
            let mut last = |tag| *decoder.get_tag_u64_vec(tag).unwrap().last().unwrap();
            assert_eq!(last(Tag::StripOffsets), 123_456);
            assert_eq!(last(Tag::StripByteCounts), 789);
            let key = Key::of_bytes(b"a large board").hexadecimal();
            assert_eq!(
                read_text(&bytes[..1000.min(bytes.len())], KEY_NAME),
                Some(key)
            );
        }
    }
}
