//! Lines over a picture that somebody else has rendered, from their G-buffer.
//!
//! `cargo run -p npr-imagespace --features wgpu --example foreign_gbuffer [picture.png]`
//!
//! A sphere and a box on a plane, cast ray by ray on the CPU, stand for another renderer. It leaves four textures, as
//! an engine would: the shaded picture, world-space normals biased into bytes, the numbers of a reversed depth buffer,
//! and the number of each object.
#![allow(clippy::print_stdout)]

use glam::Vec3;
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::separate::{DepthSource, SeparateDepth, SeparateFilter, SeparateNormal};
use npr_imagespace::pass::separate::{SeparatePass, SeparateTextures};
use npr_imagespace::pass::{InkTarget, PassTarget};
use std::error::Error;
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [480, 320];
const NEAR: f32 = 0.1;

/// What a renderer leaves behind, rows from the top.
#[derive(Default)]
struct GBuffer {
    color: Vec<[u8; 4]>,
    /// (n + 1) / 2; zeros where there is nothing.
    normal: Vec<[u8; 4]>,
    /// near / z; 0 where there is nothing.
    depth: Vec<f32>,
    object: Vec<u8>,
}

/// A hit of a ray: its parameter, the normal and the object's number.
type Hit = Option<(f32, Vec3, u8)>;

fn nearer(a: Hit, b: Hit) -> Hit {
    match (a, b) {
        (Some(first), Some(second)) => Some(if second.0 < first.0 { second } else { first }),
        (a, b) => a.or(b),
    }
}

fn plane(eye: Vec3, ray: Vec3) -> Hit {
    let along = -eye.y / ray.y;
    (ray.y < 0.0 && along < 40.0).then_some((along, Vec3::Y, 1))
}

fn sphere(eye: Vec3, ray: Vec3, centre: Vec3, radius: f32, object: u8) -> Hit {
    let from = eye - centre;
    let (a, b) = (ray.length_squared(), ray.dot(from));
    let square = b * b - a * (from.length_squared() - radius * radius);
    let along = (-b - square.sqrt()) / a;
    (square > 0.0 && along > 0.0).then(|| (along, (from + ray * along) / radius, object))
}

fn cuboid(eye: Vec3, ray: Vec3, low: Vec3, high: Vec3, object: u8) -> Hit {
    let (a, b) = ((low - eye) / ray, (high - eye) / ray);
    let (enter, leave) = (a.min(b), a.max(b));
    let along = enter.max_element();
    if along < 0.0 || along > leave.min_element() {
        return None;
    }
    let axis = Vec3::from_array([0, 1, 2].map(|i| f32::from(u8::from(enter[i] == along))));
    Some((along, -axis * ray.signum(), object))
}

fn cast(eye: Vec3, ray: Vec3) -> Hit {
    let rotated = |v: Vec3| glam::Quat::from_rotation_y(0.6) * v;
    let back = |v: Vec3| glam::Quat::from_rotation_y(-0.6) * v;
    let cube = cuboid(rotated(eye), rotated(ray), Vec3::new(-1.9, 0.0, -1.1), Vec3::new(-0.5, 1.1, 0.3), 3);
    let cube = cube.map(|(along, normal, object)| (along, back(normal), object));
    let ball = sphere(eye, ray, Vec3::new(0.9, 0.8, 0.0), 0.8, 2);
    // One that is cut by the plane.
    let cap = sphere(eye, ray, Vec3::new(-0.1, -0.25, 1.5), 0.6, 4);
    nearer(nearer(plane(eye, ray), ball), nearer(cube, cap))
}

/// Another renderer.
fn render() -> GBuffer {
    let eye = Vec3::new(0.4, 2.2, 5.5);
    let forward = (Vec3::new(0.0, 0.5, 0.0) - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let light = Vec3::new(0.5, 0.9, 0.6).normalize();
    let albedo = [Vec3::ZERO, Vec3::new(0.75, 0.74, 0.70), Vec3::new(0.85, 0.45, 0.35), Vec3::new(0.45, 0.60, 0.80)];
    let mut g = GBuffer::default();
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let at = |i: u32, size: u32| (2.0 * (i as f32 + 0.5) - size as f32) / SIZE[1] as f32;
            // Of length 1 along the view, so that the parameter is the eye-space depth.
            let ray = forward + 0.42 * (right * at(x, SIZE[0]) - up * at(y, SIZE[1]));
            let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
            let Some((depth, normal, object)) = cast(eye, ray) else {
                g.color.push([225, 232, 240, 255]);
                g.normal.push([0; 4]);
                g.depth.push(0.0);
                g.object.push(0);
                continue;
            };
            let point = eye + ray * depth + normal * 1e-3;
            let lit = if cast(point, light).is_some() { 0.0 } else { normal.dot(light).max(0.0) };
            let color = albedo.get(usize::from(object)).unwrap_or(&Vec3::new(0.55, 0.7, 0.45)) * (0.45 + 0.55 * lit);
            g.color.push([byte(color.x), byte(color.y), byte(color.z), 255]);
            let biased = normal * 0.5 + 0.5;
            g.normal.push([byte(biased.x), byte(biased.y), byte(biased.z), 255]);
            g.depth.push(NEAR / depth);
            g.object.push(object);
        }
    }
    g
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| std::env::temp_dir().join("foreign_gbuffer.png"), std::path::PathBuf::from);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    let g = render();
    let [width, height] = SIZE;
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let upload = |format, bytes: &[u8]| {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let row = Some(bytes.len() as u32 / height);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: row, rows_per_image: None };
        queue.write_texture(texture.as_image_copy(), bytes, layout, size);
        texture
    };
    let picture = upload(TextureFormat::Rgba8Unorm, g.color.as_flattened());
    let normal = upload(TextureFormat::Rgba8Unorm, g.normal.as_flattened());
    let depth = upload(TextureFormat::R32Float, bytemuck::cast_slice(&g.depth));
    let object = upload(TextureFormat::R8Uint, &g.object);
    let [picture_view, normal, depth, object] =
        [&picture, &normal, &depth, &object].map(|texture| texture.create_view(&Default::default()));

    // How these textures are to be read, and which lines are wanted.
    let filter = SeparateFilter {
        normal: Some(SeparateNormal { biased: true, ..Default::default() }),
        depth: Some(SeparateDepth { source: DepthSource::reversed(NEAR, f32::INFINITY)?, ..Default::default() }),
        ..Default::default()
    };
    let pass = SeparatePass::new(&device, &filter, InkTarget::Picture(picture.format()))?;
    let textures = SeparateTextures { normal: Some(&normal), depth: Some(&depth), region: Some(&object) };
    let composite = Composite::Over { color: Vec3::new(0.08, 0.06, 0.10), opacity: 1.0 };
    let target = PassTarget { view: &picture_view, composite: &composite, area: None };
    let mut encoder = device.create_command_encoder(&Default::default());
    pass.record(&device, &mut encoder, &filter, &textures, &target)?;

    // And back to the CPU, to be looked at.
    let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), wgpu::TexelCopyBufferInfo { buffer: &copy, layout }, size);
    queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("a buffer for reading can be mapped"));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let rows = copy.get_mapped_range(..)?;
    let pixels: Vec<u8> = rows.chunks(row as usize).flat_map(|row| row[..4 * width as usize].to_vec()).collect();
    image::save_buffer(&path, &pixels, width, height, image::ColorType::Rgba8)?;
    println!("{}", path.display());
    Ok(())
}
