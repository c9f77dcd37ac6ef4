//! `npr tam`: draws tonal art maps into a folder, or unpacks a map file.

use crate::paths;
use crate::terminal::{say, spinner};
use clap::Args;
use npr_harness::error::{HarnessError, PathRole};
use npr_harness::hatch::read_map;
use npr_hatch::files::write_file;
use npr_hatch::{
    Drawing, HatchError, MAX_TONES, Placement, StrokeImage, Tam, TamParameters, Thresholds, draw, even_tones, png,
    sheet, store,
};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Levels of fewer texels along a side hold too few strokes for an exact tone.
const SMALLEST_SIDE: u32 = 64;

/// The pictures in addition to those of the tones.
const WRITTEN: [&str; 4] = ["sheet.png", "tiled.png", "thresholds.png", "ramp.png"];

#[derive(Args)]
pub struct Options {
    /// A map that is there already, to be unpacked; without one, a map is drawn.
    #[arg(value_name = "MAP.tam")]
    map: Option<PathBuf>,
    /// The folder, which is made if need be. Files of the same names are overwritten.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print what was done as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    drawn: Drawn,
}

/// What is of no use for a map that is there already.
#[derive(Args)]
#[group(conflicts_with = "map", multiple = true)]
struct Drawn {
    /// So many tones in equal steps between white and black, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = TamParameters::default().tones.len())]
    tones: usize,
    /// The tones themselves, the lightest first, between 1 (white) and 0 (black).
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', allow_hyphen_values = true, conflicts_with = "tones")]
    tone_values: Vec<f32>,
    /// Side of the finest level in texels, a power of two from 8 to 4096.
    #[arg(long, value_name = "TEXELS", default_value_t = TamParameters::default().side)]
    size: u32,
    /// What the strokes' places and shapes are drawn from.
    #[arg(long, value_name = "N", default_value_t = TamParameters::default().seed)]
    seed: u64,
    /// A stroke's width in texels, the same at every level: 1 to 64, and at most a quarter of the side.
    #[arg(long, value_name = "W", allow_negative_numbers = true, default_value_t = TamParameters::default().width_px)]
    width_px: f32,
    /// A stroke's length as a share of the side: 0.02 to 1.
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, default_value = "0.3,0.6", value_parser = parse_range)]
    length: [f32; 2],
    /// Along what the strokes run: degrees from the texture's x axis to its y axis, which points down in a picture.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = TamParameters::default().angle_deg)]
    angle: f32,
    /// How far a stroke may be turned from that, either way: degrees, 0 to 45.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = TamParameters::default().jitter_deg)]
    jitter: f32,
    /// How far a stroke may bend, either way, as a share of its length: 0 to 0.2.
    #[arg(long, value_name = "B", allow_negative_numbers = true, default_value_t = TamParameters::default().bow)]
    bow: f32,
    /// The share of a stroke over which it thins out: 0 to 1. Of no effect with --stroke.
    #[arg(long, value_name = "T", allow_negative_numbers = true, default_value_t = TamParameters::default().taper)]
    taper: f32,
    /// How black a stroke is: 0.05 to 1.
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, default_value = "0.8,1", value_parser = parse_range)]
    pressure: [f32; 2],
    /// From which tone on new strokes run crosswise, counted from 0, the lightest, or `never` [default: the darker half].
    #[arg(long, value_name = "N|never", value_parser = parse_cross_from)]
    cross_from: Option<CrossFrom>,
    /// From the lengthwise strokes to the crosswise ones, degrees.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = TamParameters::default().cross_deg)]
    cross_angle: f32,
    /// Each stroke's place is the best of so many random ones, 1 to 4096, instead of the next of an even sequence.
    #[arg(long, value_name = "N")]
    candidates: Option<u32>,
    /// What strokes look like: a picture of one that runs from left to right, dark on light. It wants a --width-px of
    /// 4 or more; where it has much paper, dark tones are out of its reach.
    #[arg(long, value_name = "PICTURE")]
    stroke: Option<PathBuf>,
}

#[derive(Clone, Copy)]
enum CrossFrom {
    Tone(usize),
    Never,
}

fn parse_range(text: &str) -> Result<[f32; 2], String> {
    let number = |part: &str| part.trim().parse::<f32>().map_err(|_| format!("{part:?} is not a number"));
    let (low, high) = text.split_once(',').ok_or("expected two numbers: LOW,HIGH")?;
    Ok([number(low)?, number(high)?])
}

