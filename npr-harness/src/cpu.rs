//! The frame on the CPU: rays, f64, the reference.
//!
//! One ray through each pixel's centre finds what a rasteriser with exact arithmetic would find there; everything after
//! that is written as the formulas read. `samples` per pixel along each axis supersample the whole picture, lines
//! included: that is the truth against which accuracy is measured.

mod hatch;
mod ink;
mod lines;
mod shade;
mod shadow;
mod sight;
mod surface;

pub(crate) use ink::{Blot, blotted};
pub use lines::draw_lines;
pub(crate) use shadow::ShadowAt;
pub use sight::Sight;

use crate::camera::{Camera, PictureRays};
use crate::color::to_bytes;
use crate::compare::Image;
use crate::light::lights_in_world;
use crate::plan::Plan;
use crate::rays::Hit;
use crate::scene::Scene;
use crate::style::{Lines, Shade, Style};
use crate::texture::MipMapped;
use glam::{DVec2, DVec3, DVec4};
use hatch::Strokes;
use npr_toon::source::{Light, combined_color};
use shadow::Casting;
use sight::Hits;
use std::sync::atomic::{AtomicU32, Ordering};

/// What is asked of a frame on the CPU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CpuOptions {
    /// Samples per pixel along each axis, at least 1.
    pub samples: u32,
    /// Where surfaces are sampled relative to the pixels' centres, px: what changes with it is where the reference is
    /// sensitive. Lines stay where they are, since their coverage is no sample; whether they are hidden is decided by
    /// the moved samples. The printed fins, which have no coverage, are sampled like surfaces.
    pub shift_px: DVec2,
    /// Faces end so far before their boundaries, px: what is then seen between two faces that lie side by side without
    /// being joined is what a device may show there, whose corners are rounded.
    pub boundary_inset_px: f64,
    /// At most so many threads; 0 for as many as the machine has.
    pub threads: usize,
}

impl Default for CpuOptions {
    fn default() -> Self {
        Self { samples: 1, shift_px: DVec2::ZERO, boundary_inset_px: 0.0, threads: 0 }
    }
}

/// A picture in f64, before it is rounded to bytes, and the depth buffer under it.
#[derive(Clone, Debug)]
pub struct CpuFrame {
    /// Px.
    pub width: u32,
    /// Px.
    pub height: u32,
    /// Per pixel, rows from the top: display-referred RGBA, 0..=1.
    pub color: Vec<DVec4>,
    /// Per pixel the depth buffer's value, 0 where there is nothing.
    pub depth: Vec<f64>,
    /// Per pixel of the ink normal, region and depth, packed, where lines are found in the image; else empty.
    pub texels: Vec<[u32; 2]>,
}

impl CpuFrame {
    /// Rounded to bytes.
    pub fn image(&self) -> Image {
        let rgba8 = self.color.iter().flat_map(|&c| to_bytes(c)).collect();
        Image::new(self.width, self.height, rgba8).expect("four bytes a pixel")
    }
}

/// Everything that is the same for all pixels of a frame.
pub struct FrameContext<'a> {
    /// What is shown.
    pub scene: &'a Scene,
    /// How.
    pub style: &'a Style,
    /// From where.
    pub camera: &'a Camera,
    /// Px, of the grid that is sampled.
    pub size_px: DVec2,
    /// Through its points.
    rays: PictureRays,
    /// As the style's shade asks for them: one, or two for the painter.
    pub lights: Vec<Light>,
    /// Of all of them.
    light_color: DVec3,
    textures: &'a [MipMapped],
    shift_px: DVec2,
    plan: &'a Plan,
    /// What surfaces are hatched with.
    strokes: Option<Strokes<'a>>,
    /// Whether surfaces get their colours.
    painting: bool,
    /// In px of the grid that is sampled.
    boundary_inset_px: f64,
    /// Where shadows come from.
    casting: Option<Casting>,
}

