//! UsdGeomMesh becomes a cage.
use planish_scene::{LoadOptions, read_obj};
use planish_subdiv::mesh::{
    BoundaryInterpolation, ControlMesh, Corner, Crease, FaceVaryingInterpolation, INFINITE_SHARPNESS, MeshOptions,
    TriangleSubdivision, VertexInterpolation,
};

use crate::common::{assert_refused, mesh_with, read, read_with, scene_of};

fn cage(lines: &str) -> ControlMesh {
    scene_of(lines).meshes.remove(0).control_mesh
}

#[test]
fn one_cage_through_obj_and_usd_is_the_same() {
    let obj = "v 0.1 0 0\nv 1e-7 0 0\nv 1 0.3333333 0\nv 0 1 0\nv 2 0.1 0\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 2/1 5/2 3/4\n\
        t crease 2/1/0 1 2 2.5\nt corner 1/1/0 0 10\nt hole 1/0/0 1\n";
    let usd = r#"def Mesh "m" {
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 2]
        point3f[] points = [(0.1, 0, 0), (1e-7, 0, 0), (1, 0.3333333, 0), (0, 1, 0), (2, 0.1, 0)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "faceVarying")
        int[] primvars:st:indices = [0, 1, 2, 3, 0, 1, 3]
        int[] creaseIndices = [1, 2]
        int[] creaseLengths = [2]
        float[] creaseSharpnesses = [2.5]
        int[] cornerIndices = [0]
        float[] cornerSharpnesses = [10]
        int[] holeIndices = [1]
    }"#;
    let through_obj = read_obj("m.obj", obj.as_bytes(), &LoadOptions::default()).unwrap();
    let through_usd = read(usd).unwrap();
    assert_eq!(through_usd.meshes[0].control_mesh, through_obj.meshes[0].control_mesh);
    assert_eq!(through_usd.meshes[0].name, "m");
}

#[test]
fn options_are_the_schema_s_unless_authored() {
    assert_eq!(cage("").options, MeshOptions::default());
    let options = cage(
        r#"uniform token interpolateBoundary = "edgeOnly"
        uniform token faceVaryingLinearInterpolation = "boundaries"
        uniform token triangleSubdivisionRule = "smooth""#,
    )
    .options;
    assert_eq!(options.boundary, BoundaryInterpolation::EdgeOnly);
    assert_eq!(options.face_varying, FaceVaryingInterpolation::Boundaries);
    assert_eq!(options.triangles, TriangleSubdivision::Smooth);
}

#[test]
fn creases_have_a_sharpness_each_or_one_an_edge() {
    let lines = "int[] creaseIndices = [0, 1, 2, 2, 3]\nint[] creaseLengths = [3, 2]\n";
    let sharp = |values: &str| -> Vec<f32> {
        let cage = cage(&format!("{lines}float[] creaseSharpnesses = {values}"));
        cage.creases.iter().map(|crease| crease.sharpness).collect()
    };
    assert_eq!(sharp("[1, 2]"), [1.0, 1.0, 2.0]);
    assert_eq!(sharp("[1, 2, 3]"), [1.0, 2.0, 3.0]);
    assert_eq!(
        cage(&format!("{lines}float[] creaseSharpnesses = [1, inf]")).creases[2],
        Crease { vertices: [2, 3], sharpness: INFINITE_SHARPNESS }
    );
}

#[test]
fn left_handed_faces_are_reversed_with_their_coordinates() {
    let st =
        "texCoord2f[] primvars:st = [(0,0),(1,0),(2,0),(3,0),(4,0),(5,0),(6,0)] (interpolation = \"faceVarying\")\n";
    let cage = cage(&format!("{st}uniform token orientation = \"leftHanded\""));
    assert_eq!(cage.face_vertices, [0, 3, 2, 1, 1, 2, 4]);
    let channel = &cage.face_varying[0];
    let s: Vec<f32> = channel.indices.iter().map(|&index| channel.values[index as usize][0]).collect();
    assert_eq!(s, [0.0, 3.0, 2.0, 1.0, 4.0, 6.0, 5.0]);
}

