#include "sample.h"

bool normal_of(const Sample& sample, double diagonal, Vec3& normal) {
    const Vec3 product = cross(sample.tangent_u, sample.tangent_v);
    const double length_u = length(sample.tangent_u), length_v = length(sample.tangent_v);
    const double area = length(product);
    // A tangent this short is rounding of positions; a sine this small is rounding of tangents.
    const double vanishing = 1e-12 * diagonal * sample.scale;
    if (!(length_u > vanishing) || !(length_v > vanishing) || !(area > 1e-7 * length_u * length_v))
        return false;
    normal = {product.x / area, product.y / area, product.z / area};
    return true;
}
