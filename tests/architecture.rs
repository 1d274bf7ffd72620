//! Architecture: which crate knows which others, and no two files that need each other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::Visit;
use syn::{ItemMod, ItemUse, UseTree};

/// Crates of the workspace and those of its own that each may use: arrows point one way.
const CRATES: [(&str, &[&str]); 11] = [
    ("crates/numerics", &[]),
    ("crates/wheel", &["numerics"]),
    ("crates/solid", &[]),
    ("crates/mesh", &["solid"]),
    ("crates/model", &["mesh", "numerics", "solid", "wheel"]),
    ("crates/analysis", &["numerics", "solid", "wheel"]),
    ("crates/fit", &["model", "numerics", "wheel"]),
    ("crates/plot", &["analysis", "wheel"]),
    ("crates/script", &[]),
    ("crates/validation", &["analysis", "mesh", "model", "numerics", "solid", "wheel"]),
    (
        ".",
        &["analysis", "fit", "mesh", "model", "numerics", "plot", "script", "solid", "validation", "wheel"],
    ),
];

/// Crates that nothing below the service knows: HTTP, SQL, async, dates.
const OF_THE_SERVICE: [&str; 8] = ["axum", "hyper", "sqlx", "apalis", "tokio", "tower", "chrono", "reqwest"];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut waiting = vec![folder.to_owned()];
    let mut found = Vec::new();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Path of a module from the root of its crate.
type Module = Vec<String>;

/// Folder of a module with two implementations, one of which a feature chooses.
const SEAM: &str = "cluster";

/// Names of the implementations of a [`SEAM`], which are not part of the paths of their modules.
const SIDES: [&str; 2] = ["alone", "shared"];

/// Module of a file under `folder`.
fn module_of(folder: &Path, file: &Path) -> Module {
    let path = file.strip_prefix(folder).unwrap().with_extension("");
    let mut module: Module = path.iter().map(|part| part.to_str().unwrap().to_owned()).collect();
    // The program is a file of its own beside the library.
    if module.last().is_some_and(|last| ["mod", "lib"].contains(&last.as_str())) {
        module.pop();
    }
    let side = module.iter().position(|part| part == SEAM).map(|seam| seam + 1);
    if let Some(side) =
        side.filter(|&side| module.get(side).is_some_and(|part| SIDES.contains(&part.as_str())))
    {
        module.remove(side);
    }
    module
}

/// Mark, in a path in the definition of a macro, for the part that a variable stands for.
const ANY: &str = "$";

/// Paths that a file names, from the root of its crate where they begin with `crate`, `self` or `super`.
struct Named {
    /// Module that is being read: the file's, or one inside it.
    module: Module,
    /// Names that a `use` imports, with their paths.
    imported: BTreeMap<String, Module>,
    found: BTreeSet<Module>,
}

impl Named {
    /// Notes a path; returns it from the root of the crate.
    fn name(&mut self, path: Vec<String>) -> Module {
        let mut module = self.module.clone();
        let mut parts = path.into_iter().peekable();
        match parts.peek().map(String::as_str) {
            Some("crate") => {
                parts.next();
                module.clear();
            }
            Some("self") => {
                parts.next();
            }
            Some("super") => {
                while parts.next_if(|part| part == "super").is_some() {
                    module.pop();
                }
            }
            // The first part is an import, a module that this file declares, or another crate.
            Some(first) => {
                if let Some(imported) = self.imported.get(first) {
                    module.clone_from(imported);
                    parts.next();
                }
            }
            None => {}
        }
        module.extend(parts);
        self.found.insert(module.clone());
        module
    }