fn parse_cross_from(text: &str) -> Result<CrossFrom, String> {
    if text == "never" {
        return Ok(CrossFrom::Never);
    }
    let tone = text.parse().map_err(|_| format!("{text:?} is neither a tone's number nor \"never\""))?;
    Ok(CrossFrom::Tone(tone))
}

impl Drawn {
    fn parameters(&self) -> Result<TamParameters, HatchError> {
        let tones = if self.tone_values.is_empty() {
            if self.tones > MAX_TONES {
                return Err(HatchError::TonesCount { tones: self.tones });
            }
            even_tones(self.tones)
        } else {
            self.tone_values.clone()
        };
        let cross_from = match self.cross_from {
            Some(CrossFrom::Tone(tone)) => Some(tone),
            Some(CrossFrom::Never) => None,
            None => Some(tones.len().div_ceil(2)).filter(|&tone| tone < tones.len()),
        };
        let parameters = TamParameters {
            tones,
            side: self.size,
            seed: self.seed,
            width_px: self.width_px,
            length: self.length,
            angle_deg: self.angle,
            jitter_deg: self.jitter,
            bow: self.bow,
            taper: self.taper,
            pressure: self.pressure,
            cross_from,
            cross_deg: self.cross_angle,
            placement: match self.candidates {
                Some(candidates) => Placement::BestOf { candidates },
                None => Placement::Sequence,
            },
        };
        parameters.validate()?;
        Ok(parameters)
    }
}

/// A map that was drawn or read.
struct Map {
    tam: Tam,
    thresholds: Option<Thresholds>,
    /// The cost of drawing, if it was drawn.
    effort: Option<Effort>,
}

/// The cost of drawing a map.
struct Effort {
    strokes: usize,
    draw_s: f64,
    thresholds_s: f64,
}

/// The result for a tone.
struct Found {
    asked: f32,
    /// The mean of the finest level.
    mean: f64,
    /// The largest signed error of the finest level and of all levels from [`SMALLEST_SIDE`] on.
    largest_error: f64,
}

pub fn run(options: &Options) -> Result<bool, HarnessError> {
    if let Some(stroke) = options.drawn.stroke.as_deref().filter(|stroke| is_overwritten(stroke, &options.output)) {
        return Err(HarnessError::Overwrites { path: stroke.to_owned() });
    }
    paths::check_output_folder(&options.output)?;
    if let Some(stroke) = &options.drawn.stroke {
        paths::check_file(PathRole::StrokePicture, stroke)?;
    }
    if let Some(map) = &options.map {
        paths::check_file(PathRole::Map, map)?;
    }
    let map = match &options.map {
        Some(path) => read(path)?,
        None => make(&options.drawn)?,
    };
    let start = Instant::now();
    let folder = &options.output;
    let unusable = |source| HarnessError::Unusable { role: PathRole::Output, path: folder.clone(), source };
    std::fs::create_dir_all(folder).map_err(unusable)?;
    let files = write(&map, folder)
        .map_err(|source| HarnessError::Incomplete { folder: folder.clone(), source: Box::new(source) })?;
    let write_s = start.elapsed().as_secs_f64();
    let found: Vec<Found> = (0..map.tam.tones.len()).map(|tone| found(&map.tam, tone)).collect();
    if options.json {
        print_json(options, &map, &found, &files, write_s)?;
    } else {
        say(format_args!("{}\n", table(options, &map, &found, &files, write_s)))?;
    }
    Ok(true)
}

/// Whether an input picture lies in the folder and has the name of an output.
fn is_overwritten(picture: &Path, folder: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let name = picture.file_name().and_then(|name| name.to_str()).unwrap_or("");
    let is_written = WRITTEN.contains(&name) || name.starts_with("tone_") && name.ends_with(".png");
    is_written && real(picture).is_some_and(|picture| picture.parent() == real(folder).as_deref())
}

fn make(drawn: &Drawn) -> Result<Map, HarnessError> {
    let parameters = drawn.parameters()?;
    let stroke = drawn.stroke.as_ref().map(StrokeImage::load).transpose()?;
    let bar = spinner(&format!("drawing {} tones at {}²", parameters.tones.len(), parameters.side));
    let start = Instant::now();
    let drawing = draw(&parameters, stroke.as_ref())?;
    let draw_s = start.elapsed().as_secs_f64();
    bar.set_message("finding thresholds");
    let start = Instant::now();
    let thresholds = Thresholds::new(&drawing, &parameters, stroke.as_ref());
    let thresholds_s = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let Drawing { tam, layers, .. } = drawing;
    let strokes = layers.iter().map(Vec::len).sum();
    Ok(Map { tam, thresholds: Some(thresholds), effort: Some(Effort { strokes, draw_s, thresholds_s }) })
}

