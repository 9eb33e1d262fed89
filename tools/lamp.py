"""Writes scenes/lamp.usda and its texture: a desk lamp that nods over two balls, 24 frames."""
import math
import struct
import sys
import zlib
from pathlib import Path

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "scenes")


def png(path, size=64):
    """Rings of wood."""
    rows = b""
    for y in range(size):
        rows += b"\0"
        for x in range(size):
            ring = 0.5 + 0.5 * math.sin(0.9 * x + 1.5 * math.sin(2 * math.pi * y / size))
            rows += bytes(int(a + (b - a) * ring) for a, b in ((96, 168), (58, 112), (30, 66)))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def tuples(values):
    return "[" + ", ".join("(" + ", ".join(f"{c:.6g}" for c in v) + ")" for v in values) + "]"


def flat(values):
    return "[" + ", ".join(str(v) for v in values) + "]"


def rings(radii_and_heights, sides):
    """Stacked rings of points and the quads between them, seen from outside."""
    points = [(r * math.cos(2 * math.pi * k / sides), h, -r * math.sin(2 * math.pi * k / sides))
              for r, h in radii_and_heights for k in range(sides)]
    faces = [[i * sides + k, i * sides + (k + 1) % sides, (i + 1) * sides + (k + 1) % sides, (i + 1) * sides + k]
             for i in range(len(radii_and_heights) - 1) for k in range(sides)]
    return points, faces


def mesh(name, points, faces, extra=""):
    return f'''    def Mesh "{name}" (prepend apiSchemas = ["MaterialBindingAPI", "SkelBindingAPI"])
    {{
        int[] faceVertexCounts = {flat(len(f) for f in faces)}
        int[] faceVertexIndices = {flat(v for f in faces for v in f)}
        point3f[] points = {tuples(points)}
{extra}    }}
'''


def loop(start, sides):
    return [start + k % sides for k in range(sides + 1)]


png(folder / "lamp.png")
base_points, base_faces = rings([(0.9, 0), (0.9, 0.15), (0.25, 0.2), (0.1, 0.3)], 8)
base_faces += [list(range(7, -1, -1)), list(range(24, 32))]
base = mesh("Base", base_points, base_faces, f'''        int[] creaseIndices = {flat(loop(0, 8) + loop(8, 8))}
        int[] creaseLengths = [9, 9]
        float[] creaseSharpnesses = [10, 2]
        rel material:binding = </Lamp/Looks/Red>
        def GeomSubset "Collar" {{
            uniform token elementType = "face"
            uniform token familyName = "materialBind"
            int[] indices = {flat(range(16, 24))}
            rel material:binding = </Lamp/Looks/Brass>
        }}
''')
heights = [0.2, 0.6, 1.0, 1.2, 1.4, 1.8, 2.2, 2.4, 2.6, 3.0]
arm_points, arm_faces = rings([(0.07, h) for h in heights], 6)
arm_faces += [list(range(5, -1, -1)), list(range(54, 60))]
shade_points, shade_faces = rings([(0.7, 2.5), (0.55, 2.8), (0.2, 3.1), (0.12, 3.2)], 8)


def weights(h):
    """Shares of the three joints, which stand at 0.2, 1.2 and 2.4."""
    lower = min(max((h - 1.0) / 0.4, 0), 1)
    upper = min(max((h - 2.2) / 0.4, 0), 1)
    return [1 - lower, lower * (1 - upper), lower * upper]


def skin(rows):
    size = '(elementSize = 3\n            interpolation = "vertex")'
    return f'''        int[] primvars:skel:jointIndices = {flat([0, 1, 2] * len(rows))} {size}
        float[] primvars:skel:jointWeights = {flat(f"{w:.6g}" for row in rows for w in row)} {size}
'''


arm = mesh("Arm", arm_points, arm_faces, skin([weights(p[1]) for p in arm_points]) +
           "        rel material:binding = </Lamp/Looks/Brass>\n")
shade = mesh("Shade", shade_points, shade_faces, skin([[0, 0, 1]] * len(shade_points)) +
             "        rel material:binding = </Lamp/Looks/Red>\n")
moved = lambda y: f"((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,{y},0,1))"


def turn(degrees):
    half = math.radians(degrees) / 2
    return f"({math.cos(half):.6g}, 0, 0, {math.sin(half):.6g})"


frames = ", ".join(f"{frame}: [{turn(20)}, {turn(-50 + nod)}, {turn(-60 - nod)}]"
                   for frame in range(1, 25) for nod in [8 * math.sin(2 * math.pi * (frame - 1) / 24)])
