//! The settings of hatching in a style.

use crate::error::HarnessError;
use crate::schema::{within, within_colors};
use glam::{DVec3, Vec3};
use npr_hatch::files::read_file;
use npr_hatch::store::{self, Stored};
use npr_hatch::{Drawing, HATCH_TONES, HatchError, Placement, StrokeImage, Tam, TamParameters, Thresholds, draw};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// The settings of hatching, which ignores the colours of lights.
#[derive(Clone, Debug, PartialEq)]
pub struct HatchShade {
    /// The strokes.
    pub map: HatchMap,
    /// The encoding of the map that is sampled.
    pub encoding: HatchEncoding,
    /// How the map is placed on a surface.
    pub mapping: HatchMapping,
    /// How light determines the tone.
    pub transfer: HatchTransfer,
    /// The length of one side of the map on the surface, relative to half the diagonal of the model's bounding box:
    /// 0.01..=100.
    pub tile: f32,
    /// The size of a texel, px, within the range of levels: 0.25..=16. Strokes become wider and longer with it.
    pub texel_px: f32,
    /// The display-referred colour of strokes.
    pub ink: Vec3,
    /// The colour between strokes.
    pub ground: HatchGround,
}

/// The encoding of a map that is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchEncoding {
    /// Six tones in two textures, at most two of them mixed: listings 4 and 5. With
    /// [`NormalUse::PerVertex`](npr_toon::normal::NormalUse) the weights are computed at the vertices, as printed.
    SixTones,
    /// The tone at which each texel turns to ink. Supports all tones, including black.
    Thresholds,
}

/// How a map is placed on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchMapping {
    /// By the model's texture coordinates, scaled to a uniform density; models without any use planes.
    Coordinates,
    /// By projection onto three planes, along the model's axes.
    Planes,
    /// By three planes, rotated so that strokes follow the direction of largest curvature.
    Form,
}

/// How light determines the tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HatchTransfer {
    /// Listing 4: the light factor is N·L times `brightness`, and [`npr_hatch::hatch_transfer`] maps it to the tone.
    Listing4 {
        /// 7 makes the tone equal N·L, limited to the darkest tone; 0.1..=100.
        brightness: f32,
    },
    /// The tone is N·L scaled to the range from `ambient` to 1.
    Linear {
        /// 0..=1.
        ambient: f32,
    },
}

/// The colour between strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchGround {
    /// The style's paper.
    Paper,
    /// The surface's unshaded colour and texture: figure 10d of the 2002 chapter.
    Surface,
}

/// The source of a map.
#[derive(Clone, Debug, PartialEq)]
pub enum HatchSource {
    /// Drawn on first use.
    Parameters(TamParameters),
    /// Drawn on first use, with an image as the shape of the strokes.
    Stroke {
        /// The other parameters of the map.
        parameters: TamParameters,
        /// The file of the image.
        file: PathBuf,
        /// The image.
        stroke: StrokeImage,
    },
    /// Read from a file written by `npr tam`.
    File {
        /// The file.
        file: PathBuf,
        /// The images of the tones.
        tam: Tam,
        /// The thresholds, if the file has them.
        thresholds: Option<Thresholds>,
    },
}

/// A map that is drawn once and shared by all clones of a style. Two maps are equal if their sources are.
#[derive(Clone)]
pub struct HatchMap(Arc<Inner>);

struct Inner {
    source: HatchSource,
    drawing: OnceLock<Drawing>,
    thresholds: OnceLock<Thresholds>,
}

impl HatchMap {
    /// Creates a map from a source, without drawing it yet.
    pub fn new(source: HatchSource) -> Self {
        Self(Arc::new(Inner { source, drawing: OnceLock::new(), thresholds: OnceLock::new() }))
    }

    /// Reads a map written by `npr tam`.
    ///
    /// # Errors
    /// Those of [`read_map`].
    pub fn read(file: &Path) -> Result<Self, HarnessError> {
        let Stored { tam, thresholds } = read_map(file)?;
        Ok(Self::new(HatchSource::File { file: file.to_owned(), tam, thresholds }))
    }

    /// The source of the map.
    pub fn source(&self) -> &HatchSource {
        &self.0.source
    }

    fn strokes(&self) -> Option<(&TamParameters, Option<&StrokeImage>)> {
        match &self.0.source {
            HatchSource::Parameters(parameters) => Some((parameters, None)),
            HatchSource::Stroke { parameters, stroke, .. } => Some((parameters, Some(stroke))),
            HatchSource::File { .. } => None,
        }
    }

    /// The number of tones.
    pub fn tones(&self) -> usize {
        match &self.0.source {
            HatchSource::Parameters(parameters) | HatchSource::Stroke { parameters, .. } => parameters.tones.len(),
            HatchSource::File { tam, .. } => tam.tones.len(),
        }
    }

