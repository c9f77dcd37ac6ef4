//! The table `[lines.image.gbuffer]` of a style file.
//!
//! Cosines, steps, taps and softness are those of `[lines.image]`.

use super::style::{Background, GBuffer, GBufferTarget, InkStep, MOST_STEPS, SeparateTargets, Show, StepKind};
use crate::schema::one;
use npr_imagespace::composite::AlphaTest;
use npr_imagespace::filter::depth::DepthPlain;
use npr_imagespace::filter::inker::{DEPTH_DELTA, Inker, InkerForm};
use npr_imagespace::filter::printed::{PrintedDepth, PrintedEdges, PrintedFilter, PrintedNormal};
use npr_imagespace::filter::separate::{SeparateDepth, SeparateDepthTest, SeparateFilter, SeparateNormal};
use npr_imagespace::format::depth::DepthFormat;
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::morphology::{Kernel, Operation};
use npr_imagespace::picture::Taps;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct GBufferTable {
    target: TargetName,
    #[serde(default)]
    background: BackgroundName,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    depth_test: Option<DepthTestName>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    normal_format: Option<NormalFormatName>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    depth_format: Option<DepthFormatName>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    region_test: Option<RegionTestName>,
    #[serde(default = "one")]
    far: f32,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    negated_depth: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    co_issued: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    inker: Option<InkerTable>,
    #[serde(default)]
    show: ShowName,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    step: Vec<StepTable>,
}

#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TargetName {
    Rgba8,
    Separate,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BackgroundName {
    #[default]
    None,
    PlusZ,
}

