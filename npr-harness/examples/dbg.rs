#![allow(clippy::print_stdout)]
use npr_harness::{camera::*, check::*, compare::*, executor::*, plan::*, scene::*, style::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scene = Scene::new(npr_mesh::load(a[1].as_ref(), &Default::default()).unwrap().model);
    let (yaw, pitch): (f64, f64) = (a[2].parse().unwrap(), a[3].parse().unwrap());
    let f = Framing { yaw_rad: yaw.to_radians(), pitch_rad: pitch.to_radians(), ..Framing::default() };
    let camera = Camera::framed(scene.corners(), 640.0 / 360.0, &f);
    let style = style(&a[4]).unwrap();
    let plan = Plan::new(&scene, &style, &camera).unwrap();
    let ex = Executor::choose(Backend::Gpu).unwrap();
    let img = ex.render(&scene, &style, &plan, &camera, SIZE, 1, &|_| {}).unwrap();
    let (reference, exempt) = reference(&scene, &style, &plan, &camera, SIZE, 2).unwrap();
    let c = compare(&reference, &img, &exempt).unwrap();
    println!("worst {} at {:?}; over2 {} exempt {}", c.worst, c.worst_at, c.over(2), c.exempt);
    for y in 0..360 { for x in 0..640 {
        let (e, g) = (reference.pixel(x, y), img.pixel(x, y));
        let d = (0..4).map(|i| e[i].abs_diff(g[i])).max().unwrap();
        if d > 2 && !exempt[(y * 640 + x) as usize] { println!("{x},{y}: ref {e:?} gpu {g:?}");
            let (o, d) = camera.ray(glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5), glam::DVec2::new(640.0, 360.0));
            for h in scene.rays().all(o, d, camera.depth_range(), |_| true) { println!("    t {} face {} bary {:?} front {} buffer {}", h.t, h.face, h.barycentric, h.front, camera.buffer_depth(h.t));
              for v in scene.model.faces[h.face as usize] { let p = scene.model.positions[v as usize]; let c = camera.clip_from_world(640.0/360.0) * p.as_dvec3().extend(1.0);
                println!("        {v} at {:?} n {:?}", npr_outline::segment::outline_screen(c, glam::DVec2::new(640.0, 360.0)), scene.model.normals[v as usize]); }
              for dx in [-0.05, -0.045, -0.04, -0.035, -0.03, -0.02, -0.01, -0.005] { let (o, d) = camera.ray(glam::DVec2::new(x as f64 + 0.5 + dx, y as f64 + 0.5), glam::DVec2::new(640.0, 360.0));
                 println!("  dx {dx}: {:?}", scene.rays().all(o, d, camera.depth_range(), |_| true).iter().map(|h| (h.t, h.face, h.front)).collect::<Vec<_>>()); }
              for f in [811usize, 810] { for v in scene.model.faces[f] { let p = scene.model.positions[v as usize]; let c = camera.clip_from_world(640.0/360.0) * p.as_dvec3().extend(1.0); println!("   {f} {v} {:?}", npr_outline::segment::outline_screen(c, glam::DVec2::new(640.0, 360.0))); } }
              for dx in 0..6u32 { println!("   px {} ref {:?} gpu {:?}", x - 3 + dx, reference.pixel(x - 3 + dx, y), img.pixel(x - 3 + dx, y)); }
              for f in [811usize, 810] { for v in scene.model.faces[f] { println!("  n {:?}", scene.model.normals[v as usize]); } println!(" fn {:?}", scene.edges.face_normals[f]); }
              println!("       double {} cull {} light {:?}", scene.model.materials[0].double_sided, plan.cull_back, key_light(&camera)); break; } }
    } }
}
