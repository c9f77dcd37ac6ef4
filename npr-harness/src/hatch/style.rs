//! Strokes as a style has them.

use crate::error::HarnessError;
use crate::schema::{within, within_colors};
use glam::{DVec3, Vec3};
use npr_hatch::files::read_file;
use npr_hatch::store::{self, Stored};
use npr_hatch::{Drawing, HATCH_TONES, HatchError, Placement, StrokeImage, Tam, TamParameters, Thresholds, draw};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Hatching. Of the lights' colours it takes no notice.
#[derive(Clone, Debug, PartialEq)]
pub struct HatchShade {
    /// The strokes.
    pub map: HatchMap,
    /// What of the map is looked up.
    pub encoding: HatchEncoding,
    /// Where on a surface it lies.
    pub mapping: HatchMapping,
    /// How dark a surface is.
    pub transfer: HatchTransfer,
    /// The length on the surface of one side of the map, in halves of the diagonal of the model's box: 0.01..=100.
    pub tile: f32,
    /// The size of a texel, px, as long as there are levels for it: 0.25..=16. Strokes get wider and longer with it.
    pub texel_px: f32,
    /// Display-referred.
    pub ink: Vec3,
    /// What shows between strokes.
    pub ground: HatchGround,
}

/// What of a map is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchEncoding {
    /// Six tones in two textures, of which at most two tones are mixed: listings 4 and 5. With
    /// [`NormalUse::PerVertex`](npr_toon::normal::NormalUse) their weights are computed at the vertices, as printed.
    SixTones,
    /// The tone at which each texel turns to ink: any tone, black as well.
    Thresholds,
}

/// Where on a surface a map lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchMapping {
    /// By the model's texture coordinates, their density evened out; models without any by planes.
    Coordinates,
    /// By three planes, along the model's axes.
    Planes,
    /// The same, turned so that strokes run where the surface bends most.
    Form,
}

/// How dark a surface is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HatchTransfer {
    /// Listing 4: the light factor is this many times N·L, and the tone what comes of it
    /// ([`npr_hatch::hatch_transfer`]).
    Listing4 {
        /// 7 makes the tone N·L, but no darker than the darkest tone; 0.1..=100.
        brightness: f32,
    },
    /// The tone is N·L over what is left where no light falls.
    Linear {
        /// 0..=1.
        ambient: f32,
    },
}

/// What shows between strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HatchGround {
    /// The style's paper.
    Paper,
    /// The surface's own colour and texture: figure 10d of the 2002 chapter.
    Surface,
}

/// Where a map comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum HatchSource {
    /// Drawn when it is first needed.
    Parameters(TamParameters),
    /// The same, with strokes that look like a picture of one.
    Stroke {
        /// What else they are like.
        parameters: TamParameters,
        /// Where the picture comes from.
        file: PathBuf,
        /// It.
        stroke: StrokeImage,
    },
    /// Read from what `npr tam` wrote.
    File {
        /// Where from.
        file: PathBuf,
        /// The tones' images.
        tam: Tam,
        /// The thresholds, if the file has them.
        thresholds: Option<Thresholds>,
    },
}

/// A map, drawn once for all styles that are clones of one. Equal if where they come from is.
#[derive(Clone)]
pub struct HatchMap(Arc<Inner>);

struct Inner {
    source: HatchSource,
    drawing: OnceLock<Drawing>,
    thresholds: OnceLock<Thresholds>,
}

impl HatchMap {
    /// Of a source, which is not looked at yet.
    pub fn new(source: HatchSource) -> Self {
        Self(Arc::new(Inner { source, drawing: OnceLock::new(), thresholds: OnceLock::new() }))
    }

    /// What `npr tam` wrote.
    ///
    /// # Errors
    /// Those of [`read_map`].
    pub fn read(file: &Path) -> Result<Self, HarnessError> {
        let Stored { tam, thresholds } = read_map(file)?;
        Ok(Self::new(HatchSource::File { file: file.to_owned(), tam, thresholds }))
    }

    /// Where it comes from.
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

    /// How many tones it has.
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

    /// Its thresholds; `None` if the file that it comes from has none.
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
    /// The span of tones over which a texel of thresholds turns to ink: so much that a difference of light in the last
    /// digit does not turn one over.
    pub(crate) const WIDTH: f64 = 1.0 / 64.0;

    /// Which rule is broken, if one is; the first found. Nothing is drawn for it.
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

/// What is drawn for a picture takes seconds: 2²⁶ texels, of all tones and candidates. `npr tam` draws anything.
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

/// The six tones of a map, the lighter three and the darker three; a map of another number is asked for none.
pub(crate) fn six_tones(tam: &Tam) -> (DVec3, DVec3) {
    let tone = |index: usize| tam.tones.get(index).map_or(0.0, |&tone| f64::from(tone));
    (DVec3::new(tone(0), tone(1), tone(2)), DVec3::new(tone(3), tone(4), tone(5)))
}

/// The longest map, of 64 tones at 4096² with thresholds, has 1.4 GiB.
const MOST_BYTES: u64 = 3 << 29;

/// Reads what `npr tam` wrote: a regular file of at most 1.5 GiB.
///
/// # Errors
/// [`HarnessError::Read`], [`HarnessError::Map`].
pub fn read_map(path: &Path) -> Result<Stored, HarnessError> {
    let bytes = read_file(path, MOST_BYTES).map_err(|source| HarnessError::Read { path: path.to_owned(), source })?;
    store::from_bytes(&bytes).map_err(|source| HarnessError::Map { path: path.to_owned(), source })
}