/// Renders a frame.
///
/// `progress` is called with the share that is done, 0..=1, from any thread.
pub fn render(
    scene: &Scene,
    style: &Style,
    plan: &Plan,
    camera: &Camera,
    size: (u32, u32),
    options: &CpuOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CpuFrame {
    render_seen(&Sight::new(scene, camera, size), style, plan, options, progress)
}

/// As [`render`], of a view of which something may be known.
pub fn render_seen(
    sight: &Sight<'_>,
    style: &Style,
    plan: &Plan,
    options: &CpuOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CpuFrame {
    let mut frame = without_ink(sight, style, plan, options, progress);
    if let Some(image) = &plan.image {
        ink::draw_ink(image, &mut frame);
    }
    frame
}

/// The frame before lines are found in it, and the texels for that.
pub(crate) fn without_ink(
    sight: &Sight<'_>,
    style: &Style,
    plan: &Plan,
    options: &CpuOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CpuFrame {
    let Sight { scene, camera, size: (width, height), .. } = *sight;
    let samples = options.samples.max(1);
    let textures = textures(scene, plan);
    let context = FrameContext::new(scene, style, plan, camera, (width, height), options, textures);
    let fine_size = (width * samples, height * samples);
    let hits = sight.hits(fine_size, options, || context.first_hits(fine_size, options.threads));
    let mut fine = context.trace(fine_size, hits.as_ref(), options.threads, true, progress);
    let shared_texels = std::mem::take(&mut fine.texels);
    match &style.lines {
        Some(Lines::Fins(look)) => draw_lines(&context, &mut fine, look, f64::from(samples)),
        Some(Lines::Printed { width_px, ink }) => {
            lines::draw_printed(&context, &mut fine, f64::from(*width_px) * f64::from(samples), *ink);
        }
        Some(Lines::Image(_)) | None => {}
    }
    let mut frame = if samples == 1 { fine } else { averaged(&fine, width, height, samples) };
    if let Some(image) = &plan.image {
        let (ink_width, ink_height) = image.ink.scale.size((width, height));
        frame.texels = if (ink_width, ink_height) == (width, height) && samples == 1 {
            shared_texels
        } else {
            // One sample for each pixel of the ink, whatever the picture has: lines are as wide as on a device.
            let size_px = DVec2::new(ink_width.into(), ink_height.into());
            let shift_px = options.shift_px * size_px / DVec2::new(width.into(), height.into());
            let rays = camera.rays(size_px);
            let context = FrameContext { size_px, rays, shift_px, painting: false, ..context };
            context.trace((ink_width, ink_height), None, options.threads, false, &|_| {}).texels
        };
    }
    frame
}

/// What is seen through a pixel.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    /// The depth buffer's value.
    pub(crate) depth: f64,
    /// What shadows make of it.
    pub(crate) shadow: ShadowAt,
    /// Which face.
    pub(crate) face: u32,
    /// World space.
    pub(crate) at: DVec3,
}

/// What is seen through each pixel, rows from the top; `None` for background.
pub(crate) fn seen(sight: &Sight<'_>, style: &Style, plan: &Plan, options: &CpuOptions) -> Vec<Option<Seen>> {
    let Sight { scene, camera, size, .. } = *sight;
    let context = FrameContext::new(scene, style, plan, camera, size, options, textures(scene, plan));
    let hits = sight.hits(size, options, || context.first_hits(size, options.threads));
    let row = size.0 as usize;
    let mut seen = vec![None; row * size.1 as usize];
    context.by_rows((0u32..).zip(seen.chunks_mut(row)), options.threads, |(y, seen)| {
        for (x, seen) in (0u32..).zip(seen) {
            let known = hits.as_ref().map(|hits| hits[y as usize * row + x as usize]);
            *seen = known.unwrap_or_else(|| context.first_solid(x, y)).map(|hit| Seen {
                depth: camera.buffer_depth(hit.t),
                shadow: context.shadow_at(&hit),
                face: hit.face,
                at: context.interpolate(&hit, hit.barycentric).at,
            });
        }
    });
    seen
}

/// The scene's textures as a frame looks them up; none if it does not.
pub(crate) fn textures<'a>(scene: &'a Scene, plan: &Plan) -> &'a [MipMapped] {
    if plan.painted || plan.cut_out || plan.image.as_ref().is_some_and(|i| i.ink.artist) {
        scene.mip_mapped()
    } else {
        &[]
    }
}

