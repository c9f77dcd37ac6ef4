// The geometry pass.

struct SurfaceView {
    clip_from_world: mat4x4<f32>,
    // xyz: the vector from the surface at the picture's corner towards the eye, of any length, and its change along x
    // and y, per px.
    to_eye: vec4<f32>,
    to_eye_dx: vec4<f32>,
    to_eye_dy: vec4<f32>,
    // The eye with w = 1, or, in a parallel view, the direction towards the eye with w = 0.
    eye: vec4<f32>,
    // The clipping plane: a fragment is kept if the dot product with (x px, y px, depth, 1) is not negative.
    clip_px: vec4<f32>,
}

struct SurfaceMaterial {
    // Display-referred for plain surfaces, linear for textured ones.
    base_color: vec4<f32>,
    // The size of the texture's largest level in texels, its number of levels - 1, and the alpha cutoff.
    texture_size: vec2<f32>,
    last_level: f32,
    cutoff: f32,
    // The wrap mode of the texture for u and v: 0 repeat, 1 mirror, 2 clamp.
    wrap: vec2<u32>,
    // As `texture_size`, of the emissive texture.
    emissive_size: vec2<f32>,
    // The emitted colour: display-referred, or linear where a texture multiplies it; and the number of levels of this
    // texture - 1.
    emissive: vec4<f32>,
}

// The uniform for lines in the image.
struct SurfaceInk {
    // Encodes the depth buffer's value, for any projection.
    code: InkDepthCode,
    // The axes of view space, in world space.
    right: vec4<f32>,
    up: vec4<f32>,
    back: vec4<f32>,
    // The largest region number; larger numbers are folded into the range.
    region_max: u32,
    padding0: u32,
    padding1: u32,
    padding2: u32,
}

// Whether a plane clips the scene.
override surface_clipped: bool = false;
// Whether the G-buffer is packed into 32 bits instead of 64.
override surface_narrow: bool = false;
// Whether normals are used as they are in the vertex buffer.
override surface_mesh_normals: bool = false;
// Whether texels of the G-buffer are unquantised.
override surface_unquantised: bool = false;
// The source of the material's inner lines: 0 normals, 1 vertex colours, 2 texture, 3 regions, 4 none.
override surface_line_kind: u32 = 0u;
// How the directions of an artist's lines are rotated: by the vector from the eye to 0 the pixel, 1 each vertex, 2 the
// object.
override surface_artist: u32 = 0u;
// Whether the colours of the texture are region numbers.
override surface_region_of_texture: bool = false;
// Whether the alpha of the material's colour selects either its texture or its colour; else they are multiplied.
override surface_by_alpha: bool = false;
// Whether texture coordinates and vertex colours are read, in entry points that support both cases.
override surface_looked_up: bool = false;
// Whether the surface is alpha-blended.
override surface_blended: bool = false;
// Whether the surface is the ground, which shows nothing but shadows.
override surface_ground: bool = false;
// What the surface emits: 0 nothing, 1 the material's colour, 2 that times a texture.
override surface_emission: u32 = 0u;
// Whether a blended surface is drawn where it hides what is behind it, instead of blended.
override surface_hides: bool = false;
// Whether only what is behind a layer of see-through surfaces is drawn, whose depth is bound as the shadow map.
override surface_behind_layer: bool = false;

@group(0) @binding(0) var<uniform> view: SurfaceView;
@group(0) @binding(2) var<uniform> ink: SurfaceInk;
@group(1) @binding(0) var<uniform> material: SurfaceMaterial;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;
@group(1) @binding(3) var emissive_texture: texture_2d<f32>;
@group(1) @binding(4) var emissive_sampler: sampler;

struct Surface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
}

struct TexturedSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) color: vec4<f32>,
}

// With the region number for lines in the image.
struct InkedSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(3) @interpolate(flat) region: u32,
    // Of `artist_vertex`.
    @location(13) artist: vec3<f32>,
}

struct InkedTexturedSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) color: vec4<f32>,
    @location(3) @interpolate(flat) region: u32,
    @location(13) artist: vec3<f32>,
}

