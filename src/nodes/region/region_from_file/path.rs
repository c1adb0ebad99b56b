//! The path language of SVG (2, chapter 9.3).

use super::pen::Pen;
use glam::DVec2;

/// Draws the path of a `d` attribute.
///
/// # Errors
/// Where the first mistake is, in characters from 1; what is before it is drawn, as the standard asks.
pub(super) fn draw(data: &str, pen: &mut Pen) -> Result<(), usize> {
    let mut scanner = Scanner {
        bytes: data.as_bytes(),
        at: 0,
    };
    let mut control = Control::None;
    let mut command = None;
    loop {
        scanner.skip();
        let Some(next) = scanner.peek() else {
            return Ok(());
        };
        let start = scanner.at + 1;
        if next.is_ascii_alphabetic() {
            scanner.at += 1;
            command = Some(next);
        } else {
            // Numbers without a command repeat the last one; behind a move they draw lines.
            command = match command {
                Some(b'M') => Some(b'L'),
                Some(b'm') => Some(b'l'),
                Some(b'Z' | b'z') | None => return Err(start),
                other => other,
            };
        }
        let Some(letter) = command else {
            return Err(start);
        };
        let is_first = pen.rings.is_empty();
        if is_first && !letter.eq_ignore_ascii_case(&b'm') {
            return Err(start);
        }
        control = scanner.step(letter, control, pen).ok_or(start)?;
    }
}