material = lambda name, lines: f'''        def Material "{name}" {{
            token outputs:surface.connect = </Lamp/Looks/{name}/Surface.outputs:surface>
            def Shader "Surface" {{
                uniform token info:id = "UsdPreviewSurface"
{lines}                token outputs:surface
            }}
'''
looks = material("Red", '''                color3f inputs:diffuseColor = (0.6, 0.05, 0.03)
                float inputs:roughness = 0.3
                float inputs:clearcoat = 0.5
''') + "        }\n" + material("Brass", '''                color3f inputs:diffuseColor = (0.89, 0.7, 0.32)
                float inputs:metallic = 1
                float inputs:roughness = 0.25
''') + "        }\n" + material("Wood", '''                color3f inputs:diffuseColor.connect = </Lamp/Looks/Wood/Image.outputs:rgb>
''') + '''            def Shader "Image" {
                uniform token info:id = "UsdUVTexture"
                asset inputs:file = @./lamp.png@
                token inputs:wrapS = "repeat"
                token inputs:wrapT = "repeat"
                token inputs:sourceColorSpace = "sRGB"
                float2 inputs:st.connect = </Lamp/Looks/Wood/Coordinates.outputs:result>
                float3 outputs:rgb
            }
            def Shader "Coordinates" {
                uniform token info:id = "UsdPrimvarReader_float2"
                string inputs:varname = "st"
                float2 outputs:result
            }
        }
'''
desk = mesh("Desk", [(-6, 0, 6), (6, 0, 6), (6, 0, -6), (-6, 0, -6)], [[0, 1, 2, 3]],
            '''        texCoord2f[] primvars:st = [(0, 0), (4, 0), (4, 4), (0, 4)] (interpolation = "vertex")
        rel material:binding = </Lamp/Looks/Wood>
''')
cube = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
cube_faces = [[4, 5, 7, 6], [1, 0, 2, 3], [0, 4, 6, 2], [5, 1, 3, 7], [2, 6, 7, 3], [0, 1, 5, 4]]
ball = mesh("Ball", cube, cube_faces, "        color3f[] primvars:displayColor = [(0.2, 0.35, 0.6)]\n")
place = lambda name, at, scale: f'''    def Xform "{name}" (
        instanceable = true
        prepend references = </Balls>
    ) {{
        double3 xformOp:translate = {at}
        double3 xformOp:scale = ({scale}, {scale}, {scale})
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
    }}
'''
(folder / "lamp.usda").write_text(f'''#usda 1.0
(
    defaultPrim = "Lamp"
    endTimeCode = 24
    framesPerSecond = 24
    startTimeCode = 1
    timeCodesPerSecond = 24
    upAxis = "Y"
)

class "Balls"
{{
{ball}}}

def Xform "Lamp"
{{
    def Scope "Looks" {{
{looks}    }}
{desk}{base}    def SkelRoot "Body" {{
    rel skel:skeleton = </Lamp/Body/Skeleton>
    def Skeleton "Skeleton" {{
        uniform token[] joints = ["foot", "foot/elbow", "foot/elbow/head"]
        uniform matrix4d[] bindTransforms = [{moved(0.2)}, {moved(1.2)}, {moved(2.4)}]
        uniform matrix4d[] restTransforms = [{moved(0.2)}, {moved(1.0)}, {moved(1.2)}]
        rel skel:animationSource = </Lamp/Body/Skeleton/Nod>
        def SkelAnimation "Nod" {{
            uniform token[] joints = ["foot", "foot/elbow", "foot/elbow/head"]
            float3[] translations = [(0, 0.2, 0), (0, 1, 0), (0, 1.2, 0)]
            half3[] scales = [(1, 1, 1), (1, 1, 1), (1, 1, 1)]
            quatf[] rotations.timeSamples = {{ {frames} }}
        }}
    }}
{arm}{shade}    }}
{place("Near", (2.2, 0.3, 0.8), 0.4)}{place("Far", (2.6, 0.22, -0.9), 0.3)}    def Camera "Camera" {{
        float focalLength = 40
        float horizontalAperture = 36
        float verticalAperture = 20.25
        float focusDistance = 9
        float fStop = 2.8
        double shutter:open = -0.25
        double shutter:close = 0.25
        double3 xformOp:translate.timeSamples = {{ 1: (0.5, 2.6, 9), 24: (1.5, 2.6, 8.8) }}
        float3 xformOp:rotateXYZ = (-9, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    }}
    def DistantLight "Window" {{
        float inputs:intensity = 1.5
        float inputs:angle = 4
        bool inputs:normalize = true
        float3 xformOp:rotateXYZ = (-50, 35, 0)
        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
    }}
    def SphereLight "Bulb" {{
        float inputs:intensity = 60
        float inputs:radius = 0.15
        bool inputs:enableColorTemperature = true
        float inputs:colorTemperature = 2900
        double3 xformOp:translate = (1.9, 1.5, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}
    def DomeLight "Sky" {{
        float inputs:intensity = 0.25
        color3f inputs:color = (0.8, 0.9, 1)
    }}
}}
''')