// With all attributes, and the varyings for lighting: a position, or the vector to the light and the second vector, or
// the light at the vertices.
struct LitSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) color: vec4<f32>,
    @location(3) @interpolate(flat) region: u32,
    @location(4) first: vec3<f32>,
    @location(5) second: vec3<f32>,
    @location(13) artist: vec3<f32>,
}

// The reduced variants for plain surfaces without lines in the image, and for light computed at the vertices. On a
// software rasteriser, each interpolated number is about as expensive as some arithmetic per pixel.
struct PlainLitSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(4) first: vec3<f32>,
    @location(5) second: vec3<f32>,
}

struct VertexLitSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) light: vec2<f32>,
}

// Colour, and normal, region and depth packed into the first one or two 32-bit words, or unquantised in four.
struct Inked {
    @location(0) color: vec4<f32>,
    @location(1) texel: vec4<u32>,
}

struct Texel {
    @location(1) texel: vec4<u32>,
}

// The alpha written with a surface's colour. A write mask cannot be used: WebGL2 has one for all targets of a pass.
fn surface_alpha(alpha: f32) -> f32 {
    return select(1.0, alpha, surface_blended);
}

// The least alpha of a fragment that is drawn.
fn least_alpha() -> f32 {
    return select(material.cutoff, 0.5, surface_hides);
}

fn to_eye(position_px: vec2<f32>) -> vec3<f32> {
    return view.to_eye.xyz + view.to_eye_dx.xyz * position_px.x + view.to_eye_dy.xyz * position_px.y;
}

// The instance data of an object.
struct Instance {
    // The rows of the matrix from mesh space to world space.
    @location(8) row_x: vec4<f32>,
    @location(9) row_y: vec4<f32>,
    @location(10) row_z: vec4<f32>,
    // The offset added to the regions of the mesh, and the factor applied to them before.
    @location(11) regions: vec2<u32>,
    // The scale of the object's transform, and its log2.
    @location(12) scale: vec2<f32>,
    // The middle of the object's box, in world space.
    @location(13) middle: vec3<f32>,
}

fn placed_position(position: vec3<f32>, instance: Instance) -> vec3<f32> {
    let point = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(instance.row_x, point), dot(instance.row_y, point), dot(instance.row_z, point));
}

// Transforms a normal by the inverse transpose, preserving its length.
fn placed_normal(normal: vec3<f32>, instance: Instance) -> vec3<f32> {
    if surface_mesh_normals {
        return normal;
    }
    let x = vec3<f32>(instance.row_x.x, instance.row_y.x, instance.row_z.x);
    let y = vec3<f32>(instance.row_x.y, instance.row_y.y, instance.row_z.y);
    let z = vec3<f32>(instance.row_x.z, instance.row_y.z, instance.row_z.z);
    // The columns of the inverse transpose times the determinant.
    let cofactors = mat3x3<f32>(cross(y, z), cross(z, x), cross(x, y));
    let turned = cofactors * normal * sign(dot(x, cofactors[0]));
    return turned * sqrt(dot(normal, normal) / max(dot(turned, turned), 1e-37));
}

fn placed_region(region: u32, instance: Instance) -> u32 {
    return ink_fold_region(instance.regions.x + instance.regions.y * region, max(ink.region_max, 1u));
}

// The world-space direction for an index of `ink_artist_direction`, which no visible surface can have as its normal,
// rotated by a world-space vector from the eye.
fn artist_normal(index: u32, from_eye: vec3<f32>) -> vec3<f32> {
    let in_view = vec3<f32>(dot(from_eye, ink.right.xyz), dot(from_eye, ink.up.xyz), dot(from_eye, ink.back.xyz));
    let direction = ink_artist_direction(index, in_view);
    return direction.x * ink.right.xyz + direction.y * ink.up.xyz + direction.z * ink.back.xyz;
}

// The varying for an artist's lines: the direction at a vertex, if it is rotated there; the vector from the eye to the
// object, if it is rotated by that.
fn artist_vertex(position: vec3<f32>, color: vec4<f32>, instance: Instance) -> vec3<f32> {
    if surface_artist == 1u {
        return artist_normal(ink_artist_index(encode_srgb(color.rgb)), position * view.eye.w - view.eye.xyz);
    }
    if surface_artist == 2u {
        return instance.middle * view.eye.w - view.eye.xyz;
    }
    return vec3<f32>(0.0);
}