    fn tree(&mut self, before: &mut Vec<String>, tree: &UseTree) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.tree(before, &path.tree);
                before.pop();
            }
            UseTree::Group(group) => group.items.iter().for_each(|item| self.tree(before, item)),
            UseTree::Name(name) => self.leaf(before, &name.ident, &name.ident),
            UseTree::Rename(rename) => self.leaf(before, &rename.ident, &rename.rename),
            UseTree::Glob(_) => {
                self.name(before.clone());
            }
        }
    }

    fn leaf(&mut self, before: &[String], name: &syn::Ident, alias: &syn::Ident) {
        let mut path = before.to_vec();
        if name != "self" {
            path.push(name.to_string());
        }
        let alias = if alias == "self" { path.last().cloned() } else { Some(alias.to_string()) };
        let ours = path.first().is_some_and(|first| ["crate", "self", "super"].contains(&first.as_str()));
        let path = self.name(path);
        if let (true, Some(alias)) = (ours, alias) {
            self.imported.insert(alias, path);
        }
    }
}

impl<'ast> Visit<'ast> for Named {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.tree(&mut Vec::new(), &item.tree);
    }

    fn visit_item_mod(&mut self, item: &'ast ItemMod) {
        // Tests may look at anything.
        if item.ident == "tests" && item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg")) {
            return;
        }
        self.module.push(item.ident.to_string());
        syn::visit::visit_item_mod(self, item);
        self.module.pop();
    }

    /// Skips a visibility: it says who may see an item, not what the item needs.
    fn visit_vis_restricted(&mut self, _: &'ast syn::VisRestricted) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if parts.len() > 1 {
            self.name(parts);
        }
        syn::visit::visit_path(self, path);
    }

    /// Reads the arguments of macros, which are tokens: paths that begin at the root or above are seen.
    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        // A variable is two tokens, the first of which sticks to colons before it.
        let tokens = call.tokens.to_string().replace("::$ ", ":: $");
        let mut words = tokens.split_whitespace().peekable();
        while let Some(word) = words.next() {
            let first = word.trim_start_matches(|c: char| !c.is_alphanumeric() && c != '_');
            if ["crate", "super"].contains(&first) {
                let mut path = vec![first.to_owned()];
                while words.next_if_eq(&"::").is_some() {
                    let Some(part) = words.next() else { break };
                    let name = part.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap();
                    path.push(if part.starts_with(ANY) { ANY } else { name }.to_owned());
                }
                self.name(path);
            }
        }
        syn::visit::visit_macro(self, call);
    }
}

/// Paths for which one with a macro's variable may stand: the variable is replaced by every folder in its place.
fn meant(path: &Module, files: &BTreeMap<Module, PathBuf>) -> Vec<Module> {
    let Some(place) = path.iter().position(|part| part == ANY) else { return vec![path.clone()] };
    let is_meant = |(module, file): &(&Module, &PathBuf)| {
        module.len() == place + 1 && module[..place] == path[..place] && file.ends_with("mod.rs")
    };
    let folders = files.iter().filter(is_meant);
    folders.map(|(folder, _)| [folder, &path[place + 1..]].concat()).collect()
}

/// Modules of a crate that are files, with those that each needs.
fn arrows(folder: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    let all: Vec<(Module, PathBuf)> =
        rust_files(folder).into_iter().map(|file| (module_of(folder, &file), file)).collect();
    let files: BTreeMap<Module, PathBuf> = all.iter().cloned().collect();
    let mut arrows: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for (module, file) in &all {
        let syntax = syn::parse_file(&std::fs::read_to_string(file).unwrap()).unwrap();
        let (imported, found) = (BTreeMap::new(), BTreeSet::new());
        let mut named = Named { module: module.clone(), imported, found };
        // Twice: a name may be used above its import.
        named.visit_file(&syntax);
        named.visit_file(&syntax);
        let needed = named.found.iter().flat_map(|path| meant(path, &files)).filter_map(|path| {
            let file = (0..=path.len()).rev().find(|&length| files.contains_key(&path[..length]));
            file.map(|length| path[..length].to_vec())
        });
        // Both implementations of a seam are one module, which needs what either needs.
        arrows.entry(module.clone()).or_default().extend(needed.filter(|needed| needed != module));
    }
    arrows
}

