#include "ply.h"

#include "fail.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

namespace {

enum class Scalar { none, i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
    std::string name;
    Scalar type = Scalar::none;
    // Of a list's length; none: no list.
    Scalar length_type = Scalar::none;
    bool is_list() const { return length_type != Scalar::none; }
};

struct Element {
    std::string name;
    size_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    bool ascii = false;
    std::vector<Element> elements;
};

Scalar scalar_of(const std::string& name) {
    static const std::map<std::string, Scalar> scalars = {
        {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
        {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
        {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
        {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64}};
    auto found = scalars.find(name);
    if (found == scalars.end())
        fail("PLY: unknown type " + name);
    return found->second;
}

Property read_property(std::istream& words) {
    Property property;
    std::string type, length_type;
    words >> type;
    if (type == "list") {
        words >> length_type >> type;
        property.length_type = scalar_of(length_type);
    }
    property.type = scalar_of(type);
    words >> property.name;
    return property;
}

Header read_header(std::istream& in, const std::string& path) {
    Header header;
    std::string line;
    std::getline(in, line);
    if (line.compare(0, 3, "ply"))
        fail(path + " is no PLY file");
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "end_header")
            return header;
        if (key == "format") {
            std::string format;
            words >> format;
            header.ascii = format == "ascii";
            if (!header.ascii && format != "binary_little_endian")
                fail("PLY: unsupported format " + format);
        } else if (key == "element") {
            Element element;
            words >> element.name >> element.count;
            header.elements.push_back(element);
        } else if (key == "property") {
            if (header.elements.empty())
                fail("PLY: a property before the first element");
            header.elements.back().properties.push_back(read_property(words));
        }
    }
    fail("PLY: the header has no end");
}

// The numbers after the header, one by one.
class Body {
public:
    Body(std::istream& in, bool ascii)
        : bytes_(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()), next_(bytes_.data()),
          end_(next_ + bytes_.size()), ascii_(ascii) {}

    double read(Scalar type) {
        if (ascii_)
            return read_text();
        switch (type) {
        case Scalar::i8:
            return read_binary<int8_t>();
        case Scalar::u8:
            return read_binary<uint8_t>();
        case Scalar::i16:
            return read_binary<int16_t>();
        case Scalar::u16:
            return read_binary<uint16_t>();
        case Scalar::i32:
            return read_binary<int32_t>();
        case Scalar::u32:
            return read_binary<uint32_t>();
        case Scalar::f32:
            return read_binary<float>();
        default:
            return read_binary<double>();
        }
    }

    // Of a property, the list's values, or the one value.
    void read(const Property& property, std::vector<double>& values) {
        double length = property.is_list() ? read(property.length_type) : 1;
        values.clear();
        for (double i = 0; i < length; ++i)
            values.push_back(read(property.type));
    }

private:
    double read_text() {
        char* after = nullptr;
        double value = strtod(next_, &after);
        if (after == next_)
            fail("PLY: the file is cut short");
        next_ = after;
        return value;
    }

    template <class T>
    double read_binary() {
        if (end_ - next_ < (ptrdiff_t)sizeof(T))
            fail("PLY: the file is cut short");
        T value;
        memcpy(&value, next_, sizeof value);
        next_ += sizeof value;
        return (double)value;
    }

    std::string bytes_;
    const char* next_;
    const char* end_;
    bool ascii_;
};

template <class T>
PlyColumn<T>* find_column(std::vector<PlyColumn<T>>& columns, const Property& property) {
    for (PlyColumn<T>& column : columns)
        if (column.name == property.name && !property.is_list())
            return &column;
    return nullptr;
}

void read_vertices(Body& body, const Element& element, PlyFile& file) {
    file.vertex_count = element.count;
    std::vector<PlyColumn<float>*> float_columns;
    std::vector<PlyColumn<int64_t>*> integer_columns;
    for (const Property& property : element.properties) {
        float_columns.push_back(find_column(file.floats, property));
        integer_columns.push_back(find_column(file.integers, property));
        if (float_columns.back())
            float_columns.back()->present = true;
        if (integer_columns.back())
            integer_columns.back()->present = true;
    }
    std::vector<double> values;
    for (size_t i = 0; i < element.count; ++i)
        for (size_t k = 0; k < element.properties.size(); ++k) {
            body.read(element.properties[k], values);
            if (float_columns[k])
                float_columns[k]->values.push_back((float)values[0]);
            if (integer_columns[k])
                integer_columns[k]->values.push_back((int64_t)values[0]);
        }
}

void read_others(Body& body, const Element& element, PlyFile& file) {
    std::vector<double> values;
    for (size_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
            body.read(property, values);
            bool are_indices = property.name == "vertex_indices" || property.name == "vertex_index";
            if (element.name != "face" || !are_indices)
                continue;
            for (size_t k = 2; k < values.size(); ++k)
                for (double index : {values[0], values[k - 1], values[k]})
                    file.triangles.push_back((uint32_t)(int64_t)index);
        }
}

} // namespace

PlyFile read_ply(const std::string& path, const std::vector<std::string>& float_names,
                 const std::vector<std::string>& integer_names) {
    std::ifstream in(path, std::ios::binary);
    if (!in)
        fail("cannot read " + path);
    PlyFile file;
    for (const std::string& name : float_names)
        file.floats.push_back({name, false, {}});
    for (const std::string& name : integer_names)
        file.integers.push_back({name, false, {}});

    Header header = read_header(in, path);
    Body body(in, header.ascii);
    for (const Element& element : header.elements) {
        if (element.name == "vertex")
            read_vertices(body, element, file);
        else
            read_others(body, element, file);
    }
    return file;
}
