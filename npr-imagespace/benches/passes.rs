//! quick exploration
#![allow(clippy::print_stdout)]
#[path = "../tests/gpu/device.rs"]
#[allow(dead_code)]
mod device;
use device::{gpu, view};
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::{Kernel, Operation};
use npr_imagespace::pass::disc::*;
use npr_imagespace::pass::step::*;
use npr_imagespace::pass::*;
use std::time::Instant;

fn main() {
    let gpu = gpu().unwrap();
    let size = [1280, 720];
    let mut bytes = vec![0u8; (size[0] * size[1]) as usize];
    for y in 0..720usize {
        for x in 0..1280usize {
            let (a, b) = (x as f64 - 640., y as f64 - 360.);
            let d = (a * a + b * b).sqrt();
            if (d - 300.).abs() < 0.7 || (d - 100.).abs() < 0.7 || x % 257 == 3 {
                bytes[y * 1280 + x] = 255;
            }
        }
    }
    let ink = gpu.upload(INK_FORMAT, size, &bytes);
    let out = gpu.texture(INK_FORMAT, size);
    let (iv, ov) = (view(&ink), view(&out));
    let c = Composite::default();
    let onto = Onto { view: &ov, composite: &c, area: None };
    let sq = StepPass::new(&gpu.device, Step::Dilate(Kernel::Square), InkTarget::Ink).unwrap();
    let cr = StepPass::new(&gpu.device, Step::Dilate(Kernel::Cross), InkTarget::Ink).unwrap();
    let di = StepPass::new(&gpu.device, Step::Dilate(Kernel::Diagonal), InkTarget::Ink).unwrap();
    let lay = lay::LayPass::new(&gpu.device, InkTarget::Ink);
    let disc = DiscPass::new(&gpu.device, InkTarget::Ink);
    let scratch = DiscScratch::new(&gpu.device, size);
    let mut best = vec![f64::INFINITY; 12];
    for _ in 0..10 {
        let mut i = 0;
        let mut time = |f: &mut dyn FnMut(&mut wgpu::CommandEncoder)| {
            let t = Instant::now();
            gpu.run(|e| f(e));
            best[i] = best[i].min(t.elapsed().as_secs_f64() * 1e3);
            i += 1;
        };
        time(&mut |e| lay.record(&gpu.device, e, &iv, &onto));
        time(&mut |e| di.record(&gpu.device, e, &iv, &onto));
        time(&mut |e| cr.record(&gpu.device, e, &iv, &onto));
        time(&mut |e| sq.record(&gpu.device, e, &iv, &onto));
        for r in [1.0, 4.0, 16.0, 64.0] {
            for antialias in [false, true] {
                time(&mut |e| {
                    disc.record(
                        &gpu.device,
                        e,
                        Operation::Dilate,
                        &Disc { radius_px: r, antialias },
                        &iv,
                        &scratch,
                        &onto,
                    )
                    .unwrap()
                });
            }
        }
    }
    for (n, b) in ["copy", "diag", "cross", "square", "r1", "r1aa", "r4", "r4aa", "r16", "r16aa", "r64", "r64aa"]
        .iter()
        .zip(&best)
    {
        println!("{n}: {b:.2} ms  {:.2} of square", b / best[3]);
    }
}
