//! Which format a path asks for, and whether anything can be written there.

use std::io::Write as _;
use std::path::Path;

use crate::{Error, ExrOptions, Film, PngOptions, Result, atomic, write_exr_with, write_png_with};

/// A format that holds a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// Scene-linear colour, layers and metadata.
    Exr,
    /// The colour alone, 8 bit sRGB.
    Png,
}

impl ImageFormat {
    /// The format that the extension of `path` names, in either case.
    ///
    /// # Errors
    /// [`Error::Extension`] for any other extension or none.
    pub fn from_path(path: &Path) -> Result<Self> {
        if has_extension(path, "exr") {
            Ok(ImageFormat::Exr)
        } else if has_extension(path, "png") {
            Ok(ImageFormat::Png)
        } else {
            Err(Error::Extension { path: path.to_owned(), accepted: ".exr or .png" })
        }
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}

/// How files are made, whatever their format.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WriteOptions {
    /// Of EXR files.
    pub exr: ExrOptions,
    /// Of PNG files.
    pub png: PngOptions,
}

/// [`write_image_with`] the default options.
///
/// # Errors
/// As [`write_image_with`].
pub fn write_image(film: &Film, path: &Path) -> Result<()> {
    write_image_with(film, path, &WriteOptions::default())
}

/// Writes `film` in the format that the extension of `path` names.
///
/// # Errors
/// [`Error::Extension`], and those of [`write_exr_with`] and [`write_png_with`].
pub fn write_image_with(film: &Film, path: &Path, options: &WriteOptions) -> Result<()> {
    match ImageFormat::from_path(path)? {
        ImageFormat::Exr => write_exr_with(film, path, &options.exr),
        ImageFormat::Png => write_png_with(film, path, &options.png),
    }
}

/// Whether [`write_image`] could write to `path` now, found out before rendering: its extension is known, its folder
/// takes new files (one is created there and removed), and nothing but a regular file is in the way.
///
/// # Errors
/// [`Error::Extension`], [`Error::NoFolder`], [`Error::NotAFolder`], [`Error::NotAFile`]; [`Error::Write`] where the
/// folder refuses a file.
pub fn check_image_output(path: &Path) -> Result<ImageFormat> {
    let format = ImageFormat::from_path(path)?;
    atomic::check(path)?;
    Ok(format)
}

/// Writes text beside the images, by the same rules: complete or not at all, and never over what is no plain file.
///
/// # Errors
/// [`Error::NoFolder`], [`Error::NotAFolder`], [`Error::NotAFile`], [`Error::Write`].
pub fn write_text(text: &str, path: &Path) -> Result<()> {
    atomic::write(path, |writer| writer.write_all(text.as_bytes()).map_err(|source| Error::write(path, source)))
}

/// Whether text could be written to `path` now.
///
/// # Errors
/// As [`write_text`].
pub fn check_text_output(path: &Path) -> Result<()> {
    atomic::check(path)
}

/// Whether a dump could be written to `path` now; as [`check_image_output`], for the extension `.ply`.
///
/// # Errors
/// As [`check_image_output`].
pub fn check_dump_output(path: &Path) -> Result<()> {
    if !has_extension(path, "ply") {
        return Err(Error::Extension { path: path.to_owned(), accepted: ".ply" });
    }
    atomic::check(path)
}
