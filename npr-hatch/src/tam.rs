//! The images of a tonal art map.

use crate::HatchError;
use crate::parameters::validate_shape;

/// A tonal art map: per tone an image with all its mip levels, 255 paper and 0 ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Tam {
    /// The requested mean tones, 0..1, the lightest first.
    pub tones: Vec<f32>,
    /// Side of the finest level in texels, a power of two.
    pub side: u32,
    /// The images by tone and then by level, from the finest level to that of one texel; texels row by row. See
    /// [`Tam::image`].
    pub images: Vec<Vec<u8>>,
}

impl Tam {
    /// The number of levels per tone; the last level has one texel.
    pub fn levels(&self) -> usize {
        self.side.trailing_zeros() as usize + 1
    }

    /// Side of a level in texels; level 0 is the finest.
    pub fn level_side(&self, level: usize) -> u32 {
        self.side >> level
    }

    /// The texels of a tone's level.
    pub fn image(&self, tone: usize, level: usize) -> &[u8] {
        &self.images[tone * self.levels() + level]
    }

    /// The mean tone of an image, 0 black and 1 paper.
    pub fn mean(&self, tone: usize, level: usize) -> f64 {
        let image = self.image(tone, level);
        let sum: u64 = image.iter().map(|&texel| u64::from(texel)).sum();
        sum as f64 / (255.0 * image.len() as f64)
    }

    /// A level of a map of six tones as two RGB textures (Card & Mitchell 2002, listing 5): the three lighter tones, and the
    /// three darker tones.
    ///
    /// Errors: [`HatchError::PackTones`] if the map does not have six tones.
    pub fn pack_tones(&self, level: usize) -> Result<[Vec<[u8; 3]>; 2], HatchError> {
        if self.tones.len() != crate::HATCH_TONES {
            return Err(HatchError::PackTones { tones: self.tones.len() });
        }
        let pack = |first: usize| {
            let [a, b, c] = [first, first + 1, first + 2].map(|tone| self.image(tone, level));
            a.iter().zip(b).zip(c).map(|((&a, &b), &c)| [a, b, c]).collect()
        };
        Ok([pack(0), pack(3)])
    }

    /// Checks the map and returns the first violation. The result of [`crate::draw`] is valid.
    pub fn validate(&self) -> Result<(), HatchError> {
        validate_shape(&self.tones, self.side)?;
        let levels = self.levels();
        let expected = self.tones.len() * levels;
        if self.images.len() != expected {
            let image = self.images.len().min(expected);
            return Err(HatchError::ImageSize { image, texels: 0, expected });
        }
        for (image, texels) in self.images.iter().enumerate() {
            let side = self.level_side(image % levels) as usize;
            if texels.len() != side * side {
                return Err(HatchError::ImageSize { image, texels: texels.len(), expected: side * side });
            }
        }
        for tone in 1..self.tones.len() {
            for level in 0..levels {
                let mut pairs = self.image(tone - 1, level).iter().zip(self.image(tone, level));
                if let Some(texel) = pairs.position(|(light, dark)| dark > light) {
                    return Err(HatchError::NotNested { level, texel, tone });
                }
            }
        }
        Ok(())
    }
}
