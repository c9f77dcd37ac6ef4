//! Shader modules from several WGSL files.

/// A shader module from several files, given as name and text: their names at its head, and a line before each.
pub(crate) fn assemble(files: &[(&str, &str)]) -> String {
    let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
    let mut source = format!("// Made of: {}\n", names.join(", "));
    for (name, text) in files {
        source += &format!("\n// ---- {name}\n{text}");
    }
    source
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn modules_name_their_files_and_validate() {
        for (source, files) in [
            (
                crate::line_pass::record_wgsl(false),
                &["contour.wgsl", "segment.wgsl", "line_ink.wgsl", "line_unveiled.wgsl", "line_pass.wgsl"][..],
            ),
            (
                crate::line_pass::pulled_wgsl(true),
                &[
                    "contour.wgsl",
                    "segment.wgsl",
                    "line_ink.wgsl",
                    "line_veiled.wgsl",
                    "line_pass.wgsl",
                    "edge_record.wgsl",
                    "line_pulled.wgsl",
                ],
            ),
            (
                crate::line_pass::compaction_wgsl(),
                &["contour.wgsl", "segment.wgsl", "edge_record.wgsl", "compaction.wgsl"],
            ),
            (crate::fin_pass::wgsl(), &["normal_format.wgsl", "fin_printed.wgsl", "fin_pass.wgsl"]),
            (crate::hull_pass::wgsl(), &["hull.wgsl", "hull_pass.wgsl"]),
            (crate::shadow_pass::wgsl(), &["shadow_volume.wgsl", "shadow_pass.wgsl"]),
        ] {
            let (head, rest) = source.split_once('\n').unwrap();
            assert_eq!(head, format!("// Made of: {}", files.join(", ")));
            let before_each: Vec<_> = rest.lines().filter_map(|line| line.strip_prefix("// ---- ")).collect();
            assert_eq!(before_each, files);
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
        }
    }
}
