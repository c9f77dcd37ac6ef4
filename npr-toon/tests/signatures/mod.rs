//! Compares the signatures of the functions of a WGSL library with those of the Rust functions of the same names.

use std::collections::BTreeSet;

use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use syn::{FnArg, Item, Pat, ReturnType};

/// A WGSL file and the Rust files with the same stem, as text. A WGSL function must have its counterpart in that file.
pub struct Pair<'a> {
    pub wgsl: &'a str,
    pub rust: &'a str,
}

/// The permitted differences. The last element of each entry is the reason.
#[derive(Clone, Copy)]
pub struct Exceptions<'a> {
    /// WGSL functions without a counterpart in Rust.
    pub wgsl_only: &'a [(&'a str, &'a str)],
    /// WGSL functions whose counterpart has another name: WGSL name, Rust name.
    pub renamed: &'a [(&'a str, &'a str, &'a str)],
    /// Corresponding types: Rust type, WGSL type.
    pub types: &'a [(&'a str, &'a str, &'a str)],
    /// A Rust parameter that is several parameters in WGSL: function, Rust parameter, WGSL names and types.
    pub split: &'a [(&'a str, &'a str, &'a [Parameter<'a>], &'a str)],
    /// Functions for which a type corresponds to another than usual: function, Rust type, WGSL type.
    pub types_of: &'a [(&'a str, &'a str, &'a str, &'a str)],
}

/// Name and WGSL type.
pub type Parameter<'a> = (&'a str, &'a str);

type Signature = (Vec<(String, String)>, String);

/// One line for each difference between the two sides, and for each exception that no function needs.
pub fn differences(module: &Module, pairs: &[Pair], exceptions: &Exceptions) -> Vec<String> {
    let mut found = Vec::new();
    let mut used = BTreeSet::new();
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().expect("library functions have names");
        if exceptions.wgsl_only.iter().any(|entry| entry.0 == name) {
            used.insert(name.to_owned());
            continue;
        }
        let Some(pair) = pairs.iter().find(|pair| pair.wgsl.contains(&format!("fn {name}("))) else {
            found.push(format!("{name}: not in any of the WGSL files"));
            continue;
        };
        let renamed = exceptions.renamed.iter().find(|entry| entry.0 == name);
        used.extend(renamed.map(|entry| entry.0.to_owned()));
        let Some(rust) = rust_signature(pair.rust, name, renamed.map_or(name, |entry| entry.1), exceptions, &mut used)
        else {
            found.push(format!("{name}: no Rust function in the file of the same stem"));
            continue;
        };
        let arguments = function.arguments.iter();
        let arguments = arguments.map(|a| (a.name.clone().expect("parameters have names"), wgsl_type(module, a.ty)));
        let result = function.result.as_ref().map_or(String::new(), |result| wgsl_type(module, result.ty));
        let wgsl = (arguments.collect(), result);
        if wgsl != rust {
            found.push(format!("{name}: WGSL {wgsl:?}, Rust {rust:?}"));
        }
    }
    let entries = exceptions.wgsl_only.iter().map(|entry| entry.0.to_owned());
    let entries = entries.chain(exceptions.renamed.iter().map(|entry| entry.0.to_owned()));
    let entries = entries.chain(exceptions.types.iter().map(|entry| entry.0.to_owned()));
    let entries = entries.chain(exceptions.split.iter().map(|entry| format!("{}({})", entry.0, entry.1)));
    let entries = entries.chain(exceptions.types_of.iter().map(|entry| format!("{}: {}", entry.0, entry.1)));
    found.extend(entries.filter(|entry| !used.contains(entry)).map(|entry| format!("{entry}: needless exception")));
    found
}

fn wgsl_type(module: &Module, handle: Handle<Type>) -> String {
    let scalar = |scalar: naga::Scalar| match scalar.kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        _ => "bool",
    };
    let kind = &module.types[handle];
    match kind.inner {
        TypeInner::Scalar(of) => scalar(of).to_owned(),
        TypeInner::Vector { size, scalar: of } => format!("vec{}<{}>", size as u8, scalar(of)),
        TypeInner::Image { .. } => "texture".to_owned(),
        TypeInner::Sampler { .. } => "sampler".to_owned(),
        _ => kind.name.clone().unwrap_or_default(),
    }
}

/// The signature of a public Rust function in terms of WGSL types.
fn rust_signature(
    source: &str,
    wgsl_name: &str,
    name: &str,
    exceptions: &Exceptions,
    used: &mut BTreeSet<String>,
) -> Option<Signature> {
    let file = syn::parse_file(source).expect("the source is Rust");
    let function = file.items.into_iter().find_map(|item| match item {
        Item::Fn(function) if function.sig.ident == name && matches!(function.vis, syn::Visibility::Public(_)) => {
            Some(function.sig)
        }
        _ => None,
    })?;
    let mut parameters = Vec::new();
    for input in &function.inputs {
        let FnArg::Typed(input) = input else { return None };
        let Pat::Ident(pattern) = &*input.pat else { return None };
        let parameter = pattern.ident.to_string();
        match exceptions.split.iter().find(|entry| (entry.0, entry.1) == (wgsl_name, parameter.as_str())) {
            Some(&(_, _, parts, _)) => {
                used.insert(format!("{wgsl_name}({parameter})"));
                parameters.extend(parts.iter().map(|&(name, kind)| (name.to_owned(), kind.to_owned())));
            }
            None => parameters.push((parameter, as_wgsl(&input.ty, wgsl_name, exceptions, used))),
        }
    }
    let result = match &function.output {
        ReturnType::Default => String::new(),
        ReturnType::Type(_, kind) => as_wgsl(kind, wgsl_name, exceptions, used),
    };
    Some((parameters, result))
}

fn as_wgsl(kind: &syn::Type, function: &str, exceptions: &Exceptions, used: &mut BTreeSet<String>) -> String {
    let name = match kind {
        syn::Type::Reference(reference) => return as_wgsl(&reference.elem, function, exceptions, used),
        syn::Type::Path(path) => path.path.segments.last().map_or(String::new(), |segment| segment.ident.to_string()),
        syn::Type::Tuple(tuple) => format!("tuple of {}", tuple.elems.len()),
        _ => "unknown type".to_owned(),
    };
    if let Some(entry) = exceptions.types_of.iter().find(|entry| (entry.0, entry.1) == (function, name.as_str())) {
        used.insert(format!("{function}: {name}"));
        return entry.2.to_owned();
    }
    if let Some(entry) = exceptions.types.iter().find(|entry| entry.0 == name) {
        used.insert(name);
        return entry.1.to_owned();
    }
    match name.as_str() {
        "f32" | "f64" => "f32",
        "bool" => "u32",
        "Vec2" | "DVec2" => "vec2<f32>",
        "Vec3" | "DVec3" => "vec3<f32>",
        "Vec4" | "DVec4" => "vec4<f32>",
        "UVec2" => "vec2<u32>",
        other => other,
    }
    .to_owned()
}
