//! The report's page in a browser, where there is one: Chromium without a window.
//!
//! NPR_BROWSER=required makes a missing browser a failure; otherwise these tests say that they are skipped.

#![allow(clippy::print_stdout)]

mod common;

use common::Folder;
use npr_harness::chart::{Row, Table, Time, charts};
use npr_harness::check::Limit;
use npr_harness::executor::{Backend, Executor};
use npr_harness::measure::Spread;
use npr_harness::picture::Image;
use npr_harness::report::{
    AtlasEntry, CheckRow, CheckTable, Contents, GalleryPicture, Pair, PngPicture, changes, make, page,
};
use npr_harness::stability::sweeps;
use serde::Deserialize;
use std::path::Path;
use std::process::Command;

const BEFORE: &str = include_str!("page/before.js");
const AFTER: &str = include_str!("page/after.js");

/// The browser, or `None` with a message.
fn browser() -> Option<&'static str> {
    let works = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|said| said.status.success());
    let found = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"].into_iter().find(works);
    if found.is_none() {
        assert_ne!(std::env::var("NPR_BROWSER").as_deref(), Ok("required"), "NPR_BROWSER=required, and there is none");
        println!("skipped: there is no Chromium");
    }
    found
}

#[derive(Debug, Deserialize)]
struct Looked {
    width: u32,
    marks: u32,
    findings: Vec<String>,
}

/// Opens a page in a window of the given width, and returns what the scripts found.
fn looked_at(browser: &str, folder: &Folder, page: &str, width: u32) -> Looked {
    let page = page.replacen("<head>", &format!("<head>\n<script>{BEFORE}</script>"), 1);
    let page = page.replacen("</body>", &format!("<script>{AFTER}</script>\n</body>"), 1);
    let path = folder.join("page.html");
    std::fs::write(&path, page).expect("written");
    // The frame has the width asked for, whatever the least width of a window is.
    let frame = format!(
        "<!doctype html><body><iframe style=\"border: 0; width: {width}px; height: 900px\" src=\"page.html\"></iframe>\
         <pre id=\"found\"></pre><script>addEventListener(\"message\", (event) => {{ found.textContent = event.data; }});\
         </script>"
    );
    std::fs::write(folder.join("frame.html"), frame).expect("written");
    let said = run(browser, folder, &["--dump-dom", "--virtual-time-budget=60000"], &folder.join("frame.html"));
    let found =
        said.split("<pre id=\"found\">").nth(1).and_then(|rest| rest.split("</pre>").next()).unwrap_or_default();
    let found = found.replace("&lt;", "<").replace("&gt;", ">").replace("&nbsp;", "\u{a0}").replace("&amp;", "&");
    serde_json::from_str(&found).unwrap_or_else(|error| panic!("{error} in {found:?} of {said}"))
}