@vertex
fn vs_depth(@location(0) position: vec3<f32>, instance: Instance) -> @invariant @builtin(position) vec4<f32> {
    return view.clip_from_world * vec4<f32>(placed_position(position, instance), 1.0);
}

@vertex
fn vs_plain(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, instance: Instance) -> Surface {
    let world = placed_position(position, instance);
    return Surface(view.clip_from_world * vec4<f32>(world, 1.0), placed_normal(normal, instance));
}

@vertex
fn vs_textured(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>, instance: Instance,
) -> TexturedSurface {
    let world = placed_position(position, instance);
    return TexturedSurface(view.clip_from_world * vec4<f32>(world, 1.0), placed_normal(normal, instance), uv, color);
}

@vertex
fn vs_plain_inked(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(4) region: u32, instance: Instance,
) -> InkedSurface {
    let world = placed_position(position, instance);
    let number = placed_region(region, instance);
    let artist = artist_vertex(world, vec4<f32>(1.0), instance);
    return InkedSurface(view.clip_from_world * vec4<f32>(world, 1.0), placed_normal(normal, instance), number, artist);
}

@vertex
fn vs_textured_inked(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>, @location(4) region: u32, instance: Instance,
) -> InkedTexturedSurface {
    let world = placed_position(position, instance);
    let clip = view.clip_from_world * vec4<f32>(world, 1.0);
    let artist = artist_vertex(world, color, instance);
    return InkedTexturedSurface(
        clip, placed_normal(normal, instance), uv, color, placed_region(region, instance), artist,
    );
}

// The varyings of a vertex for lighting.
fn lit_vertex(mesh_position: vec3<f32>, mesh_normal: vec3<f32>, instance: Instance) -> PlainLitSurface {
    let position = placed_position(mesh_position, instance);
    let normal = placed_normal(mesh_normal, instance);
    let n = toon_unit(normal);
    let eye = view.eye.xyz - position * view.eye.w;
    // If normals are normalized at the pixel, the only further input is the position.
    var lit = PlainLitSurface(view.clip_from_world * vec4<f32>(position, 1.0), normal, position, n);
    if surface_normals == 1u {
        lit.normal = n;
        lit.first = to_first_light(position);
        lit.second = shade_second_vector(position, eye);
    } else if surface_normals == 2u {
        lit.first = vec3<f32>(light_at(n, position, eye), 0.0);
    }
    return lit;
}

@vertex
fn vs_lit(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>, @location(4) region: u32, instance: Instance,
) -> LitSurface {
    let plain = lit_vertex(position, normal, instance);
    let number = placed_region(region, instance);
    let artist = artist_vertex(placed_position(position, instance), color, instance);
    return LitSurface(plain.position, plain.normal, uv, color, number, plain.first, plain.second, artist);
}

@vertex
fn vs_lit_plain(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, instance: Instance,
) -> PlainLitSurface {
    return lit_vertex(position, normal, instance);
}

@vertex
fn vs_lit_vertex(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, instance: Instance,
) -> VertexLitSurface {
    let plain = lit_vertex(position, normal, instance);
    return VertexLitSurface(plain.position, plain.first.xy);
}

fn encode_srgb(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, c * 12.92, c <= vec3<f32>(0.0031308));
}

// The level at which a texture is sampled. Requires uniform control flow.
fn texture_level(uv: vec2<f32>, size: vec2<f32>, last_level: f32) -> f32 {
    let along_x = dpdxFine(uv) * size;
    let along_y = dpdyFine(uv) * size;
    let longest = max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-30);
    return clamp(0.5 * log2(longest), 0.0, last_level);
}

// The texture's linear colour and alpha. Requires uniform control flow.
fn texture_color(uv: vec2<f32>) -> vec4<f32> {
    let level = texture_level(uv, material.texture_size, material.last_level);
    return textureSampleLevel(base_texture, base_sampler, uv, level);
}

