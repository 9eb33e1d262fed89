//! What composition multiplies is bounded, and shared where it can be.
use crate::common::{mesh_with, read};
use crate::robust::{package, read_layers};

#[test]
fn what_composition_multiplies_is_bounded() {
    // Every level has the next one twice.
    let level = |n: usize| {
        format!(
            "def \"l{n}\" {{ def \"a\" (references = </l{0}>) {{}} def \"b\" (references = </l{0}>) {{}} }}\n",
            n + 1
        )
    };
    let laughs = format!("{}{}def \"l30\" {{}}\n", mesh_with(""), (0..30).map(level).collect::<String>());
    let error = read_layers(&[("a.usda", format!("#usda 1.0\n{laughs}").as_bytes())]).unwrap_err();
    assert!(error.contains("composition that costs"), "{error}");
    let relocations: String = (0..2000).map(|n| format!("</a{n}/b> : </a{n}/c>, ")).collect();
    let error = read(&format!("(relocates = {{ {relocations} }})\n{}", mesh_with(""))).unwrap_err().to_string();
    assert!(error.contains("2000 relocations, expected at most 256"), "{error}");
    assert_memory();
}

/// Two classes a level, each of which leads to both of the next.
fn doubling(arc: &str, levels: usize, class: impl Fn(&str) -> String) -> String {
    let level = |n: usize| {
        let to = format!("[</A{0}{BELOW}>, </B{0}{BELOW}>]", n + 1);
        ["A", "B"].map(|side| format!("class \"{side}{n}\" {}\n", class(&format!("({arc} = {to})")))).concat()
    };
    let last = ["A", "B"].map(|side| format!("class \"{side}{levels}\" {}\n", class(""))).concat();
    format!("{}{last}", (0..levels).map(level).collect::<String>())
}

/// Where arcs lead within a class, and what makes it so.
const BELOW: &str = "/x/y";
fn below(arcs: &str) -> String {
    format!("{{ def \"x\" {{ def \"y\" {arcs} {{}} }} }}")
}

/// A layer with a mesh.
fn layer(head: &str, content: &str) -> String {
    format!("#usda 1.0\n{head}{}{content}", mesh_with(""))
}

const MULTIPLIED: &str = "a prim composed of more than 4000 places, expected fewer: references of references multiply";

#[test]
fn references_that_double_are_refused_before_they_are_composed() {
    let read = |content: &str| read_layers(&[("a.usda", layer("", content).as_bytes())]);
    let multiplied = MULTIPLIED;
    for arc in ["references", "payload", "inherits", "specializes"] {
        for levels in [14, 40] {
            let root = "def \"r\" (references = </A0/x/y>) {}\n";
            let error = read(&format!("{root}{}", doubling(arc, levels, below))).unwrap_err();
            assert!(error.contains(multiplied), "{arc}, {levels}: {error}");
        }
        read(&doubling(arc, 5, below)).unwrap();
    }
    // In a package, where the first layer is another than the file.
    let root = format!("#usda 1.0\n{}def \"r\" (references = </A0/x/y>) {{}}\n", mesh_with(""));
    let zip = package(&[("root.usda", format!("{root}{}", doubling("references", 30, below)).as_bytes())], 1);
    let error = read_layers(&[("a.usdz", &zip)]).unwrap_err();
    assert!(error.contains(multiplied), "{error}");
    // Below what no walk visits: inside of a material that a mesh is bound to.
    let shader =
        format!("{}def Material \"m\" {{ def \"s\" (references = </A0/x/y>) {{}}\n", doubling("references", 30, below));
    let bound = format!("{shader} token outputs:surface.connect = </m/s.outputs:surface> }}\n");
    let mesh = mesh_with("rel material:binding = </m>\n");
    let error = read_layers(&[("a.usda", format!("#usda 1.0\n{mesh}{bound}").as_bytes())]).unwrap_err();
    assert!(error.contains(multiplied), "{error}");
    // All lead to all: no two ways are the same.
    let all: String = (0..12).map(|n| format!("</K{n}>, ")).collect();
    let clique: String = (0..12).map(|n| format!("class \"K{n}\" (references = [{all}]) {{}}\n")).collect();
    let error = read(&clique).unwrap_err();
    assert!(error.contains(multiplied), "{error}");
    // Of a set of variants one is selected, however many there are.
    let tree = doubling("references", 7, below);
    let variants: String = (0..40).map(|n| format!("\"v{n}\" (references = </A0/x/y>) {{}}\n")).collect();
    let set = format!("{tree}def \"s\" (variants = {{ string v = \"v3\" }} prepend variantSets = \"v\") {{");
    read(&format!("{set} variantSet \"v\" = {{ {variants} }} }}")).unwrap();
    // Classes of classes do not multiply, however long their chain; beside each of many references they do.
    let chain = |arc: &str, length: usize, more: &str| {
        let level = |n: usize| format!("class \"A{n}\" ({arc} = </A{}> {more}) {{}}\n", n + 1);
        let last = format!("class \"A{length}\" {{}}\nclass \"K\" {{}}\n");
        format!("def \"r\" (references = </A0>) {{}}\n{}{last}", (0..length).map(level).collect::<String>())
    };
    read(&chain("inherits", 60, "")).unwrap();
    read(&chain("specializes", 60, "")).unwrap();
    read(&chain("references", 60, "")).unwrap();
    read(&chain("references", 20, "inherits = </K>")).unwrap();
    let error = read(&chain("references", 80, "inherits = </K>")).unwrap_err();
    assert!(error.contains(multiplied), "{error}");
    // Inside of one that is selected they multiply.
    let in_variant = |arcs: &str| {
        let set = format!("variantSet \"v\" = {{ \"a\" {arcs} {{}} \"b\" {{}} }}");
        let sets = "(variants = { string v = \"a\" } prepend variantSets = \"v\")";
        format!("{{ def \"x\" {{ def \"y\" {sets} {{ {set} }} }} }}")
    };
    let root = "def \"r\" (references = </A0/x/y>) {}\n";
    let error = read(&format!("{root}{}", doubling("references", 24, in_variant))).unwrap_err();
    assert!(error.contains(multiplied), "{error}");
}

