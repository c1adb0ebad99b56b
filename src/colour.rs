//! Transfer functions and luminance weights: the only place that knows them.

/// Relative luminance of a linear Rec. 709 colour.
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The linear value of an sRGB-encoded one, both in 0 to 1 (IEC 61966-2-1).
pub fn from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// The sRGB encoding of a linear value, both in 0 to 1 (IEC 61966-2-1).
pub fn to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The linear values of the 256 sRGB bytes.
pub fn srgb_bytes() -> [f32; 256] {
    std::array::from_fn(|byte| from_srgb(byte as f64 / 255.0) as f32)
}
