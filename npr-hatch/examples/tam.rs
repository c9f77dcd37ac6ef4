//! A tonal art map as PNG files and as one file, with a sheet of its tones and finest levels and one that is tiled:
//! `cargo run --release -p npr-hatch --example tam -- FOLDER [SIDE] [CANDIDATES] [STROKE.png]`. With candidates (0: none)
//! strokes are placed by choice among them.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use npr_hatch::{Drawing, Placement, StrokeImage, Tam, TamParameters, Thresholds, draw, hatch_threshold, png, store};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "tam".into()));
    let side = arguments.next().map_or(Ok(256), |text| text.parse())?;
    let candidates = arguments.next().map_or(Ok(0), |text| text.parse())?;
    let stroke = arguments.next().map(StrokeImage::load).transpose()?;
    let placement = if candidates > 0 { Placement::BestOf { candidates } } else { Placement::Sequence };
    let width_px = if stroke.is_some() { 4.0 } else { TamParameters::default().width_px };
    let parameters = TamParameters { side, placement, width_px, ..TamParameters::default() };

    let start = Instant::now();
    let drawing = draw(&parameters, stroke.as_ref())?;
    let time_s = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let thresholds = Thresholds::new(&drawing, &parameters, stroke.as_ref());
    let thresholds_s = start.elapsed().as_secs_f64();
    let strokes = drawing.layers.iter().map(Vec::len).sum::<usize>();
    let drawn: usize = drawing.marks.iter().map(Vec::len).sum();
    println!("{:?}, {} tones at {side}² with all mips: {time_s:.3} s", placement, drawing.tam.tones.len());
    println!(
        "{strokes} strokes placed, {:.0}/s; {drawn} drawn, {:.0}/s",
        strokes as f64 / time_s,
        drawn as f64 / time_s
    );
    println!("thresholds: {thresholds_s:.3} s");
    report(&drawing);

    png::write_images(&drawing.tam, &folder)?;
    std::fs::write(folder.join("map.tam"), store::to_bytes(&drawing.tam)?)?;
    let (width, height, sheet) = contact(&drawing.tam);
    png::write_gray(folder.join("sheet.png"), width, height, &sheet)?;
    let (width, height, sheet) = tiled(&drawing.tam);
    png::write_gray(folder.join("tiled.png"), width, height, &sheet)?;
    png::write_gray16(folder.join("thresholds.png"), side, side, &thresholds.levels[0])?;
    let (width, height, sheet) = ramp(&thresholds);
    png::write_gray(folder.join("ramp.png"), width, height, &sheet)?;
    println!("{}", folder.display());
    Ok(())
}

/// Mean tones less what was asked for, in percent of white, and strokes, by tone and level.
fn report(drawing: &Drawing) {
    let tam = &drawing.tam;
    for (tone, asked) in tam.tones.iter().enumerate() {
        let errors =
            (0..tam.levels()).map(|level| format!("{:+.3}", 100.0 * (tam.mean(tone, level) - f64::from(*asked))));
        let strokes = (0..tam.levels()).map(|level| drawing.extents[tone * tam.levels() + level].strokes().to_string());
        let (errors, strokes) = (errors.collect::<Vec<_>>().join(" "), strokes.collect::<Vec<_>>().join(" "));
        println!("tone {asked:.4}: error % {errors}; strokes {strokes}");
    }
}

/// Puts an image into a sheet.
fn paste(sheet: &mut [u8], width: u32, at: (u32, u32), side: u32, image: &[u8]) {
    for (y, row) in image.chunks_exact(side as usize).enumerate() {
        let first = ((at.1 as usize + y) * width as usize) + at.0 as usize;
        sheet[first..first + side as usize].copy_from_slice(row);
    }
}

/// Tones beside each other, the four finest levels below each other, on gray.
fn contact(tam: &Tam) -> (u32, u32, Vec<u8>) {
    let gap = 8;
    let width = tam.tones.len() as u32 * (tam.side + gap) + gap;
    let height = (0..4).map(|level| tam.level_side(level) + gap).sum::<u32>() + gap;
    let mut sheet = vec![160; (width * height) as usize];
    for tone in 0..tam.tones.len() {
        let mut y = gap;
        for level in 0..4 {
            let x = gap + tone as u32 * (tam.side + gap);
            paste(&mut sheet, width, (x, y), tam.level_side(level), tam.image(tone, level));
            y += tam.level_side(level) + gap;
        }
    }
    (width, height, sheet)
}

/// The second finest level of each tone twice beside and below itself, without a gap.
fn tiled(tam: &Tam) -> (u32, u32, Vec<u8>) {
    let (side, gap) = (tam.level_side(1), 8);
    let columns = tam.tones.len().div_ceil(2) as u32;
    let (width, height) = (columns * (2 * side + gap) + gap, 2 * (2 * side + gap) + gap);
    let mut sheet = vec![160; (width * height) as usize];
    for tone in 0..tam.tones.len() {
        let (column, row) = (tone as u32 % columns, tone as u32 / columns);
        for i in 0..4 {
            let x = gap + column * (2 * side + gap) + i % 2 * side;
            let y = gap + row * (2 * side + gap) + i / 2 * side;
            paste(&mut sheet, width, (x, y), side, tam.image(tone, 1));
        }
    }
    (width, height, sheet)
}

/// All tones from white to black, four maps wide, by thresholds.
fn ramp(thresholds: &Thresholds) -> (u32, u32, Vec<u8>) {
    let side = thresholds.side;
    let (width, level) = (4 * side, &thresholds.levels[0]);
    let sheet = (0..width * side).map(|i| {
        let (x, y) = (i % width, i / width);
        let texel = f64::from(level[(y * side + x % side) as usize]) / 65535.0;
        let tone = 1.0 - (f64::from(x) + 0.5) / f64::from(width);
        (255.0 * (1.0 - hatch_threshold(texel, tone, 0.05)) + 0.5) as u8
    });
    (width, side, sheet.collect())
}