#[test]
fn what_doubles_in_another_layer_is_refused_however_it_is_reached() {
    let doubled = doubling("references", 30, below);
    let root = "def \"r\" (references = </A0/x/y>) {}\n";
    let zip = package(&[("root.usda", layer("", &doubled).as_bytes())], 1);
    let other = layer("", &doubled);
    for (way, text, name, content) in [
        ("a sublayer", layer("(subLayers = [@./other.usda@])\n", root), "other.usda", other.as_bytes()),
        ("a package", layer("", "def \"r\" (references = @./other.usdz@</A0/x/y>) {}\n"), "other.usdz", zip.as_slice()),
        (
            "an expression",
            layer(
                "(expressionVariables = { string NAME = \"other\" })\n",
                "def \"r\" (references = @`\"./${NAME}.usda\"`@</A0/x/y>) {}\n",
            ),
            "other.usda",
            other.as_bytes(),
        ),
    ] {
        let error = read_layers(&[("a.usda", text.as_bytes()), (name, content)]).unwrap_err();
        assert!(error.contains(MULTIPLIED), "{way}: {error}");
    }
}

#[test]
fn meshes_are_shared_where_all_that_they_are_made_of_is_the_same() {
    let mesh = "def Mesh \"m\" {
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        def GeomSubset \"s\" { int[] indices = [0]\nuniform token elementType = \"face\"\nuniform token familyName = \"materialBind\" }
    }\n";
    let placed =
        |name: &str, over: &str| format!("def \"{name}\" (references = </big>) {{ over \"m\" {{ {over} }} }}\n");
    let count = |over: &str| {
        let places = [placed("a", ""), placed("b", ""), placed("c", over)].concat();
        let scene = read(&format!("class \"big\" {{ {mesh} }}\n{places}")).unwrap();
        assert_eq!(scene.instances.len(), 3, "{over}");
        scene.meshes.len()
    };
    for over in ["", "token visibility = \"inherited\"", "float3[] extent = [(0, 0, 0), (1, 1, 0)]"] {
        assert_eq!(count(over), 1, "{over}");
    }
    for over in [
        "point3f[] points = [(0, 0, 1), (1, 0, 0), (1, 1, 0), (0, 1, 0)]",
        "uniform token subdivisionScheme = \"none\"",
        "int[] cornerIndices = [0]\nfloat[] cornerSharpnesses = [10]",
        "over \"s\" { int[] indices = [1] }",
    ] {
        assert_eq!(count(over), 2, "{over}");
    }
    // What moves may do so at other times in each place.
    let moving = "class \"big\" { def Mesh \"m\" {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 0, 0), (1, 1, 0)], 10: [(0, 0, 1), (1, 0, 0), (1, 1, 0)] }
    } }\n";
    let places = "def \"a\" (references = </big>) {}\ndef \"b\" (references = </big> (offset = 5)) {}\n";
    let scene = read(&format!("{moving}{places}")).unwrap();
    assert_eq!((scene.meshes.len(), scene.instances.len()), (2, 2));
}

#[test]
fn layers_that_double_are_refused_before_they_are_composed() {
    let layer = |n: usize| {
        let to = |path: &str| format!("@./l{}.usda@{path}", n + 1);
        let text = format!("(defaultPrim = \"A\")\ndef \"A\" (references = [{}, {}]) {{}}\n", to(""), to("</B>"));
        format!("#usda 1.0\n{text}def \"B\" (payload = {}) {{}}\n", to(""))
    };
    let layers: Vec<(String, String)> = (0..24).map(|n| (format!("l{n}.usda"), layer(n))).collect();
    let layers: Vec<(&str, &[u8])> = layers.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let error = read_layers(&layers).unwrap_err();
    assert!(error.contains("more than 4000 places"), "{error}");
}

#[test]
fn references_to_a_large_mesh_share_it() {
    let large: String = (0..20_000).map(|n| format!("({n}, {}, {})", n % 7, n % 5)).collect::<Vec<_>>().join(", ");
    let faces: String = (0..19_998).map(|n| format!("{n}, {}, {}", n + 1, n + 2)).collect::<Vec<_>>().join(", ");
    let counts = vec!["3"; 19_998].join(", ");
    let mesh = format!(
        "def Mesh \"m\" {{ point3f[] points = [{large}]\nint[] faceVertexIndices = [{faces}]\nint[] faceVertexCounts = [{counts}]\n}}"
    );
    let places: String = (0..400).map(|n| format!("def \"r{n}\" (references = </big>) {{ double3 xformOp:translate = ({n}, 0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"] }}\n")).collect();
    // One of them has a colour of its own.
    let other =
        "def \"other\" (references = </big>) { over \"m\" { color3f[] primvars:displayColor = [(1, 0, 0)] } }\n";
    let scene = read(&format!("class \"big\" {{ {mesh} }}\n{places}{other}")).unwrap();
    assert_eq!((scene.meshes.len(), scene.instances.len()), (2, 401));
    assert_eq!(scene.meshes[0].control_mesh.positions, scene.meshes[1].control_mesh.positions);
    assert_eq!(scene.instances[399].transform.translation.x, 399.0);
    assert_memory();
}

/// No test of this process has taken more than half a GiB.
fn assert_memory() {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("the peak of resident memory");
    let peak: u64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
    assert!(peak < 512 << 10, "{peak} KiB");
}
