//! The resolution that a PNG file states.

/// Pixels per mm along x and y, from the chunk pHYs.
pub(in crate::nodes) fn pixels_per_mm(bytes: &[u8]) -> Option<[f64; 2]> {
    let mut rest = bytes.get(8..)?;
    loop {
        let (length, name) = (number(rest)? as usize, rest.get(4..8)?);
        let body = rest.get(8..)?.get(..length)?;
        match name {
            b"IDAT" | b"IEND" => return None,
            // The last byte says whether the unit is the metre.
            b"pHYs" if length == 9 && body[8] == 1 => {
                let resolution = [number(body)?, number(&body[4..])?];
                let is_stated = resolution.iter().all(|part| *part > 0);
                return is_stated.then(|| resolution.map(|part| f64::from(part) / 1000.0));
            }
            _ => rest = rest.get(8 + length + 4..)?,
        }
    }
}

fn number(bytes: &[u8]) -> Option<u32> {
    let bytes: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
    Some(u32::from_be_bytes(bytes))
}
