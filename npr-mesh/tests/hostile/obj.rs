//! Wavefront OBJ and MTL.

use crate::case::{Case, Expect, fails, loads};

pub const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn case(name: &str, text: impl Into<Vec<u8>>, expect: Expect) -> Case {
    Case::new(&format!("obj-{name}"), "m.obj", text, expect)
}

/// The vertices of the triangle followed by a text.
fn after(text: &str) -> String {
    format!("{TRIANGLE}{text}")
}

/// A triangle with the material `a` of a file.
fn material(name: &str, mtl: impl Into<Vec<u8>>, warnings: &[&str]) -> Case {
    case(&format!("mtl-{name}"), after("mtllib m.mtl\nusemtl a\nf 1 2 3\n"), loads(1, warnings)).with("m.mtl", mtl)
}

pub fn cases() -> Vec<Case> {
    [texts(), faces(), numbers(), libraries(), materials()].into_iter().flatten().collect()
}

fn texts() -> Vec<Case> {
    let plain = after("f 1 2 3\n");
    let utf16 = |big: bool| {
        let units = std::iter::once('\u{feff}').chain(plain.chars()).map(|c| c as u16);
        units.flat_map(|unit| if big { unit.to_be_bytes() } else { unit.to_le_bytes() }).collect::<Vec<u8>>()
    };
    let bytes = |parts: &[&[u8]]| parts.concat();
    vec![
        case("empty", "", fails(&["no triangle"])),
        case("blank", "\n \t\r\n\n", fails(&["no triangle"])),
        case("comment-only", "# nothing here", fails(&["no triangle"])),
        case("vertices-only", TRIANGLE, fails(&["no triangle"])),
        case("backslashes-only", "\\\n\\\n\\", fails(&["no triangle"])),
        case("html", "<!DOCTYPE html>\n<html><body>404</body></html>\n", fails(&["no triangle"])),
        case("nul", bytes(&[plain.as_bytes(), b"\0"]), fails(&["not a text file"])),
        case("binary", (0..9999u32).map(|i| ((i * i) >> 3) as u8).collect::<Vec<u8>>(), fails(&["not a text file"])),
        case("utf16-little", utf16(false), fails(&["not a text file"])),
        case("utf16-big", utf16(true), fails(&["not a text file"])),
        case("glb-inside", &b"glTF\x02\0\0\0\x14\0\0\0"[..], fails(&["not a text file"])),
        case("byte-order-mark", format!("\u{feff}{plain}"), loads(1, &["1 byte-order marks"])),
        case("byte-order-mark-twice", format!("\u{feff}\u{feff}{plain}"), loads(1, &["2 byte-order marks"])),
        case("crlf", plain.replace('\n', "\r\n"), loads(1, &[])),
        case("cr", plain.replace('\n', "\r"), loads(1, &[])),
        case("cr-among-lf", plain.replacen('\n', "\r", 2), loads(1, &[])),
        case("cr-cr-lf", plain.replace('\n', "\r\r\n"), loads(1, &[])),
        case("no-end-of-line", plain.trim_end(), loads(1, &[])),
        case("form-feeds", plain.replace(' ', "\x0c"), loads(1, &[])),
        case("tabs", plain.replace(' ', "\t"), loads(1, &[])),
        case("indented", plain.replace('\n', "\n   "), loads(1, &[])),
        case("continued-face", after("f 1 \\\n 2 \\\r\n 3\n"), loads(1, &["1 lines go on"])),
        case("continued-vertex", plain.replacen(' ', " \\\n", 3), loads(1, &["1 lines go on"])),
        case("continued-twice", plain.replace("v 0", "v \\\n0"), loads(1, &["2 lines go on"])),
        case("continued-at-end", after("f 1 2 3 \\"), loads(1, &["1 lines go on"])),
        case("continued-word", after("f 1 2 3\\\n"), loads(1, &["1 lines go on"])),
        case("continued-long", after(&format!("f 1 2 3 {}\n", "\\\n ".repeat(50_000))), loads(1, &["1 lines go on"])),
        case("continued-comment", after("# a \\\nf 1 2 3\n"), loads(1, &[])),
        case("comment-not-utf8", bytes(&[b"# caf\xe9 \xff\n", plain.as_bytes()]), loads(1, &["1 lines are not UTF-8"])),
        case("group-not-utf8", bytes(&[b"g caf\xe9\n", plain.as_bytes()]), loads(1, &["1 lines are not UTF-8"])),
        case(
            "comment-behind-not-utf8",
            bytes(&[TRIANGLE.as_bytes(), b"f 1 2 3 # \xe9\n"]),
            loads(1, &["1 lines are not UTF-8"]),
        ),
        case(
            "material-not-utf8",
            bytes(&[TRIANGLE.as_bytes(), b"usemtl \xe9\nf 1 2 3\n"]),
            loads(1, &["1 lines are not UTF-8", "no material file defines"]),
        ),
        case("face-not-utf8", bytes(&[TRIANGLE.as_bytes(), b"f 1 2 \xe9\n"]), fails(&["line 4", "no number"])),
        case("vertex-not-utf8", bytes(&[b"v 0 0 \xe9\n", plain.as_bytes()]), fails(&["line 1: not UTF-8"])),
        case("unknown-keyword", after("hello world\nf 1 2 3\n"), loads(1, &["1 lines begin with none"])),
        case("long-line", after(&format!("#{}\nf 1 2 3\n", "x".repeat(3_000_000))), loads(1, &[])),
        case(
            "long-keyword",
            after(&format!("{}\nf 1 2 3\n", "x".repeat(3_000_000))),
            loads(1, &["none of the format's"]),
        ),
        case("many-groups", after(&"g a\nf 1 2 3\n".repeat(50_000)), loads(50_000, &[])),
        case("many-blank-lines", after(&format!("{}f 1 2 3\n", "\n".repeat(2_000_000))), loads(1, &[])),
    ]
}