/// Modules that can be reached from `from`.
fn reached(arrows: &BTreeMap<Module, BTreeSet<Module>>, from: &Module) -> BTreeSet<Module> {
    let mut waiting = vec![from];
    let mut reached = BTreeSet::new();
    while let Some(module) = waiting.pop() {
        for next in &arrows[module] {
            if reached.insert(next.clone()) {
                waiting.push(next);
            }
        }
    }
    reached
}

#[test]
fn no_file_needs_itself_in_the_end() {
    for (name, _) in CRATES {
        let arrows = arrows(&root().join(name).join("src"));
        let circular: Vec<String> = arrows
            .keys()
            .filter(|module| reached(&arrows, module).contains(*module))
            .map(|module| module.join("::"))
            .collect();
        assert_eq!(circular, [""; 0], "{name}");
    }
}

#[test]
fn a_circle_is_found_however_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let circular = || {
        let arrows = arrows(folder.path());
        arrows.keys().filter(|module| reached(&arrows, module).contains(*module)).count()
    };
    write("lib.rs", "mod a; mod b; mod c;");
    write("c.rs", "pub fn three() {}");
    write("b.rs", "use crate::c::three; pub fn two() { three() }");
    for need in [
        "use crate::{b::two as dos, c};",
        "pub use super::b::*;",
        "pub fn one() { crate::b::two() }",
        "mod inside { use super::super::b::two; }",
        "use crate::{self as all, c}; pub fn one() { all::b::two() }",
        "pub fn one() { println!(\"{:?}\", super::b::two()) }",
    ] {
        write("a.rs", need);
        assert_eq!(circular(), 0, "{need}");
        write("b.rs", "pub use crate::{c::three, a}; pub fn two() {}");
        assert_eq!(circular(), 2, "{need}");
        write("b.rs", "#[cfg(test)] mod tests { use crate::a; } pub(in crate::a) fn two() {}");
        assert_eq!(circular(), 0, "{need}");
    }
    std::fs::create_dir(folder.path().join("all")).unwrap();
    write("all/mod.rs", "pub mod one;");
    std::fs::create_dir(folder.path().join("all/one")).unwrap();
    write("a.rs", "macro_rules! table { ($($name:ident)*) => { [$(&crate::all::$name::ONE),*] }; }");
    write("all/one/mod.rs", "pub const ONE: u32 = 1;");
    assert_eq!(circular(), 0);
    write("all/one/mod.rs", "pub const ONE: u32 = crate::a::TWO;");
    assert_eq!(circular(), 2);
    // Either side of a seam is seen.
    std::fs::create_dir_all(folder.path().join("cluster/shared")).unwrap();
    write("a.rs", "use crate::cluster::queue::Queue;");
    write("cluster/shared/queue.rs", "pub struct Queue;");
    write("cluster/alone.rs", "pub mod queue { pub enum Queue {} }");
    assert_eq!(circular(), 0);
    write("cluster/shared/queue.rs", "pub struct Queue(crate::a::One);");
    assert_eq!(circular(), 2);
}

