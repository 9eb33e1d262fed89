//! Frames that change steadily, and the same frame every time.

use std::fs;
use std::path::Path;

use planish_tests::folder::temporary;
use planish_tests::layers::Layers;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::{root, scene};

/// Frames of the zoom.
const FRAME_COUNT: usize = 40;
/// Most that a frame may differ from the one before, in means of how the frames beside these two differ.
const MOST_JUMP: f64 = 1.3;
/// The same for how far the frame is from one of fine tessellation, in medians of all frames.
const MOST_TESSELLATION_JUMP: f64 = 3.0;
/// Most that the tessellation may be off in the mean of a frame's pixels, of 0 to 1.
const MOST_ERROR: f64 = 0.02;

/// A scene of one mesh with a camera path from far to near.
fn write_zoom(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("zoom.json");
    let text = format!(
        r#"{{"meshes": [{{"name": "mesh", "file": "{}"}}], "instances": [{{"mesh": "mesh"}}],
            "paths": [{{"name": "zoom", "fov": 45, "frames": {FRAME_COUNT}, "keys": [
                {{"eye": [6, 4, 9], "target": [0, 0.5, 0]}}, {{"eye": [2, 2, 3.5], "target": [0, 0.5, 0]}}]}}]}}"#,
        scene("mixed_triangles_quads").display()
    );
    fs::write(&path, text).unwrap();
    path
}

/// The colours of all frames of the zoom.
fn zoom(flags: &str) -> Vec<Vec<f32>> {
    let folder = temporary();
    let (path, out) = (write_zoom(folder.path()), folder.path().join("####.exr"));
    let range = format!("--camera zoom --frames 0-{} --size 128x96 --samples 4 {flags}", FRAME_COUNT - 1);
    Planish::render(&path, &out).flags(&range).run().silent_success().unwrap();
    let image = |frame: usize| Layers::read(&folder.path().join(format!("{frame:04}.exr")));
    (0..FRAME_COUNT).map(|frame| ["R", "G", "B"].map(|name| image(frame).floats(name)).concat()).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn differences(a: &[f32], b: &[f32]) -> Vec<f64> {
    a.iter().zip(b).map(|(&a, &b)| f64::from(a) - f64::from(b)).collect()
}

/// Each frame with the next.
fn changes<T: AsRef<[V]>, V: Copy + Into<f64>>(frames: &[T]) -> Vec<f64> {
    let change = |[a, b]: &[T; 2]| mean(a.as_ref().iter().zip(b.as_ref()).map(|(&a, &b)| (a.into() - b.into()).abs()));
    frames.array_windows().map(change).collect()
}

/// The largest of a list over the mean of its two neighbours.
fn largest_over_neighbours(values: &[f64]) -> f64 {
    values.array_windows().map(|[a, b, c]| 2.0 * b / (a + c)).fold(0.0, f64::max)
}

/// The largest of a list over its median.
fn largest_over_median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() - 1] / sorted[sorted.len() / 2]
}

/// A patch that is split or a level that is entered must not show: the frames change steadily, and so does how far they are
/// from frames of fine tessellation.
#[test]
fn a_zoom_has_no_jumps() {
    let (frames, fine) = (zoom("--edge-pixels 6"), zoom("--edge-pixels 1.5"));
    let errors: Vec<Vec<f64>> = frames.iter().zip(&fine).map(|(frame, fine)| differences(frame, fine)).collect();
    let jump = largest_over_neighbours(&changes(&frames));
    let tessellation_jump = largest_over_median(&changes(&errors));
    let rms = |error: &Vec<f64>| mean(error.iter().map(|e| e * e)).sqrt();
    let error = errors.iter().map(rms).fold(0.0, f64::max);
    let told = format!("jump {jump}, of the tessellation {tessellation_jump}, largest RMS error {error}");
    eprintln!("{told}");
    assert!(jump < MOST_JUMP && tessellation_jump < MOST_TESSELLATION_JUMP && error < MOST_ERROR, "{told}");
}

/// The triangles of a dump, sorted: their order may be another one every time.
fn sorted_triangles(vertices: impl Iterator<Item = Vertex>) -> Vec<Vec<[u32; 11]>> {
    let bits = |vertex: &Vertex| {
        let Vertex { position: [x, y, z], normal: [nx, ny, nz], uv: [u, v], face, level, kind, .. } = *vertex;
        let [x, y, z, nx, ny, nz, u, v] = [x, y, z, nx, ny, nz, u, v].map(f32::to_bits);
        [face, u32::from(level), u32::from(kind), u, v, x, y, z, nx, ny, nz]
    };
    let vertices: Vec<Vertex> = vertices.collect();
    let mut triangles: Vec<Vec<[u32; 11]>> =
        vertices.as_chunks::<3>().0.iter().map(|triangle| triangle.iter().map(bits).collect()).collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn the_same_command_gives_the_same_triangles_and_pixels_with_any_number_of_threads() {
    let made = |thread_count: Option<&str>| {
        let folder = temporary();
        let path = root().join("scenes/several.json");
        let out = |name| folder.path().join(name);
        let on = |command: Planish| match thread_count {
            Some(count) => command.env("LP_NUM_THREADS", count),
            None => command,
        };
        let image = "--size 200x150 --samples 3 --edge-pixels 3 --aov z,n,p,uv,face,patch,level,tess -o";
        on(Planish::render(&path, &out("a.exr")).flags(image).path(&out("a.png"))).run().silent_success().unwrap();
        let from_near = "--edge-pixels 3 --size 160x90 --eye -6,0.6,3 --target 1,0.4,0";
        on(Planish::dump(&path, &out("a.ply")).flags(from_near)).run().silent_success().unwrap();
        let triangles = sorted_triangles(Dump::read(&out("a.ply")).unwrap().vertices());
        (fs::read(out("a.exr")).unwrap(), fs::read(out("a.png")).unwrap(), triangles)
    };
    let first = made(None);
    for thread_count in [None, Some("1"), Some("2")] {
        let again = made(thread_count);
        assert!(again.0 == first.0, "the EXR file with {thread_count:?} threads has other bytes");
        assert!(again.1 == first.1, "the PNG file with {thread_count:?} threads has other bytes");
        assert!(again.2 == first.2, "the dump with {thread_count:?} threads has other triangles");
    }
}
