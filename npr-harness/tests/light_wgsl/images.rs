//! Checks of npr-toon: ramps in 8-bit textures, read by `textureLoad` and by a sampler.

use crate::check::{Allowed, Check, Extra, Given, MODELS, SMALL, compare_with};
use crate::random::Random;
use glam::{DVec2, DVec4, UVec2, Vec4};
use npr_harness::gpu::GpuContext;
use npr_toon::row::{RampRow, TexelFilter, toon_row};
use npr_toon::table::{RampTable, toon_table};
use wgpu::util::DeviceExt as _;

/// The bound is an 8-bit step, except for a sampler's mix of four texels: it may quantize the weights to 1/256 along
/// each axis, and the texels here are as different as possible, so it is a step per axis.
const STEP: f64 = 1.0 / 255.0;

/// Random texels: neighbours are as different as possible.
fn any_texels(random: &Random, count: u32) -> Vec<[u8; 4]> {
    (0..count).map(|_| [(); 4].map(|()| random.pick(&[0, 255, random.below(256) as u8]))).collect()
}

fn rows(filter: TexelFilter) -> Vec<RampRow> {
    let random = Random::new(8);
    let row = |_| {
        let count = random.pick(&[1, 2, 3, 16, 256, random.below(64) + 1]);
        let (from, to) = random.pick(&[(0.0, 1.0), (-1.0, 1.0), (random.range(-1.0, 0.0), random.range(0.1, 2.0))]);
        RampRow { texels: any_texels(&random, count), from, to, filter }
    };
    (0..MODELS).map(row).collect()
}

fn tables(filter: TexelFilter) -> Vec<RampTable> {
    let random = Random::new(9);
    let table = |_| {
        let size = UVec2::new(random.below(16) + 1, random.below(16) + 1);
        RampTable { texels: any_texels(&random, size.x * size.y), size, filter }
    };
    (0..MODELS).map(table).collect()
}

/// Coordinates along the row and beyond its ends; its ends.
fn along(random: &Random, row: &RampRow) -> Given {
    let length = row.to - row.from;
    let texel = length / row.texels.len() as f32;
    let border = row.from + texel * random.below(row.texels.len() as u32 + 1) as f32;
    let x = match random.below(6) {
        0 => border + texel / 2.0,
        1 => border + texel * random.range(-0.1, 0.1),
        2 => random.range(-9.0, 9.0),
        _ => random.range(row.from - 0.1 * length, row.to + 0.1 * length),
    };
    [Vec4::new(x, row.from, row.to, 0.0); 4]
}

fn within(random: &Random, _: &RampTable) -> Given {
    [Vec4::new(random.range(-0.2, 1.2), random.range(-0.2, 1.2), 0.0, 0.0); 4]
}

/// Whether `t`, 0..=1 along `count` texels, is within 1e-5 of a border between two.
fn at_a_border(t: f64, count: u32) -> bool {
    let texels = t * f64::from(count);
    texels > 0.5 && texels < f64::from(count) - 0.5 && (texels - texels.round()).abs() < SMALL * f64::from(count)
}

fn row_color(row: &RampRow, g: &Given) -> DVec4 {
    toon_row(row, f64::from(g[0].x)).extend(0.0)
}

fn row_bound(row: &RampRow, g: &Given) -> Allowed {
    let [x, from, to, _] = g[0].as_dvec4().to_array();
    let jumps = row.filter == TexelFilter::Nearest && at_a_border((x - from) / (to - from), row.texels.len() as u32);
    if jumps { Allowed::Anything } else { Allowed::Within(STEP) }
}

fn table_color(table: &RampTable, g: &Given) -> DVec4 {
    toon_table(table, DVec2::new(f64::from(g[0].x), f64::from(g[0].y))).extend(0.0)
}

fn table_bound(table: &RampTable, g: &Given) -> Allowed {
    let jumps = at_a_border(f64::from(g[0].x), table.size.x) || at_a_border(f64::from(g[0].y), table.size.y);
    if table.filter == TexelFilter::Nearest && jumps { Allowed::Anything } else { Allowed::Within(STEP) }
}

fn sampled_table_bound(_: &RampTable, _: &Given) -> Allowed {
    Allowed::Within(2.0 * STEP)
}

const fn row(name: &'static str, wgsl: &'static str) -> Check<RampRow> {
    Check { name, wgsl, given: along, rust: row_color, allowed: row_bound }
}

const fn table(name: &'static str, wgsl: &'static str) -> Check<RampTable> {
    Check { name, wgsl, given: within, rust: table_color, allowed: table_bound }
}

