// What the kernels of a frame share: objects, marks and lists, reached through one address.
#ifndef PLANISH_SCENE
#define PLANISH_SCENE
#include "tables.glsl"
#include "visibility.glsl"

// The limit surface of a face lies in the convex hull of its one-ring.
const uint OBJECT_IN_HULL = 1;
// Triangles that show their back are never seen.
const uint OBJECT_HIDES_BACKS = 2;
// The transform mirrors.
const uint OBJECT_MIRRORED = 4;
// Its texture coordinates are bilinear in every face.
const uint OBJECT_LINEAR_TEX_COORDS = 8;
// It has colours, which are subdivided as positions are.
const uint OBJECT_VERTEX_COLORS = 16;
// It has colours, which are bilinear in every Ptex face.
const uint OBJECT_VARYING_COLORS = 32;
// Its cage's points are made by `deform.comp`: what is known of them on the CPU is of another pose.
const uint OBJECT_DEFORMS = 64;
// It is not there in this frame.
const uint OBJECT_HIDDEN = 128;

// A mesh at a place. "First" names a place in a table of all meshes or objects.
struct Object {
    mat4x3 to_world;
    vec3 low;             // box around the cage, in the mesh's own space
    vec3 high;
    float largest_edge;   // length of the longest edge of the cage, in world space
    float displacement;   // how far the surface may be moved, in world space
    uint flags;
    uint first_slot;      // of its densities
    uint first_mesh_slot; // of the mesh's slots in the tables of neighbours and rings
    uint vertex_count;    // slots below this are vertices of the cage
    uint slot_count;
    uint first_point;     // the cage's first point
    uint first_ptex;      // of the mesh's Ptex faces in their table
    uint first_face;      // number of its first Ptex face among those of all objects
    uint first_patch;     // regular patches of level 0
    uint patch_count;
    uint first_root;      // irregular faces of level 0
    uint root_count;
    uint map;             // its displacement map; NONE for none
    uint first_edge;      // edge e of the tables is bit first_edge + e of the split edges
    mat4x3 motion;        // to the world at the next moment: of the mesh's own space where it deforms, else of the world now
};

// Density at a vertex, and the largest around it; planes of the view that the vertex, and all vertices around it, lie outside of.
struct SlotDensity {
    float density;
    float ring;
    uint outside;
    uint ring_outside;
};

// A list that kernels append to: how many groups of 64 it takes to go over it, and how many entries were appended. More
// than fit are counted, not written.
struct ListHead {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint count;
    uint capacity;
};

// The lists, by their heads. Active faces have a head a level, from level 1 on; points in use one a phase of subdivision.
const uint LIST_VERTICES = 0;  // chunks of vertices
const uint LIST_MIDDLES = 1;   // chunks of slots that are faces of other than four sides
const uint LIST_ROOTS = 2;     // chunks of irregular faces of level 0
const uint LIST_BASE = 3;      // chunks of regular patches of level 0
const uint LIST_PATCHES = 4;   // regular patches of finer levels
const uint LIST_LEAVES = 5;    // irregular faces that are not refined
const uint LIST_CUT = 6;       // patches that are cut
const uint LIST_CUT_GREGORY = 7; // Gregory patches that are cut
const uint LIST_ACTIVE = 8;    // + level
const uint LIST_PHASES = LIST_ACTIVE + LEVEL_COUNT; // + phase
const uint MAX_PHASES = 2 * LEVEL_COUNT + 1;
const uint LIST_COUNT = LIST_PHASES + MAX_PHASES;
// Entries of a chunk, and threads of a group.
const uint CHUNK = 64;

// An object's number and a place in a table: of one element, or of a chunk of them. Faces that cannot be seen are selected for
// the sake of their neighbours; their object has this bit.
const uint ITEM_UNSEEN = 0x80000000u;
struct ListItem {
    uint object;
    uint place;
};

