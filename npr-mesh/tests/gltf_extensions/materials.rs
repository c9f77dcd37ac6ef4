//! Colour and emission of materials, and their textures.

use crate::doc::{Doc, PRIMITIVE};
use crate::{assert_fails, loaded, warnings};
use glam::{Vec2, Vec3, Vec4};
use image::{ImageFormat, Rgba, RgbaImage};
use npr_mesh::Material;
use serde_json::{Value, json};
use std::io::Cursor;

/// A square with one material.
fn with(material: Value) -> Doc {
    Doc::square().set("/materials", json!([material])).set(&format!("{PRIMITIVE}/material"), json!(0))
}

fn picture(format: ImageFormat, color: [u8; 4]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    RgbaImage::from_pixel(2, 2, Rgba(color)).write_to(&mut bytes, format).expect("a picture");
    bytes.into_inner()
}

/// Adds images of these formats and colours, in this order.
fn with_images(mut doc: Doc, images: &[(ImageFormat, [u8; 4])]) -> Doc {
    let views: Vec<usize> = images.iter().map(|&(format, color)| doc.view(&picture(format, color))).collect();
    doc.set("/images", views.into_iter().map(|view| json!({"bufferView": view})).collect())
}

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];

/// The first texel of the texture of a material.
fn texel(doc: &Doc, texture: impl Fn(&Material) -> Option<u32>) -> Option<[u8; 4]> {
    let loaded = loaded(doc);
    let mesh = &loaded.meshes[0];
    let texture = &mesh.textures[texture(&mesh.materials[0])? as usize];
    texture.rgba8.first_chunk().copied()
}

#[test]
fn specular_glossiness_has_precedence() {
    let extension = |properties: Value| json!({"KHR_materials_pbrSpecularGlossiness": properties});
    let metallic = json!({"baseColorFactor": [0, 0, 1, 1], "baseColorTexture": {"index": 0}});
    let doc = with_images(
        with(json!({
            "extensions": extension(json!({"diffuseFactor": [0.9, 0.2, 0.1, 0.5], "diffuseTexture": {"index": 1}})),
            "pbrMetallicRoughness": metallic
        })),
        &[(ImageFormat::Png, RED), (ImageFormat::Png, GREEN)],
    )
    .set("/textures", json!([{"source": 0}, {"source": 1}]))
    .set("/extensionsRequired", json!(["KHR_materials_pbrSpecularGlossiness"]));
    let file = loaded(&doc);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    assert_eq!(file.meshes[0].materials[0].base_color, Vec4::new(0.9, 0.2, 0.1, 0.5));
    assert_eq!(file.meshes[0].textures.len(), 1, "the other model's texture is not loaded");
    assert_eq!(texel(&doc, |m| m.texture), Some(GREEN));
    // An empty extension is white, and no texture of the other model shows through.
    let empty = loaded(&doc.set("/materials/0/extensions", extension(json!({}))));
    assert_eq!((empty.meshes[0].materials[0].base_color, empty.meshes[0].textures.len()), (Vec4::ONE, 0));
    let bad = with(json!({"extensions": extension(json!({"diffuseFactor": [2, 0, 0, 1]}))}));
    assert_eq!(warnings(&loaded(&bad)), ["material 0: its base colour [2, 0, 0, 1] is not within 0 to 1"]);
}

#[test]
fn emission_is_factor_times_strength() {
    let emissive = |material: Value| {
        let file = loaded(&with(material));
        (file.meshes[0].materials[0].emissive, warnings(&file))
    };
    assert_eq!(emissive(json!({})), (Vec3::ZERO, vec![]));
    assert_eq!(emissive(json!({"emissiveFactor": [1, 0.5, 0]})), (Vec3::new(1.0, 0.5, 0.0), vec![]));
    let strength = |strength: f64| json!({"KHR_materials_emissive_strength": {"emissiveStrength": strength}});
    let strong = json!({"emissiveFactor": [1, 0.5, 0], "extensions": strength(4.0)});
    assert_eq!(emissive(strong), (Vec3::new(4.0, 2.0, 0.0), vec![]));
    let (clamped, told) = emissive(json!({"emissiveFactor": [2, -1, 0]}));
    assert_eq!((clamped, told), (Vec3::X, vec!["material 0: its emission [2, -1, 0] is not within 0 to 1".to_owned()]));
    assert_fails(
        &with(json!({"emissiveFactor": [1, 1, 1], "extensions": strength(-1.0)})),
        "material 0: its emissive strength is negative or not finite",
    );
    assert_fails(&with(json!({"emissiveFactor": [1e300, 1, 1]})), "material 0: its emission is not finite");
}