fn read(path: &Path) -> Result<Map, HarnessError> {
    let bar = spinner(&format!("reading {}", path.display()));
    let stored = read_map(path)?;
    bar.finish_and_clear();
    Ok(Map { tam: stored.tam, thresholds: stored.thresholds, effort: None })
}

/// Writes the files of a map; a map that was read is not written as a map file again.
fn write(map: &Map, folder: &Path) -> Result<Vec<PathBuf>, HarnessError> {
    let Map { tam, thresholds, effort } = map;
    let bar = spinner(&format!("writing {}", folder.display()));
    let mut files = Vec::new();
    let mut file = |name| {
        let path = folder.join(name);
        files.push(path.clone());
        path
    };
    if effort.is_some() {
        let path = file("map.tam");
        let bytes = store::to_bytes(tam, thresholds.as_ref())?;
        write_file(&path, &bytes).map_err(|source| HarnessError::Write { path, source })?;
    }
    let [sheet_name, tiled, thresholds_name, ramp] = WRITTEN;
    png::write_sheet(file(sheet_name), &sheet::contact(tam))?;
    png::write_sheet(file(tiled), &sheet::tiled(tam))?;
    if let Some(thresholds) = thresholds {
        png::write_gray16(file(thresholds_name), tam.side, tam.side, &thresholds.levels[0])?;
        png::write_sheet(file(ramp), &sheet::ramp(thresholds))?;
    }
    files.extend(png::write_images(tam, folder)?);
    bar.finish_and_clear();
    Ok(files)
}

fn found(tam: &Tam, tone: usize) -> Found {
    let asked = tam.tones[tone];
    let error = |level| tam.mean(tone, level) - f64::from(asked);
    let large = (1..tam.levels()).filter(|&level| tam.level_side(level) >= SMALLEST_SIDE).map(error);
    let first = error(0);
    let largest_error = large.fold(first, |a, b| if b.abs() > a.abs() { b } else { a });
    Found { asked, mean: first + f64::from(asked), largest_error }
}

fn print_json(
    options: &Options,
    map: &Map,
    found: &[Found],
    files: &[PathBuf],
    write_s: f64,
) -> Result<(), HarnessError> {
    let tones: Vec<_> = found
        .iter()
        .map(|found| json!({"asked": found.asked, "found": found.mean, "largest_error": found.largest_error}))
        .collect();
    let effort = map.effort.as_ref();
    say(format_args!(
        "{}\n",
        json!({
            "input": options.map, "output": options.output,
            "side": map.tam.side, "levels": map.tam.levels(), "tones": tones, "thresholds": map.thresholds.is_some(),
            "strokes": effort.map(|effort| effort.strokes),
            "strokes_per_s": effort.map(|effort| effort.strokes as f64 / effort.draw_s),
            "draw_s": effort.map(|effort| effort.draw_s),
            "thresholds_s": effort.map(|effort| effort.thresholds_s),
            "write_s": write_s,
            "files": files,
        })
    ))
}

/// The table as one string, so that a reader such as `head`, which closes the pipe early, causes no error.
fn table(options: &Options, map: &Map, found: &[Found], files: &[PathBuf], write_s: f64) -> String {
    let Tam { tones, side, .. } = &map.tam;
    let mut lines = vec![format!(
        "{}: {} tones at {side}² with {} mips",
        options.output.display(),
        tones.len(),
        map.tam.levels() - 1
    )];
    if let Some(Effort { strokes, draw_s, thresholds_s }) = map.effort {
        lines.push(format!("{draw_s:.3} s to draw, {thresholds_s:.3} s for the thresholds, {write_s:.3} s to write"));
        lines.push(format!("{strokes} strokes placed, {:.0} per second", strokes as f64 / draw_s));
    } else {
        lines.push(format!("{write_s:.3} s to write"));
    }
    lines.push(format!("tone   asked   found   largest error, all levels from {}² on", SMALLEST_SIDE.min(*side)));
    lines.extend(found.iter().enumerate().map(|(tone, Found { asked, mean, largest_error })| {
        format!("{tone:4}  {asked:.4}  {mean:.4}  {largest_error:+.5}")
    }));
    // The images are the last files.
    lines.extend(files[..files.len() - map.tam.images.len()].iter().map(|path| path.display().to_string()));
    lines.push(format!("{}: {} images", options.output.join("tone_N_SIDE.png").display(), map.tam.images.len()));
    if map.thresholds.is_none() {
        lines.push("the file has no thresholds: no thresholds.png, no ramp.png".to_owned());
    }
    lines.join("\n")
}