#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum DepthTestName {
    Sum,
    SumPrinted,
    Each,
    Step,
    Bend,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum NormalFormatName {
    Float,
    Half,
    Bytes,
    #[serde(rename = "octahedral-5")]
    Oct5,
    #[serde(rename = "octahedral-8")]
    Oct8,
    #[serde(rename = "octahedral-16")]
    Oct16,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
enum DepthFormatName {
    #[serde(rename = "float")]
    Float,
    #[serde(rename = "half")]
    Half,
    #[serde(rename = "8-bit")]
    Bits8,
    #[serde(rename = "16-bit")]
    Bits16,
    #[serde(rename = "packed-2x8")]
    Packed2,
    #[serde(rename = "packed-4x8")]
    Packed4,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RegionTestName {
    Numbers,
    ColorSums,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ShowName {
    #[default]
    Lines,
    Normals,
    Depth,
    Regions,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default, expecting = "a table of the inker, also {}")]
struct InkerTable {
    form: InkerFormName,
    normal_cos: f32,
    normal_fall: f32,
    depth_delta: f32,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum InkerFormName {
    Printed,
    Corrected,
    Explicit,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StepTable {
    kind: StepName,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    kernel: Option<KernelName>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    threshold: Option<f32>,
    #[serde(default = "once")]
    times: u32,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StepName {
    Dilate,
    Erode,
    Open,
    Close,
    SoftCross,
    SoftDiagonal,
    SoftDiagonalPrinted,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum KernelName {
    Cross,
    Diagonal,
    Square,
}

fn once() -> u32 {
    1
}

impl Default for InkerTable {
    fn default() -> Self {
        Self::new(&Inker::default())
    }
}

impl InkerTable {
    fn new(inker: &Inker) -> Self {
        Self {
            form: match inker.form {
                InkerForm::Printed => InkerFormName::Printed,
                InkerForm::Corrected => InkerFormName::Corrected,
                InkerForm::Explicit => InkerFormName::Explicit,
            },
            normal_cos: inker.normal_cos,
            normal_fall: inker.normal_fall,
            depth_delta: inker.depth_delta,
        }
    }
}

/// The keys of `[lines.image]` that the filters over a G-buffer take too.
#[derive(Clone, Copy)]
pub(crate) struct SharedKeys {
    pub(crate) normal_cos: Option<f32>,
    pub(crate) depth_step: Option<f32>,
    pub(crate) regions: bool,
    /// Whether the kind of regions is not the default, and whether the tests of normals and depth are not.
    pub(crate) named_regions: bool,
    pub(crate) named_tests: bool,
    pub(crate) taps: Taps,
    pub(crate) softness: f32,
    /// That of the composite.
    pub(crate) alpha_test: Option<AlphaTest>,
}

impl SharedKeys {
    pub(crate) fn of(gbuffer: &GBuffer) -> Self {
        match &gbuffer.target {
            GBufferTarget::Rgba8(PrintedFilter::Edges(edges)) => Self {
                normal_cos: edges.normal.map(|normal| normal.cos),
                depth_step: edges.depth.map(|depth| depth.threshold),
                // There are none, but they can be shown.
                regions: true,
                named_regions: false,
                named_tests: false,
                taps: edges.taps,
                softness: 0.0,
                alpha_test: edges.co_issued,
            },
            GBufferTarget::Rgba8(PrintedFilter::Inker(inker)) => {
                let (taps, softness) = (inker.taps, inker.softness);
                Self {
                    normal_cos: None,
                    depth_step: None,
                    regions: true,
                    named_regions: false,
                    named_tests: false,
                    taps,
                    softness,
                    alpha_test: None,
                }
            }
            GBufferTarget::Separate(SeparateTargets { filter, .. }) => Self {
                normal_cos: filter.normal.map(|normal| normal.cos),
                depth_step: filter.depth.map(|depth| match depth.test {
                    SeparateDepthTest::Bend { step } | SeparateDepthTest::Step { step } => step,
                    SeparateDepthTest::Plain { threshold, .. } => threshold,
                }),
                regions: filter.regions,
                named_regions: false,
                named_tests: false,
                taps: filter.taps,
                softness: filter.softness,
                alpha_test: None,
            },
        }
    }
}

impl GBufferTable {
    pub(crate) fn shows_lines(&self) -> bool {
        matches!(self.show, ShowName::Lines)
    }

    pub(crate) fn new(gbuffer: &GBuffer) -> Self {
        let plain = |form| match form {
            DepthPlain::Sum => DepthTestName::Sum,
            DepthPlain::SumPrinted => DepthTestName::SumPrinted,
            DepthPlain::Any => DepthTestName::Each,
        };
        let mut table = Self {
            target: TargetName::Rgba8,
            background: match gbuffer.background {
                Background::None => BackgroundName::None,
                Background::PlusZ => BackgroundName::PlusZ,
            },
            depth_test: None,
            normal_format: None,
            depth_format: None,
            region_test: None,
            far: gbuffer.far,
            negated_depth: gbuffer.negated_depth,
            co_issued: false,
            inker: None,
            show: match gbuffer.show {
                Show::Lines => ShowName::Lines,
                Show::Normals => ShowName::Normals,
                Show::Depth => ShowName::Depth,
                Show::Regions => ShowName::Regions,
            },
            step: gbuffer.steps.iter().flatten().map(StepTable::new).collect(),
        };
        match &gbuffer.target {
            GBufferTarget::Rgba8(PrintedFilter::Edges(edges)) => {
                table.depth_test = edges.depth.map(|depth| plain(depth.form));
                table.co_issued = edges.co_issued.is_some();
            }
            GBufferTarget::Rgba8(PrintedFilter::Inker(inker)) => table.inker = Some(InkerTable::new(inker)),
            GBufferTarget::Separate(separate) => {
                table.target = TargetName::Separate;
                table.depth_test = separate.filter.depth.map(|depth| match depth.test {
                    SeparateDepthTest::Bend { .. } => DepthTestName::Bend,
                    SeparateDepthTest::Step { .. } => DepthTestName::Step,
                    SeparateDepthTest::Plain { form, .. } => plain(form),
                });
                table.normal_format = Some(match separate.normals {
                    None => NormalFormatName::Float,
                    Some(NormalFormat::Half) => NormalFormatName::Half,
                    Some(NormalFormat::Biased8) => NormalFormatName::Bytes,
                    Some(NormalFormat::Oct5) => NormalFormatName::Oct5,
                    Some(NormalFormat::Oct8) => NormalFormatName::Oct8,
                    Some(NormalFormat::Oct16) => NormalFormatName::Oct16,
                });
                table.depth_format = Some(match separate.depth {
                    DepthFormat::Float => DepthFormatName::Float,
                    DepthFormat::Half => DepthFormatName::Half,
                    DepthFormat::Unorm8 => DepthFormatName::Bits8,
                    DepthFormat::Unorm16 => DepthFormatName::Bits16,
                    DepthFormat::Packed2x8 => DepthFormatName::Packed2,
                    DepthFormat::Packed4x8 => DepthFormatName::Packed4,
                });
                table.region_test =
                    Some(if separate.region_sums { RegionTestName::ColorSums } else { RegionTestName::Numbers });
            }
        }
        table
    }

    /// An error says what contradicts what.
    pub(crate) fn gbuffer(self, keys: SharedKeys) -> Result<GBuffer, String> {
        let printed_background = matches!(self.background, BackgroundName::PlusZ);
        let plain = |test| match test {
            DepthTestName::Sum => Some(DepthPlain::Sum),
            DepthTestName::SumPrinted => Some(DepthPlain::SumPrinted),
            DepthTestName::Each => Some(DepthPlain::Any),
            DepthTestName::Step | DepthTestName::Bend => None,
        };
        let is_listings = self.target == TargetName::Rgba8 && self.inker.is_none();
        if self.co_issued && !(is_listings && keys.alpha_test.is_some()) {
            let needs = "an RGBA8 target without the inker, and composite.alpha-tested";
            return Err(format!("the co-issued reading of listings 9 and 10 needs {needs}"));
        }
        let target = match self.target {
            TargetName::Rgba8 => {
                let is_separate =
                    self.normal_format.is_some() || self.depth_format.is_some() || self.region_test.is_some();
                if is_separate {
                    return Err("formats and region tests of a G-buffer need target = \"separate\"".into());
                }
                if keys.named_regions {
                    return Err("an RGBA8 target has no regions: `regions` cannot say which".into());
                }
                if matches!(self.show, ShowName::Regions) {
                    return Err("an RGBA8 target has no regions to show: target = \"separate\" has".into());
                }
                GBufferTarget::Rgba8(if let Some(inker) = self.inker {
                    if self.depth_test.is_some() {
                        return Err("the inker has a depth test of its own: `depth-test` cannot be there too".into());
                    }
                    if keys.named_tests {
                        let own = "`normals`, `normal-cos`, `depth` and `depth-step` cannot be there too";
                        return Err(format!("the inker has tests of its own: {own}"));
                    }
                    let is_explicit = matches!(inker.form, InkerFormName::Explicit);
                    if !is_explicit && (inker.depth_delta != DEPTH_DELTA || keys.softness != 0.0) {
                        return Err("only the explicit form of the inker has `depth-delta` and softness".into());
                    }
                    PrintedFilter::Inker(Inker {
                        form: match inker.form {
                            InkerFormName::Printed => InkerForm::Printed,
                            InkerFormName::Corrected => InkerForm::Corrected,
                            InkerFormName::Explicit => InkerForm::Explicit,
                        },
                        normal_cos: inker.normal_cos,
                        normal_fall: inker.normal_fall,
                        depth_delta: inker.depth_delta,
                        softness: keys.softness,
                        taps: keys.taps,
                    })
                } else {
                    if keys.softness != 0.0 {
                        return Err("lines on bytes are hard: softness needs target = \"separate\" or the inker".into());
                    }
                    let Some(form) = plain(self.depth_test.unwrap_or(DepthTestName::Sum)) else {
                        return Err("an RGBA8 target needs a depth test of \"sum\", \"sum-printed\" or \"each\"".into());
                    };
                    PrintedFilter::Edges(PrintedEdges {
                        normal: keys.normal_cos.map(|cos| PrintedNormal { cos, printed_background }),
                        depth: keys.depth_step.map(|threshold| PrintedDepth { form, threshold }),
                        taps: keys.taps,
                        co_issued: if self.co_issued { keys.alpha_test } else { None },
                    })
                })
            }
            TargetName::Separate => {
                if self.inker.is_some() {
                    return Err("the inker needs target = \"rgba8\"".into());
                }
                let test = self.depth_test.unwrap_or(DepthTestName::Bend);
                let test = |step: f32| match (plain(test), test) {
                    (Some(form), _) => SeparateDepthTest::Plain { form, threshold: step },
                    (None, DepthTestName::Step) => SeparateDepthTest::Step { step },
                    (None, _) => SeparateDepthTest::Bend { step },
                };
                GBufferTarget::Separate(SeparateTargets {
                    filter: SeparateFilter {
                        normal: keys.normal_cos.map(|cos| SeparateNormal { cos, biased: false }),
                        depth: keys
                            .depth_step
                            .map(|step| SeparateDepth { test: test(step), ..SeparateDepth::default() }),
                        regions: keys.regions,
                        taps: keys.taps,
                        softness: keys.softness,
                    },
                    normals: match self.normal_format.unwrap_or(NormalFormatName::Float) {
                        NormalFormatName::Float => None,
                        NormalFormatName::Half => Some(NormalFormat::Half),
                        NormalFormatName::Bytes => Some(NormalFormat::Biased8),
                        NormalFormatName::Oct5 => Some(NormalFormat::Oct5),
                        NormalFormatName::Oct8 => Some(NormalFormat::Oct8),
                        NormalFormatName::Oct16 => Some(NormalFormat::Oct16),
                    },
                    depth: match self.depth_format.unwrap_or(DepthFormatName::Float) {
                        DepthFormatName::Float => DepthFormat::Float,
                        DepthFormatName::Half => DepthFormat::Half,
                        DepthFormatName::Bits8 => DepthFormat::Unorm8,
                        DepthFormatName::Bits16 => DepthFormat::Unorm16,
                        DepthFormatName::Packed2 => DepthFormat::Packed2x8,
                        DepthFormatName::Packed4 => DepthFormat::Packed4x8,
                    },
                    region_sums: matches!(self.region_test, Some(RegionTestName::ColorSums)),
                })
            }
        };
        if !matches!(self.show, ShowName::Lines) && !self.step.is_empty() {
            return Err("steps of morphology need lines: show = \"lines\"".into());
        }
        if matches!(self.show, ShowName::Regions) && !keys.regions {
            return Err("regions are to be shown, and `regions` is \"none\"".into());
        }
        let count = self.step.len();
        if count > MOST_STEPS {
            return Err(format!("{count} steps of morphology: at most {MOST_STEPS} (each has `times`)"));
        }
        let mut steps = [None; MOST_STEPS];
        for (to, step) in steps.iter_mut().zip(self.step) {
            *to = Some(step.step()?);
        }
        Ok(GBuffer {
            target,
            background: if printed_background { Background::PlusZ } else { Background::None },
            far: self.far,
            negated_depth: self.negated_depth,
            steps,
            show: match self.show {
                ShowName::Lines => Show::Lines,
                ShowName::Normals => Show::Normals,
                ShowName::Depth => Show::Depth,
                ShowName::Regions => Show::Regions,
            },
        })
    }
}

impl StepTable {
    fn new(InkStep { kind, times }: &InkStep) -> Self {
        let (kind, kernel, threshold) = match *kind {
            StepKind::Hard(operation, kernel) => {
                let kernel = match kernel {
                    Kernel::Cross => KernelName::Cross,
                    Kernel::Diagonal => KernelName::Diagonal,
                    Kernel::Square => KernelName::Square,
                };
                let kind = match operation {
                    Operation::Dilate => StepName::Dilate,
                    Operation::Erode => StepName::Erode,
                    Operation::Open => StepName::Open,
                    Operation::Close => StepName::Close,
                };
                (kind, Some(kernel), None)
            }
            StepKind::SoftCross => (StepName::SoftCross, None, None),
            StepKind::SoftDiagonal(threshold) => (StepName::SoftDiagonal, None, Some(threshold)),
            StepKind::SoftDiagonalPrinted(threshold) => (StepName::SoftDiagonalPrinted, None, Some(threshold)),
        };
        Self { kind, kernel, threshold, times: *times }
    }

    fn step(self) -> Result<InkStep, String> {
        let hard = match self.kind {
            StepName::Dilate => Some(Operation::Dilate),
            StepName::Erode => Some(Operation::Erode),
            StepName::Open => Some(Operation::Open),
            StepName::Close => Some(Operation::Close),
            StepName::SoftCross | StepName::SoftDiagonal | StepName::SoftDiagonalPrinted => None,
        };
        if hard.is_none() && self.kernel.is_some() {
            return Err("a soft step has a kernel of its own: `kernel` cannot be there too".into());
        }
        let is_diagonal = matches!(self.kind, StepName::SoftDiagonal | StepName::SoftDiagonalPrinted);
        if self.threshold.is_some() && !is_diagonal {
            return Err("only smoothed diagonal steps have a threshold".into());
        }
        let threshold = self.threshold.unwrap_or(0.5);
        let kernel = match self.kernel {
            None | Some(KernelName::Cross) => Kernel::Cross,
            Some(KernelName::Diagonal) => Kernel::Diagonal,
            Some(KernelName::Square) => Kernel::Square,
        };
        let kind = match (hard, self.kind) {
            (Some(operation), _) => StepKind::Hard(operation, kernel),
            (None, StepName::SoftDiagonal) => StepKind::SoftDiagonal(threshold),
            (None, StepName::SoftDiagonalPrinted) => StepKind::SoftDiagonalPrinted(threshold),
            (None, _) => StepKind::SoftCross,
        };
        Ok(InkStep { kind, times: self.times })
    }
}