    fn drawing(&self) -> Result<Option<&Drawing>, HatchError> {
        let Some((parameters, stroke)) = self.strokes() else { return Ok(None) };
        if let Some(drawing) = self.0.drawing.get() {
            return Ok(Some(drawing));
        }
        let drawing = draw(parameters, stroke)?;
        Ok(Some(self.0.drawing.get_or_init(|| drawing)))
    }

    /// The images of its tones.
    ///
    /// # Errors
    /// Those of [`npr_hatch::draw`].
    pub fn tam(&self) -> Result<&Tam, HatchError> {
        match (&self.0.source, self.drawing()?) {
            (HatchSource::File { tam, .. }, _) => Ok(tam),
            (_, Some(drawing)) => Ok(&drawing.tam),
            (_, None) => unreachable!("what is no file is drawn"),
        }
    }

    /// Its threshold map; `None` if it was read from a file without one.
    ///
    /// # Errors
    /// Those of [`npr_hatch::draw`].
    pub fn thresholds(&self) -> Result<Option<&Thresholds>, HatchError> {
        if let HatchSource::File { thresholds, .. } = &self.0.source {
            return Ok(thresholds.as_ref());
        }
        let drawing = self.drawing()?;
        let drawn = drawing.zip(self.strokes()).map(|(drawing, (parameters, stroke))| {
            self.0.thresholds.get_or_init(|| Thresholds::new(drawing, parameters, stroke))
        });
        Ok(drawn)
    }
}

impl PartialEq for HatchMap {
    fn eq(&self, other: &Self) -> bool {
        self.0.source == other.0.source
    }
}

impl fmt::Debug for HatchMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("HatchMap").field(&self.0.source).finish()
    }
}

impl HatchShade {
    /// The range of tones over which a texel of a threshold map turns to ink, wide enough that a rounding difference of
    /// the light does not toggle a texel.
    pub(crate) const WIDTH: f64 = 1.0 / 64.0;

    /// Returns the first rule that is violated, if any, without drawing the map.
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        if let Some((parameters, _)) = self.map.strokes() {
            parameters.validate()?;
            check_effort(parameters)?;
        }
        let tones = self.map.tones();
        if self.encoding == HatchEncoding::SixTones && tones != HATCH_TONES {
            return Err(HarnessError::SixTones { tones });
        }
        if let (HatchEncoding::Thresholds, HatchSource::File { file, thresholds: None, .. }) =
            (self.encoding, self.map.source())
        {
            return Err(HarnessError::NoThresholds { path: file.clone() });
        }
        match self.transfer {
            HatchTransfer::Listing4 { brightness } => {
                within("a hatching's brightness", brightness, 0.1, 100.0, "0.1..=100")?;
                if tones != HATCH_TONES {
                    return Err(HarnessError::SixTones { tones });
                }
            }
            HatchTransfer::Linear { ambient } => within("ambient light", ambient, 0.0, 1.0, "0..=1")?,
        }
        within("a hatching's tile", self.tile, 0.01, 100.0, "0.01..=100 halves of the model's diagonal")?;
        within("a hatching's texels", self.texel_px, 0.25, 16.0, "0.25..=16 px")?;
        within_colors("a component of the ink", &self.ink.to_array())
    }
}

/// Limits maps drawn for a picture to 2²⁶ texels over all tones and candidates, which take seconds. `npr tam` has no
/// such limit.
fn check_effort(parameters: &TamParameters) -> Result<(), HarnessError> {
    let TamParameters { side, tones, placement, .. } = parameters;
    let candidates = if let Placement::BestOf { candidates } = placement { *candidates } else { 1 };
    let texels = u64::from(*side).pow(2) * tones.len() as u64 * u64::from(candidates);
    if texels > MOST_EFFORT {
        return Err(HarnessError::MapEffort { side: *side, tones: tones.len(), candidates });
    }
    Ok(())
}

const MOST_EFFORT: u64 = 1 << 26;

/// The six tones of a map: the lighter three and the darker three. Zero for maps with another number of tones.
pub(crate) fn six_tones(tam: &Tam) -> (DVec3, DVec3) {
    let tone = |index: usize| tam.tones.get(index).map_or(0.0, |&tone| f64::from(tone));
    (DVec3::new(tone(0), tone(1), tone(2)), DVec3::new(tone(3), tone(4), tone(5)))
}

/// The largest file that is read. The largest map, 64 tones at 4096² with thresholds, takes 1.4 GiB.
const MOST_BYTES: u64 = 3 << 29;

/// Reads a map written by `npr tam` from a regular file of at most 1.5 GiB.
///
/// # Errors
/// [`HarnessError::Read`], [`HarnessError::Map`].
pub fn read_map(path: &Path) -> Result<Stored, HarnessError> {
    let bytes = read_file(path, MOST_BYTES).map_err(|source| HarnessError::Read { path: path.to_owned(), source })?;
    store::from_bytes(&bytes).map_err(|source| HarnessError::Map { path: path.to_owned(), source })
}
