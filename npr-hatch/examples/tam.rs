//! A tonal art map as PNG files and as one file, with a sheet of its tones and levels, one that is tiled, and all tones
//! by thresholds: `cargo run --release -p npr-hatch --example tam -- FOLDER [SIDE] [STROKE.png]`. The command `npr tam` does
//! the same with all parameters.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use npr_hatch::{StrokeImage, TamParameters, Thresholds, draw, png, sheet, store};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "tam".into()));
    let side = arguments.next().map_or(Ok(256), |text| text.parse())?;
    let stroke = arguments.next().map(StrokeImage::load).transpose()?;
    // A width of 1.5 texels is too small to show a picture.
    let width_px = if stroke.is_some() { 4.0 } else { TamParameters::default().width_px };
    let parameters = TamParameters { side, width_px, ..TamParameters::default() };

    let start = Instant::now();
    let drawing = draw(&parameters, stroke.as_ref())?;
    let strokes = drawing.layers.iter().map(Vec::len).sum::<usize>();
    println!("{strokes} strokes at {side}² and all mips in {:.3} s", start.elapsed().as_secs_f64());
    let thresholds = Thresholds::new(&drawing, &parameters, stroke.as_ref());

    let tam = drawing.tam;
    png::write_images(&tam, &folder)?;
    std::fs::write(folder.join("map.tam"), store::to_bytes(&tam, Some(&thresholds))?)?;
    png::write_gray16(folder.join("thresholds.png"), side, side, &thresholds.levels[0])?;
    png::write_sheet(folder.join("sheet.png"), &sheet::contact(&tam))?;
    png::write_sheet(folder.join("tiled.png"), &sheet::tiled(&tam))?;
    png::write_sheet(folder.join("ramp.png"), &sheet::ramp(&thresholds))?;
    for (tone, asked) in tam.tones.iter().enumerate() {
        println!("tone {tone}: {asked:.4}, drawn {:.4}", tam.mean(tone, 0));
    }
    println!("{}", folder.display());
    Ok(())
}
