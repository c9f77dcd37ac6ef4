//! What can go wrong on the way to a picture.

use crate::picture::PictureFormat;
use std::fmt;

/// What a path that a command was given is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PathRole {
    /// A file with a model.
    Model,
    /// A file with a style.
    Style,
    /// A folder with files that a model names.
    AssetRoot,
    /// A file with a tonal art map.
    Map,
    /// A picture of a stroke.
    StrokePicture,
    /// What is written.
    Output,
}

impl PathRole {
    fn kind(self) -> &'static str {
        match self {
            Self::AssetRoot => "directory",
            Self::Model | Self::Style | Self::Map | Self::StrokePicture | Self::Output => "file",
        }
    }
}

impl fmt::Display for PathRole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Model => "model",
            Self::Style => "style",
            Self::AssetRoot => "asset root",
            Self::Map => "map",
            Self::StrokePicture => "stroke picture",
            Self::Output => "output",
        })
    }
}

/// The beginning of a list of known names.
fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|nearest| format!("did you mean {nearest:?}? ")).unwrap_or_default()
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HarnessError {
    /// The model.
    #[error(transparent)]
    Load(#[from] npr_mesh::LoadError),
    /// The lines.
    #[error(transparent)]
    Outline(#[from] npr_outline::OutlineError),
    /// The lines in the image.
    #[error(transparent)]
    ImageSpace(#[from] npr_imagespace::ImageSpaceError),
    /// Bands, ramps or lights.
    #[error(transparent)]
    Toon(#[from] npr_toon::ToonError),
    /// The cool and warm tones.
    #[error(transparent)]
    Gooch(#[from] npr_gooch::GoochError),
    /// A tonal art map.
    #[error(transparent)]
    Hatch(#[from] npr_hatch::HatchError),
    /// A map that should have six tones.
    #[error("a map of {tones} tones: listings 4 and 5 know six (thresholds with a linear transfer know any number)")]
    SixTones {
        /// How many it has.
        tones: usize,
    },
    /// A map that takes long to draw, in a style, which is drawn anew for each run.
    #[error(
        "a map of {side} × {side} texels, {tones} tones and {candidates} candidates takes long: draw it once with npr tam, and name its file"
    )]
    MapEffort {
        /// Texels.
        side: u32,
        /// How many.
        tones: usize,
        /// For each stroke.
        candidates: u32,
    },
    /// A file without thresholds where they are to be drawn.
    #[error("{}: the map has no thresholds; its six tones can be drawn", path.display())]
    NoThresholds {
        /// Which.
        path: std::path::PathBuf,
    },
    /// A file with a tonal art map.
    #[error("{}: {source}", path.display())]
    Map {
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: npr_hatch::HatchError,
    },
    /// Only some of a folder's files could be written.
    #[error("{source}; {} is incomplete", folder.display())]
    Incomplete {
        /// Which.
        folder: std::path::PathBuf,
        /// What failed first.
        source: Box<HarnessError>,
    },
    /// A light from within, and one picture of depths to hold all that it shines on.
    #[error(
        "a shadow map holds what a light sees from outside: it is {radii} radii from the model's middle, and needs {least} (volumes take any light)"
    )]
    ShadowMapLight {
        /// Halves of the diagonal of the model's box.
        radii: f64,
        /// The same.
        least: f64,
    },
    /// Lines around shadows that nothing casts.
    #[error("style {style} draws lines around shadows, and has none (the table `shadow`)")]
    NoShadow {
        /// Which.
        style: String,
    },
    /// A style without a light.
    #[error("a style needs one light or two")]
    NoLight,
    /// A style's file that is not TOML, or has keys or values that a style does not have.
    #[error("{}:{line}:{column}: {message}", path.display())]
    StyleToml {
        /// Which file.
        path: std::path::PathBuf,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// In the parser's words.
        message: String,
    },
    /// A style's file with two tables of which a style has one.
    #[error(
        "{}:{line}:{column}: a style has one kind of {what}: [{table}.{first}] and [{table}.{second}] are both there",
        path.display()
    )]
    TwoKinds {
        /// Which file.
        path: std::path::PathBuf,
        /// Of the second table, from 1.
        line: usize,
        /// The same.
        column: usize,
        /// What there is one kind of.
        what: &'static str,
        /// The key above both.
        table: &'static str,
        /// A key.
        first: String,
        /// Another one.
        second: String,
    },
    /// A style's file that says something twice or leaves out what is needed.
    #[error("{}: {what}", path.display())]
    StyleTable {
        /// Which file.
        path: std::path::PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A style's file with a number out of its range.
    #[error("{}: {source}", path.display())]
    StyleRule {
        /// Which file.
        path: std::path::PathBuf,
        /// Which rule is broken.
        source: Box<HarnessError>,
    },
    /// The image of a ramp, named in a style's file.
    #[error("a ramp's image: {0}")]
    RampImage(crate::picture::ImageError),
    /// A style that has no TOML form.
    #[error("a style could not be written: {0}")]
    StyleWrite(#[from] toml::ser::Error),
    /// A picture file.
    #[error(transparent)]
    Image(#[from] crate::picture::ImageError),
    /// Pictures that cannot be compared.
    #[error(transparent)]
    Compare(#[from] crate::picture::CompareError),
    /// No adapter that can do what every picture needs.
    #[error("no usable graphics adapter (seen: {})", if seen.is_empty() { "none".to_owned() } else { seen.join("; ") })]
    NoAdapter {
        /// Those that were found and are not enough.
        seen: Vec<String>,
    },
    /// The adapter gave no device.
    #[error("{adapter} gave no device: {fault}")]
    NoDevice {
        /// Which.
        adapter: String,
        /// Why, in its own words.
        fault: String,
    },
    /// A texture larger than the device's can be.
    #[error(
        "{what} of {width} × {height} px: this device's textures have at most {limit} × {limit} px (the CPU has no such limit)"
    )]
    TextureTooLarge {
        /// What of the picture.
        what: &'static str,
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Px.
        limit: u32,
    },
    /// A ramp's image larger than the device's textures can be.
    #[error(
        "a ramp of {width} × {height} texels: this device's textures are at most {limit} × {limit} (the CPU has no such limit)"
    )]
    RampTooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Texels along a side.
        limit: u32,
    },
    /// A buffer larger than the device's can be.
    #[error("{what} needs {bytes} bytes, this device's buffers hold at most {limit}")]
    BufferTooLarge {
        /// What it holds.
        what: &'static str,
        /// How much it holds.
        bytes: u64,
        /// How much is allowed.
        limit: u64,
    },
    /// More draws than a software adapter has memory for: it keeps half a MiB for each until a picture is finished
    /// (lavapipe, Mesa 22.3).
    #[error("{draws} draws, one for each material or blended face: {limit} at most on a software adapter")]
    TooManyDraws {
        /// How many there would be.
        draws: usize,
        /// How many are made.
        limit: usize,
    },
    /// Shadow volumes in a parallel view, whose depth ends, on a device that cuts off what is farther.
    #[error("this device cannot draw shadow volumes in a parallel view (a shadow map, or the CPU, can)")]
    ParallelVolumes,
    /// An environment variable that names no limits.
    #[error("NPR_GPU_LIMITS={name:?}: it must be adapter or webgl2")]
    GpuLimits {
        /// What it says.
        name: String,
    },
    /// The device is there no more.
    #[error("the graphics device was lost: {reason}")]
    Lost {
        /// In its own words.
        reason: String,
    },
    /// The device has no memory left.
    #[error("the graphics device is out of memory: {fault}")]
    OutOfMemory {
        /// In its own words.
        fault: String,
    },
    /// The device reported a fault.
    #[error("the graphics device failed: {fault}")]
    Device {
        /// In its own words.
        fault: String,
    },
    /// Faces that cannot be cut into more.
    #[error(transparent)]
    Tessellate(#[from] npr_mesh::pn_triangles::TessellateError),
    /// A material that the model does not have.
    #[error("no material is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownMaterial {
        /// What was asked for.
        name: String,
        /// The material that was probably meant, if one is called nearly the same.
        nearest: Option<String>,
        /// Those there are.
        known: String,
    },
    /// A plan for the CPU, given to a device.
    #[error("the plan is for the CPU: shadows are to be found by rays")]
    RayPlan,
    /// An object that a transform would make flat.
    #[error("the transform of object {object} has no inverse")]
    SingularTransform {
        /// The number of the object.
        object: usize,
    },
    /// A material of an object's own that cannot replace those of its mesh.
    #[error(
        "material {material:?} cannot replace those of object {object}: it has a texture that the scene does not have, or \
         another alpha mode"
    )]
    ObjectMaterial {
        /// The number of the object.
        object: usize,
        /// The name of the material.
        material: String,
    },
    /// A cut scene, and lines that do not know of the cut.
    #[error("style {style} draws a model's edges, which a clip plane does not cut; lines in the image are cut with it")]
    ClippedEdges {
        /// Which.
        style: String,
    },
    /// A style that does not exist.
    #[error("no style is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownStyle {
        /// What was asked for.
        name: String,
        /// The style that was probably meant, if one is called nearly the same.
        nearest: Option<String>,
        /// Those there are.
        known: String,
    },
    /// A picture without pixels, or longer than any.
    #[error("a picture of {width} × {height} px: each side must lie in 1..={limit}")]
    Size {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Px.
        limit: u32,
    },
    /// A picture that takes more memory than is allowed.
    #[error(
        "a picture of {width} × {height} px with {samples} × {samples} samples takes about {} MiB, and {} are allowed (--max-memory)",
        bytes >> 20,
        limit >> 20
    )]
    PictureMemory {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Per pixel along each axis.
        samples: u32,
        /// What it takes.
        bytes: u64,
        /// What is allowed.
        limit: u64,
    },
    /// A number out of its range.
    #[error("{what} of {value}: it must lie in {range}")]
    Range {
        /// What it is.
        what: &'static str,
        /// What was asked for.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The build has no device executor.
    #[error("this build has no GPU executor (the feature `gpu` is off)")]
    NoGpuInBuild,
    /// A device was asked for, and none is to be looked for.
    #[error("a device was asked for (--backend gpu), and NPR_GPU=off says to look for none")]
    GpuOff,
    /// A device was required and there is none.
    #[error("NPR_GPU=required, but {0}")]
    GpuRequired(String),
    /// An environment variable that says nothing.
    #[error("NPR_GPU={0:?}: it must be required, auto or off")]
    Policy(String),
    /// A file or directory that a command was given and that is not there.
    #[error("{role} {}: no such {}", path.display(), role.kind())]
    NoSuchPath {
        /// What it is for.
        role: PathRole,
        /// Which.
        path: std::path::PathBuf,
    },
    /// A directory where a command needs a file.
    #[error("{role} {}: is a directory", path.display())]
    IsDirectory {
        /// What it is for.
        role: PathRole,
        /// Which.
        path: std::path::PathBuf,
    },
    /// A file or directory that a command was given and that the system does not let it use.
    #[error("{role} {}: {source}", path.display())]
    Unusable {
        /// What it is for.
        role: PathRole,
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A picture's file whose extension names no format that can be written.
    #[error(
        "output {}: unknown picture format (expected {}, or - for PNG on standard output)",
        path.display(),
        PictureFormat::EXTENSIONS.map(|(extension, _)| format!(".{extension}")).join(", ")
    )]
    PictureFormat {
        /// Which file.
        path: std::path::PathBuf,
    },
    /// A picture that is larger than its file's format can say.
    #[error("a picture of {width} × {height} px: each side of a {format} picture must lie in 1..={limit}")]
    FormatSize {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Of the file.
        format: PictureFormat,
        /// Px.
        limit: u32,
    },
    /// Two things that would be written to standard output, one into the other.
    #[error("--json and -o - would both write to standard output")]
    StandardOutputTwice,
    /// A file that could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file that could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// Which.
        path: std::path::PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A picture that would be written over what it is made of.
    #[error("{}: it is read for the picture, and would be overwritten by it", path.display())]
    Overwrites {
        /// Which file.
        path: std::path::PathBuf,
    },
    /// A table that could not be written as JSON.
    #[error("could not write JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl HarnessError {
    /// Whether the fault lies with a device, and the CPU may make the picture.
    pub(crate) fn is_of_the_device(&self) -> bool {
        matches!(
            self,
            Self::NoAdapter { .. }
                | Self::NoDevice { .. }
                | Self::Lost { .. }
                | Self::OutOfMemory { .. }
                | Self::Device { .. }
        ) || self.is_device_limit()
    }

    /// Whether a device cannot make the picture for a limit that it has, without a fault.
    pub(crate) fn is_device_limit(&self) -> bool {
        use npr_outline::OutlineError;
        match self {
            Self::TextureTooLarge { .. }
            | Self::RampTooLarge { .. }
            | Self::BufferTooLarge { .. }
            | Self::TooManyDraws { .. }
            | Self::ParallelVolumes => true,
            Self::Outline(error) => matches!(error, OutlineError::TooManyEdges { .. }),
            #[cfg(feature = "gpu")]
            Self::Hatch(error) => matches!(error, npr_hatch::HatchError::TooLarge { .. }),
            _ => false,
        }
    }

    /// Whether the device makes no further picture.
    pub(crate) fn is_final(&self) -> bool {
        matches!(self, Self::Lost { .. } | Self::OutOfMemory { .. })
    }
}
