#include "attributes.h"

#include "../shared/json.h"

#include <ImfBoxAttribute.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompressionAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfLineOrderAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <cstdio>
#include <vector>

namespace {

// Digits with which every float is read back as it was.
const char* const float_format = "%.9g";

std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (char c : text) {
        char escaped[8];
        if (c == '"' || c == '\\') {
            json += {'\\', c};
        } else if ((unsigned char)c < 0x20) {
            snprintf(escaped, sizeof escaped, "\\u%04x", c);
            json += escaped;
        } else {
            json += c;
        }
    }
    return json + "\"";
}

template <class Vec>
void append(std::vector<double>& numbers, const Vec& point) {
    numbers.push_back(point.x);
    numbers.push_back(point.y);
}

// The numbers of an attribute; none where it has no such type.
std::vector<double> numbers_of(const Imf::Attribute& attribute) {
    std::vector<double> numbers;
    if (auto integer = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
        numbers = {(double)integer->value()};
    } else if (auto real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
        numbers = {real->value()};
    } else if (auto rational = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
        numbers = {(double)rational->value().n, (double)rational->value().d};
    } else if (auto vector = dynamic_cast<const Imf::V2fAttribute*>(&attribute)) {
        append(numbers, vector->value());
    } else if (auto box = dynamic_cast<const Imf::Box2iAttribute*>(&attribute)) {
        append(numbers, box->value().min);
        append(numbers, box->value().max);
    } else if (auto matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
        for (int i = 0; i < 16; ++i)
            numbers.push_back(matrix->value()[i / 4][i % 4]);
    } else if (auto primaries = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
        const Imf::Chromaticities& value = primaries->value();
        for (const Imath::V2f& point : {value.red, value.green, value.blue, value.white})
            append(numbers, point);
    } else if (auto compression = dynamic_cast<const Imf::CompressionAttribute*>(&attribute)) {
        numbers = {(double)compression->value()};
    } else if (auto order = dynamic_cast<const Imf::LineOrderAttribute*>(&attribute)) {
        numbers = {(double)order->value()};
    }
    return numbers;
}

std::string value_of(const Imf::Attribute& attribute) {
    if (auto text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
        return quoted(text->value());
    std::vector<double> numbers = numbers_of(attribute);
    return numbers.empty() ? "null" : json_array(numbers.data(), numbers.size(), float_format);
}

// As the format's documents call it.
const char* name_of(Imf::PixelType type) {
    switch (type) {
    case Imf::UINT:
        return "uint";
    case Imf::HALF:
        return "half";
    default:
        return "float";
    }
}

std::string json_of(const Imf::Header& header) {
    std::string attributes, channels;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        JsonObject attribute;
        attribute.text("type", entry.attribute().typeName()).json("value", value_of(entry.attribute()));
        attributes += (attributes.empty() ? "" : ",") + quoted(entry.name()) + ":" + attribute.str();
    }
    for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry)
        channels += (channels.empty() ? "" : ",") + quoted(entry.name()) + ":" + quoted(name_of(entry.channel().type));
    return JsonObject().json("attributes", "{" + attributes + "}").json("channels", "{" + channels + "}").str();
}

} // namespace

std::string json_of(const Imf::MultiPartInputFile& file) {
    std::string parts;
    for (int part = 0; part < file.parts(); ++part)
        parts += (part ? "," : "") + json_of(file.header(part));
    return JsonObject().json("parts", "[" + parts + "]").str();
}
