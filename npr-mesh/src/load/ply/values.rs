//! The numbers of a PLY file.

use super::header::{Element, Encoding, Kind, Scalar};

/// The numbers that are not read yet.
pub struct Values<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl<'a> Values<'a> {
    pub fn new(body: &'a [u8], encoding: Encoding) -> Self {
        Self { rest: body, encoding }
    }

    pub fn is_binary(&self) -> bool {
        self.encoding != Encoding::Ascii
    }

    /// The number of bytes that are not read yet.
    pub fn left(&self) -> usize {
        self.rest.len()
    }

    /// The least number of bytes of one element.
    pub fn least_bytes(&self, element: &Element) -> u64 {
        let of_property = |kind: Kind| match kind {
            // A digit; the space between two is missing at the end of the file.
            _ if !self.is_binary() => 1,
            Kind::Scalar(scalar) | Kind::List(scalar, _) => scalar.bytes() as u64,
        };
        element.properties.iter().map(|property| of_property(property.kind)).sum()
    }

    /// The next number. Integers are exact in f64.
    #[inline]
    pub fn next(&mut self, scalar: Scalar) -> Result<f64, &'static str> {
        match self.encoding {
            Encoding::Ascii => self.word(),
            Encoding::LittleEndian => self.binary(scalar, false),
            Encoding::BigEndian => self.binary(scalar, true),
        }
    }

    fn binary(&mut self, scalar: Scalar, reversed: bool) -> Result<f64, &'static str> {
        let (bytes, rest) = self.rest.split_at_checked(scalar.bytes()).ok_or("cut off")?;
        self.rest = rest;
        let mut little = [0; 8];
        little[..bytes.len()].copy_from_slice(bytes);
        if reversed {
            little[..bytes.len()].reverse();
        }
        let [a, b, c, d, ..] = little;
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes([a]).into(),
            Scalar::U8 => a.into(),
            Scalar::I16 => i16::from_le_bytes([a, b]).into(),
            Scalar::U16 => u16::from_le_bytes([a, b]).into(),
            Scalar::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Scalar::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Scalar::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Scalar::F64 => f64::from_le_bytes(little),
        })
    }

    fn word(&mut self) -> Result<f64, &'static str> {
        let text = self.rest.trim_ascii_start();
        let length = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (word, rest) = text.split_at(length);
        self.rest = rest;
        if word.is_empty() {
            return Err("cut off");
        }
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or("a word that is no number")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type() {
        let le = |bytes: &[u8], scalar| Values::new(bytes, Encoding::LittleEndian).next(scalar).unwrap();
        let be = |bytes: &[u8], scalar| Values::new(bytes, Encoding::BigEndian).next(scalar).unwrap();
        assert_eq!((le(&[0xFF], Scalar::I8), be(&[0xFF], Scalar::U8)), (-1.0, 255.0));
        assert_eq!((le(&[1, 2], Scalar::I16), be(&[1, 2], Scalar::U16)), (513.0, 258.0));
        assert_eq!((le(&[0xFE, 0xFF, 0xFF, 0xFF], Scalar::I32), be(&[0, 0, 1, 0], Scalar::U32)), (-2.0, 256.0));
        assert_eq!((le(&1.5f32.to_le_bytes(), Scalar::F32), be(&0.1f64.to_be_bytes(), Scalar::F64)), (1.5, 0.1));
        let mut text = Values::new(b" 1 .5\n\n-2e3 nan", Encoding::Ascii);
        let numbers: Vec<f64> = (0..3).map(|_| text.next(Scalar::F32).unwrap()).collect();
        assert_eq!(numbers, [1.0, 0.5, -2000.0]);
        assert!(text.next(Scalar::F32).unwrap().is_nan());
        assert_eq!(text.next(Scalar::F32), Err("cut off"));
        assert_eq!(Values::new(&[1, 2], Encoding::BigEndian).next(Scalar::F32), Err("cut off"));
    }
}