fn faces() -> Vec<Case> {
    let ring = |n: usize, radius: &dyn Fn(usize) -> f64| {
        let mut text = String::new();
        for i in 0..n {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            text += &format!("v {:.9} {:.9} 0\n", angle.cos() * radius(i), angle.sin() * radius(i));
        }
        text + "f" + &(1..=n).map(|i| format!(" {i}")).collect::<String>() + "\n"
    };
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut tangle = |n: usize| {
        let vertices: String = (0..n).map(|_| format!("v {} {} {}\n", random(), random(), random())).collect();
        vertices + "f" + &(1..=n).map(|i| format!(" {i}")).collect::<String>() + "\n"
    };
    let same = format!("{TRIANGLE}f{}\n", " 1".repeat(50_000));
    let none = ["no triangle"];
    vec![
        case("negative", after("f -3 -2 -1\n"), loads(1, &[])),
        case("negative-too-far", after("f -4 -2 -1\n"), fails(&["line 4", "vertex -4, and there are 3"])),
        case("negative-forward", after("f -3 -2 -1\nf 1 2 -9\n"), fails(&["line 5", "-9"])),
        case("zero", after("f 0 1 2\n"), fails(&["line 4", "count from 1"])),
        case("minus-zero", after("f -0 1 2\n"), fails(&["line 4", "count from 1"])),
        case("beyond", after("f 1 2 4\n"), fails(&["line 4: a face uses vertex 4 of 3"])),
        case("forward", format!("f 1 2 3\n{TRIANGLE}"), loads(1, &[])),
        case("large-index", after("f 1 2 4294967297\n"), fails(&["line 4", "too large"])),
        case("endless-index", after(&format!("f 1 2 {}\n", "9".repeat(300))), fails(&["line 4", "too large"])),
        case("fractional-index", after("f 1.0 2.0 3.0\n"), fails(&["line 4", "no number"])),
        case("four-numbers", after("f 1/1/1/1 2 3\n"), fails(&["line 4", "no number"])),
        case("words", after("f a b c\n"), fails(&["line 4", "no number"])),
        case("lone-sign", after("f 1 2 -\n"), fails(&["line 4", "no number"])),
        case("leading-zeros-and-signs", after("f 01 +2 003\n"), loads(1, &[])),
        case("empty-slashes", after("f 1// 2// 3//\n"), loads(1, &[])),
        case("texture-slash", after("f 1/ 2/ 3/\n"), loads(1, &[])),
        case("texture-beyond", after("vt 0 0\nf 1/2 2/1 3/1\n"), fails(&["texture coordinate 2 of 1"])),
        case("normal-beyond", after("vn 0 0 1\nf 1//2 2//1 3//1\n"), fails(&["normal 2 of 1"])),
        case("texture-zero", after("vt 0 0\nf 1/0 2/0 3/0\n"), loads(1, &[])),
        case("some-have-textures", after("vt 0 0\nf 1/1 2/1 3/1\nf 1 2 3\n"), loads(2, &[])),
        case("mixed-corners", after("vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\n"), loads(1, &["1 of 3 vertices have no"])),
        case("no-corners", after("f\nf 1 2 3\n"), loads(1, &["1 faces with fewer"])),
        case("one-and-two-corners", after("f 1\nf 1 2\nf 1 2 3\n"), loads(1, &["2 faces with fewer"])),
        case("only-two-corners", after("f 1 2\n"), fails(&none)),
        case("lines-and-points", after("l 1 2 3\np 1\nl 1 2\nf 1 2 3\n"), loads(1, &["1 points"])),
        case("only-lines", after("l 1 2 3\n"), loads(0, &[])),
        case("only-points", after("p 1 2 3\n"), fails(&["no triangle in it (1 points are left out)"])),
        case("line-vertex-missing", after("l 1 4\nf 1 2 3\n"), fails(&["line 4", "a line uses vertex 4 of 3"])),
        case("line-vertex-later", after("l 1 4\nv 1 1 1\nf 1 2 3\n"), loads(1, &[])),
        case("line-vertex-zero", after("l 0 1\nf 1 2 3\n"), fails(&["line 4", "without a vertex"])),
        case("line-vertex-before-all", after("l -4 -1\nf 1 2 3\n"), fails(&["line 4", "vertex -4"])),
        case("line-too-large", after("l 1 99999999999\nf 1 2 3\n"), fails(&["line 4", "too large"])),
        case("line-of-one", after("l 1\nl\nl 2 2\nf 1 2 3\n"), loads(1, &["3 lines from a vertex to itself"])),
        case("line-not-finite", "v nan 0 0\nv 1 0 0\nl 1 2\n", fails(&["line 1", "not finite"])),
        case("smoothing-nonsense", after("s\ns x\ns -1\nf 1 2 3\n"), loads(1, &["3 smoothing groups"])),
        case("smoothing-large", after("s 99999999999999\nf 1 2 3\ns 4294967295\nf 1 2 3\n"), loads(2, &[])),
        case("capitals", "V 0 0 0\nF 1 1 1\n", fails(&["no triangle in it (2 lines begin with none"])),
        case(
            "old-keyword",
            after("fo 1 2 3\nfo 1 2 # 3\nf 3 2 1 # 4\nfo 3 2 1 # 4\n"),
            loads(3, &["1 faces with fewer"]),
        ),
        case("bad-line-element", after("l 7 8 x\nf 1 2 3\n"), fails(&["line 4", "a line's end that is no number"])),
        case(
            "curves",
            after("cstype bezier\ndeg 3\ncurv 0 1 1 2 3\nparm u 0 1\nend\nf 1 2 3\n"),
            loads(1, &["1 curves and surfaces"]),
        ),
        case("call", after("call other.obj\nf 1 2 3\n"), loads(1, &["1 calls of other files"])),
        case("zero-area", after("f 1 2 3\nf 1 1 2\nf 1 2 2\n"), loads(3, &["2 of 3 faces have no area"])),
        case("all-zero-area", after("f 1 1 1\n"), loads(1, &["1 of 1 faces have no area"])),
        case("in-line", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", loads(1, &["1 of 1 faces have no area"])),
        case("duplicates", after("f 1 2 3\nf 2 3 1\nf 3 2 1\n"), loads(3, &[])),
        case("opposite", after("v 1 1 0\nf 1 2 3\nf 2 3 4\n"), loads(2, &[])),
        case("three-at-an-edge", after("v 0 0 1\nv 0 0 -1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n"), loads(3, &[])),
        case("polygon-100000", ring(100_000, &|_| 1.0), loads(99_998, &[])),
        case("polygon-star-100000", ring(100_000, &|i| if i % 2 == 0 { 1.0 } else { 0.5 }), loads(99_998, &[])),
        case("polygon-comb", ring(20_000, &|i| 1.0 + (i * 7919 % 101) as f64 * 0.01), loads(19_998, &[])),
        case("polygon-tangle", tangle(3000), loads(2998, &[])),
        case("polygon-tangle-20000", tangle(20_000), loads(19_998, &[])),
        case("polygon-tangle-100000", tangle(100_000), loads(99_998, &[])),
        case("polygon-of-one-vertex", same, loads(49_998, &["49998 of 49998 faces have no area"])),
        case("polygon-too-long", ring(100_001, &|_| 1.0), fails(&["100001 corners of a polygon", "100000"])),
        case(
            "polygon-keyhole",
            "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n",
            loads(8, &[]),
        ),
        case(
            "quads-at-one-edge",
            after(&("v 1 1 0\n".to_owned() + &"f 1 2 4 3\n".repeat(150_000))),
            loads(300_000, &[]),
        ),
        case("polygon-round-and-round", after(&format!("f{}\n", " 1 2 3".repeat(33_000))), loads(98_998, &["no area"])),
        case("polygon-back-and-forth", after(&format!("f{} 3\n", " 1 2".repeat(49_000))), loads(97_999, &["no area"])),
        case("same-face-often", after(&"f 1 2 3\n".repeat(500_000)), loads(500_000, &[])),
        case(
            "faces-at-one-edge",
            (0..100_000).map(|i| format!("v 0 {i} {}\n", i % 7)).collect::<String>()
                + "v 0 0 0\nv 1 0 0\n"
                + &(1..=100_000).map(|i| format!("f 100001 100002 {i}\n")).collect::<String>(),
            loads(100_000, &["1 of 100000 faces have no area"]),
        ),
        case(
            "many-polygon-tangles",
            {
                let vertices = tangle(300);
                let line = vertices.lines().last().expect("a face").to_owned() + "\n";
                vertices + &line.repeat(99)
            },
            loads(29_800, &[]),
        ),
    ]
}

fn numbers() -> Vec<Case> {
    let vertex = |name: &str, word: &str, expect: Expect| {
        case(&format!("number-{name}"), format!("v {word} 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), expect)
    };
    let not_finite = || fails(&["line 1: vertex", "not finite"]);
    let no_number = || fails(&["line 1", "no number"]);
    let mut cases = vec![
        vertex("1e400", "1e400", not_finite()),
        vertex("minus-1e400", "-1e400", not_finite()),
        vertex("nan", "nan", not_finite()),
        vertex("inf", "inf", not_finite()),
        vertex("1e-400", "1e-400", loads(1, &[])),
        vertex("300-digits", &"1".repeat(300), not_finite()),
        vertex("300-decimals", &format!("0.{}", "3".repeat(300)), loads(1, &[])),
        vertex("a-million-digits", &format!("0.{}", "3".repeat(1_000_000)), loads(1, &[])),
        vertex("endless-exponent", &format!("1e-{}", "9".repeat(300)), loads(1, &[])),
        vertex("hexadecimal", "0x10", no_number()),
        vertex("comma", "0,5", no_number()),
        vertex("no-exponent", "1e", no_number()),
        vertex("underscores", "1_000", no_number()),
        vertex("visual-c-nan", "-1.#IND", fails(&["line 1"])),
        vertex("other-digits", "\u{661}", no_number()),
        vertex("points", ".5", loads(1, &[])),
        vertex("trailing-point", "5.", loads(1, &[])),
        vertex("plus", "+5", loads(1, &[])),
        case("two-coordinates", "v 0 0\nf 1 1 1\n", fails(&["line 1: a vertex of 2 coordinates"])),
        case("unused-nan", format!("{TRIANGLE}v nan 1e400 -inf\nf 1 2 3\n"), loads(1, &[])),
        case("unused-no-number", format!("{TRIANGLE}v a b c\nf 1 2 3\n"), fails(&["line 4", "no number"])),
        case("weight", "v 0 0 0 1\nv 2 0 0 2\nv 0 1 0 1\nf 1 2 3\n", loads(1, &[])),
        case("weight-zero", "v 0 0 0 0\nf 1 1 1\n", fails(&["line 1: a vertex weight of 0"])),
        case("weight-tiny", "v 1 0 0 1e-40\nv 0 0 0\nf 1 2 2\n", fails(&["line 1", "not finite"])),
        case("weight-no-number", "v 1 0 0 x\nv 0 0 0\nf 1 2 2\n", fails(&["line 1", "no number"])),
        case("five-numbers", format!("{TRIANGLE}v 0 0 1 1 1\nf 1 2 3\n"), loads(1, &["5 numbers or more"])),
        case("nine-numbers", "v 0 0 0 1 1 1 7 8 9\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nf 1 2 3\n", loads(1, &["5 numbers"])),
        case("colours-255", "v 0 0 0 255 0 0\nv 1 0 0 0 0 9\nv 0 1 0 0 0 0\nf 1 2 3\n", loads(1, &["0..=255"])),
        case(
            "colours-1e38",
            "v 0 0 0 1e38 -5 0\nv 1 0 0 0 0 9\nv 0 1 0 0 0 0\nf 1 2 3\n",
            loads(1, &["0..=255", "1 vertex colours are not within"]),
        ),
        case("colours-nan", "v 0 0 0 nan 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n", loads(1, &["are not finite"])),
        case("colours-of-some", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", loads(1, &["2 vertices have no colour"])),
        case("colours-no-number", "v 0 0 0 a b c\nf 1 1 1\n", fails(&["line 1: a vertex colour"])),
        case("texture-one-number", after("vt 0.5\nf 1/1 2/1 3/1\n"), loads(1, &[])),
        case("texture-no-number", after("vt\nf 1/1 2/1 3/1\n"), fails(&["line 4: a texture coordinate"])),
        case("texture-nan", after("vt nan 1e400\nf 1/1 2/1 3/1\n"), loads(1, &["are not finite"])),
        case("normal-zero", after("vn 0 0 0\nf 1//1 2//1 3//1\n"), loads(1, &[])),
        case("normal-nan", after("vn nan 0 0\nf 1//1 2//1 3//1\n"), loads(1, &[])),
        case("normal-tiny", after("vn 1e-40 0 0\nf 1//1 2//1 3//1\n"), loads(1, &[])),
        case("normal-huge", after("vn 3e38 3e38 3e38\nf 1//1 2//1 3//1\n"), loads(1, &[])),
        case("normal-two-numbers", after("vn 0 1\nf 1//1 2//1 3//1\n"), fails(&["line 4: a normal"])),
    ];
    for (name, size) in
        [("1e-40", 1e-40), ("1e-30", 1e-30), ("1e-20", 1e-20), ("1e20", 1e20), ("1e30", 1e30), ("3e38", 3e38)]
    {
        let text =
            format!("v 0 0 0\nv {size:e} 0 0\nv {size:e} {size:e} 0\nv 0 {size:e} {:e}\nf 1 2 3 4\n", size / 3.0);
        cases.push(case(&format!("size-{name}"), text, loads(2, &[])));
    }
    let far = "v 1e7 1e7 -1e7\nv 10000001 1e7 -1e7\nv 1e7 10000001 -1e7\nf 1 2 3\n";
    cases.push(case("far-away", far, loads(1, &[])));
    cases
}

fn libraries() -> Vec<Case> {
    let red = "newmtl a\nKd 1 0 0\n";
    let named = |name: &str, line: &str, warnings: &[&str]| {
        case(&format!("mtllib-{name}"), after(&format!("mtllib {line}\nusemtl a\nf 1 2 3\n")), loads(1, warnings))
    };
    let undefined = "no material file defines \"a\"";
    let outside = "leads out of the model's folder";
    let many = |count: usize| (0..count).map(|i| format!("mtllib {i}.mtl\n")).collect::<String>();
    vec![
        named("missing", "none.mtl", &["none.mtl", undefined]),
        named("itself", "m.obj", &[undefined]),
        named("folder", "sub", &["not a regular file", undefined]).with("sub/x", ""),
        named("nothing", "", &["1 mtllib lines without a name", undefined]),
        named("parent", "../secret.mtl", &[outside, undefined]).with("../secret.mtl", red),
        named("parent-within", "sub/../m.mtl", &[]).with("sub/x", "").with("m.mtl", red),
        named("absolute", "/etc/hostname", &["hostname", undefined]),
        named("device", "/dev/zero", &["zero", undefined]),
        named("device-by-parents", "../../../../../../../../dev/zero", &[outside, undefined]),
        named("drive", "C:\\models\\m.mtl", &[]).with("m.mtl", red),
        named("backslash", "sub\\m.mtl", &[]).with("sub/m.mtl", red),
        named("spaces", "my file.mtl", &[]).with("my file.mtl", red),
        named("quotes", "\"m.mtl\"", &[]).with("m.mtl", red),
        named("two", "none.mtl m.mtl", &["none.mtl"]).with("m.mtl", red),
        named("comment", "m.mtl # the file", &[]).with("m.mtl", red),
        named("control-characters", "\x1b[2Jx.mtl", &["x.mtl", undefined]),
        named("long-name", &"x".repeat(1_000_000), &["material file", undefined]),
        named("link-inside", "link.mtl", &[]).with("m.mtl", red).link("link.mtl", "m.mtl"),
        named("link-outside", "link.mtl", &[outside, undefined]).link("link.mtl", "/etc/hostname"),
        named("link-to-device", "link.mtl", &[outside, undefined]).link("link.mtl", "/dev/zero"),
        named("link-to-folder-outside", "sub/hostname", &[outside, undefined]).link("sub", "/etc"),
        named("link-to-itself", "link.mtl", &["link.mtl", undefined]).link("link.mtl", "link.mtl"),
        Case { pipe: Some("m.mtl".to_owned()), ..named("pipe", "m.mtl", &["not a regular file", undefined]) },
        named("asset-root", "m.mtl", &[]).with("../assets-1/m.mtl", red).asset_root("../assets-1"),
        named("asset-root-parent", "../assets-2/m.mtl", &[]).with("../assets-2/m.mtl", red).asset_root("../assets-2"),
        named("asset-root-beyond", "../assets-3.mtl", &[outside, undefined])
            .with("../assets-3.mtl", red)
            .with("../assets-3/x", "")
            .asset_root("../assets-3"),
        named("asset-root-behind", "m.mtl", &[])
            .with("m.mtl", red)
            .with("../assets-4/m.mtl", "nothing")
            .asset_root("../assets-4"),
        case("mtllib-many", after(&(many(5000) + "f 1 2 3\n")), loads(1, &["material file", "and 4900 more"])),
        case("mtllib-too-many", after(&(many(10_001) + "f 1 2 3\n")), fails(&["files named in it"])),
        case(
            "mtllib-one-line-many",
            after(&format!("mtllib{}\nf 1 2 3\n", " a".repeat(10_001))),
            fails(&["files named"]),
        ),
        case("mtllib-again", after(&("mtllib m.mtl\n".repeat(100_000) + "usemtl a\nf 1 2 3\n")), loads(1, &[]))
            .with("m.mtl", red),
        case("mtllib-later", after("usemtl a\nf 1 2 3\nmtllib m.mtl\n"), loads(1, &[])).with("m.mtl", red),
        case("usemtl-empty", after("usemtl\nusemtl   \nf 1 2 3\n"), loads(1, &["2 usemtl lines without a name"])),
        case("usemtl-unknown", after("usemtl nobody\nf 1 2 3\n"), loads(1, &["no material file defines \"nobody\""])),
        case("usemtl-comment", after("mtllib m.mtl\nusemtl a # red\nf 1 2 3\n"), loads(1, &[])).with("m.mtl", red),
        case("usemtl-number-sign", after("mtllib m.mtl\nusemtl a #2\nf 1 2 3\n"), loads(1, &[]))
            .with("m.mtl", "newmtl a #1\nnewmtl a #2\n"),
        case("usemtl-control", after("usemtl \x1b[31m\u{7}x\nf 1 2 3\n"), loads(1, &["no material file defines"])),
        case("usemtl-long", after(&format!("usemtl {}\nf 1 2 3\n", "x".repeat(1 << 20))), loads(1, &["no material"])),
        case(
            "usemtl-many",
            after(&(0..50_000).map(|i| format!("usemtl {i}\nf 1 2 3\n")).collect::<String>()),
            loads(50_000, &["no material file defines", "and 49997 more (50000 materials)"]),
        ),
        case(
            "usemtl-many-known",
            after(&(0..50_000).map(|i| format!("mtllib m.mtl\nusemtl {i}\nf 1 2 3\n")).collect::<String>()),
            loads(50_000, &[]),
        )
        .with("m.mtl", (0..50_000).map(|i| format!("newmtl {i}\n")).collect::<String>()),
    ]
}

fn materials() -> Vec<Case> {
    vec![
        material("empty", "", &["no material file defines \"a\""]),
        material("byte-order-mark", "\u{feff}newmtl a\nKd 1 0 0\n", &[]),
        material("crlf", "newmtl a\r\nKd 1 0 0\r\n", &[]),
        material("not-utf8", &b"# \xe9\nnewmtl a\nKd 1 0 0\n"[..], &["not UTF-8 throughout"]),
        material("binary", &b"\0\x01\x02newmtl a\0"[..], &["no material file defines"]),
        material("no-name", "newmtl\nKd 1 0 0\nnewmtl a\n", &[]),
        material("twice", "newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\n", &[]),
        material("before-newmtl", "Kd 1 0 0\nmap_Kd x.png\nnewmtl a\n", &[]),
        material("kd-one", "newmtl a\nKd 0.5\n", &[]),
        material("kd-two", "newmtl a\nKd 1 0\n", &["Kd \"1 0\" is not understood"]),
        material("kd-none", "newmtl a\nKd\n", &["Kd \"\" is not understood"]),
        material("kd-words", "newmtl a\nKd red green blue\n", &["is not understood"]),
        material("kd-nan", "newmtl a\nKd nan nan nan\n", &["is not understood"]),
        material("kd-inf", "newmtl a\nKd 1e400 0 0\n", &["is not understood"]),
        material("kd-huge", "newmtl a\nKd 1e38 0 0\n", &["is not within 0 to 1"]),
        material("kd-negative", "newmtl a\nKd -1 0 0\n", &["is not within 0 to 1"]),
        material("kd-spectral", "newmtl a\nKd spectral file.rfl 1.0\n", &["is not understood"]),
        material("kd-long", format!("newmtl a\nKd {}\n", "9".repeat(1 << 20)), &["is not understood"]),
        material("d-two", "newmtl a\nd 2\n", &[]),
        material("d-negative", "newmtl a\nd -3\n", &[]),
        material("d-nan", "newmtl a\nd nan\n", &["d \"nan\" is not understood"]),
        material("d-halo", "newmtl a\nd -halo 0.5\n", &[]),
        material("d-and-tr", "newmtl a\nd 0.5\nTr 0.9\n", &["d 0.5 and Tr 0.9 contradict each other"]),
        material("d-and-tr-agree", "newmtl a\nd 0.5\nTr 0.5\n", &[]),
        material("tr-alone", "newmtl a\nTr 1\n", &["Tr 1 without d is taken as opaque"]),
        material("tr-inf", "newmtl a\nTr 1e400\n", &["Tr \"1e400\" is not understood"]),
        material(
            "numbers-elsewhere",
            "newmtl a\nNs x\nNi\nillum 99999999999\nKs\nKe 1 2\nPr nan\n",
            &["Ke \"1 2\" is not understood"],
        ),
        material("no-emission", "newmtl a\nKe 0 0 0\n", &[]),
        material("many", (0..200_000).map(|i| format!("newmtl m{i}\n")).collect::<String>() + "newmtl a\n", &[]),
    ]
}
