#include "dump.h"

#include "../shared/fail.h"
#include "../shared/ply.h"

#include <cstdio>

uint32_t Dump::add(Vec3 position, Vec3 normal, double at_u, double at_v, int ptex) {
    double norm = length(normal);
    if (!(norm > 0)) {
        normal = {0, 0, 0};
        norm = 1;
    }
    x.push_back((float)position.x);
    y.push_back((float)position.y);
    z.push_back((float)position.z);
    nx.push_back((float)(normal.x / norm));
    ny.push_back((float)(normal.y / norm));
    nz.push_back((float)(normal.z / norm));
    u.push_back((float)at_u);
    v.push_back((float)at_v);
    face.push_back(ptex);
    return (uint32_t)(vertex_count() - 1);
}

Dump read_dump(const std::string& path) {
    PlyFile file = read_ply(path, {"x", "y", "z", "nx", "ny", "nz", "u", "v", "s", "t"}, {"face", "level"});
    for (size_t k = 0; k < 8; ++k)
        if (!file.floats[k].present)
            fail("PLY: vertex property `" + file.floats[k].name + "' is missing");
    if (file.floats[8].present != file.floats[9].present)
        fail("PLY: only one of the vertex properties `s' and `t' is there");
    if (!file.integers[0].present)
        fail("PLY: vertex property `face' is missing");

    Dump dump;
    std::vector<float>* columns[] = {&dump.x,  &dump.y, &dump.z, &dump.nx, &dump.ny,
                                     &dump.nz, &dump.u, &dump.v, &dump.s,  &dump.t};
    for (size_t k = 0; k < file.floats.size(); ++k)
        columns[k]->swap(file.floats[k].values);
    dump.face.swap(file.integers[0].values);
    dump.level.swap(file.integers[1].values);
    dump.level.resize(dump.vertex_count(), 0);
    dump.triangles.swap(file.triangles);
    return dump;
}

void write_dump(const std::string& path, const Dump& dump, bool ascii) {
    FILE* file = fopen(path.c_str(), "wb");
    if (!file)
        fail("cannot write " + path);
    fprintf(file, "ply\nformat %s 1.0\n", ascii ? "ascii" : "binary_little_endian");
    fprintf(file, "element vertex %zu\n", dump.vertex_count());
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
        fprintf(file, "property float %s\n", name);
    fprintf(file, "property int face\nelement face %zu\n", dump.triangles.size() / 3);
    fprintf(file, "property list uchar int vertex_indices\nend_header\n");

    for (size_t i = 0; i < dump.vertex_count(); ++i) {
        const float values[8] = {dump.x[i],  dump.y[i],  dump.z[i], dump.nx[i],
                                 dump.ny[i], dump.nz[i], dump.u[i], dump.v[i]};
        const int32_t face = (int32_t)dump.face[i];
        if (ascii) {
            for (float value : values)
                fprintf(file, "%.9g ", value);
            fprintf(file, "%d\n", face);
        } else {
            fwrite(values, sizeof values, 1, file);
            fwrite(&face, sizeof face, 1, file);
        }
    }
    for (size_t i = 0; i < dump.triangles.size(); i += 3) {
        const uint32_t* corners = &dump.triangles[i];
        const unsigned char corner_count = 3;
        if (ascii) {
            fprintf(file, "3 %u %u %u\n", corners[0], corners[1], corners[2]);
        } else {
            fwrite(&corner_count, 1, 1, file);
            fwrite(corners, sizeof *corners, 3, file);
        }
    }
    if (fclose(file))
        fail("cannot write " + path);
}