#[test]
fn coordinates_may_belong_to_anything() {
    let s = |values: &str, interpolation: &str| -> Vec<f32> {
        let cage = cage(&format!("float2[] primvars:st = {values} (interpolation = \"{interpolation}\")"));
        let channel = &cage.face_varying[0];
        channel.indices.iter().map(|&index| channel.values[index as usize][0]).collect()
    };
    assert_eq!(s("[(7,0)]", "constant"), [7.0; 7]);
    assert_eq!(s("[(7,0),(8,0)]", "uniform"), [7.0, 7.0, 7.0, 7.0, 8.0, 8.0, 8.0]);
    assert_eq!(s("[(0,0),(1,0),(2,0),(3,0),(4,0)]", "vertex"), [0.0, 1.0, 2.0, 3.0, 1.0, 4.0, 2.0]);
    assert_eq!(s("[(0,0),(1,0),(2,0),(3,0),(4,0)]", "varying"), [0.0, 1.0, 2.0, 3.0, 1.0, 4.0, 2.0]);
}

#[test]
fn equal_coordinates_without_indices_are_no_seam() {
    let st = "texCoord2f[] primvars:st = [(0,0),(1,0),(2,0),(3,0),(1,0),(5,0),(6,0)] (interpolation = \"faceVarying\")";
    assert_eq!(cage(st).face_varying[0].indices, [0, 1, 2, 3, 1, 4, 5]);
}

#[test]
fn polygons_are_infinitely_sharp_and_loop_is_refused() {
    for scheme in ["none", "bilinear"] {
        let scene = read(&mesh_with(&format!("uniform token subdivisionScheme = \"{scheme}\""))).unwrap();
        let cage = &scene.meshes[0].control_mesh;
        assert_eq!((cage.creases.len(), cage.corners.len()), (6, 5));
        assert_eq!(cage.corners[4], Corner { vertex: 4, sharpness: INFINITE_SHARPNESS });
        assert_eq!(
            scene.warnings[0].to_string(),
            format!("/World/Mesh: subdivisionScheme {scheme}: all edges and vertices are infinitely sharp")
        );
    }
    assert_refused(
        &mesh_with("uniform token subdivisionScheme = \"loop\""),
        "/World/Mesh.subdivisionScheme: found \"loop\", expected catmullClark, bilinear or none",
    );
}

#[test]
fn colours_of_vertices_are_the_cage_s() {
    let five = "color3f[] primvars:displayColor = [(1,0,0),(0,1,0),(0,0,1),(1,1,1),(0,0,0)]";
    for (name, interpolation) in [("vertex", VertexInterpolation::Vertex), ("varying", VertexInterpolation::Varying)] {
        let colors = cage(&format!("{five} (interpolation = \"{name}\")")).colors.unwrap();
        assert_eq!((colors.values[2], colors.interpolation), ([0.0, 0.0, 1.0], interpolation));
    }
}

#[test]
fn wrong_indices_are_named_with_their_prim() {
    let refused = |lines: &str, message: &str| assert_refused(&mesh_with(lines), &format!("/World/Mesh.{message}"));
    refused("int[] holeIndices = [2]", "holeIndices: found face 2, expected 0 to 1");
    refused(
        "int[] cornerIndices = [-1]\nfloat[] cornerSharpnesses = [1]",
        "cornerIndices: found vertex -1, expected 0 to 4",
    );
    refused(
        "int[] creaseIndices = [0, 1]\nint[] creaseLengths = [3]\nfloat[] creaseSharpnesses = [1]",
        "creaseIndices: found 2 vertices, expected the 3 of creaseLengths",
    );
    refused(
        "texCoord2f[] primvars:st = [(0, 0)] (interpolation = \"vertex\")",
        "primvars:st: found 1 values, expected the 5 of vertex",
    );
    let mesh = "def Mesh \"m\" {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 7]\n\
        point3f[] points = [(0,0,0),(1,0,0),(1,1,0)]\n}";
    assert_refused(mesh, "/m.faceVertexIndices: found vertex 7 at corner 2, expected 0 to 2");
}

#[test]
fn degenerate_faces_are_refused_or_dropped() {
    let text = "def Mesh \"m\" {\nint[] faceVertexCounts = [3, 2, 3]\nint[] faceVertexIndices = [0, 0, 1, 0, 1, 0, 1, 2]\n\
        int[] holeIndices = [0, 2]\npoint3f[] points = [(0,0,0),(1,0,0),(1,1,0)]\n}";
    assert_refused(
        text,
        "/m.faceVertexIndices: found face 0 with vertex 0 twice, expected 3 or more different vertices",
    );
    let scene = read_with(text, &LoadOptions { repair: true, ..LoadOptions::default() }).unwrap();
    let cage = &scene.meshes[0].control_mesh;
    assert_eq!((cage.face_vertices.as_slice(), cage.holes.as_slice()), ([0, 1, 2].as_slice(), [0].as_slice()));
    assert_eq!(scene.warnings.len(), 2);
}
