//! The reference renderer: ray casting on the CPU in f64.
//!
//! One ray through each pixel's centre finds the surface that a rasteriser with exact arithmetic would find there.
//! Shading implements the formulas without optimisation. With several samples per pixel, surfaces and edge lines are
//! supersampled; that picture is the ground truth for measurements of accuracy.

pub mod frame;
mod ground;
mod ground_hit;
pub mod primary_hits;
mod shade;
mod surface;
pub(crate) mod veils;

pub use frame::{CpuFrame, CpuOptions};
pub use primary_hits::PrimaryHits;

use crate::camera::PictureRays;
use crate::edge_lines::cpu::draw_lines;
use crate::hatch::cpu::Strokes;
use crate::hull_lines::cpu::draw_hulls;
use crate::image_lines::cpu::draw_ink;
use crate::image_lines::gbuffer::texel::GBufferTexel;
use crate::plan::Plan;
use crate::printed_fins::cpu::draw_printed;
use crate::rays::Hit;
use crate::scene::Scene;
use crate::scene::opacity::HIDES_FROM;
use crate::shadow::cpu::ShadowAt;
use crate::view::{View, size_px};
use glam::{DVec2, DVec3, DVec4};
use ground_hit::GroundHit;
use npr_mesh::AlphaMode;
use primary_hits::Hits;
use std::sync::atomic::{AtomicU32, Ordering};

/// Everything that is the same for all pixels of a frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameContext<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) plan: &'a Plan,
    /// Width and height of the sample grid, px.
    size: (u32, u32),
    /// Generates rays through its points.
    rays: PictureRays,
    shift_px: DVec2,
    /// The strokes that surfaces are hatched with.
    strokes: Option<Strokes<'a>>,
    /// In px of the sample grid.
    boundary_inset_px: f64,
    /// Whether a cut-out face may be at the place of another.
    has_coincident_cut_outs: bool,
}

/// Renders a frame.
///
/// `progress` is called with the fraction done, 0..=1, from any thread.
pub fn render(scene: &Scene, plan: &Plan, options: &CpuOptions, progress: &(dyn Fn(f64) + Sync)) -> CpuFrame {
    render_kept(&PrimaryHits::new(scene, plan.view), plan, options, progress)
}

