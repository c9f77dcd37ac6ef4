//! The sections.

use crate::chart::front::{dominated, front};
use crate::chart::table::Point;
use crate::check::Limit;
use crate::plot::{curves, mark_positions, scatter, themed};
use crate::report::html::{Column, Field, TableRow, escaped, number, picture, table, thousands};
use crate::report::{
    AtlasEntry, ChartContent, CheckTable, Contents, Direction, Found, GalleryPicture, Pair, atlas_diagram,
    chart_diagram,
};
use std::fmt::Write;

/// A section of the page, with its entries in the table of contents.
pub(super) struct Section {
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    /// The id and the title of each part.
    pub(super) parts: Vec<(String, String)>,
    pub(super) html: String,
}

/// The sections that have content, in order.
pub fn all(contents: &Contents) -> Vec<Section> {
    let sections = [
        changes(contents),
        gallery(&contents.gallery),
        charts(&contents.charts),
        atlas(&contents.atlas),
        contents.check.as_ref().map(check),
        pairs(&contents.pairs),
        Some(machine(contents)),
    ];
    sections.into_iter().flatten().collect()
}

fn gallery(pictures: &[GalleryPicture]) -> Option<Section> {
    if pictures.is_empty() {
        return None;
    }
    let mut html = String::from("<div class=\"pictures\">\n");
    for GalleryPicture { name, about, passes, time_ms, picture: image } in pictures {
        let image = picture(image, &format!("{name}: {about}"));
        let (name, about, passes) = (escaped(name), escaped(about), escaped(&passes.join("; ")));
        // Writing to a String cannot fail.
        let _ = write!(html, "<figure>\n{image}\n<figcaption><strong>{name}</strong> {about}. ");
        let _ =
            writeln!(html, "<span class=\"aside\">{passes}; {} ms</span></figcaption>\n</figure>", number(*time_ms));
    }
    html.push_str("</div>\n");
    Some(Section { id: "gallery", title: "Gallery", parts: Vec::new(), html })
}

fn charts(charts: &[ChartContent]) -> Option<Section> {
    if charts.is_empty() {
        return None;
    }
    let mut html = String::from(
        "<p>Each point is a variant on an executor, over all scenes: its error against the truth, and the time of its frame \
         relative to a plain pass that was measured in the same rounds. Bars are the quartiles of the time. What lies on the \
         Pareto front is beaten by nothing in both; up and to the right of it, everything is. Arrow keys go from point to \
         point.</p>\n",
    );
    for chart in charts {
        html.push_str(&one_chart(chart));
    }
    let parts = charts.iter().map(|chart| (format!("chart-{}", chart.name), chart.title.clone())).collect();
    Some(Section { id: "charts", title: "Accuracy and speed", parts, html })
}

/// The numbers of a point, by name.
fn numbers(point: &Point) -> Vec<(String, String)> {
    let mut lines = vec![("executor".to_owned(), point.executor.clone())];
    lines.extend(point.errors.iter().map(|(name, value)| (name.clone(), number(*value))));
    let spread = point.relative;
    let time = format!("{} ({} to {})", number(spread.median), number(spread.low), number(spread.high));
    lines.push(("relative time".into(), time));
    lines.push(("memory".into(), format!("{} bytes", thousands(point.bytes))));
    lines.push(("scenes".into(), point.scenes.to_string()));
    if point.historical {
        lines.push(("historical".into(), "for comparison only".into()));
    }
    lines
}

fn one_chart(chart: &ChartContent) -> String {
    let ChartContent { name, title, about, points, .. } = chart;
    let mut html = format!("<section class=\"part\" id=\"chart-{name}\">\n<h3>{}</h3>\n", escaped(title));
    let _ = writeln!(html, "<p>{}</p>", escaped(about));
    let diagram = chart_diagram(chart);
    let label = format!("{title}: {} against time", chart.error);
    let mut marks = String::from("<g transform=\"scale(16)\">\n");
    let mut order: Vec<usize> = (0..points.len()).filter(|&n| points[n].error().is_finite()).collect();
    order.sort_by(|&a, &b| points[a].relative.median.total_cmp(&points[b].relative.median));
    let positions = mark_positions(&diagram);
    for (place, n) in order.into_iter().enumerate() {
        let (point, (x, y)) = (&points[n], positions[n]);
        let numbers = numbers(point);
        let tip: Vec<String> = numbers.iter().map(|(name, value)| format!("{name}\t{value}")).collect();
        let spoken: Vec<String> = numbers.iter().map(|(name, value)| format!("{name} {value}")).collect();
        // One point of a chart is reached by Tab, the others from it by arrow keys.
        let _ = writeln!(
            marks,
            "<circle class=\"mark\" role=\"img\" tabindex=\"{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"10\" data-name=\"{}\" \
             data-tip=\"{}\" aria-label=\"{}: {}\"/>",
            if place == 0 { 0 } else { -1 },
            escaped(&point.variant),
            escaped(&tip.join("\n")),
            escaped(&point.variant),
            escaped(&spoken.join(", ")),
        );
    }
    marks.push_str("</g>\n");
    html.push_str(&figure(&scatter(&diagram), &label, &marks));
    html.push_str(&chart_table(chart));
    html.push_str(&dominated_list(points));
    html.push_str("</section>\n");
    html
}

