#include "cage.h"

#include "../shared/fail.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cstdlib>

using namespace OpenSubdiv;

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Cage& cage) {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = (int)cage.points.size();
    descriptor.numFaces = cage.face_count();
    descriptor.numVertsPerFace = cage.face_sizes.data();
    descriptor.vertIndicesPerFace = cage.face_points.data();
    descriptor.numCreases = (int)cage.crease_sharpness.size();
    descriptor.creaseVertexIndexPairs = cage.crease_points.data();
    descriptor.creaseWeights = cage.crease_sharpness.data();
    descriptor.numCorners = (int)cage.corner_sharpness.size();
    descriptor.cornerVertexIndices = cage.corner_points.data();
    descriptor.cornerWeights = cage.corner_sharpness.data();
    descriptor.numHoles = (int)cage.hole_faces.size();
    descriptor.holeIndices = cage.hole_faces.data();
    Far::TopologyDescriptor::FVarChannel channel;
    if (!cage.face_values.empty()) {
        channel.numValues = (int)cage.values.size();
        channel.valueIndices = cage.face_values.data();
        descriptor.numFVarChannels = 1;
        descriptor.fvarChannels = &channel;
    }
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(descriptor, Factory::Options(cage.scheme, cage.options)));
}

CageExtent extent_of(const Cage& cage) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    CageExtent extent;
    for (int index : cage.face_points) {
        const Vec3& point = cage.points[index];
        const double coordinates[3] = {point.x, point.y, point.z};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], coordinates[axis]);
            high[axis] = std::max(high[axis], coordinates[axis]);
            extent.max_coordinate = std::max(extent.max_coordinate, std::fabs(coordinates[axis]));
        }
    }
    extent.diagonal = length({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    if (cage.face_points.empty() || !(extent.diagonal > 0))
        fail("the mesh has no extent");
    return extent;
}

static void print_error(Far::ErrorType, const char* message) {
    fprintf(stderr, "OpenSubdiv error: %s\n", message);
}

static void print_warning(const char* message) {
    if (getenv("OSD_WARN"))
        fprintf(stderr, "OpenSubdiv warning: %s\n", message);
}

void report_opensubdiv_errors() {
    Far::SetErrorCallback(print_error);
    Far::SetWarningCallback(print_warning);
}