#[test]
fn crates_know_only_those_below_them() {
    for (name, below) in CRATES {
        let manifest = std::fs::read_to_string(root().join(name).join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("\n[dependencies]\n").nth(1).unwrap_or_default();
        let dependencies = dependencies.split("\n[").next().unwrap();
        let names = || dependencies.lines().filter_map(|line| line.split(['.', ' ', '=']).next());
        let ours: Vec<&str> = names().filter_map(|name| name.strip_prefix("rubmap-")).collect();
        assert_eq!(ours, below, "{name}");
        if name != "." {
            let service: Vec<&str> = names().filter(|name| OF_THE_SERVICE.contains(name)).collect();
            assert_eq!(service, [""; 0], "{name}");
        }
    }
}

/// Paths of the files under `folders` that contain one of `words`.
fn offenders(folders: &[&str], words: &[&str]) -> Vec<PathBuf> {
    let files = folders.iter().flat_map(|folder| {
        let path = root().join(folder);
        if path.is_dir() { rust_files(&path) } else { vec![path] }
    });
    files
        .filter(|file| {
            let text = std::fs::read_to_string(file).unwrap();
            words.iter().any(|word| text.contains(word))
        })
        .collect()
}

#[test]
fn physics_asks_neither_the_environment_nor_the_date() {
    let words = ["std::env::", "SystemTime", "async fn"];
    for (name, _) in CRATES.iter().filter(|(name, _)| *name != ".") {
        assert_eq!(offenders(&[&format!("{name}/src")], &words), [""; 0].map(PathBuf::from));
    }
}

#[test]
fn the_service_has_floors() {
    for (floor, later) in [
        ("src/store", &["crate::import", "crate::jobs", "crate::http", "crate::app", "crate::cli"][..]),
        (
            "src/memory.rs",
            &["crate::store", "crate::import", "crate::jobs", "crate::http", "crate::app", "crate::cli"],
        ),
        (
            "src/pool.rs",
            &["crate::store", "crate::import", "crate::jobs", "crate::http", "crate::app", "crate::cli"],
        ),
        ("src/import.rs", &["crate::jobs", "crate::http", "crate::app", "crate::cli"]),
        ("src/jobs", &["crate::http", "crate::app", "crate::cli"]),
        ("src/http", &["crate::app", "crate::cli"]),
    ] {
        assert_eq!(offenders(&[floor], later), [""; 0].map(PathBuf::from), "{floor}");
    }
}

#[test]
fn only_the_store_has_sql_and_only_http_has_status_codes() {
    let above =
        ["src/import.rs", "src/jobs", "src/http", "src/app.rs", "src/config.rs", "src/cli", "src/main.rs"];
    assert_eq!(offenders(&above, &["sqlx"]), [""; 0].map(PathBuf::from));
    let below = ["src/store", "src/import.rs", "src/jobs", "src/app.rs", "src/config.rs"];
    assert_eq!(offenders(&below, &["StatusCode"]), [""; 0].map(PathBuf::from));
}

#[test]
fn http_computes_nothing() {
    let verbs = ["prepare", "check", "run_speed", "modal_analysis", "critical_speeds", "plan"];
    let verbs = verbs.map(|verb| format!("run::{verb}"));
    assert_eq!(offenders(&["src/http"], &verbs.each_ref().map(String::as_str)), [""; 0].map(PathBuf::from));
}

/// First words that lean on what stands above a comment, or on the name of the thing: an editor shows one comment at a time.
const LEANING: [&str; 15] = [
    "What", "Of", "It", "Its", "Those", "That", "The same", "Who", "Whose", "They", "These", "Such", "So",
    "Them", "Likewise",
];

#[test]
fn doc_comments_begin_with_the_thing() {
    let folders = ["src", "crates", "tests", "benches", "fuzz"].map(|folder| root().join(folder));
    let mut leaning = Vec::new();
    for file in folders.iter().flat_map(|folder| rust_files(folder)) {
        let text = std::fs::read_to_string(&file).unwrap();
        let mut inside = false;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim_start();
            let comment = line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).map(str::trim_start);
            let begins = comment.filter(|_| !inside).unwrap_or_default();
            let ends_word = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '-');
            let leans = LEANING.iter().any(|words| begins.strip_prefix(words).is_some_and(ends_word));
            if leans {
                leaning.push(format!("{}:{}: {begins}", file.display(), number + 1));
            }
            // What follows a heading (`# Errors`) stands alone, too.
            inside = comment.is_some_and(|comment| !comment.starts_with("# "));
        }
    }
    assert!(leaning.is_empty(), "begin with a noun or verb of the thing:\n{}", leaning.join("\n"));
}