/// As [`render`], with primary hits that may be cached. `hits` must be for the plan's camera.
pub(crate) fn render_kept(
    hits: &PrimaryHits<'_>,
    plan: &Plan,
    options: &CpuOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CpuFrame {
    let mut frame = without_ink(hits, plan, options, progress);
    if let Some(image) = &plan.image {
        draw_ink(image, &mut frame);
    }
    frame
}

/// The frame before lines are found in the image, and the packed G-buffer for finding them.
pub(crate) fn without_ink(
    hits: &PrimaryHits<'_>,
    plan: &Plan,
    options: &CpuOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CpuFrame {
    let (scene, view) = (hits.scene, &plan.view);
    let context = FrameContext::new(scene, plan, options);
    let hits = hits.hits(view, options, || context.first_hits(options.threads));
    let beside_picture = plan.image.as_ref().is_some_and(|image| !image.own_surfaces);
    let mut fine = context.trace(hits.as_ref(), options.threads, true, beside_picture, progress);
    let shared = (std::mem::take(&mut fine.texels), std::mem::take(&mut fine.gbuffer));
    if let Some(hulls) = &plan.hulls {
        draw_hulls(hulls, scene, view, context.shift_px, &mut fine);
    }
    if let Some(printed) = &plan.printed_fins {
        draw_printed(printed, scene, view, context.shift_px, &mut fine);
    }
    if let Some(edges) = &plan.edge_lines {
        let veils = if plan.veiled { context.veils(options.threads) } else { Vec::new() };
        draw_lines(edges, scene, view, context.shift_px, &veils, &mut fine);
    }
    let mut frame = if view.samples == 1 { fine } else { fine.resolved(view.samples) };
    if let Some(image) = &plan.image {
        (frame.texels, frame.gbuffer) = if image.own_surfaces {
            // One sample per pixel of the ink, independent of the picture's samples, so that lines are as wide as on
            // the GPU.
            let own = context.of_ink(image.size, options).trace(None, options.threads, false, true, &|_| {});
            (own.texels, own.gbuffer)
        } else {
            shared
        };
    }
    frame
}

/// A row of the G-buffer.
enum TexelRow<'a> {
    Packed(&'a mut [[u32; 2]]),
    Unquantised(&'a mut [GBufferTexel]),
}

/// The visible surface point at a pixel.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    /// The depth buffer's value.
    pub(crate) depth: f64,
    /// Its shadow state.
    pub(crate) shadow: ShadowAt,
    /// The index of its face.
    pub(crate) face: u32,
    /// Its position in scene space.
    pub(crate) at: DVec3,
}

/// The visible surface point at each sample of the view, in rows from the top; `None` for background.
pub(crate) fn seen(hits: &PrimaryHits<'_>, plan: &Plan, options: &CpuOptions) -> Vec<Option<Seen>> {
    let context = FrameContext::new(hits.scene, plan, options);
    let known = hits.hits(&plan.view, options, || context.first_hits(options.threads));
    let row = context.size.0 as usize;
    let mut seen = vec![None; row * context.size.1 as usize];
    context.by_rows((0u32..).zip(seen.chunks_mut(row)), options.threads, |(y, seen)| {
        for (x, seen) in (0u32..).zip(seen) {
            let known = known.as_ref().map(|hits| hits[y as usize * row + x as usize]);
            *seen = known.unwrap_or_else(|| context.first_solid(x, y)).map(|hit| Seen {
                depth: plan.view.camera.buffer_depth(hit.t),
                shadow: context.shadow_at(&hit),
                face: hit.face,
                at: context.interpolate(&hit, hit.barycentric).at,
            });
        }
    });
    seen
}

impl<'a> FrameContext<'a> {
    pub(crate) fn new(scene: &'a Scene, plan: &'a Plan, options: &CpuOptions) -> Self {
        let View { camera, samples, .. } = &plan.view;
        Self {
            scene,
            plan,
            size: plan.view.sampled_size(),
            rays: camera.rays(plan.view.sampled_size_px()),
            shift_px: options.shift_px * f64::from(*samples),
            strokes: plan.hatch().map(|hatch| Strokes::new(hatch, *samples)),
            boundary_inset_px: options.boundary_inset_px * f64::from(*samples),
            has_coincident_cut_outs: scene.has_coincident_cut_outs(),
        }
    }

    /// The context for the pixels of the ink, if the ink has its own surface pass.
    fn of_ink(&self, size: (u32, u32), options: &CpuOptions) -> Self {
        let shift_px = options.shift_px * size_px(size) / size_px(self.plan.view.size);
        let rays = self.plan.view.camera.rays(size_px(size));
        Self { size, rays, shift_px, ..*self }
    }
}

/// The relative difference of distances up to which two faces are at one place.
const COINCIDENT: f64 = 1e-12;

/// The farthest distance that is that of a face at `t`, up to rounding.
fn coincident_end(t: f64) -> f64 {
    t * (1.0 + COINCIDENT)
}

impl FrameContext<'_> {
    /// The visible unblended surface at a point of the picture, px: its position and the display-referred colour of a
    /// pixel centred there. Blended surfaces are ignored.
    pub(crate) fn seen_at(&mut self, point_px: DVec2) -> Option<(DVec3, DVec3)> {
        let corner = point_px.floor().max(DVec2::ZERO);
        self.shift_px = point_px - corner - 0.5;
        let (x, y) = (corner.x as u32, corner.y as u32);
        let hit = self.first_solid(x, y)?;
        Some((self.interpolate(&hit, hit.barycentric).at, self.paint(&hit, x, y).truncate()))
    }

    /// Paints surfaces if `picture` is set, and fills the packed G-buffer for lines in the image if `texels` is set.
    /// Lines are drawn afterwards. `hits` are those of [`Self::first_hits`], if known.
    fn trace(
        &self,
        hits: Option<&Hits>,
        threads: usize,
        picture: bool,
        texels: bool,
        progress: &(dyn Fn(f64) + Sync),
    ) -> CpuFrame {
        let (width, height) = self.size;
        let (row, pixels) = (width as usize, width as usize * height as usize);
        let mut color = vec![DVec4::ZERO; if picture { pixels } else { 0 }];
        let mut depth = vec![0.0; color.len()];
        let is_packed = self.plan.image.as_ref().is_some_and(|image| image.gbuffer.is_none());
        let mut gbuffer = vec![[0; 4]; if texels && !is_packed { pixels } else { 0 }];
        let mut texels = vec![[0; 2]; if texels && is_packed { pixels } else { 0 }];
        let packed = texels.chunks_mut(row).map(TexelRow::Packed);
        let rows_of_texels = packed.chain(gbuffer.chunks_mut(row).map(TexelRow::Unquantised)).map(Some);
        let rows_of_texels = rows_of_texels.chain(std::iter::repeat_with(|| None));
        let rows_of_picture = color.chunks_mut(row).zip(depth.chunks_mut(row)).map(Some);
        let rows_of_picture = rows_of_picture.chain(std::iter::repeat_with(|| None));
        let rows = AtomicU32::new(0);
        self.by_rows((0..height).zip(rows_of_picture.zip(rows_of_texels)), threads, |(y, (picture, texels))| {
            let hits = hits.map(|hits| &hits[y as usize * row..][..row]);
            self.trace_row(y, width, hits, picture, texels);
            let done = rows.fetch_add(1, Ordering::Relaxed) + 1;
            progress(f64::from(done) / f64::from(height));
        });
        CpuFrame { width, height, color, depth, texels, gbuffer }
    }

    /// The nearest unblended hit at each pixel.
    fn first_hits(&self, threads: usize) -> Hits {
        let (width, height) = self.size;
        let mut hits = vec![None; width as usize * height as usize];
        self.by_rows((0u32..).zip(hits.chunks_mut(width as usize)), threads, |(y, row)| {
            for (x, hit) in (0..).zip(row) {
                *hit = self.first_solid(x, y);
            }
        });
        Hits::new(hits)
    }

    /// Runs `work` for all rows on several threads. Rows are handed out one by one, since their cost varies. A single
    /// thread is the calling thread, because some platforms have no other.
    fn by_rows<Row>(&self, rows: impl Iterator<Item = Row> + Send, threads: usize, work: impl Fn(Row) + Sync) {
        // Built before the threads need it, so that they do not wait for each other.
        self.scene.build_rays();
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
        mut texels: Option<TexelRow<'_>>,
    ) {
        for x in 0..width {
            let solid = hits.map_or_else(|| self.first_solid(x, y), |hits| hits[x as usize]);
            let ground = self.ground_at(solid.as_ref(), x, y);
            let hiding = if self.plan.blended_hide { self.first_hiding(solid, x, y) } else { solid };
            if let Some((color, depth)) = &mut picture {
                color[x as usize] = self.trace_pixel(solid.as_ref(), ground.as_ref(), x, y);
                depth[x as usize] = hiding.map_or(0.0, |hit| self.plan.view.camera.buffer_depth(hit.t));
            }
            // A blended surface that hides lines is in front of the ground.
            let ground = ground.filter(|_| hiding == solid);
            match (&mut texels, &ground) {
                (Some(TexelRow::Packed(texels)), Some(ground)) => texels[x as usize] = self.ground_texel(ground),
                (Some(TexelRow::Unquantised(texels)), Some(_)) => texels[x as usize] = self.ground_gbuffer_texel(),
                (Some(TexelRow::Packed(texels)), None) => texels[x as usize] = self.texel(hiding.as_ref(), x, y),
                (Some(TexelRow::Unquantised(texels)), None) => {
                    texels[x as usize] = self.gbuffer_texel(hiding.as_ref(), x, y)
                }
                (None, _) => {}
            }
        }
    }

    /// The sample point of a pixel.
    pub(crate) fn sample_point(&self, x: f64, y: f64) -> DVec2 {
        DVec2::new(x + 0.5, y + 0.5) + self.shift_px
    }

    /// The nearest unblended hit at a pixel.
    fn first_solid(&self, x: u32, y: u32) -> Option<Hit> {
        let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
        let is_solid = |hit: &Hit| {
            self.is_shown(hit)
                && self.scene.keeps(origin + direction * hit.t)
                && !self.is_blended(hit)
                && !self.is_cut_out(hit, x, y)
                && !self.is_inset(hit, x, y)
        };
        let nearest = self.scene.closest(origin, direction, self.plan.view.camera.depth_range(), is_solid)?;
        if !self.has_coincident_cut_outs {
            return Some(nearest);
        }
        // Of faces at one place, whose distances are equal up to rounding, what is left of a cut-out is seen, and of several
        // the later.
        let coincident =
            self.scene.all(origin, direction, (nearest.t * (1.0 - COINCIDENT), coincident_end(nearest.t)), is_solid);
        let is_cut = |hit: &Hit| matches!(self.material(hit).alpha_mode, AlphaMode::Mask { .. });
        coincident.into_iter().max_by_key(|hit| (is_cut(hit), hit.object, hit.face))
    }

    /// The nearest surface at a pixel that hides lines behind it: `solid`, the nearest unblended one, or a blended one in
    /// front of it.
    fn first_hiding(&self, solid: Option<Hit>, x: u32, y: u32) -> Option<Hit> {
        let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
        let range = self.plan.view.camera.depth_range();
        let nearer = (range.0, solid.map_or(range.1, |hit| coincident_end(hit.t)));
        let hides = |hit: &Hit| {
            self.is_blended(hit)
                && self.is_shown(hit)
                && self.scene.keeps(origin + direction * hit.t)
                && self.opacity(hit, x, y) >= HIDES_FROM
        };
        self.scene.closest(origin, direction, nearer, hides).or(solid)
    }

    fn trace_pixel(&self, solid: Option<&Hit>, ground: Option<&GroundHit>, x: u32, y: u32) -> DVec4 {
        let paper = self.plan.paper.as_dvec3();
        let mut color = match (ground, solid) {
            (Some(ground), _) => self.paint_ground(ground, x, y),
            (None, Some(hit)) if self.plan.paint.is_some() => self.paint(hit, x, y).truncate(),
            _ => paper,
        };
        if self.plan.blended {
            let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
            let range = self.plan.view.camera.depth_range();
            let nearer = (range.0, solid.map_or(range.1, |hit| coincident_end(hit.t)));
            let is_blended =
                |hit: &Hit| self.is_shown(hit) && self.is_blended(hit) && self.scene.keeps(origin + direction * hit.t);
            let mut hits = self.scene.all(origin, direction, nearer, is_blended);
            // Of coincident ones the later is above; a stable sort keeps their order.
            hits.sort_by(|a, b| b.t.total_cmp(&a.t));
            for hit in hits {
                let over = self.paint(&hit, x, y);
                color = color.lerp(over.truncate(), over.w);
            }
        }
        color.extend(1.0)
    }
}
