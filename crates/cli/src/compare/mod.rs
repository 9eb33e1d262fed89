//! `planish compare`: how far one dump lies from another, as section 5 of Loop et al. (2009) measures it.
//!
//! | module | idea |
//! |---|---|
//! | `soup` | a dump's triangles, and the box around them |
//! | `deviation` | distance and angle of two points, and sums of many |
//! | `parametric` | points matched by (face, u, v) |
//! | `tree`, `nearest` | nearest points, from samples by area |
//! | `report` | the table and the JSON |
//! | `picture` | a dump in false colours |
//! | `threads` | work on all cores |

mod deviation;
mod nearest;
mod parametric;
mod picture;
mod report;
mod soup;
#[cfg(test)]
mod tests;
mod threads;
mod tree;

use std::path::Path;

use anyhow::{Context, Result, bail};
use planish_film::{check_image_output, write_image};
use planish_scene::{Bounds, Camera};

use crate::args::CompareArguments;
use crate::console::{Console, print_output};
use crate::names::MetricName;
use deviation::Deviation;
use report::{Described, Measured, NearestReport, Report};
use soup::Soup;
use tree::Tree;

/// Runs the command.
pub fn run(arguments: &CompareArguments, console: &Console) -> Result<()> {
    let pictures = [arguments.output.as_deref(), arguments.normal_view.as_deref()];
    for path in pictures.iter().flatten() {
        check_image_output(path)?;
    }
    let [a, b] = [&arguments.a, &arguments.b].map(|path| Soup::read(path));
    let (a, b) = (a?, b?);
    let Some((bounds, diagonal)) = b.bounds().map(|bounds| (bounds, bounds.diagonal())).filter(|(_, d)| *d > 0.0)
    else {
        bail!("cannot compare with {}: all its points are one", arguments.b.display());
    };
    let areas = [area(&a, &arguments.a)?, area(&b, &arguments.b)?];
    let parametric = parametric::compare(&a, &b);
    let [common_faces, other_faces @ ..] = parametric.faces;
    if common_faces == 0 {
        bail!("{} and {} have no Ptex face in common", arguments.a.display(), arguments.b.display());
    }
    for (path, count) in [&arguments.a, &arguments.b].into_iter().zip(other_faces).filter(|(_, count)| *count > 0) {
        console.warn(format_args!("{count} of the faces of {} are not in the other dump", path.display()));
    }
    let (by_nearest, samples) = (arguments.metric == MetricName::Nearest, arguments.samples);
    let is_drawn = pictures.iter().any(Option::is_some);
    let tree = (samples > 0 || is_drawn && by_nearest).then(|| Tree::new(&b.triangles));
    let nearest = tree.as_ref().filter(|_| samples > 0).map(|tree| {
        let a_to_b = nearest::compare(&a, tree, samples);
        let b_to_a = nearest::compare(&b, &Tree::new(&a.triangles), samples);
        let [a_to_b, b_to_a, both] = [a_to_b, b_to_a, a_to_b.greater(b_to_a)].map(|s| Measured::new(s, diagonal));
        NearestReport { samples, a_to_b, b_to_a, both }
    });
    if is_drawn {
        let by_nearest = tree.as_ref().filter(|_| by_nearest).map(|tree| nearest::corner_deviations(&a, tree));
        let deviations = by_nearest.as_ref().unwrap_or(&parametric.deviations);
        write_pictures(arguments, console, &a, deviations, &bounds)?;
    }
    let described = |path: &Path, soup: &Soup, other_faces, area| Described {
        path: path.display().to_string(),
        triangles: soup.triangles.len(),
        other_faces,
        area,
    };
    let report = Report {
        a: described(&arguments.a, &a, other_faces[0], areas[0]),
        b: described(&arguments.b, &b, other_faces[1], areas[1]),
        common_faces,
        diagonal,
        parametric: Measured::new(parametric.summary, diagonal),
        nearest,
    };
    print_output(&if arguments.json {
        serde_json::to_string_pretty(&report).context("cannot write JSON")? + "\n"
    } else {
        report.to_text()
    })
}

fn area(soup: &Soup, path: &Path) -> Result<f64> {
    let area = soup.area();
    if area > 0.0 { Ok(area) } else { bail!("cannot compare {}: its triangles have no area", path.display()) }
}

/// Draws A in the default view of B, so that pictures of several approximations of one surface fit each other.
fn write_pictures(
    arguments: &CompareArguments,
    console: &Console,
    a: &Soup,
    deviations: &[Option<[Deviation; 3]>],
    bounds: &Bounds,
) -> Result<()> {
    let [width, height] = arguments.size;
    let camera = Camera::default_view(bounds)?;
    let view = picture::View {
        view_projection: (camera.projection_matrix(width as f32 / height as f32) * camera.view_matrix()).as_dmat4(),
        eye: camera.eye.as_dvec3(),
        size: arguments.size,
    };
    let distance: fn(Deviation) -> f64 = |deviation| deviation.distance;
    let degrees: fn(Deviation) -> f64 = |deviation| deviation.angle.map_or(f64::NAN, f64::to_degrees);
    let wanted = [
        (&arguments.output, distance, arguments.scale, "units of length"),
        (&arguments.normal_view, degrees, arguments.normal_scale, "degrees"),
    ];
    for (path, value, scale, unit) in wanted {
        let Some(path) = path else { continue };
        let values = deviations.iter().map(|corners| corners.map_or([f64::NAN; 3], |corners| corners.map(value)));
        let scale = scale.unwrap_or_else(|| values.clone().flatten().fold(0.0, f64::max));
        // Without any deviation all is blue.
        let inverse = if scale > 0.0 { scale.recip() } else { 0.0 };
        let scaled = values.map(|values| values.map(|value| value * inverse));
        write_image(&picture::draw(a.triangles.iter().zip(scaled), &view), path)?;
        console.explain(format_args!("{}: red is {scale:.4e} {unit}", path.display()));
    }
    Ok(())
}