// Adds the display-referred emission to a shaded colour; the target clamps the sum. Requires uniform control flow.
fn with_emission(color: vec3<f32>, uv: vec2<f32>) -> vec3<f32> {
    if surface_emission == 0u {
        return color;
    }
    if surface_emission == 1u {
        return color + material.emissive.rgb;
    }
    let level = texture_level(uv, material.emissive_size, material.emissive.w);
    let texel = textureSampleLevel(emissive_texture, emissive_sampler, uv, level);
    return color + encode_srgb(material.emissive.rgb * texel.rgb);
}

// Linear colour and alpha, excluding a vertex colour or texture that encodes lines. Requires uniform control flow.
fn base_color(texel: vec4<f32>, color: vec4<f32>) -> vec4<f32> {
    var base = material.base_color;
    if surface_line_kind != 1u {
        base *= color;
    }
    if surface_line_kind == 2u {
        return base;
    }
    if surface_by_alpha {
        return toon_material(base, texel);
    }
    return base * texel;
}

// Per-pixel shading with light directions that are the same everywhere. Requires uniform control flow.
fn painted(base: vec3<f32>, normal: vec3<f32>, position_px: vec2<f32>, at: ShadowAt) -> vec3<f32> {
    let n = toon_unit(normal);
    return shade_color(base, light_at(n, vec3<f32>(0.0), to_eye(position_px)), n, at);
}

// Discards fragments beyond the clipping plane. Must come after all derivatives.
fn clip_off(position: vec4<f32>) {
    if surface_clipped && dot(view.clip_px, vec4<f32>(position.xyz, 1.0)) < 0.0 {
        discard;
    }
}

fn facing(normal: vec3<f32>, front: bool) -> vec3<f32> {
    return select(-normal, normal, front);
}

@fragment
fn fs_painted(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let normal = facing(in.normal, front);
    let at = shadow_at(in.position, normal);
    let color = with_emission(painted(material.base_color.rgb, normal, in.position.xy, at), vec2<f32>(0.0));
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(material.base_color.a));
}

@fragment
fn fs_painted_textured(in: TexturedSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = base_color(texture_color(in.uv), in.color);
    let normal = facing(in.normal, front);
    let at = shadow_at(in.position, normal);
    let color = with_emission(painted(encode_srgb(base.rgb), normal, in.position.xy, at), in.uv);
    if base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(base.a));
}

@fragment
fn fs_cut_out(in: TexturedSurface) {
    if base_color(texture_color(in.uv), in.color).a < least_alpha() {
        discard;
    }
    clip_off(in.position);
}

@fragment
fn fs_nothing() {
}

// The alpha of a see-through surface, unless it hides what is behind it or belongs to the layer before.
fn veil(position: vec4<f32>, alpha: f32) -> vec4<f32> {
    let at = position.xy / vec2<f32>(textureDimensions(shadow_map));
    let before = textureSampleLevel(shadow_map, shadow_nearest, at, 0.0).x;
    if alpha >= 0.5 || surface_behind_layer && position.z >= before {
        discard;
    }
    clip_off(position);
    return vec4<f32>(alpha);
}

@fragment
fn fs_veil(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return veil(position, material.base_color.a);
}

@fragment
fn fs_veil_textured(in: TexturedSurface) -> @location(0) vec4<f32> {
    return veil(in.position, base_color(texture_color(in.uv), in.color).a);
}

fn wrapped(texel: i32, size: i32, wrap: u32) -> i32 {
    if wrap == 2u {
        return clamp(texel, 0, size - 1);
    }
    let period = select(size, 2 * size, wrap == 1u);
    let folded = ((texel % period) + period) % period;
    return select(folded, 2 * size - 1 - folded, folded >= size);
}

// The region encoded by the nearest texel.
fn texture_region(uv: vec2<f32>) -> u32 {
    let size = vec2<i32>(textureDimensions(base_texture));
    let at = vec2<i32>(floor(uv * vec2<f32>(size)));
    let texel = vec2<i32>(wrapped(at.x, size.x, material.wrap.x), wrapped(at.y, size.y, material.wrap.y));
    return ink_region_of_color(encode_srgb(textureLoad(base_texture, texel, 0).rgb));
}

