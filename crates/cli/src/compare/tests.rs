//! What is known of surfaces in closed form.

use glam::{DVec3, Vec2, Vec3};

use super::deviation::{Deviation, Summary};
use super::soup::{Corner, Soup, Triangle};
use super::tree::Tree;
use super::{nearest, parametric};

const SAMPLES: u32 = 5_000;

/// A surface over the unit square of one face, as `2 * side^2` triangles.
fn surface(face: i32, side: u32, point: impl Fn(Vec2) -> (Vec3, Vec3)) -> Soup {
    let corner = |column: u32, row: u32| {
        let uv = Vec2::new(column as f32, row as f32) / side as f32;
        let (position, normal) = point(uv);
        Corner { position, normal, uv }
    };
    let cells = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
    let triangles = cells.flat_map(|(c, r)| {
        let [a, b, d, e] = [corner(c, r), corner(c + 1, r), corner(c, r + 1), corner(c + 1, r + 1)];
        [[a, b, d], [b, e, d]].map(|corners| Triangle { face, corners })
    });
    Soup::new(triangles.collect())
}

/// A square with sides of length 1, moved.
fn square(side: u32, offset: Vec3) -> Soup {
    surface(0, side, |uv| (uv.extend(0.0) + offset, Vec3::Z))
}

/// Longitudes and latitudes.
fn sphere(side: u32, radius: f32) -> Soup {
    surface(0, side, |uv| {
        let ((sin_u, cos_u), (sin_v, cos_v)) =
            ((uv.x * std::f32::consts::TAU).sin_cos(), (uv.y * std::f32::consts::PI).sin_cos());
        let normal = Vec3::new(sin_v * cos_u, sin_v * sin_u, cos_v);
        (radius * normal, normal)
    })
}

fn by_nearest(from: &Soup, to: &Soup) -> Summary {
    nearest::compare(from, &Tree::new(&to.triangles), SAMPLES)
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, expected {expected} within {tolerance}");
}

#[test]
fn a_surface_does_not_deviate_from_itself() {
    let sphere = sphere(24, 1.0);
    let matched = parametric::compare(&sphere, &sphere).summary;
    assert_eq!((matched.distance.max, matched.normal.max), (0.0, 0.0));
    let nearest = by_nearest(&sphere, &sphere);
    assert!(nearest.distance.max < 1e-12 && nearest.normal.max < 1e-6, "{nearest:?}");
}

#[test]
fn a_copy_beside_a_square_has_the_distance_that_it_was_moved() {
    let (a, b) = (square(7, Vec3::new(0.0, 0.0, 0.25)), square(10, Vec3::ZERO));
    for summary in [parametric::compare(&a, &b).summary, by_nearest(&a, &b), by_nearest(&b, &a)] {
        for value in [summary.distance.rms, summary.distance.mean, summary.distance.max] {
            assert_near(value, 0.25, 1e-7);
        }
        assert_near(summary.normal.max, 0.0, 1e-7);
    }
}

#[test]
fn a_spike_between_the_samples_is_the_maximum_and_changes_no_mean() {
    let spiked = surface(0, 200, |uv| {
        let is_middle = (uv - Vec2::splat(0.5)).length() < 1e-4;
        (uv.extend(if is_middle { 0.25 } else { 0.0 }), Vec3::Z)
    });
    let flat = square(200, Vec3::ZERO);
    let found = nearest::compare(&spiked, &Tree::new(&flat.triangles), 5);
    assert_near(found.distance.max, 0.25, 1e-7);
    assert!(found.distance.rms < 1e-12, "five samples miss it: {found:?}");
}

#[test]
fn spheres_deviate_by_the_difference_of_their_radii() {
    let (a, b) = (sphere(96, 1.25), sphere(128, 1.0));
    // What a chord of the coarser sphere lies below it, and of the denser in the other direction.
    let sagitta = 2.0 * 1.25 * (std::f64::consts::PI / 96.0).powi(2);
    for summary in [parametric::compare(&a, &b).summary, by_nearest(&a, &b), by_nearest(&b, &a)] {
        for value in [summary.distance.rms, summary.distance.mean, summary.distance.max] {
            assert_near(value, 0.25, sagitta);
        }
    }
}