#[test]
fn the_emissive_texture_shares_the_texture_coordinates_of_the_colour() {
    let two = &[(ImageFormat::Png, RED), (ImageFormat::Png, GREEN)];
    let textured = |color: Value, emissive: Value| {
        let material = json!({
            "pbrMetallicRoughness": {"baseColorTexture": color},
            "emissiveFactor": [1, 1, 1],
            "emissiveTexture": emissive
        });
        with_images(with(material), two).set("/textures", json!([{"source": 0}, {"source": 1}]))
    };
    let same = textured(json!({"index": 0}), json!({"index": 1}));
    assert_eq!((texel(&same, |m| m.texture), texel(&same, |m| m.emissive_texture)), (Some(RED), Some(GREEN)));
    assert_eq!(loaded(&same).meshes[0].materials[0].emissive, Vec3::ONE);

    let shifted = json!({"index": 1, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}});
    let other = loaded(&textured(json!({"index": 0}), shifted.clone()));
    let told = warnings(&other);
    assert!(told.len() == 1 && told[0].starts_with("material 0: its emission is left out: "), "{told:?}");
    let material = &other.meshes[0].materials[0];
    assert_eq!((material.texture, material.emissive_texture, material.emissive), (Some(0), None, Vec3::ZERO));

    // Alone, it has the coordinates that it asks for.
    let alone = textured(json!({"index": 0}), shifted).without("/materials/0/pbrMetallicRoughness");
    let alone = loaded(&alone);
    assert!(alone.warnings.is_empty(), "{:?}", alone.warnings);
    assert_eq!(alone.meshes[0].uvs, [[0.5, 0.0], [1.5, 0.0], [1.5, 1.0], [0.5, 1.0]].map(Vec2::from));
    assert_eq!(alone.meshes[0].materials[0].emissive_texture, Some(0));

    // Without its image the whole surface would glow.
    let broken = textured(json!({"index": 0}), json!({"index": 1})).set("/images/1", json!({"uri": "none.png"}));
    let broken = loaded(&broken);
    assert!(warnings(&broken)[0].starts_with("image 1 is left out: "), "{:?}", broken.warnings);
    assert_eq!(broken.meshes[0].materials[0].emissive, Vec3::ZERO);
}

#[test]
fn materials_that_differ_in_their_emission_stay_apart_in_one_model() {
    let mut doc = with(json!({"name": "a", "emissiveFactor": [1, 0, 0]}));
    doc.json["materials"].as_array_mut().expect("materials").push(json!({"name": "a"}));
    let mut second = doc.json["meshes"][0].clone();
    second["primitives"][0]["material"] = json!(1);
    doc.json["meshes"].as_array_mut().expect("meshes").push(second);
    let doc =
        doc.set("/nodes", json!([{"mesh": 0}, {"mesh": 1}, {"mesh": 0}])).set("/scenes/0/nodes", json!([0, 1, 2]));
    let model = loaded(&doc).into_model();
    assert_eq!(model.materials.iter().map(|m| m.emissive).collect::<Vec<_>>(), [Vec3::X, Vec3::ZERO]);
    assert_eq!(model.face_material, [0, 0, 1, 1, 0, 0]);
}

#[test]
fn each_primitive_has_the_texture_coordinates_that_its_material_asks_for() {
    let mut doc = Doc::square();
    let second = doc.floats("VEC2", &[0.25; 8]);
    let primitive = doc.json["meshes"][0]["primitives"][0].clone();
    let of = |material: usize| {
        let mut primitive = primitive.clone();
        primitive["attributes"]["TEXCOORD_1"] = json!(second);
        primitive["material"] = json!(material);
        primitive
    };
    let base = |info: Value| json!({"pbrMetallicRoughness": {"baseColorTexture": info}});
    let transform = json!({"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1, "scale": [2, 2]}}});
    let glossy = json!({"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 0, "texCoord": 1}}});
    let doc = with_images(doc, &[(ImageFormat::Png, RED)])
        .set("/textures", json!([{"source": 0}]))
        .set(
            "/materials",
            json!([
                base(json!({"index": 0})),
                base(json!({"index": 0, "texCoord": 1})),
                base(transform),
                {"extensions": glossy},
                {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "texCoord": 1}}
            ]),
        )
        .set("/meshes/0/primitives", (0..5).map(of).collect());
    let file = loaded(&doc);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let uvs = &file.meshes[0].uvs;
    assert_eq!(uvs[..4], [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
    for (primitive, uv) in [(1, 0.25), (2, 0.5), (3, 0.25), (4, 0.25)] {
        assert_eq!(uvs[4 * primitive..4 * primitive + 4], [Vec2::splat(uv); 4], "primitive {primitive}");
    }
}

#[test]
fn webp_images_have_precedence_over_the_fallback() {
    let textured = with(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let doc = with_images(textured, &[(ImageFormat::Png, RED), (ImageFormat::WebP, GREEN)]);
    let webp = json!({"EXT_texture_webp": {"source": 1}});
    let both = doc.clone().set("/textures", json!([{"source": 0, "extensions": webp}]));
    assert_eq!(texel(&both, |m| m.texture), Some(GREEN));
    let alone = doc
        .set("/textures", json!([{"extensions": webp}]))
        .set("/extensionsRequired", json!(["EXT_texture_webp"]))
        .set("/extensionsUsed", json!(["EXT_texture_webp"]));
    assert_eq!(texel(&alone, |m| m.texture), Some(GREEN));
    assert!(loaded(&alone).warnings.is_empty());
}

#[test]
fn basis_textures_have_their_fallback_or_a_warning_that_names_the_extension() {
    let textured = with(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let doc = with_images(textured, &[(ImageFormat::Png, RED)]).set("/extensionsUsed", json!(["KHR_texture_basisu"]));
    let basis = json!({"KHR_texture_basisu": {"source": 0}});
    let both = doc.clone().set("/textures", json!([{"source": 0, "extensions": basis}]));
    assert_eq!(texel(&both, |m| m.texture), Some(RED));
    assert_eq!(warnings(&loaded(&both)), ["the extension KHR_texture_basisu is ignored"]);
    let alone = doc.set("/textures", json!([{"extensions": basis}]));
    assert_eq!(texel(&alone, |m| m.texture), None);
    assert_eq!(
        warnings(&loaded(&alone))[1],
        "material 0: texture 0 is left out: its image is in the extension KHR_texture_basisu, which is not supported"
    );
    let required = alone.set("/extensionsRequired", json!(["KHR_texture_basisu"]));
    assert_fails(&required, "needs the extension KHR_texture_basisu, which is not supported");
}