// 64 words of marks, of elements `first` up to `end` of one phase; those that are marked are listed from `first_item` of the phase
// on. A phase is the rows that subdivision makes at once, or all limit points.
struct MarkGroup {
    uint phase;
    uint first;
    uint end;
    uint first_item;
};

// A patch to draw. Flags: edges that are split, 4 bits; of a piece of a cut patch its place and how many there are a side.
// The factors are those of the whole patch (factors.glsl): many threads find them here, before a draw's few do.
struct DrawEntry {
    uint place;
    uint object;
    uint flags;
    uint triangles; // that the tessellator makes of it
    vec4 low;
    vec4 high;
    vec2 inner;
};

// VkDrawIndirectCommand: a vertex is a patch.
struct DrawArguments {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};

// A list of patches to draw: one draw of all, or several of a few each.
struct DrawHead {
    DrawArguments all;
    uint count;          // entries
    uint capacity;
    uint first;          // place of the first entry
    uint draw_count;
    uint draw_capacity;
    uint first_draw;
};
const uint DRAW_REGULAR = 0;
const uint DRAW_TRANSITION = 1;
const uint DRAW_FILLING = 2;
const uint DRAW_CUT = 3;
const uint DRAW_GREGORY = 4;
const uint DRAW_GREGORY_CUT = 5;
const uint DRAW_TRIANGLE = 6; // thirds of Gregory triangles
const uint DRAW_TRIANGLE_CUT = 7;
const uint DRAW_TABLE = 8;    // faces whose points are rows of a table
const uint DRAW_COUNT = 9;

// What a frame drew and computed: patches by level, of each kind.
struct FrameCounts {
    uint regular[LEVEL_COUNT];
    uint transition[LEVEL_COUNT];
    uint filling[LEVEL_COUNT];
    uint gregory[LEVEL_COUNT];  // quads
    uint triangle[LEVEL_COUNT];
    uint table[LEVEL_COUNT];
    uint truncated;
    uint density_bits; // the largest density, as its bits
};

const uint SELECT_DYNAMIC = 0;
const uint SELECT_STATIC = 1;

