//! Tests that the files of the workspace have no cyclic dependencies.
//!
//! A file depends on the file that defines an item which it names in a `use` or by a path from `crate`, `self`, `super`
//! or one of its own modules. Exceptions are a parent's `mod` lines, its `pub use` of its children, which are resolved
//! to the child, and code under `cfg(test)`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

/// The path of a module from the crate's root.
type Module = Vec<String>;

/// The declarations of a file.
#[derive(Default)]
struct Source {
    /// Its child modules in other files.
    children: BTreeSet<String>,
    /// The re-exports from its children, by exported name; `*` for all names of a child.
    re_exports: Vec<(String, Vec<String>)>,
    /// Paths to other files, as written.
    paths: Vec<Vec<String>>,
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let syn::Meta::List(list) = &attribute.meta else { return false };
        list.path.is_ident("cfg") && list.tokens.to_string() == "test"
    })
}

/// All paths of a `use` tree, each with the name that it introduces.
fn flatten(tree: &syn::UseTree, before: &[String], found: &mut Vec<(String, Vec<String>)>) {
    let with = |name: &syn::Ident| [before, &[name.to_string()]].concat();
    match tree {
        syn::UseTree::Path(path) => flatten(&path.tree, &with(&path.ident), found),
        syn::UseTree::Name(name) if name.ident == "self" => {
            found.push((before.last().cloned().unwrap_or_default(), before.to_vec()));
        }
        syn::UseTree::Name(name) => found.push((name.ident.to_string(), with(&name.ident))),
        syn::UseTree::Rename(rename) => found.push((rename.rename.to_string(), with(&rename.ident))),
        syn::UseTree::Glob(_) => found.push(("*".into(), before.to_vec())),
        syn::UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, before, found)),
    }
}

impl<'ast> Visit<'ast> for Source {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            syn::Item::Use(item) => &item.attrs,
            _ => &Vec::new(),
        };
        if is_test(attributes) {
            return;
        }
        match item {
            syn::Item::Mod(item) if item.content.is_none() => {
                self.children.insert(item.ident.to_string());
            }
            syn::Item::Use(item) => {
                let mut found = Vec::new();
                flatten(&item.tree, &[], &mut found);
                for (name, path) in found {
                    let own = path.first().is_some_and(|first| self.children.contains(first));
                    if own && !matches!(item.vis, syn::Visibility::Inherited) {
                        self.re_exports.push((name, path));
                    } else {
                        self.paths.push(path);
                    }
                }
            }
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if path.leading_colon.is_none() && names.len() > 1 {
            self.paths.push(names);
        }
        visit::visit_path(self, path);
    }
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            rust_files(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
}

/// The module of a file below the folder of a crate's root.
fn module_of(root: &Path, file: &Path) -> Module {
    let mut names: Module = file
        .strip_prefix(root)
        .expect("it is below")
        .with_extension("")
        .iter()
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    if names.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        names.pop();
    }
    names
}

/// The module whose file defines the item that a path in a module names, if it is one of these files.
fn target(sources: &BTreeMap<Module, Source>, of: &Module, path: &[String], depth: usize) -> Option<Module> {
    let mut at = match path.first()?.as_str() {
        "crate" => Module::new(),
        "self" => of.clone(),
        "super" => of[..of.len().checked_sub(1)?].to_vec(),
        child if sources[of].children.contains(child) => [of.clone(), vec![child.to_owned()]].concat(),
        _ => return None,
    };
    let mut rest = &path[1..];
    while let Some(first) = rest.first() {
        let next = [at.clone(), vec![first.clone()]].concat();
        if first == "super" {
            at.pop()?;
        } else if sources.contains_key(&next) {
            at = next;
        } else {
            break;
        }
        rest = &rest[1..];
    }
    let source = sources.get(&at)?;
    if let (Some(name), true) = (rest.first(), depth < 8) {
        let of_name = source.re_exports.iter().find(|(known, _)| known == name);
        if let Some((_, handed_on)) = of_name {
            return target(sources, &at, handed_on, depth + 1);
        }
    }
    Some(at)
}