fn run(browser: &str, folder: &Folder, arguments: &[&str], page: &Path) -> String {
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"])
        .args(["--disable-component-update", "--disable-sync", "--hide-scrollbars", "--window-size=1400,1000"])
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .args(arguments)
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("the browser runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn gradient(width: u32, height: u32, seed: u32) -> PngPicture {
    let pixels = (0..height).flat_map(|y| (0..width).flat_map(move |x| [x as u8, y as u8, (seed + x * y) as u8, 255]));
    let image = Image::new(width, height, pixels.collect()).expect("an image");
    PngPicture::new(&image, 640).expect("a PNG")
}

fn row(chart: &str, variant: &str, executor: &str, error: f64, time: f64) -> Row {
    let spread = |median: f64| Spread { median, low: 0.95 * median, high: 1.1 * median };
    Row {
        chart: chart.into(),
        variant: variant.into(),
        historical: variant.contains("printed"),
        executor: executor.into(),
        scene: "teapot".into(),
        errors: vec![("1 − F1".into(), error), ("pieces for each curve".into(), 1.0 + error)],
        time: Time { relative: spread(time), relative_own: spread(time), ms: spread(3.0 * time), device_ms: None },
        bytes: (1e6 * time) as u64,
    }
}

/// A small report with all of its sections: real sweeps, and a table of made-up numbers.
fn contents(folder: &Folder) -> Contents {
    let names = ["edge lines", "fins as printed", "inverted hull", "lines in the image, 32-bit packed G-buffer"];
    let (first, second) = (charts()[0], charts()[1]);
    let mut table = Table { machine: vec!["a machine".into()], ..Table::default() };
    for (n, name) in names.into_iter().enumerate() {
        for (m, executor) in ["llvmpipe", "cpu"].into_iter().enumerate() {
            let (error, time) = (0.3 / (1 + 4 * n) as f64, 1.3 + n as f64 + 5.0 * m as f64);
            table.rows.push(row(first.name, name, executor, if n == 3 { 0.0 } else { error }, time));
            table.rows.push(row(second.name, name, executor, if n == 1 { f64::NAN } else { error * time }, time));
        }
    }
    let mut old = table.clone();
    old.rows[0].errors[0].1 *= 2.0;
    old.rows[2].time.relative.high = 0.1;
    old.rows[4].variant = "a variant that is gone".into();
    let path = folder.join("old.csv");
    std::fs::write(&path, old.to_csv()).expect("written");
    let of =
        |chart| make::content(chart, table.rows.iter().filter(|row| row.chart == chart.name).cloned().collect(), &[]);
    let executors = [Executor::choose(Backend::Cpu).expect("an executor")];
    let sweeps = sweeps().into_iter().filter(|sweep| !sweep.needs_adapter).take(2);
    let mut atlas: Vec<AtlasEntry> = sweeps.map(|sweep| make::swept(&sweep, &executors).expect("a sweep")).collect();
    let skipped = AtlasEntry { name: "skipped".into(), found: Err("no adapter".into()), ..atlas[0].clone() };
    atlas.push(skipped);
    let check_row = |n: u32| CheckRow {
        model: "scene".into(),
        view: "composed".into(),
        technique: "cartoon".into(),
        metric: format!("metric number {n} with <a long> & \"quoted\" name"),
        value: f64::from(n) * 0.1,
        limit: [None, Some(Limit::AtMost(0.5)), Some(Limit::AtLeast(0.0))][n as usize % 3],
        pass: n % 3 != 1 || n < 5,
    };
    Contents {
        machine: table.machine.clone(),
        skipped: vec!["something, for a reason".into()],
        gallery: vec![GalleryPicture {
            name: "cartoon".into(),
            about: "bands and lines".into(),
            passes: vec!["surfaces".into(), "lines".into()],
            time_ms: 12.3,
            picture: gradient(640, 360, 1),
        }],
        charts: vec![of(&first), of(&second)],
        atlas,
        check: Some(CheckTable {
            executor: "cpu".into(),
            skipped: vec!["a check".into()],
            rows: (0..9).map(check_row).collect(),
        }),
        pairs: vec![Pair {
            style: "cartoon".into(),
            executors: ["CPU, ray casting".into(), "llvmpipe (LLVM 15.0.6, 256 bits) (Vulkan, software)".into()],
            pictures: [gradient(640, 360, 1), gradient(640, 360, 2)],
            difference: gradient(640, 360, 3),
            differing: 1234,
            pixels: 230_400,
            worst: 2,
        }],
        changes: Some(changes(&path, &table).expect("a table")),
    }
}

#[test]
fn the_page_works_on_narrow_and_wide_screens() {
    let folder = Folder::new();
    let contents = contents(&folder);
    let page = page(&contents);
    for address in ["http:", "https:", "//"] {
        // The namespace of SVG is a name.
        let found = page.replace("http://www.w3.org/2000/svg", "").matches(&format!("=\"{address}")).count();
        assert_eq!(found, 0, "something is from elsewhere");
    }
    if let Some(dir) = std::env::var_os("NPR_PAGE") {
        std::fs::write(Path::new(&dir).join("page.html"), &page).expect("written");
    }
    let Some(browser) = browser() else { return };
    for width in [360, 1280] {
        let looked = looked_at(browser, &folder, &page, width);
        assert_eq!(looked.width, width);
        // A variant without an error has no mark.
        assert_eq!(looked.marks, 14);
        assert_eq!(looked.findings, [""; 0], "at {width} px");
    }
}

/// What the test of the page must find.
#[test]
fn faults_of_a_page_are_found() {
    let folder = Folder::new();
    let contents = contents(&folder);
    let page = page(&contents);
    let Some(browser) = browser() else { return };
    let changed = |replacements: &[(&str, &str)]| {
        replacements.iter().fold(page.clone(), |page, (what, by)| {
            assert!(page.contains(what), "{what}");
            page.replace(what, by)
        })
    };
    let content = [
        ("no picture", "<img src=\"data:image/png;base64,AAAA\" alt=\"none\">"),
        ("no text in place of a picture", "<img src=\"data:image/png;base64,AAAB\">"),
        ("from elsewhere", "<img src=\"other.png\" alt=\"other\">"),
        ("the page is", "<div style=\"width: 500px\">wide</div>"),
        (
            "leaves the window: <div style=\"width: 501px",
            "<div style=\"overflow: hidden\"><div style=\"width: 501px\">wide</div></div>",
        ),
        ("console.error: broken", "<script>console.error(\"broken\")</script>"),
        ("error: Uncaught", "<script>throw new Error(\"broken\")</script>"),
        ("leads nowhere", "<a href=\"#nowhere\">nowhere</a>"),
        ("one id", "<p id=\"gallery\"></p>"),
        ("skips a level", "<h2>2</h2><h4>4</h4>"),
        ("contrast", "<p style=\"color: #999; background: #fff\">faint</p>"),
    ];
    let behaviour = [
        ("an arrow key does not reach", ("ArrowRight: 1", "ArrowSideways: 1")),
        ("Escape does not close", ("=== \"Escape\"", "=== \"Escaped\"")),
        ("not sorted", ("x - y;", "y - x;")),
        ("the filter lets everything through", ("row.hidden = !fits", "row.hidden = false")),
        ("the slider does not move", ("slider.addEventListener(\"input\"", "slider.addEventListener(\"other\"")),
        ("the theme does not change", ("[data-theme=\"dark\"] { color-scheme: dark; }", "x { color: red; }")),
        ("not in the contents", ("<a href=\"#atlas\">", "<a href=\"#gallery\">")),
    ];
    // One page with all faults of a kind; what hides others has a page of its own.
    let added = format!("{}</main>", content.map(|(_, html)| html).concat());
    let pages = [
        (content.map(|(fault, _)| fault).to_vec(), changed(&[("</main>", &added)])),
        (behaviour.map(|(fault, _)| fault).to_vec(), changed(&behaviour.map(|(_, replacement)| replacement))),
        (vec!["no tooltip at point"], changed(&[("\"focus\", ()", "\"nothing\", ()")])),
    ];
    for (faults, page) in pages {
        let findings = looked_at(browser, &folder, &page, 360).findings;
        for fault in faults {
            assert!(findings.iter().any(|finding| finding.contains(fault)), "{fault}: {findings:#?}");
        }
    }
}
