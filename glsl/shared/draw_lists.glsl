// Appending to draw lists, and what the variants of the emit stage ask of an object. Included where `push`, with the scene's
// address, and the constants BATCH_VERTICES and CULL are declared.
#ifndef PLANISH_DRAW_LISTS
#define PLANISH_DRAW_LISTS
shared uint seen[2];
shared uint most_vertices;
shared uint first_entry;
shared uint first_draw;

// Appends the entries of those threads that have one, in their order. All threads of the group must call it.
void append_entries(uint draw, bool is_seen, DrawEntry entry, uint vertices)
{
    uint thread = gl_LocalInvocationID.x;
    barrier();
    if (thread < 2u) {
        seen[thread] = 0u;
    }
    if (thread == 0u) {
        most_vertices = 1u;
    }
    barrier();
    if (is_seen) {
        atomicOr(seen[thread >> 5], 1u << (thread & 31u));
        atomicMax(most_vertices, vertices);
    }
    barrier();
    uint count = bitCount(seen[0]) + bitCount(seen[1]);
    if (count == 0u) {
        return;
    }
    uint batch = BATCH_VERTICES == 0u ? CHUNK : clamp(BATCH_VERTICES / most_vertices, 1u, CHUNK);
    uint draws = BATCH_VERTICES == 0u ? 0u : (count + batch - 1u) / batch;
    DrawHeads heads = push.scene.v.draw_heads;
    if (thread == 0u) {
        first_entry = atomicAdd(heads.v[draw].count, count);
        first_draw = draws == 0u ? 0u : atomicAdd(heads.v[draw].draw_count, draws);
    }
    barrier();
    uint capacity = heads.v[draw].capacity;
    if (is_seen) {
        uint rank = bitCount(seen[thread >> 5] & ((1u << (thread & 31u)) - 1u)) + (thread >= 32u ? bitCount(seen[0]) : 0u);
        if (first_entry + rank < capacity) {
            push.scene.v.entries.v[heads.v[draw].first + first_entry + rank] = entry;
        }
    }
    for (uint i = thread; i < draws; i += CHUNK) {
        if (first_draw + i < heads.v[draw].draw_capacity) {
            uint begin = min(first_entry + i * batch, capacity);
            uint end = min(min(first_entry + count, first_entry + (i + 1u) * batch), capacity);
            push.scene.v.draws.v[heads.v[draw].first_draw + first_draw + i] = DrawArguments(end - begin, 1u, begin, 0u);
        }
    }
}

bool is_culled(FrameInput frame) { return CULL && frame.view.cull != 0u; }

// Whether triangles of an object that show their back are not seen.
bool culls_back(FrameInput frame, Object object)
{
    return frame.view.cull == 2u && (object.flags & (OBJECT_HIDES_BACKS | OBJECT_MIRRORED)) == OBJECT_HIDES_BACKS;
}

bool is_split(Object object, uint edge)
{
    uint bit = object.first_edge + edge;
    return edge != NONE && (push.scene.v.split_edges.v[bit >> 5] >> (bit & 31u) & 1u) != 0u;
}
#endif
