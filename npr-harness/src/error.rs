//! The errors of this crate.

use crate::picture::PictureFormat;
use std::fmt;

/// The role of a path in a command's arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PathRole {
    /// A model file.
    Model,
    /// A style file.
    Style,
    /// A folder with files that a model refers to.
    AssetRoot,
    /// A file with a tonal art map.
    Map,
    /// An image of a stroke.
    StrokePicture,
    /// A table of an earlier run.
    Table,
    /// The output.
    Output,
}

impl PathRole {
    fn kind(self) -> &'static str {
        match self {
            Self::AssetRoot => "directory",
            Self::Model | Self::Style | Self::Map | Self::StrokePicture | Self::Table | Self::Output => "file",
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
            Self::Table => "table",
            Self::Output => "output",
        })
    }
}

/// The first part of a list of known names.
fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|nearest| format!("did you mean {nearest:?}? ")).unwrap_or_default()
}

/// The reason why a picture could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HarnessError {
    /// The model could not be loaded.
    #[error(transparent)]
    Load(#[from] npr_mesh::LoadError),
    /// A model could not be written.
    #[error(transparent)]
    Export(#[from] npr_mesh::export::ExportError),
    /// A model is written only as `.glb`.
    #[error("{}: a model is written as .glb", path.display())]
    ModelFormat {
        /// The output.
        path: std::path::PathBuf,
    },
    /// An error from npr-outline, about edge lines, fins or shadow volumes.
    #[error(transparent)]
    Outline(#[from] npr_outline::OutlineError),
    /// An error from npr-imagespace, about image-space lines.
    #[error(transparent)]
    ImageSpace(#[from] npr_imagespace::ImageSpaceError),
    /// An error from npr-toon, about bands, ramps or lights.
    #[error(transparent)]
    Toon(#[from] npr_toon::ToonError),
    /// An error from npr-gooch, about Gooch shading.
    #[error(transparent)]
    Gooch(#[from] npr_gooch::GoochError),
    /// An error from npr-hatch, about a tonal art map.
    #[error(transparent)]
    Hatch(#[from] npr_hatch::HatchError),
    /// A map with another number of tones where six are needed.
    #[error("a map of {tones} tones: listings 4 and 5 know six (thresholds with a linear transfer know any number)")]
    SixTones {
        /// The number of tones.
        tones: usize,
    },
    /// A style's map takes too long to draw; it is drawn again in each run.
    #[error(
        "a map of {side} × {side} texels, {tones} tones and {candidates} candidates takes long: draw it once with npr tam, and name its file"
    )]
    MapEffort {
        /// The side of the map, texels.
        side: u32,
        /// The number of tones.
        tones: usize,
        /// The number of candidates per stroke.
        candidates: u32,
    },
    /// A map file without thresholds, for a style that uses them.
    #[error("{}: the map has no thresholds; its six tones can be drawn", path.display())]
    NoThresholds {
        /// The map file.
        path: std::path::PathBuf,
    },
    /// A map file that is not valid.
    #[error("{}: {source}", path.display())]
    Map {
        /// The map file.
        path: std::path::PathBuf,
        /// The cause.
        source: npr_hatch::HatchError,
    },
    /// Only some of a folder's files could be written.
    #[error("{source}; {} is incomplete", folder.display())]
    Incomplete {
        /// The folder.
        folder: std::path::PathBuf,
        /// The first failure.
        source: Box<HarnessError>,
    },
    /// A shadow map for a light within or too close to the model's bounding sphere.
    #[error(
        "a shadow map holds what a light sees from outside: it is {radii} radii from the model's middle, and needs {least} (volumes take any light)"
    )]
    ShadowMapLight {
        /// The distance of the light from the sphere's centre, in halves of the bounding box's diagonal.
        radii: f64,
        /// The least distance allowed, in the same unit.
        least: f64,
    },
    /// A style with shadow lines but without shadows.
    #[error("style {style} draws lines around shadows, and has none (the table `shadow`)")]
    NoShadow {
        /// The name of the style.
        style: String,
    },
    /// A style without a light.
    #[error("a style needs one to eight lights")]
    NoLight,
    /// A style file that is not TOML, or has unknown keys or invalid values.
    #[error("{}:{line}:{column}: {message}", path.display())]
    StyleToml {
        /// The file.
        path: std::path::PathBuf,
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// The parser's message.
        message: String,
    },
    /// A style file with two alternative tables.
    #[error(
        "{}:{line}:{column}: a style has one kind of {what}: [{table}.{first}] and [{table}.{second}] are both there",
        path.display()
    )]
    TwoKinds {
        /// The file.
        path: std::path::PathBuf,
        /// The line of the second table, from 1.
        line: usize,
        /// The column of the second table, from 1.
        column: usize,
        /// What the tables are alternatives for.
        what: &'static str,
        /// The key that contains both.
        table: &'static str,
        /// The key of the first table.
        first: String,
        /// The key of the second table.
        second: String,
    },
    /// A style file with contradictory or missing keys.
    #[error("{}: {what}", path.display())]
    StyleTable {
        /// The file.
        path: std::path::PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A style file with a number out of its range.
    #[error("{}: {source}", path.display())]
    StyleRule {
        /// The file.
        path: std::path::PathBuf,
        /// The rule that is violated.
        source: Box<HarnessError>,
    },
    /// The image of a ramp that a style file refers to could not be read.
    #[error("a ramp's image: {0}")]
    RampImage(crate::picture::ImageError),
    /// A style that cannot be written as TOML.
    #[error("a style could not be written: {0}")]
    StyleWrite(#[from] toml::ser::Error),
    /// A picture file could not be read or written.
    #[error(transparent)]
    Image(#[from] crate::picture::ImageError),
    /// Pictures that cannot be compared.
    #[error(transparent)]
    Compare(#[from] crate::picture::CompareError),
    /// No adapter meets the requirements.
    #[error("no usable graphics adapter (seen: {})", if seen.is_empty() { "none".to_owned() } else { seen.join("; ") })]
    NoAdapter {
        /// The adapters that were found and rejected.
        seen: Vec<String>,
    },
    /// The adapter could not be opened.
    #[error("{adapter} gave no device: {fault}")]
    NoDevice {
        /// The adapter.
        adapter: String,
        /// The driver's message.
        fault: String,
    },
    /// A texture that exceeds the device's limit.
    #[error(
        "{what} of {width} × {height} px: this device's textures have at most {limit} × {limit} px (the CPU has no such limit)"
    )]
    TextureTooLarge {
        /// The use of the texture.
        what: &'static str,
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Px.
        limit: u32,
    },
    /// A ramp image that exceeds the device's limit.
    #[error(
        "a ramp of {width} × {height} texels: this device's textures are at most {limit} × {limit} (the CPU has no such limit)"
    )]
    RampTooLarge {
        /// The width in texels.
        width: u32,
        /// The height in texels.
        height: u32,
        /// The largest side in texels.
        limit: u32,
    },
    /// A buffer that exceeds the device's limit.
    #[error("{what} needs {bytes} bytes, this device's buffers hold at most {limit}")]
    BufferTooLarge {
        /// The content of the buffer.
        what: &'static str,
        /// Its size, bytes.
        bytes: u64,
        /// The limit, bytes.
        limit: u64,
    },
    /// More draws than a software adapter has memory for: it keeps half a MiB per draw until a picture is finished
    /// (lavapipe, Mesa 22.3).
    #[error("{draws} draws, one for each material or blended face: {limit} at most on a software adapter")]
    TooManyDraws {
        /// The number of draws.
        draws: usize,
        /// The limit.
        limit: usize,
    },
    /// A G-buffer of separate targets on a device that cannot render to 32-bit floats.
    #[error("this device cannot render to the 32-bit floats of a G-buffer of separate targets (the CPU can)")]
    FloatTargets,
    /// Shadow volumes in a parallel view, which has a far plane, on a device that cannot disable depth clipping.
    #[error("this device cannot draw shadow volumes in a parallel view (a shadow map, or the CPU, can)")]
    ParallelVolumes,
    /// The environment variable `NPR_GPU_LIMITS` has an unknown value.
    #[error("NPR_GPU_LIMITS={name:?}: it must be adapter or webgl2")]
    GpuLimits {
        /// The value.
        name: String,
    },
    /// The device was lost.
    #[error("the graphics device was lost: {reason}")]
    Lost {
        /// The driver's message.
        reason: String,
    },
    /// The device is out of memory.
    #[error("the graphics device is out of memory: {fault}")]
    OutOfMemory {
        /// The driver's message.
        fault: String,
    },
    /// The device reported an error.
    #[error("the graphics device failed: {fault}")]
    Device {
        /// The driver's message.
        fault: String,
    },
    /// Faces that cannot be tessellated.
    #[error(transparent)]
    Tessellate(#[from] npr_mesh::pn_triangles::TessellateError),
    /// A material that the model does not have.
    #[error("no material is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownMaterial {
        /// The value requested.
        name: String,
        /// A material with a similar name, if there is one.
        nearest: Option<String>,
        /// The existing names.
        known: String,
    },
    /// A plan for the CPU was passed to the GPU executor.
    #[error("the plan is for the CPU: shadows are to be found by rays")]
    RayPlan,
    /// A transform that cannot place an object.
    #[error("the transform of object {object} {fault}")]
    ObjectTransform {
        /// The number of the object.
        object: usize,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// An object without a mesh.
    #[error("object {object} places mesh {mesh} of {meshes}")]
    ObjectMesh {
        /// The number of the object.
        object: usize,
        /// The number of the mesh that it names.
        mesh: usize,
        /// How many there are.
        meshes: usize,
    },
    /// A scene whose materials or meshes were changed after it was uploaded.
    #[error("the materials or coincident faces of the scene have changed: it must be uploaded again")]
    StaleUpload,
    /// A material override that is not compatible with the materials of the mesh.
    #[error(
        "material {material:?} cannot replace those of object {object}: it has a texture that the scene does not have, or \
         another alpha mode"
    )]
    ObjectMaterial {
        /// The index of the object.
        object: usize,
        /// The name of the material.
        material: String,
    },
    /// An object names two lights that it cannot have.
    #[error("object {object} cannot have the lights {} and {}: {fault}", lights[0], lights[1])]
    ObjectLights {
        /// The index of the object.
        object: usize,
        /// The indices of the lights.
        lights: [usize; 2],
        /// What is wrong with them.
        fault: &'static str,
    },
    /// A style has more lights than [`crate::scene::MAX_LIGHTS`].
    #[error("{lights} lights are too many: a style has at most {max}")]
    TooManyLights {
        /// The number of lights.
        lights: usize,
        /// The maximum.
        max: usize,
    },
    /// A scene with a clipping plane, and a style with lines that do not support it.
    #[error(
        "style {style} draws a model's edges or its hull, which a clip plane does not cut; lines in the image are cut with it"
    )]
    ClippedEdges {
        /// The name of the style.
        style: String,
    },
    /// A style that does not exist.
    #[error("no style is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownStyle {
        /// The value requested.
        name: String,
        /// A style with a similar name, if there is one.
        nearest: Option<String>,
        /// The existing names.
        known: String,
    },
    /// A figure that does not exist.
    #[error("no figure is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownFigure {
        /// The value requested.
        name: String,
        /// A figure with a similar name, if there is one.
        nearest: Option<String>,
        /// The existing names.
        known: String,
    },
    /// A picture without pixels, or with a side that exceeds the limit.
    #[error("a picture of {width} × {height} px: each side must lie in 1..={limit}")]
    Size {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// Px.
        limit: u32,
    },
    /// A picture that needs more memory than allowed.
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
        /// Samples per pixel along each axis.
        samples: u32,
        /// The memory needed, bytes.
        bytes: u64,
        /// The memory allowed, bytes.
        limit: u64,
    },
    /// Settings of a style's G-buffer that contradict each other.
    #[error("a G-buffer: {what} needs {needs}")]
    GBuffer {
        /// What was asked for.
        what: &'static str,
        /// What else it takes.
        needs: &'static str,
    },
    /// A number out of its range.
    #[error("{what} of {value}: it must lie in {range}")]
    Range {
        /// The name of the number.
        what: &'static str,
        /// The value requested.
        value: f64,
        /// The range.
        range: &'static str,
    },
    /// The build does not include the GPU executor.
    #[error("this build has no GPU executor (the feature `gpu` is off)")]
    NoGpuInBuild,
    /// The GPU was requested, but `NPR_GPU` disables it.
    #[error("a device was asked for (--backend gpu), and NPR_GPU=off says to look for none")]
    GpuOff,
    /// The GPU was required, but there is no adapter.
    #[error("NPR_GPU=required, but {0}")]
    GpuRequired(String),
    /// The environment variable `NPR_GPU` has an unknown value.
    #[error("NPR_GPU={0:?}: it must be required, auto or off")]
    Policy(String),
    /// A file or directory in a command's arguments that does not exist.
    #[error("{role} {}: no such {}", path.display(), role.kind())]
    NoSuchPath {
        /// Its role.
        role: PathRole,
        /// The path.
        path: std::path::PathBuf,
    },
    /// A directory where a command needs a file.
    #[error("{role} {}: is a directory", path.display())]
    IsDirectory {
        /// Its role.
        role: PathRole,
        /// The path.
        path: std::path::PathBuf,
    },
    /// A file or directory in a command's arguments that cannot be accessed.
    #[error("{role} {}: {source}", path.display())]
    Unusable {
        /// Its role.
        role: PathRole,
        /// The path.
        path: std::path::PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A picture file whose extension is not that of a supported format.
    #[error(
        "output {}: unknown picture format (expected {}, or - for PNG on standard output)",
        path.display(),
        PictureFormat::EXTENSIONS.map(|(extension, _)| format!(".{extension}")).join(", ")
    )]
    PictureFormat {
        /// The file.
        path: std::path::PathBuf,
    },
    /// A picture that exceeds the largest size of its file format.
    #[error("a picture of {width} × {height} px: each side of a {format} picture must lie in 1..={limit}")]
    FormatSize {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
        /// The format of the file.
        format: PictureFormat,
        /// Px.
        limit: u32,
    },
    /// Two outputs that would both be written to standard output.
    #[error("--json and -o - would both write to standard output")]
    StandardOutputTwice,
    /// A file that could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The path.
        path: std::path::PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A file that could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// The path.
        path: std::path::PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A budget for what a style does not have.
    #[error("the style {style:?} has no {measure} that could err")]
    NothingErrs {
        /// The style.
        style: String,
        /// The measure.
        measure: &'static str,
    },
    /// No way to make a picture is in the cost table.
    #[error("the cost table knows no way to make this picture: npr calibrate measures this machine anew")]
    NoConfiguration,
    /// No way to make a picture is as fast as a budget asks.
    #[error(
        "the fastest way to make this picture takes {least_plain:.2} plain passes ({least_ms:.1} ms when this machine was calibrated), and {asked_plain:.2} are asked for"
    )]
    NoSuchSpeed {
        /// What the budget allows, in plain passes.
        asked_plain: f64,
        /// What the fastest way is expected to take, in plain passes.
        least_plain: f64,
        /// The same in ms.
        least_ms: f64,
    },
    /// No way to make a picture is as accurate as a budget asks.
    #[error(
        "no way to make this picture{} keeps {measure} to {asked}: the best one found errs by {least:.4}",
        if *in_time { " in the time" } else { "" }
    )]
    NoSuchAccuracy {
        /// The measure that is not kept to.
        measure: &'static str,
        /// What the budget allows.
        asked: f64,
        /// The least error that was measured.
        least: f64,
        /// Whether only ways within a time were tried.
        in_time: bool,
    },
    /// No folder for caches is known.
    #[error("this system names no folder for caches: give a file with -o, and to plans with --calibration")]
    NoCache,
    /// A calibration that cannot be used.
    #[error("{}: {what}", path.display())]
    Calibration {
        /// The file.
        path: std::path::PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// A picture that would overwrite one of its inputs.
    #[error("{}: it is read for the picture, and would be overwritten by it", path.display())]
    Overwrites {
        /// The file.
        path: std::path::PathBuf,
    },
    /// A table that could not be read.
    #[error("{}:{line}: column {column:?}: {message}", path.display())]
    Csv {
        /// The file.
        path: std::path::PathBuf,
        /// The line, from 1.
        line: u64,
        /// The name of the column; empty if the whole line is meant.
        column: String,
        /// What is wrong.
        message: String,
    },
    /// A diagram that could not be made a picture.
    #[cfg(feature = "laboratory")]
    #[error(transparent)]
    Plot(#[from] crate::plot::PngError),
    /// A result of the report that cannot be written as TOML.
    #[error("a result could not be kept: {0}")]
    StageWrite(toml::ser::Error),
    /// A sweep or chart that does not exist.
    #[error("no {kind} is called {name:?} ({}there are: {known})", did_you_mean(nearest))]
    UnknownMeasurement {
        /// "sweep" or "chart".
        kind: &'static str,
        /// The value requested.
        name: String,
        /// One with a similar name, if there is one.
        nearest: Option<String>,
        /// The existing names.
        known: String,
    },
    /// Data that could not be written as JSON.
    #[error("could not write JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl HarnessError {
    /// Whether the error is the GPU's, so that the CPU can render the picture.
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

    /// Whether the picture exceeds a limit of the GPU, without a failure.
    pub(crate) fn is_device_limit(&self) -> bool {
        use npr_outline::OutlineError;
        match self {
            Self::TextureTooLarge { .. }
            | Self::RampTooLarge { .. }
            | Self::BufferTooLarge { .. }
            | Self::TooManyDraws { .. }
            | Self::FloatTargets
            | Self::ParallelVolumes => true,
            Self::Outline(error) => matches!(error, OutlineError::TooManyEdges { .. }),
            #[cfg(feature = "gpu")]
            Self::Hatch(error) => matches!(error, npr_hatch::HatchError::TooLarge { .. }),
            _ => false,
        }
    }

    /// Whether the GPU cannot render any further picture.
    pub(crate) fn is_final(&self) -> bool {
        matches!(self, Self::Lost { .. } | Self::OutOfMemory { .. })
    }
}
