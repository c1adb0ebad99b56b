//! Predictors of TIFF: samples become differences to the pixel before.

use crate::output::MapRequest;
use crate::value::SampleType;

/// Horizontal differences of rows of interleaved samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Predictor {
    samples: usize,
    sample_type: SampleType,
    row_bytes: usize,
}

impl Predictor {
    pub(super) fn new(request: &MapRequest) -> Predictor {
        Predictor {
            samples: request.kind.samples(),
            sample_type: request.format.sample_type(),
            row_bytes: request.row_bytes(),
        }
    }

    /// The rows, little-endian, as differences.
    pub(super) fn apply(self, rows: &[u8]) -> Vec<u8> {
        let mut predicted = Vec::with_capacity(rows.len());
        for row in rows.chunks_exact(self.row_bytes) {
            match self.sample_type {
                SampleType::Whole8 => self.push_differences(row, &mut predicted),
                SampleType::Whole16 => self.push_wide_differences(row, &mut predicted),
                SampleType::Half => self.push_planes::<2>(row, &mut predicted),
                SampleType::Float => self.push_planes::<4>(row, &mut predicted),
            }
        }
        predicted
    }

    /// Differences of bytes (TIFF 6.0, section 14).
    fn push_differences(self, row: &[u8], predicted: &mut Vec<u8>) {
        let (first, rest) = row.split_at(self.samples);
        predicted.extend_from_slice(first);
        let pairs = rest.iter().zip(row);
        predicted.extend(pairs.map(|(now, before)| now.wrapping_sub(*before)));
    }

    /// Differences of big-endian 16-bit samples, little-endian.
    fn push_wide_differences(self, row: &[u8], predicted: &mut Vec<u8>) {
        let samples = row.as_chunks::<2>().0.iter();
        let samples = samples.map(|bytes| u16::from_be_bytes(*bytes));
        let before = std::iter::repeat_n(0, self.samples).chain(samples.clone());
        let differences = samples
            .zip(before)
            .map(|(now, before)| now.wrapping_sub(before));
        predicted.extend(differences.flat_map(u16::to_le_bytes));
    }

    /// The highest bytes of all samples, then the next ones, and differences of those (Adobe Photoshop TIFF
    /// Technical Note 3).
    fn push_planes<const B: usize>(self, row: &[u8], predicted: &mut Vec<u8>) {
        let samples = row.as_chunks::<B>().0;
        let mut planes = vec![0; row.len()];
        for (index, sample) in samples.iter().enumerate() {
            for (place, byte) in sample.iter().enumerate() {
                let plane = if cfg!(target_endian = "little") {
                    B - 1 - place
                } else {
                    place
                };
                planes[plane * samples.len() + index] = *byte;
            }
        }
        self.push_differences(&planes, predicted);
    }
}