impl<'a> FrameContext<'a> {
    /// `size`: the picture's, px.
    pub(crate) fn new(
        scene: &'a Scene,
        style: &'a Style,
        plan: &'a Plan,
        camera: &'a Camera,
        (width, height): (u32, u32),
        options: &CpuOptions,
        textures: &'a [MipMapped],
    ) -> Self {
        let samples = options.samples.max(1);
        let lights = lights_in_world(style, scene, camera);
        let size_px = DVec2::new(f64::from(width * samples), f64::from(height * samples));
        Self {
            scene,
            style,
            camera,
            size_px,
            rays: camera.rays(size_px),
            light_color: combined_color(&lights),
            lights,
            textures,
            shift_px: options.shift_px * f64::from(samples),
            plan,
            strokes: match (&style.shade, &plan.hatch) {
                (Shade::Hatch(shade), Some(plan)) => Some(Strokes::new(shade, plan, style.normals, samples)),
                _ => None,
            },
            painting: plan.painted,
            boundary_inset_px: options.boundary_inset_px * f64::from(samples),
            casting: plan.shadow.as_ref().map(|shadow| Casting::new(shadow, scene, style, camera)),
        }
    }
}

impl FrameContext<'_> {
    /// The solid surface that is seen through any point of the picture, px: where it is, and its display-referred
    /// colour, as a pixel that had its centre there would show it. What is blended over it is left out.
    pub(crate) fn seen_at(&mut self, point_px: DVec2) -> Option<(DVec3, DVec3)> {
        let corner = point_px.floor().max(DVec2::ZERO);
        self.shift_px = point_px - corner - 0.5;
        let (x, y) = (corner.x as u32, corner.y as u32);
        let hit = self.first_solid(x, y)?;
        Some((self.interpolate(&hit, hit.barycentric).at, self.paint(&hit, x, y).truncate()))
    }

    /// Paints surfaces; lines are drawn over them afterwards. Without a picture only what lines are found in is made.
    /// `hits`, if they are known, are those of [`Self::first_hits`].
    fn trace(
        &self,
        (width, height): (u32, u32),
        hits: Option<&Hits>,
        threads: usize,
        picture: bool,
        progress: &(dyn Fn(f64) + Sync),
    ) -> CpuFrame {
        let (row, pixels) = (width as usize, width as usize * height as usize);
        let mut color = vec![DVec4::ZERO; if picture { pixels } else { 0 }];
        let mut depth = vec![0.0; color.len()];
        let mut texels = vec![[0; 2]; if self.plan.image.is_some() { pixels } else { 0 }];
        let rows_of_texels = texels.chunks_mut(row).map(Some).chain(std::iter::repeat_with(|| None));
        let rows_of_picture = color.chunks_mut(row).zip(depth.chunks_mut(row)).map(Some);
        let rows_of_picture = rows_of_picture.chain(std::iter::repeat_with(|| None));
        let rows = AtomicU32::new(0);
        self.by_rows((0..height).zip(rows_of_picture.zip(rows_of_texels)), threads, |(y, (picture, texels))| {
            let hits = hits.map(|hits| &hits[y as usize * row..][..row]);
            self.trace_row(y, width, hits, picture, texels);
            let done = rows.fetch_add(1, Ordering::Relaxed) + 1;
            progress(f64::from(done) / f64::from(height));
        });
        CpuFrame { width, height, color, depth, texels }
    }

    /// What is seen through each pixel, but for what is blended over it.
    fn first_hits(&self, (width, height): (u32, u32), threads: usize) -> Hits {
        let mut hits = vec![None; width as usize * height as usize];
        self.by_rows((0u32..).zip(hits.chunks_mut(width as usize)), threads, |(y, row)| {
            for (x, hit) in (0..).zip(row) {
                *hit = self.first_solid(x, y);
            }
        });
        Hits::new(hits)
    }

    /// Does `work` for all rows, on several threads. Rows are handed out one by one, since the cost of a row depends on
    /// what is in it. With one thread that is the caller's: some platforms have no other.
    fn by_rows<Row>(&self, rows: impl Iterator<Item = Row> + Send, threads: usize, work: impl Fn(Row) + Sync) {
        // Built before the threads ask for it, so that they do not wait for each other.
        self.scene.rays();
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { available } else { threads };
        if threads == 1 {
            rows.for_each(work);
            return;
        }
        let rows = std::sync::Mutex::new(rows);
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    loop {
                        let next = rows.lock().expect("no thread panics while it holds the lock").next();
                        let Some(row) = next else { break };
                        work(row);
                    }
                });
            }
        });
    }

    fn trace_row(
        &self,
        y: u32,
        width: u32,
        hits: Option<&[Option<Hit>]>,
        mut picture: Option<(&mut [DVec4], &mut [f64])>,
        mut texels: Option<&mut [[u32; 2]]>,
    ) {
        for x in 0..width {
            let solid = hits.map_or_else(|| self.first_solid(x, y), |hits| hits[x as usize]);
            if let Some((color, depth)) = &mut picture {
                color[x as usize] = self.trace_pixel(solid.as_ref(), x, y);
                depth[x as usize] = solid.map_or(0.0, |hit| self.camera.buffer_depth(hit.t));
            }
            if let Some(texels) = &mut texels {
                texels[x as usize] = self.texel(solid.as_ref(), x, y);
            }
        }
    }

    /// The point of the picture that stands for a pixel.
    pub fn sample_point(&self, x: f64, y: f64) -> DVec2 {
        DVec2::new(x + 0.5, y + 0.5) + self.shift_px
    }

    /// What is seen through a pixel, but for what is blended over it.
    fn first_solid(&self, x: u32, y: u32) -> Option<Hit> {
        let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
        let is_solid = |hit: &Hit| {
            self.is_shown(hit)
                && self.scene.keeps(origin + direction * hit.t)
                && !self.is_blended(hit)
                && !self.is_cut_out(hit, x, y)
                && !self.is_inset(hit, x, y)
        };
        self.scene.rays().closest(origin, direction, self.camera.depth_range(), is_solid)
    }

    fn trace_pixel(&self, solid: Option<&Hit>, x: u32, y: u32) -> DVec4 {
        let paper = self.style.paper.as_dvec3();
        let mut color = match solid {
            Some(hit) if self.painting => self.paint(hit, x, y).truncate(),
            _ => paper,
        };
        if self.plan.blended && self.painting {
            let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
            let range = self.camera.depth_range();
            let nearer = (range.0, solid.map_or(range.1, |hit| hit.t));
            let is_blended =
                |hit: &Hit| self.is_shown(hit) && self.is_blended(hit) && self.scene.keeps(origin + direction * hit.t);
            for hit in self.scene.rays().all(origin, direction, nearer, is_blended).iter().rev() {
                let over = self.paint(hit, x, y);
                color = color.lerp(over.truncate(), over.w);
            }
        }
        color.extend(1.0)
    }
}

/// The mean of each pixel's samples, in display space, as coverage is blended there; of the depth, the nearest.
fn averaged(fine: &CpuFrame, width: u32, height: u32, samples: u32) -> CpuFrame {
    let mut color = Vec::with_capacity(width as usize * height as usize);
    let mut depth = Vec::with_capacity(color.capacity());
    for y in 0..height {
        for x in 0..width {
            let (mut sum, mut nearest) = (DVec4::ZERO, 0.0f64);
            for sub in 0..samples * samples {
                let row = (y * samples + sub / samples) as usize * fine.width as usize;
                let at = row + (x * samples + sub % samples) as usize;
                sum += fine.color[at];
                nearest = nearest.max(fine.depth[at]);
            }
            color.push(sum / f64::from(samples * samples));
            depth.push(nearest);
        }
    }
    CpuFrame { width, height, color, depth, texels: Vec::new() }
}