/// A themed diagram, with elements above it.
fn figure(svg: &str, label: &str, above: &str) -> String {
    let label = escaped(label);
    let svg = themed(svg).replacen("<svg", &format!("<svg role=\"group\" aria-label=\"{label}\""), 1);
    // Neither enlarged nor reduced so far that its text is too small.
    let natural = svg.split("viewBox=\"0 0 ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    let width = natural.map_or(960.0, |units| units / 16.0);
    let svg = svg.replacen("<svg", &format!("<svg style=\"max-width: {width}px; min-width: {}px\"", 0.9 * width), 1);
    let svg = svg.replacen("</svg>", &format!("{above}</svg>"), 1);
    format!("<div class=\"diagram\" role=\"region\" aria-label=\"{label}, diagram\" tabindex=\"0\">\n{svg}</div>\n")
}

fn chart_table(chart: &ChartContent) -> String {
    let points = &chart.points;
    let front = front(points);
    // Errors of all points, in the order in which they first come.
    let mut errors: Vec<&str> = Vec::new();
    for (name, _) in points.iter().flat_map(|point| &point.errors) {
        if !errors.contains(&name.as_str()) {
            errors.push(name);
        }
    }
    let mut columns = vec![Column::text("variant"), Column::text("executor")];
    columns.extend(errors.iter().map(|name| Column::number(name)));
    columns.extend(["relative time", "low", "high", "bytes"].map(Column::number));
    columns.push(Column::text("front"));
    let row = |(n, point): (usize, &Point)| {
        let mut fields = vec![Field::text(&point.variant), Field::text(&point.executor)];
        for error in &errors {
            let value = point.errors.iter().find(|(name, _)| name == error).map_or(f64::NAN, |(_, value)| *value);
            fields.push(Field::number(value));
        }
        fields.extend([point.relative.median, point.relative.low, point.relative.high].map(Field::number));
        fields.push(Field::shown(point.bytes as f64, &thousands(point.bytes)));
        let standing = match (front.contains(&n), point.historical) {
            (true, true) => "front, historical",
            (true, false) => "front",
            (false, true) => "historical",
            (false, false) => "",
        };
        fields.push(Field::text(standing));
        TableRow { class: if front.contains(&n) { "front" } else { "" }, fields }
    };
    let rows: Vec<_> = points.iter().enumerate().map(row).collect();
    table(&format!("table-{}", chart.name), &format!("{}: all points", chart.title), &columns, &rows)
}

fn dominated_list(points: &[Point]) -> String {
    let found = dominated(points);
    if found.is_empty() {
        return "<p>No variant is dominated.</p>\n".into();
    }
    let mut html = format!("<details>\n<summary>Dominated: {} of {}</summary>\n<ul>\n", found.len(), points.len());
    for dominated in found {
        let (point, by) = (&points[dominated.point], &points[dominated.by]);
        let name =
            |point: &Point| format!("<strong>{}</strong> on {}", escaped(&point.variant), escaped(&point.executor));
        let clearly = if dominated.clearly { "" } else { " (their times overlap)" };
        let _ = writeln!(html, "<li>{} by {}{clearly}</li>", name(point), name(by));
    }
    html.push_str("</ul>\n</details>\n");
    html
}

fn atlas(entries: &[AtlasEntry]) -> Option<Section> {
    if entries.is_empty() {
        return None;
    }
    let mut html = String::from(
        "<p>Each sweep varies the parameter that breaks a method. Solid vertical lines are measured limits, dashed ones those \
         that a formula predicts.</p>\n",
    );
    for entry in entries {
        html.push_str(&one_sweep(entry));
    }
    let parts = entries.iter().map(|entry| (format!("sweep-{}", entry.name), title(&entry.name))).collect();
    Some(Section { id: "atlas", title: "Failure atlas", parts, html })
}

/// A name in kebab case as a title.
fn title(name: &str) -> String {
    let words = name.replace('-', " ");
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn one_sweep(entry: &AtlasEntry) -> String {
    let AtlasEntry { name, technique, what, found } = entry;
    let mut html = format!("<section class=\"part\" id=\"sweep-{name}\">\n<h3>{}</h3>\n", escaped(&title(name)));
    let _ = writeln!(html, "<p><span class=\"tag\">{}</span> {}</p>", escaped(technique), escaped(what));
    match found {
        Err(why) => {
            let _ = writeln!(html, "<p class=\"note\">Skipped: {}</p>", escaped(why));
        }
        Ok(found) => {
            let label = format!("{}: {} against {}", title(name), found.error.name, found.parameter.name);
            html.push_str(&figure(&curves(&atlas_diagram(found)), &label, ""));
            if !found.pictures.is_empty() {
                html.push_str("<div class=\"pictures small\">\n");
                for (caption, image) in &found.pictures {
                    let image = picture(image, caption);
                    let _ =
                        writeln!(html, "<figure>\n{image}\n<figcaption>{}</figcaption>\n</figure>", escaped(caption));
                }
                html.push_str("</div>\n");
            }
            html.push_str(&limits(name, found));
        }
    }
    html.push_str("</section>\n");
    html
}

fn limits(name: &str, found: &Found) -> String {
    let columns = [
        Column::text("method"),
        Column::text("limit"),
        Column::number("measured"),
        Column::number("predicted"),
        Column::text("formula"),
        Column::number("bound"),
        Column::text("to be mended"),
    ];
    let rows = found.curves.iter().map(|curve| {
        let limit = &curve.limit;
        let predicted = limit.predicted.as_ref();
        let fields = vec![
            Field::text(&curve.name),
            Field::text(&limit.what),
            Field::number(limit.measured),
            predicted.map_or_else(|| Field::text(""), |(value, _)| Field::number(*value)),
            Field::text(predicted.map_or("", |(_, formula)| formula)),
            bound(limit.bound),
            Field::text(limit.to_be_mended.as_deref().unwrap_or("")),
        ];
        TableRow { class: if limit.bound.holds(limit.measured) { "" } else { "failed" }, fields }
    });
    table(&format!("limits-{name}"), &format!("{}: limits", title(name)), &columns, &rows.collect::<Vec<_>>())
}

fn bound(limit: Limit) -> Field {
    match limit {
        Limit::AtLeast(value) => Field::shown(value, &format!("≥ {}", number(value))),
        Limit::AtMost(value) => Field::shown(value, &format!("≤ {}", number(value))),
    }
}

fn check(check: &CheckTable) -> Section {
    let failed = check.rows.iter().filter(|row| !row.pass).count();
    let limited = check.rows.iter().filter(|row| row.limit.is_some()).count();
    let mut html = format!(
        "<p>On {}: <strong>{} passed, {failed} failed</strong>, {} without a limit.</p>\n",
        escaped(&check.executor),
        limited.saturating_sub(failed),
        check.rows.len() - limited
    );
    if !check.skipped.is_empty() {
        html.push_str("<ul>\n");
        for skipped in &check.skipped {
            let _ = writeln!(html, "<li>Skipped: {}</li>", escaped(skipped));
        }
        html.push_str("</ul>\n");
    }
    html.push_str(
        "<p class=\"filter\"><label>Filter <input type=\"search\" data-filter=\"table-check\"></label> <label><input \
         type=\"checkbox\" data-failed=\"table-check\"> failed only</label> <output aria-live=\"polite\"></output></p>\n",
    );
    let columns = [
        Column::text("technique"),
        Column::text("metric"),
        Column::text("model"),
        Column::text("view"),
        Column::number("value"),
        Column::number("limit"),
        Column::text("verdict"),
    ];
    let mut rows: Vec<_> = check.rows.iter().collect();
    rows.sort_by_key(|row| row.pass);
    let rows = rows.into_iter().map(|row| {
        let verdict = match (row.pass, row.limit) {
            (false, _) => "fail",
            (true, Some(_)) => "pass",
            (true, None) => "",
        };
        let fields = vec![
            Field::text(&row.technique),
            Field::text(&row.metric),
            Field::text(&row.model),
            Field::text(&row.view),
            Field::number(row.value),
            row.limit.map_or_else(|| Field::text(""), bound),
            Field::text(verdict),
        ];
        TableRow { class: if row.pass { "" } else { "failed" }, fields }
    });
    html.push_str(&table("table-check", "Checks, failed ones first", &columns, &rows.collect::<Vec<_>>()));
    Section { id: "check", title: "Checks", parts: Vec::new(), html }
}

fn pairs(pairs: &[Pair]) -> Option<Section> {
    if pairs.is_empty() {
        return None;
    }
    let mut html = String::from(
        "<p>The same picture by two executors. The slider moves the border between them; the third picture is their \
         difference, amplified: black where they are equal.</p>\n",
    );
    for pair in pairs {
        let Pair { style, executors: [left, right], pictures, difference, differing, pixels, worst } = pair;
        let share = 100.0 * *differing as f64 / (*pixels).max(1) as f64;
        let alt = |executor: &str| format!("{style} by {executor}");
        let _ = writeln!(html, "<section class=\"part\" id=\"pair-{0}\">\n<h3>{0}</h3>", escaped(style));
        let _ = writeln!(
            html,
            "<p>{} of {} pixels differ ({} %), by at most {worst} of 255.</p>\n<div class=\"pictures\">\n<figure>\n\
             <div class=\"compare\">\n{}\n{}\n</div>\n<label class=\"slider\">{} <input type=\"range\" min=\"0\" max=\"100\" \
             value=\"50\" aria-label=\"{}: border between {} and {}\"> {}</label>\n</figure>",
            thousands(*differing),
            thousands(*pixels),
            number(share),
            picture(&pictures[0], &alt(left)),
            picture(&pictures[1], &alt(right)),
            escaped(left),
            escaped(style),
            escaped(left),
            escaped(right),
            escaped(right),
        );
        let _ = writeln!(
            html,
            "<figure>\n{}\n<figcaption>Difference</figcaption>\n</figure>\n</div>\n</section>",
            picture(difference, &format!("{style}: difference"))
        );
    }
    let parts = pairs.iter().map(|pair| (format!("pair-{}", pair.style), pair.style.clone())).collect();
    Some(Section { id: "pairs", title: "Executors compared", parts, html })
}

fn changes(contents: &Contents) -> Option<Section> {
    let changes = contents.changes.as_ref()?;
    let count = |direction| changes.changes.iter().filter(|change| change.direction == direction).count();
    let mut html = String::from("<p>Compared with:</p>\n<ul>\n");
    for old in &changes.old {
        let _ = writeln!(html, "<li>{}</li>", escaped(old));
    }
    // A line of the machine says with which sizes, rounds and scenes charts were measured.
    if changes.old.iter().any(|old| !contents.machine.iter().all(|line| old.contains(line.as_str()))) {
        html.push_str(
            "<li><strong>That run had another machine, size, number of rounds or other scenes than this one: what differs \
             may come from there.</strong></li>\n",
        );
    }
    let _ = writeln!(
        html,
        "</ul>\n<p>Of {} values, <strong>{} became worse, {} better</strong>; {} are new, {} are gone. An error counts if it \
         changed at all, a time if the ranges between its quartiles have nothing in common.</p>",
        thousands(changes.compared as u64),
        count(Direction::Worse),
        count(Direction::Better),
        count(Direction::Added),
        count(Direction::Removed)
    );
    let columns = [
        Column::text("chart"),
        Column::text("variant"),
        Column::text("executor"),
        Column::text("scene"),
        Column::text("what"),
        Column::number("before"),
        Column::number("now"),
        Column::text("direction"),
    ];
    let rows = changes.changes.iter().map(|change| {
        let value = |value: Option<f64>| value.map_or_else(|| Field::text(""), Field::number);
        let (direction, class) = match change.direction {
            Direction::Worse => ("worse", "failed"),
            Direction::Better => ("better", "front"),
            Direction::Added => ("new", ""),
            Direction::Removed => ("gone", ""),
        };
        let mut fields: Vec<_> = [&change.chart, &change.variant, &change.executor, &change.scene, &change.what]
            .map(|text| Field::text(text))
            .into();
        fields.extend([value(change.old), value(change.new), Field::text(direction)]);
        TableRow { class, fields }
    });
    if !changes.changes.is_empty() {
        html.push_str(&table("table-changes", "Changes, worse ones first", &columns, &rows.collect::<Vec<_>>()));
    }
    Some(Section { id: "changes", title: "Changes", parts: Vec::new(), html })
}

fn machine(contents: &Contents) -> Section {
    let mut html = format!("<ul>\n<li>npr {}</li>\n", env!("CARGO_PKG_VERSION"));
    for line in &contents.machine {
        let _ = writeln!(html, "<li>{}</li>", escaped(line));
    }
    html.push_str("</ul>\n");
    if !contents.skipped.is_empty() {
        html.push_str("<p>Not in this report:</p>\n<ul>\n");
        for line in &contents.skipped {
            let _ = writeln!(html, "<li>{}</li>", escaped(line));
        }
        html.push_str("</ul>\n");
    }
    Section { id: "machine", title: "Machine and versions", parts: Vec::new(), html }
}
