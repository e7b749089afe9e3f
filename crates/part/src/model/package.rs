//! 3MF files as packages: a ZIP archive, the model file that it names, and the extensions that it requires.
//!
//! Nothing is unpacked to disk, and a path only names an entry of the archive. The unpacked size is bounded.

use super::ImportError;
use super::xml::{Element, Elements, Step};
use std::collections::BTreeMap;
use std::io::{BufReader, Cursor, Read};
use zip::ZipArchive;
use zip::read::ZipFile;

/// The namespace of the toolpath extension.
pub const TOOLPATH: &str = "http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03";
/// Its name in earlier drafts, which readers still accept.
pub const OLD_TOOLPATH: &str = "http://schemas.microsoft.com/3dmanufacturing/toolpath/2019/05";
/// The namespace of the production extension.
pub const PRODUCTION: &str = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// Most bytes that the files of an archive may unpack to.
const MOST_BYTES: u64 = 4 << 30;
/// They may also not unpack to more than this multiple of the archive's size, unless that is small: models unpack to 5
/// to 30 times their size.
const MOST_TIMES: u64 = 100;
/// Bytes that any archive may unpack to.
const SMALL_BYTES: u64 = 64 << 20;
/// Most entries of an archive.
const MOST_ENTRIES: usize = 100_000;
/// Path of the model if the archive does not state it.
const USUAL: &str = "3D/3dmodel.model";

/// A 3MF file that is being read.
pub struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Bytes that may be read from it in all.
    most: u64,
    /// Bytes that may still be read from it.
    left: u64,
}

/// The elements of a file in a package.
pub type PackageElements<'p, 'a> = Elements<BufReader<Counted<'p, ZipFile<'p, Cursor<&'a [u8]>>>>>;

/// Whether the bytes are those of a ZIP archive, as 3MF files are.
pub fn is_package(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

pub fn broken(reason: impl Into<String>) -> ImportError {
    ImportError::Broken { format: "3MF", reason: reason.into() }
}

/// A path in a 3MF file as the name of an archive entry.
pub fn entry_name(path: &str) -> String {
    path.trim_start_matches('/').to_owned()
}

impl<'a> Package<'a> {
    /// # Errors
    /// [`ImportError::Broken`] where the bytes are not an archive, or one with too many entries.
    pub fn open(bytes: &'a [u8]) -> Result<Self, ImportError> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken(error.to_string()))?;
        if archive.len() > MOST_ENTRIES {
            return Err(broken(format!("its archive has {} entries, at most {MOST_ENTRIES} are read", archive.len())));
        }
        let most = most_of(bytes.len());
        Ok(Self { archive, most, left: most })
    }

    /// The path of the model in the archive, as its relationships state it.
    ///
    /// # Errors
    /// [`ImportError::Broken`] where it is not there.
    pub fn main(&mut self) -> Result<String, ImportError> {
        let mut found = None;
        if let Ok(entry) = self.archive.by_name("_rels/.rels") {
            let mut elements = Elements::new(BufReader::new(entry.take(1 << 20)), "3MF");
            while let Some(step) = elements.step()? {
                let Step::Begin(element) = step else { continue };
                let is_model = element.attribute("Type").is_some_and(|kind| kind.ends_with("/3dmodel"));
                if element.name() == "Relationship" && is_model {
                    found = element.attribute("Target");
                }
            }
        }
        let path = found.map_or(USUAL.to_owned(), |path| entry_name(&path));
        if self.archive.by_name(&path).is_err() {
            return Err(broken(format!("this ZIP archive holds no model ({path} is not in it)")));
        }
        Ok(path)
    }

    /// The elements of the file at a path in the archive.
    ///
    /// # Errors
    /// [`ImportError::Broken`] where it is not there.
    pub fn elements(&mut self, path: &str) -> Result<PackageElements<'_, 'a>, ImportError> {
        let entry = self.archive.by_name(path).map_err(|error| broken(format!("{path}: {error}")))?;
        let limited = Counted { inner: entry, most: self.most, left: &mut self.left };
        Ok(Elements::new(BufReader::with_capacity(1 << 16, limited), "3MF"))
    }
}

/// The namespaces of the extensions that a model requires.
pub fn required_extensions(model: &Element) -> Vec<String> {
    let attributes = model.attributes().into_iter();
    let spaces: BTreeMap<String, String> =
        attributes.filter_map(|(key, value)| Some((key.strip_prefix("xmlns:")?.to_owned(), value))).collect();
    let required = model.attribute("requiredextensions").unwrap_or_default();
    required.split_whitespace().map(|prefix| spaces.get(prefix).map_or(prefix, String::as_str).to_owned()).collect()
}

/// Refuses a file that requires an unsupported extension.
///
/// # Errors
/// [`ImportError::Broken`] that names the extension.
pub fn check_extensions(model: &Element, known: &[&str]) -> Result<(), ImportError> {
    match required_extensions(model).into_iter().find(|space| !known.contains(&space.as_str())) {
        None => Ok(()),
        Some(space) if [TOOLPATH, OLD_TOOLPATH].contains(&space.as_str()) => Err(broken(
            "it holds toolpaths, not the shape of a part: `inspect`, `simulate` and `export` read it, and the part itself \
             is planned from its own file",
        )),
        Some(space) => {
            Err(broken(format!("it requires the extension {space}, which is not read; save it with triangles alone")))
        }
    }
}

/// Millimetres per unit of a model.
///
/// # Errors
/// [`ImportError::Broken`] for a unit that 3MF does not know.
pub fn unit_in_mm(model: &Element) -> Result<f64, ImportError> {
    let unit = model.attribute("unit").unwrap_or_default();
    Ok(match unit.as_str() {
        "" | "millimeter" => 1.0,
        "micron" => 1e-3,
        "centimeter" => 10.0,
        "meter" => 1000.0,
        "inch" => 25.4,
        "foot" => 304.8,
        other => return Err(broken(format!("its unit \"{other}\" is not a 3MF unit"))),
    })
}

/// Bytes that may be read from an archive of this size.
pub(super) fn most_of(packed: usize) -> u64 {
    (MOST_TIMES * packed as u64).clamp(SMALL_BYTES, MOST_BYTES)
}

pub(super) fn unfolds(most: u64) -> String {
    let megabytes = most >> 20;
    format!(
        "it unpacks to more than {megabytes} MB, which no model of its size does. Save the part in another format, such as STL"
    )
}

/// Reads until more than the limit has been read from an archive.
pub struct Counted<'a, R> {
    inner: R,
    most: u64,
    left: &'a mut u64,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        *self.left = self.left.checked_sub(count as u64).ok_or_else(|| std::io::Error::other(unfolds(self.most)))?;
        Ok(count)
    }
}