/// Functions and bindings that the checks use, placed before the library.
const READERS: &str = "
    @group(0) @binding(2) var image: texture_2d<f32>;
    @group(0) @binding(3) var by_sampler: sampler;
    fn texel(x: u32, y: u32) -> vec4<f32> {
        return vec4(textureLoad(image, vec2(x, y), 0).rgb, 0.0);
    }
    fn sampled(uv: vec2<f32>) -> vec4<f32> {
        return vec4(textureSampleLevel(image, by_sampler, uv, 0.0).rgb, 0.0);
    }
    fn row_nearest(x: f32, start: f32, end: f32) -> vec4<f32> {
        return texel(toon_row_nearest(x, start, end, textureDimensions(image).x), 0u);
    }
    fn row_linear(x: f32, start: f32, end: f32) -> vec4<f32> {
        let taps = toon_row_taps(x, start, end, textureDimensions(image).x);
        return mix(texel(taps.left, 0u), texel(taps.right, 0u), taps.share);
    }
    fn table_nearest(uv: vec2<f32>) -> vec4<f32> {
        let size = textureDimensions(image);
        return texel(toon_row_nearest(uv.x, 0.0, 1.0, size.x), toon_row_nearest(uv.y, 0.0, 1.0, size.y));
    }
    fn table_linear(uv: vec2<f32>) -> vec4<f32> {
        let size = textureDimensions(image);
        let across = toon_row_taps(uv.x, 0.0, 1.0, size.x);
        let down = toon_row_taps(uv.y, 0.0, 1.0, size.y);
        return toon_table_mix(
            texel(across.left, down.left), texel(across.right, down.left),
            texel(across.left, down.right), texel(across.right, down.right), across.share, down.share);
    }";

const NEAREST_ROWS: &[Check<RampRow>] = &[
    row("toon_row, nearest, by textureLoad", "row_nearest(a.x, a.y, a.z)"),
    row("toon_row, nearest, by a sampler", "sampled(vec2((a.x - a.y) / (a.z - a.y), 0.5))"),
];
const LINEAR_ROWS: &[Check<RampRow>] = &[
    row("toon_row, linear, by textureLoad", "row_linear(a.x, a.y, a.z)"),
    row("toon_row, linear, by a sampler", "sampled(vec2((a.x - a.y) / (a.z - a.y), 0.5))"),
];
const NEAREST_TABLES: &[Check<RampTable>] = &[
    table("toon_table, nearest, by textureLoad", "table_nearest(a.xy)"),
    table("toon_table, nearest, by a sampler", "sampled(a.xy)"),
];
const LINEAR_TABLES: &[Check<RampTable>] = &[
    table("toon_table, linear, by textureLoad", "table_linear(a.xy)"),
    Check { allowed: sampled_table_bound, ..table("toon_table, linear, by a sampler", "sampled(a.xy)") },
];

pub fn calls() -> Vec<&'static str> {
    vec![READERS]
}

/// Uploads the models' texels to textures, and compares.
fn compare_images<M>(
    gpu: &GpuContext,
    filter: TexelFilter,
    models: &[M],
    image: fn(&M) -> (UVec2, &[[u8; 4]]),
    checks: &[Check<M>],
) {
    let views: Vec<_> = models
        .iter()
        .map(|model| {
            let (size, texels) = image(model);
            let descriptor = wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            let order = wgpu::util::TextureDataOrder::LayerMajor;
            let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, texels.as_flattened());
            texture.create_view(&Default::default())
        })
        .collect();
    let mode = match filter {
        TexelFilter::Nearest => wgpu::FilterMode::Nearest,
        TexelFilter::Linear => wgpu::FilterMode::Linear,
    };
    // The default address mode is clamp-to-edge.
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: mode,
        min_filter: mode,
        ..Default::default()
    });
    let resources = views
        .iter()
        .map(|view| vec![wgpu::BindingResource::TextureView(view), wgpu::BindingResource::Sampler(&sampler)])
        .collect();
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampling = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let extra = Extra { declarations: READERS.into(), layout: vec![texture, sampling], resources };
    compare_with(gpu, npr_toon::WGSL, &extra, &[], models, checks);
}

#[test]
fn rows_in_textures_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    for (filter, checks) in [(TexelFilter::Nearest, NEAREST_ROWS), (TexelFilter::Linear, LINEAR_ROWS)] {
        compare_images(
            &gpu,
            filter,
            &rows(filter),
            |row| (UVec2::new(row.texels.len() as u32, 1), &row.texels),
            checks,
        );
    }
}

#[test]
fn tables_in_textures_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    for (filter, checks) in [(TexelFilter::Nearest, NEAREST_TABLES), (TexelFilter::Linear, LINEAR_TABLES)] {
        compare_images(&gpu, filter, &tables(filter), |table| (table.size, &table.texels), checks);
    }
}
