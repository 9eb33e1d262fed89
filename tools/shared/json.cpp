#include "json.h"

#include <cmath>
#include <cstdio>

static std::string formatted(double value, const char* format) {
    if (!std::isfinite(value))
        return "null";
    char text[64];
    snprintf(text, sizeof text, format, value);
    return text;
}

JsonObject& JsonObject::json(const char* name, const std::string& value) {
    if (!fields_.empty())
        fields_ += ",";
    fields_ += "\"" + std::string(name) + "\":" + value;
    return *this;
}

JsonObject& JsonObject::count(const char* name, size_t value) {
    return json(name, std::to_string(value));
}

JsonObject& JsonObject::integer(const char* name, long value) {
    return json(name, std::to_string(value));
}

JsonObject& JsonObject::number(const char* name, double value, const char* format) {
    return json(name, formatted(value, format));
}

JsonObject& JsonObject::boolean(const char* name, bool value) {
    return json(name, value ? "true" : "false");
}

JsonObject& JsonObject::text(const char* name, const std::string& value) {
    return json(name, "\"" + value + "\"");
}

std::string json_array(const double* values, size_t count, const char* format) {
    std::string array = "[";
    for (size_t i = 0; i < count; ++i)
        array += (i ? "," : "") + formatted(values[i], format);
    return array + "]";
}