// What a frame asks for.
struct FrameInput {
    EmitView view;
    float edge_scale;  // pixels of a sphere's diameter times its distance over its radius, over those that an edge should have
    float density;     // the density itself, where it is the same everywhere; else 0
    float least_cosine; // between the view's axis and a corner of the image: nothing that is seen is beside it by more
    uint selection;
    uint max_level;
    uint object_lod;   // 1: one density an object
    uint object_count;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Objects { Object v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SlotDensities { SlotDensity v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Bits { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ListItems { ListItem v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ListHeads { ListHead v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MarkGroups { MarkGroup v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DrawEntries { DrawEntry v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DrawHeads { DrawHead v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Draws { DrawArguments v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Counts { FrameCounts v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Inputs { FrameInput v; };

struct SceneData {
    Inputs frame_input;
    Objects objects;
    Points points;
    LimitPoints limits;
    RegularPatches patches;
    SeamTable seams;
    IrregularFaces irregular;
    GregoryFaces gregory;
    SpokePoints spokes;
    Points spoke_middles;       // of ACC and Pm-patches
    GregoryStencils stencils;   // of Gregory patches
    RingPoints stencil_points;
    Weights stencil_weights;
    TablePatches table_patches; // of the method `table` and its rivals; these eight are empty for others
    Points table_normals;       // of the points of all levels, where surfaces are shaded by them
    TableEdges table_edges;
    Indices table_controls;
    Weights table_weights;
    TableTangents table_tangents;
    ShortWeights short_weights;  // instead of both, where they have 16 bits
    ShortWeights short_tangents;
    PtexFaces ptex_faces;
    Indices neighbour_first; // slot to its first in `neighbours`
    Indices neighbours;
    Indices ring_first;      // slot to its first in `rings`
    Indices rings;
    Weights density_scales;  // of cage points
    Indices star_first;
    Indices star_marks_of;   // places among the marks of the points around
    DisplacementMaps maps;
    Weights texel_counts;    // of slots of meshes: texels of their map along an edge
    TexCoords tex_coords;
    Indices patch_tex_coords; // 16 of each patch: of the surface where it is displaced, else of the trees
    Indices face_tex_coords;  // 8 of each irregular face, at its limit points; or 4 of each quad of the trees
    Indices tex_nodes;        // four branches each
    Indices tex_roots;        // the branch of each Ptex face
    Points point_colors;      // of the points of all levels; the three tables are empty where nothing needs them
    Points limit_colors;      // of the limit points
    Points gregory_colors;    // of the control points of Gregory patches, 20 a face
    Points next_points;       // of all levels, at the next moment; these two are empty where no motion is asked for
    LimitPoints next_limits;
    Points slot_colors;       // of the slots of meshes: vertices, and faces of other than four sides
    LimitSeats limit_seats;
    LimitTangentTable limit_tangents;
    SlotDensities densities;
    Bits split_edges;
    Bits star_marks;
    Bits marks;              // of points and limit points in use, phase by phase
    MarkGroups mark_groups;
    Bits in_use;             // their numbers, phase by phase
    ListItems chunks;        // of all four kinds
    ListItems active_faces;      // level by level
    ListItems patch_items;
    ListItems leaf_items;
    ListItems cut_items;
    ListItems cut_gregory_items;
    ListHeads heads;
    DrawHeads draw_heads;
    DrawEntries entries;
    Draws draws;
    Counts counts;
    uint chunk_first[4];     // where each kind's chunks begin
    uint first_active[LEVEL_COUNT];
    uint mark_group_count;
    uint first_limit_mark;
    uint table_level;        // 2^this segments a side of a table's patches
    uint table_steps;        // and they are faces of the cage split so often
    float short_scale;       // of weights of 16 bits: what 1 stands for
    uvec2 materials;         // address of the MaterialTables (materials.glsl), for holes in them; 0 where nothing has any
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer SceneTables { SceneData v; };

// Number of entries of a list.
uint list_length(ListHeads heads, uint list)
{
    return min(heads.v[list].count, heads.v[list].capacity);
}

// Whether any object stands elsewhere than its mesh: without it no transform is fetched, or applied.
layout(constant_id = 4) const bool PLACED = true;
// Whether any object is displaced.
layout(constant_id = 6) const bool DISPLACED = false;
// Whether texture coordinates are asked for.
layout(constant_id = 7) const bool TEX_COORDS = false;
// Whether irregular faces are drawn as Gregory patches.
layout(constant_id = 8) const bool GREGORY = false;
// Whether colours are asked for.
layout(constant_id = 9) const bool COLORED = false;
// Whether it is asked where points are at the next moment.
layout(constant_id = 13) const bool MOVING = false;

vec3 to_world(Object object, vec3 p)
{
    if (!PLACED) {
        return p;
    }
    // Columns times coordinates, in this order everywhere.
    precise vec3 result = ((object.to_world[0] * p.x + object.to_world[1] * p.y) + object.to_world[2] * p.z) + object.to_world[3];
    return result;
}

// A vector between points.
vec3 to_world_vector(Object object, vec3 a)
{
    if (!PLACED) {
        return a;
    }
    precise vec3 result = (object.to_world[0] * a.x + object.to_world[1] * a.y) + object.to_world[2] * a.z;
    return result;
}

// A unit normal under the transform: across the transformed plane. Mirrored ones are turned over, as crossed tangents are.
vec3 normal_to_world(Object object, vec3 n)
{
    if (!PLACED) {
        return n;
    }
    precise vec3 x = precise_cross(object.to_world[1], object.to_world[2]);
    precise vec3 y = precise_cross(object.to_world[2], object.to_world[0]);
    precise vec3 z = precise_cross(object.to_world[0], object.to_world[1]);
    precise vec3 turned = (x * n.x + y * n.y) + z * n.z;
    return unit_vector(turned);
}
#endif
