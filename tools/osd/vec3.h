#pragma once

#include <cmath>

// Three doubles, with the two members through which OpenSubdiv interpolates.
struct Vec3 {
    double x = 0, y = 0, z = 0;

    void Clear(void* = nullptr) { x = y = z = 0; }
    void AddWithWeight(const Vec3& other, double weight) {
        x += weight * other.x;
        y += weight * other.y;
        z += weight * other.z;
    }
};
static_assert(sizeof(Vec3) == 3 * sizeof(double), "OpenSubdiv reads arrays of Vec3 as arrays of doubles");

inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double length(Vec3 a) {
    return std::sqrt(dot(a, a));
}

// In degrees, 0 to 180; accurate for small angles, and for vectors of any length but 0.
inline double angle_degrees(Vec3 a, Vec3 b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 57.29577951308232; // 180 / pi
}
