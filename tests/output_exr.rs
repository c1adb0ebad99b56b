//! The layout of OpenEXR maps, read from the bytes alone: attributes, increasing lines, and where blocks lie.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod output_support;

use output_support::{Map, with_size};
use std::collections::BTreeMap;
use yosegi::output::MapKind;
use yosegi::value::MapFormat;

/// Bytes that are taken from the front.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, length: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(length);
        self.0 = rest;
        taken
    }

    fn text(&mut self) -> String {
        let length = self.0.iter().position(|byte| *byte == 0).unwrap();
        let text = String::from_utf8(self.take(length).to_vec()).unwrap();
        self.take(1);
        text
    }

    /// A little-endian number of `length` bytes.
    fn number(&mut self, length: usize) -> u64 {
        let bytes = self.take(length).iter().rev();
        bytes.fold(0, |all, byte| all << 8 | u64::from(*byte))
    }
}

#[test]
fn blocks_lie_in_the_order_of_their_lines() {
    for format in [MapFormat::ExrHalf, MapFormat::ExrFloat] {
        let map = Map::gradient(&with_size([50, 140], MapKind::Colour, format));
        let mut rest = Rest(&map.bytes);
        // The magic number, version 2, one part of scan lines.
        assert_eq!([rest.number(4), rest.number(4)], [0x0131_2f76, 2]);
        let mut attributes = BTreeMap::new();
        while rest.0[0] != 0 {
            let (name, kind, length) = (rest.text(), rest.text(), rest.number(4));
            attributes.insert(name, (kind, rest.take(length as usize).to_vec()));
        }
        rest.take(1);
        let attribute = |name: &str| attributes[name].1.as_slice();
        // Increasing lines, PIZ, and a window of 50 by 140 pixels.
        assert_eq!(
            (attribute("lineOrder"), attribute("compression")),
            (&[0][..], &[4][..])
        );
        let mut window = Rest(attribute("dataWindow"));
        assert_eq!([0; 4].map(|_| window.number(4)), [0, 0, 49, 139]);
        // Blocks of PIZ have 32 lines.
        let offsets = [0; 5].map(|_| rest.number(8) as usize);
        for (index, offset) in offsets.into_iter().enumerate() {
            assert_eq!(offset, map.bytes.len() - rest.0.len(), "block {index}");
            assert_eq!(rest.number(4), 32 * index as u64);
            let length = rest.number(4) as usize;
            rest.take(length);
        }
        assert!(rest.0.is_empty());
    }
}