// `artist`: of `artist_vertex`, interpolated.
fn inked_normal(
    normal: vec3<f32>, texel: vec4<f32>, color: vec4<f32>, position_px: vec2<f32>, artist: vec3<f32>,
) -> vec3<f32> {
    if surface_line_kind == 0u {
        return normal;
    }
    if surface_line_kind >= 3u {
        return vec3<f32>(0.0);
    }
    if surface_artist == 1u {
        return artist;
    }
    var index = ink_artist_index(encode_srgb(color.rgb));
    if surface_line_kind == 2u {
        index = ink_artist_texel(vec4<f32>(encode_srgb(texel.rgb), texel.a));
    }
    if surface_artist == 2u {
        return artist_normal(index, artist);
    }
    return artist_normal(index, -to_eye(position_px));
}

// The largest region number that leaves room for the shadow state.
fn shadowed_most() -> u32 {
    return select(INK_TEXEL64_SHADOWED_REGION_MAX, INK_TEXEL32_SHADOWED_REGION_MAX, surface_narrow);
}

// The texel of the ground: background, with a shadow state where texels have one.
fn ground_words(at: ShadowAt) -> vec4<u32> {
    if surface_unquantised || surface_shadow_lines != 1u {
        return vec4<u32>(0u);
    }
    let number = ink_shadow_background(at.state, shadowed_most());
    if surface_narrow {
        return vec4<u32>(ink_texel32_bits(vec3<f32>(0.0, 1.0, 0.0), number, 0u), 0u, 0u, 0u);
    }
    return vec4<u32>(ink_texel64_bits(vec3<f32>(0.0, 1.0, 0.0), number, 0u), 0u, 0u);
}

fn words(normal: vec3<f32>, region: u32, position: vec4<f32>, at: ShadowAt) -> vec4<u32> {
    if surface_ground {
        return ground_words(at);
    }
    if surface_unquantised {
        let v = position.z * ink.code.scale + ink.code.bias;
        let shadowed = surface_shadow_lines == 2u && at.negated;
        return gbuffer_pack(normal, region, select(1.0 / v, v, ink.code.parallel != 0u), shadowed);
    }
    let depth = ink_depth_code_of(position.z, ink.code);
    let number = shadow_region(region, at, shadowed_most());
    if surface_narrow {
        return vec4<u32>(ink_texel32_bits(normal, number, depth), 0u, 0u, 0u);
    }
    return vec4<u32>(ink_texel64_bits(normal, number, depth), 0u, 0u);
}

fn plain_words(in: InkedSurface, front: bool, at: ShadowAt) -> vec4<u32> {
    let own = shadow_normal(facing(in.normal, front), at);
    let normal = inked_normal(own, vec4<f32>(1.0), vec4<f32>(1.0), in.position.xy, in.artist);
    return words(normal, in.region, in.position, at);
}

fn textured_words(in: InkedTexturedSurface, front: bool, texel: vec4<f32>, at: ShadowAt) -> vec4<u32> {
    var region = in.region;
    if surface_region_of_texture {
        region = ink_region_pair(in.region, texture_region(in.uv));
        if surface_shadow_lines == 1u {
            region = ink_fold_region(region, shadowed_most());
        } else if surface_narrow {
            region = ink_fold_region(region, INK_TEXEL32_REGION_MAX);
        }
    }
    let own = shadow_normal(facing(in.normal, front), at);
    return words(inked_normal(own, texel, in.color, in.position.xy, in.artist), region, in.position, at);
}

@fragment
fn fs_painted_inked(in: InkedSurface, @builtin(front_facing) front: bool) -> Inked {
    let normal = facing(in.normal, front);
    let at = shadow_at(in.position, normal);
    let color = with_emission(painted(material.base_color.rgb, normal, in.position.xy, at), vec2<f32>(0.0));
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), plain_words(in, front, at));
}

@fragment
fn fs_painted_textured_inked(in: InkedTexturedSurface, @builtin(front_facing) front: bool) -> Inked {
    let texel = texture_color(in.uv);
    let base = base_color(texel, in.color);
    let normal = facing(in.normal, front);
    let at = shadow_at(in.position, normal);
    let color = with_emission(painted(encode_srgb(base.rgb), normal, in.position.xy, at), in.uv);
    if base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), textured_words(in, front, texel, at));
}

