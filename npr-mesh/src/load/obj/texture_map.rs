//! The `map_…` statements of material files: options and the name of a file.

use crate::Wrap;
use crate::load::external::{meanings, shortened};
use std::path::PathBuf;

/// The operands of a `map_…` statement.
pub(super) struct TextureMap {
    /// The possible names of the file.
    pub names: Vec<PathBuf>,
    /// The name as written, for messages.
    pub written: String,
    pub wrap: Wrap,
    pub placement: Placement,
}

/// How texture coordinates (u, v) become those of an image: u · scale + offset, with v upwards (`-s` and `-o`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub scale: [f32; 2],
    pub offset: [f32; 2],
}

impl Default for Placement {
    fn default() -> Self {
        Self { scale: [1.0; 2], offset: [0.0; 2] }
    }
}

impl Placement {
    /// Places a texture coordinate with v upwards. Exact for the default placement.
    pub fn place(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        [u * self.scale[0] + self.offset[0], v * self.scale[1] + self.offset[1]]
    }
}

/// The options, and how many operands each has at least and at most.
const OPTIONS: [(&str, usize, usize); 13] = [
    ("-s", 1, 3),
    ("-o", 1, 3),
    ("-t", 1, 3),
    ("-mm", 1, 2),
    ("-blendu", 1, 1),
    ("-blendv", 1, 1),
    ("-cc", 1, 1),
    ("-clamp", 1, 1),
    ("-imfchan", 1, 1),
    ("-type", 1, 1),
    ("-texres", 1, 1),
    ("-boost", 1, 1),
    ("-bm", 1, 1),
];

impl TextureMap {
    /// Reads what follows the keyword: options, and the name of a file, which may contain spaces and be in quotes. Some
    /// exporters write options behind the name. Returns the options that are ignored, too; there is no map without a
    /// name.
    pub fn read(line: &str) -> (Option<Self>, Vec<&'static str>) {
        let mut map =
            Self { names: Vec::new(), written: String::new(), wrap: Wrap::Repeat, placement: Placement::default() };
        let mut ignored = Vec::new();
        let mut rest = map.read_options(line.trim(), true, &mut ignored);
        if let Some(quoted) = rest.strip_prefix('"')
            && let Some((name, after)) = quoted.split_once('"')
        {
            map.read_options(after.trim(), false, &mut ignored);
            rest = name;
        } else if let Some(at) = options_behind(rest) {
            map.read_options(rest[at..].trim(), false, &mut ignored);
            rest = rest[..at].trim_end();
        }
        let name = rest.trim_matches('"').trim();
        map.written = shortened(name);
        match meanings(name) {
            Some(names) => (Some(Self { names, ..map }), ignored),
            None => (None, ignored),
        }
    }

    /// Reads options, and returns what follows them: if a name must follow, at least the last word.
    fn read_options<'a>(&mut self, mut rest: &'a str, name_follows: bool, ignored: &mut Vec<&'static str>) -> &'a str {
        while rest.starts_with('-') {
            let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            // The name of a file may begin with a hyphen.
            let Some((option, least, most)) = option(word) else { break };
            rest = after.trim_start();
            let mut operands = Vec::new();
            while operands.len() < most {
                let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                // The name of the file follows fewer operands than there may be.
                if word.is_empty()
                    || (name_follows && after.is_empty())
                    || (operands.len() >= least && word.parse::<f32>().is_err())
                {
                    break;
                }
                operands.push(word);
                rest = after.trim_start();
            }
            let numbers: Vec<f32> = operands.iter().map_while(|word| word.parse().ok()).collect();
            let target = match option {
                "-s" => Some(&mut self.placement.scale),
                "-o" => Some(&mut self.placement.offset),
                "-clamp" => {
                    let on = operands.first().is_some_and(|word| word.eq_ignore_ascii_case("on"));
                    self.wrap = if on { Wrap::Clamp } else { Wrap::Repeat };
                    None
                }
                _ => {
                    ignored.push(option);
                    None
                }
            };
            // The third number is for solid textures.
            for (target, number) in target.into_iter().flatten().zip(numbers).filter(|(_, number)| number.is_finite()) {
                *target = number;
            }
        }
        rest
    }
}

fn option(word: &str) -> Option<(&'static str, usize, usize)> {
    OPTIONS.iter().find(|(name, ..)| *name == word).copied()
}

/// Where options with an operand follow a name.
fn options_behind(text: &str) -> Option<usize> {
    text.match_indices(" -").map(|(at, _)| at).find(|&at| {
        let mut words = text[at..].split_whitespace();
        let is_option = words.next().and_then(option).is_some();
        is_option && words.next().is_some_and(|word| word.parse::<f32>().is_ok() || ["on", "off"].contains(&word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_and_names() {
        let at = |scale, offset| Placement { scale, offset };
        let same = Placement::default();
        for (line, name, placement, wrap, ignored) in [
            ("t.png", "t.png", same, Wrap::Repeat, &[][..]),
            ("my own t.png", "my own t.png", same, Wrap::Repeat, &[]),
            ("\"my own t.png\"", "my own t.png", same, Wrap::Repeat, &[]),
            ("-s 2 3 1 t.png", "t.png", at([2.0, 3.0], [0.0; 2]), Wrap::Repeat, &[]),
            ("-s 2 t.png", "t.png", at([2.0, 1.0], [0.0; 2]), Wrap::Repeat, &[]),
            ("-o .25 -0.5 my own 2.png", "my own 2.png", at([1.0; 2], [0.25, -0.5]), Wrap::Repeat, &[]),
            ("-clamp on -s 2 2 t.png", "t.png", at([2.0; 2], [0.0; 2]), Wrap::Clamp, &[]),
            ("-clamp off t.png", "t.png", same, Wrap::Repeat, &[]),
            (
                "-blendu off -blendv on -cc on -mm 0 1 -t 1 1 1 -texres 512 -bm 0.5 -boost 2 -imfchan l -type sphere t.png",
                "t.png",
                same,
                Wrap::Repeat,
                &["-blendu", "-blendv", "-cc", "-mm", "-t", "-texres", "-bm", "-boost", "-imfchan", "-type"],
            ),
            ("t.png -s 2 2 2", "t.png", at([2.0; 2], [0.0; 2]), Wrap::Repeat, &[]),
            ("\"t -s 2.png\" -o 1 1 1", "t -s 2.png", at([1.0; 2], [1.0; 2]), Wrap::Repeat, &[]),
            ("-hyphen.png", "-hyphen.png", same, Wrap::Repeat, &[]),
            ("-s nan inf t.png", "t.png", same, Wrap::Repeat, &[]),
            ("a -s b.png", "a -s b.png", same, Wrap::Repeat, &[]),
            ("-s 1 2 3", "3", at([1.0, 2.0], [0.0; 2]), Wrap::Repeat, &[]),
            ("-CLAMP", "-CLAMP", same, Wrap::Repeat, &[]),
        ] {
            let (map, found) = TextureMap::read(line);
            let map = map.unwrap_or_else(|| panic!("{line}: no name"));
            assert_eq!((map.names[0].to_str(), map.placement, map.wrap), (Some(name), placement, wrap), "{line}");
            assert_eq!(found, ignored, "{line}");
        }
        for line in ["", "\"\"", "-bm"] {
            assert!(TextureMap::read(line).0.is_none(), "{line}");
        }
    }
}