/// For each module: its dependencies.
fn dependencies(sources: &BTreeMap<Module, Source>) -> BTreeMap<Module, BTreeSet<Module>> {
    let of = |(module, source): (&Module, &Source)| {
        let targets = source.paths.iter().filter_map(|path| target(sources, module, path, 0));
        (module.clone(), targets.filter(|target| target != module).collect())
    };
    sources.iter().map(of).collect()
}

/// The dependency cycles, one per set of modules.
fn circles(dependencies: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<Module>> {
    let mut found: BTreeMap<BTreeSet<Module>, Vec<Module>> = BTreeMap::new();
    'starts: for start in dependencies.keys() {
        let mut before: BTreeMap<&Module, &Module> = BTreeMap::new();
        let mut next = vec![start];
        while let Some(module) = next.pop() {
            for target in &dependencies[module] {
                if target == start {
                    let mut way = vec![start.clone(), module.clone()];
                    let mut at = module;
                    while let Some(from) = before.get(at) {
                        way.push((*from).clone());
                        at = from;
                    }
                    way.reverse();
                    found.entry(way.iter().cloned().collect()).or_insert(way);
                    continue 'starts;
                }
                if !before.contains_key(target) {
                    before.insert(target, module);
                    next.push(target);
                }
            }
        }
    }
    found.into_values().collect()
}

fn read(text: &str) -> Source {
    let file = syn::parse_file(text).expect("it compiles");
    let mut source = Source::default();
    // Children first, because a `use` may refer to them.
    for item in &file.items {
        if let syn::Item::Mod(item) = item
            && item.content.is_none()
            && !is_test(&item.attrs)
        {
            source.children.insert(item.ident.to_string());
        }
    }
    source.visit_file(&file);
    source
}

#[test]
fn no_file_depends_on_itself_by_way_of_others() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    let crates = ["npr-mesh", "npr-outline", "npr-toon", "npr-gooch", "npr-hatch", "npr-imagespace", "npr-harness"];
    let (mut all, mut count) = (Vec::new(), 0);
    for name in crates {
        let library = workspace.join(name).join("src");
        for root in [library.clone(), library.join("bin/npr")] {
            let mut files = Vec::new();
            if root.is_dir() {
                rust_files(&root, &mut files);
            }
            let others = library.join("bin");
            files.retain(|file| root != library || !file.starts_with(&others));
            files.retain(|file| file.file_name().is_none_or(|name| name != "tests.rs"));
            let sources: BTreeMap<Module, Source> = files
                .iter()
                .map(|file| (module_of(&root, file), read(&fs::read_to_string(file).expect("text"))))
                .collect();
            count += sources.len();
            all.extend(circles(&dependencies(&sources)).iter().map(|way| {
                let names: Vec<String> = way.iter().map(|module| module.join("::")).collect();
                format!("{name}: {}", names.join(" -> "))
            }));
        }
    }
    assert!(count > 150, "{count} files");
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn a_circle_is_found_by_use_by_path_and_through_a_parent() {
    let module = |name: &str| if name.is_empty() { vec![] } else { name.split("::").map(str::to_owned).collect() };
    let circle_of = |files: &[(&str, &str)]| {
        let sources = files.iter().map(|(name, text)| (module(name), read(text))).collect();
        !circles(&dependencies(&sources)).is_empty()
    };
    let root = ("", "pub mod a;\npub mod b;\npub use a::A;");
    assert!(!circle_of(&[root, ("a", "pub struct A;"), ("b", "use crate::a::A;")]));
    assert!(!circle_of(&[root, ("a", "pub struct A;"), ("b", "use crate::A;")]));
    assert!(circle_of(&[root, ("a", "use crate::b::B;"), ("b", "use crate::a::A;")]));
    assert!(circle_of(&[root, ("a", "fn f() { crate::b::g() }"), ("b", "use super::A;")]));
    assert!(circle_of(&[("", "mod a;\nuse a::A;\nstruct B;"), ("a", "use super::B;")]));
    // References in tests do not count.
    assert!(!circle_of(&[root, ("a", "#[cfg(test)]\nmod tests { use crate::b::B; }"), ("b", "use crate::a::A;")]));
}