// The colour of a surface, or of the ground, whose base colour is paper: paper where it is lit.
fn surface_or_ground(color: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    if surface_ground && !at.dark {
        return material.base_color.rgb;
    }
    return color;
}

// The lookup coordinates of the light at a pixel, computed at the vertices or at the pixel.
fn light_of(in: PlainLitSurface, front: bool) -> vec2<f32> {
    if surface_normals == 2u {
        return select(light_of_back(in.first.xy), in.first.xy, front);
    }
    let normal = facing(in.normal, front);
    if surface_normals == 1u {
        return light_interpolated(normal, in.first, in.second);
    }
    return light_at(toon_unit(normal), in.first, to_eye(in.position.xy));
}

fn without_lookups(in: LitSurface) -> PlainLitSurface {
    return PlainLitSurface(in.position, in.normal, in.first, in.second);
}

// The unshaded colour of a surface, and its alpha. Requires uniform control flow.
fn lit_base(in: LitSurface, texel: vec4<f32>) -> vec4<f32> {
    if surface_looked_up {
        let base = base_color(texel, in.color);
        return vec4<f32>(encode_srgb(base.rgb), base.a);
    }
    return material.base_color;
}

fn lit_texel(in: LitSurface) -> vec4<f32> {
    if surface_looked_up {
        return texture_color(in.uv);
    }
    return vec4<f32>(1.0);
}

fn lit_words(in: LitSurface, texel: vec4<f32>, front: bool, at: ShadowAt) -> vec4<u32> {
    if surface_looked_up {
        let looked_up = InkedTexturedSurface(in.position, in.normal, in.uv, in.color, in.region, in.artist);
        return textured_words(looked_up, front, texel, at);
    }
    return plain_words(InkedSurface(in.position, in.normal, in.region, in.artist), front, at);
}

@fragment
fn fs_lit(in: LitSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = lit_base(in, lit_texel(in));
    let at = shadow_at(in.position, facing(in.normal, front));
    let n = toon_unit(facing(in.normal, front));
    let color = surface_or_ground(with_emission(shade_color(base.rgb, light_of(without_lookups(in), front), n, at), in.uv), at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(base.a));
}

@fragment
fn fs_lit_plain(in: PlainLitSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let at = shadow_at(in.position, facing(in.normal, front));
    let n = toon_unit(facing(in.normal, front));
    let color = surface_or_ground(with_emission(shade_color(material.base_color.rgb, light_of(in, front), n, at), vec2<f32>(0.0)), at);
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(material.base_color.a));
}

@fragment
fn fs_lit_vertex(in: VertexLitSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let light = select(light_of_back(in.light), in.light, front);
    let shaded = shade_color(material.base_color.rgb, light, vec3<f32>(0.0), NO_SHADOW);
    let color = with_emission(shaded, vec2<f32>(0.0));
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(material.base_color.a));
}

@fragment
fn fs_lit_inked(in: LitSurface, @builtin(front_facing) front: bool) -> Inked {
    let texel = lit_texel(in);
    let base = lit_base(in, texel);
    let at = shadow_at(in.position, facing(in.normal, front));
    let n = toon_unit(facing(in.normal, front));
    let color = surface_or_ground(with_emission(shade_color(base.rgb, light_of(without_lookups(in), front), n, at), in.uv), at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), lit_words(in, texel, front, at));
}

@fragment
fn fs_texels(in: InkedSurface, @builtin(front_facing) front: bool) -> Texel {
    let at = shadow_at(in.position, facing(in.normal, front));
    clip_off(in.position);
    return Texel(plain_words(in, front, at));
}

@fragment
fn fs_texels_textured(in: InkedTexturedSurface, @builtin(front_facing) front: bool) -> Texel {
    let texel = texture_color(in.uv);
    let at = shadow_at(in.position, facing(in.normal, front));
    if base_color(texel, in.color).a < least_alpha() {
        discard;
    }
    clip_off(in.position);
    return Texel(textured_words(in, front, texel, at));
}

@fragment
fn fs_clipped(@builtin(position) position: vec4<f32>) {
    clip_off(position);
}
