#pragma once

#include <cstddef>
#include <string>

// A JSON object, written field by field in the order given. Names and texts must need no escaping.
class JsonObject {
public:
    JsonObject& count(const char* name, size_t value);
    JsonObject& integer(const char* name, long value);
    // With a printf format; null where the value is not finite.
    JsonObject& number(const char* name, double value, const char* format = "%.4g");
    JsonObject& boolean(const char* name, bool value);
    JsonObject& text(const char* name, const std::string& value);
    // A value that is JSON already.
    JsonObject& json(const char* name, const std::string& value);
    std::string str() const { return "{" + fields_ + "}"; }

private:
    std::string fields_;
};

// "[a,b,..]", with a printf format.
std::string json_array(const double* values, size_t count, const char* format);
