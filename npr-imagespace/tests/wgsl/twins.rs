//! Compares the signatures of functions that are written in WGSL and in Rust: the same name, in files of the same stem,
//! with the same parameters in the same order and of corresponding types.
//!
//! Types correspond as follows, whatever the names of the parameters:
//!
//! - f32 and f64 to f32; u8, u16, u32 and enumerations to u32; i32, bool, vectors and matrices to their own;
//! - references to what they refer to; `Option` to what is in it, since WGSL has none;
//! - arrays of numbers to vectors; of bytes to vectors of u32, i32, or of f32 as a texture of unsigned normalised bytes
//!   yields them;
//! - other arrays to one parameter an element, named with its index: `taps: [Vec3; 4]` to `tap0`, `tap1`, `tap2`,
//!   `tap3`; two vectors of two numbers also to one of four;
//! - tuples to vectors of as many numbers;
//! - structs by the tables in [`Twins`].

use naga::{ArraySize, Module, ScalarKind, Type, TypeInner, VectorSize};
use std::fmt::Write;

/// A parameter's name and its type as WGSL writes it. The name of a result is empty.
type Parameter = (String, String);

/// What of two signatures may differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(dead_code, reason = "no crate has an exception of each kind")]
pub enum Except {
    /// There is no Rust function.
    Missing,
    /// The types; names and order are compared.
    Types,
    /// The result's type.
    Result,
    /// The parameters.
    Parameters,
}

/// How the types of a crate correspond, and which functions differ.
pub struct Twins<'a> {
    /// Rust types that are one type of the WGSL.
    pub types: &'a [(&'a str, &'a str)],
    /// Rust structs that WGSL functions take member by member: names and types.
    pub members: &'a [(&'a str, &'a [(&'a str, &'a str)])],
    /// Functions that differ: the name, what differs, and why.
    pub exceptions: &'a [(&'a str, Except, &'a str)],
}

/// A function's parameters and its result.
struct Signature {
    parameters: Vec<Parameter>,
    result: String,
}

impl Twins<'_> {
    /// How the functions of a WGSL file differ from those of its Rust file, a line each. `library` is the file with all
    /// that it needs.
    pub fn differences(&self, library: &Module, wgsl: &str, rust: &str) -> Vec<String> {
        let rust = syn::parse_file(rust).expect("the file compiles");
        let mut differences = Vec::new();
        for (_, function) in library.functions.iter() {
            let name = function.name.as_deref().expect("functions have names");
            if !wgsl.contains(&format!("fn {name}(")) {
                continue;
            }
            let excepted =
                self.exceptions.iter().find(|(excepted, ..)| *excepted == name).map(|(_, except, _)| *except);
            let twin = rust.items.iter().find_map(|item| match item {
                syn::Item::Fn(function) if function.sig.ident == name => Some(&function.sig),
                _ => None,
            });
            let Some(twin) = twin else {
                if excepted != Some(Except::Missing) {
                    differences.push(format!("{name}: no Rust function in the file of the same stem"));
                }
                continue;
            };
            let found = signature(library, function);
            let differs = |except| match except {
                None => !self.corresponds(twin, &found, true, true, true),
                Some(Except::Types) => !self.corresponds(twin, &found, true, false, false),
                Some(Except::Result) => !self.corresponds(twin, &found, true, true, false),
                Some(Except::Parameters) => !self.corresponds(twin, &found, false, false, true),
                Some(Except::Missing) => true,
            };
            if differs(excepted) {
                let mut difference = format!("{name}: WGSL has");
                for (name, ty) in &found.parameters {
                    write!(difference, " {name}: {ty},").expect("a string takes all");
                }
                write!(difference, " -> {}; Rust has", found.result).expect("a string takes all");
                for (name, forms) in parameters(twin).map(|(name, ty)| (name.clone(), self.forms(&name, ty))) {
                    write!(difference, " {name} as {forms:?},").expect("a string takes all");
                }
                differences.push(format!("{difference} -> {:?}", self.result(twin)));
            } else if excepted.is_some() && !differs(None) {
                differences.push(format!("{name}: an exception that none is needed for"));
            }
        }
        differences
    }

    fn corresponds(&self, twin: &syn::Signature, found: &Signature, named: bool, typed: bool, result: bool) -> bool {
        let forms: Vec<_> = parameters(twin).map(|(name, ty)| self.forms(&name, ty)).collect();
        (!named || matches(&forms, &found.parameters, typed))
            && (!result || self.result(twin).iter().any(|form| *form == [(String::new(), found.result.clone())]))
    }

    fn result(&self, twin: &syn::Signature) -> Vec<Vec<Parameter>> {
        match &twin.output {
            syn::ReturnType::Type(_, ty) => self.forms("", ty),
            syn::ReturnType::Default => vec![vec![(String::new(), "nothing".to_owned())]],
        }
    }

    /// The parameters that a Rust parameter may be in WGSL; empty for a type that has no form there.
    fn forms(&self, name: &str, ty: &syn::Type) -> Vec<Vec<Parameter>> {
        let one = |ty: &str| vec![vec![(name.to_owned(), ty.to_owned())]];
        match ty {
            syn::Type::Reference(reference) => self.forms(name, &reference.elem),
            syn::Type::Path(path) => {
                let last = path.path.segments.last().expect("a path has a segment");
                if let syn::PathArguments::AngleBracketed(arguments) = &last.arguments
                    && last.ident == "Option"
                    && let Some(syn::GenericArgument::Type(inner)) = arguments.args.first()
                {
                    return self.forms(name, inner);
                }
                let ident = last.ident.to_string();
                if let Some(wgsl) = known(&ident) {
                    return one(wgsl);
                }
                let mut forms = Vec::new();
                if let Some((_, wgsl)) = self.types.iter().find(|(rust, _)| *rust == ident) {
                    forms.extend(one(wgsl));
                }
                if let Some((_, members)) = self.members.iter().find(|(rust, _)| *rust == ident) {
                    forms.push(members.iter().map(|(name, ty)| ((*name).to_owned(), (*ty).to_owned())).collect());
                }
                forms
            }
            syn::Type::Array(array) => {
                let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(len), .. }) = &array.len else {
                    return Vec::new();
                };
                let len: usize = len.base10_parse().expect("a length");
                if last_ident(&array.elem).as_deref() == Some("u8") {
                    return ["f32", "i32", "u32"]
                        .iter()
                        .flat_map(|scalar| one(&format!("vec{len}<{scalar}>")))
                        .collect();
                }
                let mut forms = Vec::new();
                for element in self.forms("", &array.elem) {
                    let [(_, element)] = &element[..] else { continue };
                    if ["f32", "u32", "i32", "bool"].contains(&element.as_str()) {
                        forms.extend(one(&format!("vec{len}<{element}>")));
                        continue;
                    }
                    let singular = name.strip_suffix('s').unwrap_or(name);
                    forms.push((0..len).map(|i| (format!("{singular}{i}"), element.clone())).collect());
                    if (len, element.as_str()) == (2, "vec2<f32>") {
                        // `ends_px: [DVec2; 2]`.
                        forms.extend(one("vec4<f32>"));
                    }
                }
                forms
            }
            syn::Type::Tuple(tuple) => {
                let mut scalars = Vec::new();
                for element in &tuple.elems {
                    let forms = self.forms("", element);
                    let Some((_, ty)) = forms.first().and_then(|form| form.first()) else { return Vec::new() };
                    match ty.strip_prefix("vec").and_then(|rest| rest.split_once('<')) {
                        Some((len, scalar)) => {
                            let len = len.parse().expect("2 to 4");
                            scalars.extend(std::iter::repeat_n(scalar.trim_end_matches('>').to_owned(), len));
                        }
                        None => scalars.push(ty.clone()),
                    }
                }
                let alike = scalars.windows(2).all(|pair| pair[0] == pair[1]);
                if alike { one(&format!("vec{}<{}>", scalars.len(), scalars[0])) } else { Vec::new() }
            }
            _ => Vec::new(),
        }
    }
}