#[test]
fn a_slide_along_the_surface_is_parametric_alone() {
    let slide = |uv: Vec2| Vec2::new(uv.x + 0.2 * uv.x * (1.0 - uv.x), uv.y);
    let (a, b) = (surface(0, 8, |uv| (slide(uv).extend(0.0), Vec3::Z)), square(8, Vec3::ZERO));
    let matched = parametric::compare(&a, &b).summary.distance;
    assert_near(matched.max, 0.05, 1e-7);
    assert_eq!((matched.at.face, matched.at.u), (0, 0.5));
    assert!(by_nearest(&a, &b).distance.max < 1e-7 && by_nearest(&b, &a).distance.max < 1e-7);
}

#[test]
fn matched_points_between_vertices_are_interpolated() {
    // No vertex of one is a vertex of the other, but at the corners and the middle lines.
    let tilted = |side| surface(3, side, |uv| (Vec3::new(uv.x, uv.y, 2.0 * uv.x - uv.y), Vec3::Z));
    let matched = parametric::compare(&tilted(6), &tilted(4));
    assert!(matched.summary.distance.max < 1e-6, "{:?}", matched.summary);
    assert!(matched.deviations.iter().all(Option::is_some));
}

#[test]
fn deviations_count_by_area() {
    // A quarter of the square is a triangle; the rest is made of finer ones, nearly without deviation.
    let b = square(1, Vec3::ZERO);
    let mut triangles = vec![];
    let mut add = |corners: [[f32; 2]; 3], z: f32| {
        let corner = |uv: [f32; 2]| Corner { position: Vec2::from(uv).extend(z), normal: Vec3::Z, uv: uv.into() };
        triangles.push(Triangle { face: 0, corners: corners.map(corner) });
    };
    add([[0.0, 0.0], [1.0, 0.0], [0.5, 0.5]], 2.0);
    add([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 0.0);
    add([[0.0, 0.0], [0.5, 0.5], [0.0, 1.0]], 0.0);
    let a = Soup::new(triangles);
    for summary in [parametric::compare(&a, &b).summary, by_nearest(&a, &b)] {
        assert_near(summary.distance.mean, 0.5, 1e-3);
        assert_near(summary.distance.rms, 1.0, 1e-3);
        assert_near(summary.distance.max, 2.0, 1e-9);
    }
}

#[test]
fn normals_deviate_by_the_angle_between_them() {
    let turned = |angle: f32| surface(0, 4, |uv| (uv.extend(0.0), Vec3::new(angle.sin(), 0.0, angle.cos())));
    for angle in [1e-5, 0.3, 2.5] {
        for summary in
            [parametric::compare(&turned(angle), &turned(0.0)).summary, by_nearest(&turned(angle), &turned(0.0))]
        {
            assert_near(summary.normal.rms, f64::from(angle), 1e-6);
        }
    }
    let none = surface(0, 4, |uv| (uv.extend(0.0), Vec3::ZERO));
    let summary = parametric::compare(&none, &turned(0.0)).summary;
    assert_eq!(summary.normal.max, 0.0);
}

#[test]
fn faces_that_only_one_has_are_counted_and_not_compared() {
    let join = |faces: &[i32]| {
        let squares = faces.iter().flat_map(|&face| surface(face, 2, |uv| (uv.extend(face as f32), Vec3::Z)).triangles);
        Soup::new(squares.collect())
    };
    let matched = parametric::compare(&join(&[5, 1, 3]), &join(&[0, 3, 2, 4, 1]));
    assert_eq!(matched.faces, [2, 1, 3]);
    assert_eq!(matched.deviations.iter().filter(|deviations| deviations.is_none()).count(), 8);
    assert_eq!(matched.summary.distance.max, 0.0);
}

#[test]
fn the_tree_finds_what_looking_at_every_triangle_finds() {
    let (mut soup, probes) = (sphere(9, 1.0), sphere(13, 1.4));
    // Triangles without area, one a line and one a point.
    let [a, b, _] = soup.triangles[0].corners;
    soup.triangles.extend([[a, b, a], [a, a, a]].map(|corners| Triangle { face: 0, corners }));
    let tree = Tree::new(&soup.triangles);
    let each: Vec<Tree> = soup.triangles.chunks(1).map(Tree::new).collect();
    let squared = |tree: &Tree, point| tree.nearest(point).unwrap().distance_squared;
    for corner in probes.triangles.iter().flat_map(|triangle| triangle.corners) {
        for point in [1.0, 0.6, 0.0].map(|scale| scale * corner.position.as_dvec3()) {
            let expected = each.iter().map(|tree| squared(tree, point)).fold(f64::INFINITY, f64::min);
            assert_eq!(squared(&tree, point), expected);
        }
    }
    assert!(Tree::new(&[]).nearest(DVec3::ZERO).is_none());
}

#[test]
fn the_nearest_point_of_a_triangle_is_no_farther_than_any_other_of_it() {
    let triangle = square(1, Vec3::ZERO).triangles[0];
    let triangles = [triangle];
    let tree = Tree::new(&triangles);
    let steps = || (-4..=8).map(|step| f64::from(step) / 4.0);
    for (x, y, z) in steps().flat_map(|x| steps().flat_map(move |y| [-1.0, 0.0, 0.5].map(|z| (x, y, z)))) {
        let point = DVec3::new(x, y, z);
        let nearest = tree.nearest(point).unwrap();
        let at = triangle.at(nearest.weights).position;
        assert_near(at.distance_squared(point), nearest.distance_squared, 1e-12);
        assert!(nearest.weights.iter().all(|&weight| weight >= 0.0));
        for (a, b) in (0..=20).flat_map(|a| (0..=20 - a).map(move |b| (f64::from(a) / 20.0, f64::from(b) / 20.0))) {
            let other = triangle.at([a, b, 1.0 - a - b]).position;
            assert!(other.distance_squared(point) >= nearest.distance_squared - 1e-12, "{point}: {other} is nearer");
        }
    }
}

#[test]
fn samples_lie_everywhere_by_area() {
    // Two squares, one with nine times the other's area: shares are exact to one sample.
    let mut triangles = surface(0, 3, |uv| (uv.extend(0.0), Vec3::Z)).triangles;
    triangles.extend(surface(1, 5, |uv| (3.0 * uv.extend(1.0), Vec3::Z)).triangles);
    let soup = Soup::new(triangles);
    let samples = nearest::samples(&soup, 1_000);
    let on_small = samples.iter().filter(|(triangle, _)| triangle.face == 0).count();
    assert!((99..=101).contains(&on_small), "{on_small}");
    assert!(samples.iter().all(|(_, weights)| (weights.iter().sum::<f64>() - 1.0).abs() < 1e-12));
}

#[test]
fn an_order_of_triangles_does_not_matter() {
    let (a, b) = (sphere(12, 1.0), sphere(16, 1.0));
    let mut reversed = a.triangles.clone();
    reversed.reverse();
    assert_eq!(by_nearest(&a, &b), by_nearest(&Soup::new(reversed), &b));
}

#[test]
fn pictures_show_the_greatest_deviation_red_and_none_blue() {
    let soup = square(2, Vec3::ZERO);
    let view = super::picture::View {
        view_projection: glam::DMat4::from_cols_array(
            &[[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [-1.0, -1.0, 0.5, 1.0]]
                .concat()
                .try_into()
                .unwrap(),
        ),
        eye: DVec3::new(0.5, 0.5, 1e6),
        size: [64, 64],
    };
    let right = |triangle: &Triangle| triangle.corners.map(|corner| f64::from(corner.uv.x >= 0.5));
    let film = super::picture::draw(soup.triangles.iter().map(|triangle| (triangle, right(triangle))), &view);
    let pixel = |column: usize, row: usize| film.color[64 * row + column];
    assert_eq!(film.color.len(), 64 * 64);
    assert!(pixel(0, 32)[2] > 0.9 && pixel(0, 32)[0] < 0.1, "{:?}", pixel(0, 32));
    assert!(pixel(45, 32)[0] > 0.9 && pixel(45, 32)[2] < 0.1, "{:?}", pixel(45, 32));
    let unknown = super::picture::draw(soup.triangles.iter().map(|triangle| (triangle, [f64::NAN; 3])), &view);
    assert_eq!(unknown.color[64 * 32 + 10][0], unknown.color[64 * 32 + 10][2]);
}

#[test]
fn points_of_a_plane_deviate_by_distance_alone() {
    let triangle = square(1, Vec3::ZERO).triangles[0];
    let (a, b) = (triangle.at([0.5, 0.5, 0.0]), triangle.at([0.5, 0.25, 0.25]));
    let deviation = Deviation::between(&a, &b);
    assert_eq!(deviation.angle, Some(0.0));
    assert!(deviation.distance > 0.0);
}
