//! A test case: files and the expected result.

use npr_mesh::edges::{self, EdgeOptions};
use npr_mesh::{LoadError, LoadOptions, Loaded, Model, load};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub struct Case {
    /// The name of the case and of its folder.
    pub name: String,
    /// Files by path relative to the folder; the first is the model.
    pub files: Vec<(String, Vec<u8>)>,
    /// Symbolic links as path and target.
    pub links: Vec<(String, String)>,
    /// The path of a named pipe.
    pub pipe: Option<String>,
    /// `asset_root` is relative to the case's folder.
    pub options: LoadOptions,
    pub expect: Expect,
}

pub enum Expect {
    /// The number of faces, and exactly as many warnings as parts, each of which contains one of these parts. The
    /// warning about missing normals is ignored.
    Loads(usize, Vec<String>),
    /// An error whose message contains all of these parts.
    Fails(Vec<String>),
}

pub fn loads(faces: usize, warnings: &[&str]) -> Expect {
    Expect::Loads(faces, warnings.iter().map(|w| (*w).to_owned()).collect())
}

pub fn fails(parts: &[&str]) -> Expect {
    Expect::Fails(parts.iter().map(|part| (*part).to_owned()).collect())
}

impl Case {
    pub fn new(name: &str, file: &str, bytes: impl Into<Vec<u8>>, expect: Expect) -> Self {
        Self {
            name: name.to_owned(),
            files: vec![(file.to_owned(), bytes.into())],
            links: Vec::new(),
            pipe: None,
            options: LoadOptions::default(),
            expect,
        }
    }

    pub fn with(mut self, file: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.push((file.to_owned(), bytes.into()));
        self
    }

    pub fn link(mut self, path: &str, target: &str) -> Self {
        self.links.push((path.to_owned(), target.to_owned()));
        self
    }

    pub fn asset_root(mut self, folder: &str) -> Self {
        self.options.asset_root = Some(PathBuf::from(folder));
        self
    }

    /// Writes the files into a folder of the case's name, and returns the path of the model.
    pub fn write(&self, into: &Path) -> PathBuf {
        let folder = into.join(&self.name);
        for (name, bytes) in &self.files {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().expect("in a folder")).expect("a folder");
            fs::write(path, bytes).expect("written");
        }
        #[cfg(unix)]
        for (name, target) in &self.links {
            let path = folder.join(name);
            let _ = fs::remove_file(&path);
            std::os::unix::fs::symlink(target, path).expect("a link");
        }
        #[cfg(unix)]
        if let Some(pipe) = &self.pipe {
            let _ = fs::remove_file(folder.join(pipe));
            let made = std::process::Command::new("mkfifo").arg(folder.join(pipe)).status();
            assert!(made.is_ok_and(|status| status.success()), "mkfifo");
        }
        folder.join(&self.files[0].0)
    }

    /// Whether this operating system supports the files.
    pub fn is_possible(&self) -> bool {
        cfg!(unix) || (self.links.is_empty() && self.pipe.is_none())
    }

    /// Loads the model, and returns the difference from the expectation.
    pub fn run(&self, folder: &Path) -> (Duration, Result<(), String>) {
        let model = self.write(folder);
        let mut options = self.options.clone();
        options.asset_root = options.asset_root.map(|root| folder.join(&self.name).join(root));
        let start = Instant::now();
        let result = load(&model, &options);
        // Followed by an edge search, as in any use.
        let outcome = self.compare(result);
        (start.elapsed(), outcome)
    }

    fn compare(&self, result: Result<Loaded, LoadError>) -> Result<(), String> {
        match (result, &self.expect) {
            (Ok(loaded), Expect::Loads(faces, warnings)) => {
                let lines: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
                let found = sound(loaded)?.faces.len();
                if found != *faces {
                    return Err(format!("{found} faces, expected {faces}"));
                }
                let told: Vec<&String> = lines.iter().filter(|w| !w.starts_with("no normals: ")).collect();
                let expected = |w: &&&String| warnings.iter().any(|part| w.contains(part));
                let missing: Vec<_> = warnings.iter().filter(|part| !told.iter().any(|w| w.contains(*part))).collect();
                let more: Vec<_> = told.iter().filter(|w| !expected(w)).collect();
                if !missing.is_empty() || !more.is_empty() {
                    return Err(format!("warnings {told:?}: missing {missing:?}, not expected {more:?}"));
                }
                if let Some(long) = told.iter().find(|w| w.len() > 600 || w.chars().any(char::is_control)) {
                    return Err(format!("a warning of {} bytes or with control characters", long.len()));
                }
                Ok(())
            }
            (Err(error), Expect::Fails(parts)) => {
                let message = error.to_string();
                let missing: Vec<_> = parts.iter().filter(|part| !message.contains(*part)).collect();
                if !missing.is_empty() {
                    return Err(format!("{message:?} without {missing:?}"));
                }
                if !message.contains(&self.name) || message.lines().count() != 1 || message.len() > 1000 {
                    return Err(format!("{message:?} is not one short line that names the file's folder"));
                }
                Ok(())
            }
            (Ok(loaded), Expect::Fails(parts)) => {
                Err(format!("{} objects, expected an error with {parts:?}", loaded.objects.len()))
            }
            (Err(error), Expect::Loads(faces, _)) => Err(format!("{error}, expected {faces} faces")),
        }
    }
}