/// The WGSL type of a Rust one, where that is the same for every crate.
fn known(rust: &str) -> Option<&'static str> {
    Some(match rust {
        "f32" | "f64" => "f32",
        "u8" | "u16" | "u32" => "u32",
        "i32" => "i32",
        "bool" => "bool",
        "Vec2" | "DVec2" => "vec2<f32>",
        "Vec3" | "DVec3" => "vec3<f32>",
        "Vec4" | "DVec4" => "vec4<f32>",
        "UVec2" => "vec2<u32>",
        "IVec2" => "vec2<i32>",
        "IVec4" => "vec4<i32>",
        "IVec3" => "vec3<i32>",
        "Mat4" | "DMat4" => "mat4x4<f32>",
        _ => return None,
    })
}

fn last_ident(ty: &syn::Type) -> Option<String> {
    match ty {
        syn::Type::Path(path) => Some(path.path.segments.last()?.ident.to_string()),
        _ => None,
    }
}

/// Whether some choice of a form for each Rust parameter is what WGSL has.
fn matches(forms: &[Vec<Vec<Parameter>>], found: &[Parameter], typed: bool) -> bool {
    let Some((first, rest)) = forms.split_first() else { return found.is_empty() };
    first.iter().any(|form| {
        let (Some(head), Some(tail)) = (found.get(..form.len()), found.get(form.len()..)) else { return false };
        let alike = form.iter().zip(head).all(|(form, found)| form.0 == found.0 && (!typed || form.1 == found.1));
        alike && matches(rest, tail, typed)
    })
}

fn parameters(signature: &syn::Signature) -> impl Iterator<Item = (String, &syn::Type)> {
    signature.inputs.iter().map(|input| match input {
        syn::FnArg::Typed(typed) => match &*typed.pat {
            syn::Pat::Ident(ident) => (ident.ident.to_string(), &*typed.ty),
            // A pattern has no name to compare.
            _ => (String::new(), &*typed.ty),
        },
        _ => panic!("{} is no free function", signature.ident),
    })
}

fn signature(module: &Module, function: &naga::Function) -> Signature {
    let name_of = |ty| type_name(module, &module.types[ty]);
    let parameters = function
        .arguments
        .iter()
        .map(|argument| (argument.name.clone().expect("arguments have names"), name_of(argument.ty)))
        .collect();
    let result = function.result.as_ref().map_or("nothing".to_owned(), |result| name_of(result.ty));
    Signature { parameters, result }
}

fn type_name(module: &Module, ty: &Type) -> String {
    let scalar = |kind| match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        ScalarKind::Bool => "bool",
        _ => panic!("a scalar that no function takes"),
    };
    let len = |size: VectorSize| size as u8;
    match &ty.inner {
        TypeInner::Scalar(found) => scalar(found.kind).to_owned(),
        TypeInner::Vector { size, scalar: found } => format!("vec{}<{}>", len(*size), scalar(found.kind)),
        TypeInner::Matrix { columns, rows, scalar: found } => {
            format!("mat{}x{}<{}>", len(*columns), len(*rows), scalar(found.kind))
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            format!("array<{}, {count}>", type_name(module, &module.types[*base]))
        }
        _ => ty.name.clone().expect("structs have names"),
    }
}