/// The point that a smooth curve goes on from.
#[derive(Clone, Copy)]
enum Control {
    None,
    Cubic(DVec2),
    Quadratic(DVec2),
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Scanner<'_> {
    /// One command with its numbers; `None` if they are not as they should be.
    fn step(&mut self, letter: u8, control: Control, pen: &mut Pen) -> Option<Control> {
        let from = pen.at;
        let base = if letter.is_ascii_lowercase() {
            from
        } else {
            DVec2::ZERO
        };
        match letter.to_ascii_lowercase() {
            b'm' => pen.move_to(base + self.pair()?),
            b'l' => pen.line_to(base + self.pair()?),
            b'h' => pen.line_to(DVec2::new(base.x + self.number()?, from.y)),
            b'v' => pen.line_to(DVec2::new(from.x, base.y + self.number()?)),
            b'z' => pen.close(),
            b'c' | b's' => {
                let first = match (letter.to_ascii_lowercase(), control) {
                    (b'c', _) => base + self.pair()?,
                    (_, Control::Cubic(before)) => 2.0 * from - before,
                    _ => from,
                };
                let (second, to) = (base + self.pair()?, base + self.pair()?);
                pen.cubic_to(first, second, to);
                return Some(Control::Cubic(second));
            }
            b'q' | b't' => {
                let middle = match (letter.to_ascii_lowercase(), control) {
                    (b'q', _) => base + self.pair()?,
                    (_, Control::Quadratic(before)) => 2.0 * from - before,
                    _ => from,
                };
                pen.quadratic_to(middle, base + self.pair()?);
                return Some(Control::Quadratic(middle));
            }
            b'a' => {
                let (radii, axis) = (self.pair()?, self.number()?.to_radians());
                let (large, sweep) = (self.flag()?, self.flag()?);
                pen.arc_to(radii, axis, large, sweep, base + self.pair()?);
            }
            _ => return None,
        }
        Some(Control::None)
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Skips white space and a comma.
    fn skip(&mut self) {
        while self
            .peek()
            .is_some_and(|byte| byte.is_ascii_whitespace() || byte == b',')
        {
            self.at += 1;
        }
    }

    fn pair(&mut self) -> Option<DVec2> {
        Some(DVec2::new(self.number()?, self.number()?))
    }

    /// A flag of one digit, behind which no space is needed.
    fn flag(&mut self) -> Option<bool> {
        self.skip();
        let flag = match self.peek()? {
            b'0' => false,
            b'1' => true,
            _ => return None,
        };
        self.at += 1;
        Some(flag)
    }

    fn number(&mut self) -> Option<f64> {
        self.skip();
        let start = self.at;
        self.take(|byte| byte == b'+' || byte == b'-', 1);
        self.take(|byte| byte.is_ascii_digit(), usize::MAX);
        if self.take(|byte| byte == b'.', 1) > 0 {
            self.take(|byte| byte.is_ascii_digit(), usize::MAX);
        }
        let before = self.at;
        if self.take(|byte| byte == b'e' || byte == b'E', 1) > 0 {
            self.take(|byte| byte == b'+' || byte == b'-', 1);
            if self.take(|byte| byte.is_ascii_digit(), usize::MAX) == 0 {
                self.at = before;
            }
        }
        let text = std::str::from_utf8(&self.bytes[start..self.at]).ok()?;
        text.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// Goes on over bytes of a sort, and says over how many.
    fn take(&mut self, is_one: impl Fn(u8) -> bool, most: usize) -> usize {
        let start = self.at;
        while self.at - start < most && self.peek().is_some_and(&is_one) {
            self.at += 1;
        }
        self.at - start
    }
}

/// The numbers of a list, as in `points`; what is behind a mistake is left out.
pub(super) fn numbers(text: &str) -> Vec<f64> {
    let mut scanner = Scanner {
        bytes: text.as_bytes(),
        at: 0,
    };
    std::iter::from_fn(|| scanner.number()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::doubled_area;

    fn area(data: &str) -> f64 {
        let mut pen = Pen::new(1e-5);
        draw(data, &mut pen).unwrap();
        let rings = pen.drawn(glam::DAffine2::IDENTITY);
        rings.iter().map(|ring| doubled_area(ring)).sum::<f64>() / 2.0
    }

    #[test]
    fn each_command_draws_what_it_says() {
        let pi = std::f64::consts::PI;
        let cases = [
            ("M0 0L4 0L4 3L0 3Z", 12.0),
            ("m0 0l4 0 0 3-4 0z", 12.0),
            ("M1,1H5V4H1Z", 12.0),
            ("M1 1h4v3h-4z", 12.0),
            // A quarter of a parabola's box: two thirds of the triangle.
            ("M0 0Q2 4 4 0Z", -16.0 / 3.0),
            ("M0 0q2-4 4 0z", 16.0 / 3.0),
            ("M0 0Q1-2 2 0T4 0Z", 0.0),
            ("M0 0C0 -4 4 -4 4 0Z", 0.6 * 16.0),
            ("M0 0c0-4 4-4 4 0z", 0.6 * 16.0),
            ("M0 0C0 -4 4 -4 4 0S8 4 8 0Z", 0.0),
            ("M-2 0A2 2 0 0 1 2 0Z", 2.0 * pi),
            ("M-2 0A2 2 0 0 0 2 0Z", -2.0 * pi),
            ("M0 0a2 1 0 1 1 0 1e-9z", 2.0 * pi),
            ("M0 0a1 1 0 112 0z", 0.5 * pi),
            ("M0 0A1 1 0 1 1 4 0Z", 2.0 * pi),
            ("M0 2A2 2 0 0 0 2 4L2 2Z", -pi),
            ("M3 0a3 1 90 0 1 0 6z", 1.5 * pi),
            ("M.5.5 2.5.5 2.5-1.5z", -2.0),
        ];
        for (data, expected) in cases {
            let found = area(data);
            assert!(
                (found - expected).abs() < 3e-4,
                "{data}: {found} instead of {expected}"
            );
        }
    }

    #[test]
    fn what_is_before_a_mistake_is_drawn() {
        let mistake = |data: &str| {
            let mut pen = Pen::new(0.1);
            (draw(data, &mut pen), pen.rings.concat().len())
        };
        assert_eq!(mistake("M0 0L1 0L1 1x2"), (Err(13), 3));
        assert_eq!(mistake("M0 0L1 0L1"), (Err(9), 2));
        assert_eq!(mistake("L1 1"), (Err(1), 0));
        assert_eq!(mistake("M0 0 Z 4"), (Err(8), 2));
        assert_eq!(mistake("M0 0A1 1 0 2 0 1 1"), (Err(5), 1));
        assert_eq!(mistake("M1e999 0"), (Err(1), 0));
        assert_eq!(mistake(""), (Ok(()), 0));
    }
}