fn check(holds: bool, what: &str) -> Result<(), String> {
    if holds { Ok(()) } else { Err(what.to_owned()) }
}

/// Checks all guarantees for a loaded file, and returns it as one model.
pub fn sound(loaded: Loaded) -> Result<Model, String> {
    check(!loaded.objects.is_empty(), "no objects")?;
    check(loaded.objects.iter().all(|o| o.mesh < loaded.meshes.len()), "a mesh is out of range")?;
    check(loaded.objects.iter().all(|o| o.world_from_mesh.is_finite()), "a transform is not finite")?;
    for (number, mesh) in loaded.meshes.iter().enumerate() {
        check(!mesh.faces.is_empty() || !mesh.lines.is_empty(), "a mesh without faces and lines")?;
        check(loaded.objects.iter().any(|o| o.mesh == number), "a mesh without objects")?;
        sound_model(mesh)?;
    }
    let model = loaded.into_model();
    sound_model(&model)?;
    Ok(model)
}

fn sound_model(model: &Model) -> Result<(), String> {
    let vertices = model.positions.len();
    let fits = |length: usize, of: usize| length == 0 || length == of;
    check(model.faces.iter().flatten().all(|&v| (v as usize) < vertices), "a vertex is out of range")?;
    check(model.lines.iter().flatten().all(|&v| (v as usize) < vertices), "a line's vertex is out of range")?;
    check(model.positions.iter().all(|p| p.is_finite()), "a position is not finite")?;
    check(model.normals.len() == vertices, "normals")?;
    check(model.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "a normal is not unit")?;
    check(fits(model.uvs.len(), vertices) && model.uvs.iter().all(|uv| uv.is_finite()), "texture coordinates")?;
    let bright = model.colors.iter().all(|c| c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 1000.0);
    check(fits(model.colors.len(), vertices) && bright, "colours")?;
    let faces = model.faces.len();
    check(model.face_material.len() == faces, "materials of faces")?;
    check(fits(model.face_mesh.len(), faces) && fits(model.face_polygon.len(), faces), "meshes, polygons")?;
    check(model.face_material.iter().all(|&m| (m as usize) < model.materials.len()), "a material is out of range")?;
    check(model.face_polygon.is_sorted(), "polygons do not ascend")?;
    check(model.lines.iter().flatten().all(|&v| (v as usize) < vertices), "a line's vertex is out of range")?;
    check(fits(model.side_visibility.len(), faces), "sides of faces")?;
    for material in &model.materials {
        let color = material.base_color;
        check(color.min_element() >= 0.0 && color.max_element() <= 1.0, "a material's colour")?;
        let emits = material.emissive;
        check(emits.is_finite() && emits.min_element() >= 0.0, "a material's emission is not within its range")?;
        let mut textures = [material.texture, material.emissive_texture].into_iter().flatten();
        check(textures.all(|t| (t as usize) < model.textures.len()), "a texture is out of range")?;
    }
    let texels = |t: &npr_mesh::Texture| t.rgba8.len() == t.width as usize * t.height as usize * 4;
    check(model.textures.iter().all(texels), "texels")?;
    let options = EdgeOptions::default();
    let found = edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &options);
    check(found.face_normals.iter().all(|n| n.is_finite()), "a face's normal is not finite")?;
    check(found.edges.iter().all(|e| e.faces()[0] as usize <= faces), "edges")
}
