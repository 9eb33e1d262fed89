#include "image.h"

#include "../shared/fail.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

static std::string rows_from_the_top(const Image& image, const std::string& row_prefix) {
    const size_t row_size = (size_t)image.width * 3;
    std::string rows;
    for (int y = image.height - 1; y >= 0; --y) {
        rows += row_prefix;
        rows.append((const char*)&image.rgb[y * row_size], row_size);
    }
    return rows;
}

static std::string big_endian(uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += (char)(value >> shift);
    return bytes;
}

// The CRC-32 of PNG and zlib, bit by bit: an image is written once a run.
static uint32_t crc32(const std::string& bytes) {
    uint32_t crc = ~0u;
    for (unsigned char byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static uint32_t adler32(const std::string& bytes) {
    uint32_t a = 1, b = 0;
    for (unsigned char byte : bytes) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

// A zlib stream of stored blocks: no compressor needed.
static std::string zlib_stored(const std::string& bytes) {
    const size_t largest_block = 65535;
    std::string stream = "\x78\x01";
    for (size_t first = 0; first < bytes.size();) {
        const size_t size = std::min(largest_block, bytes.size() - first);
        const bool is_last = first + size == bytes.size();
        const char header[5] = {(char)is_last, (char)size, (char)(size >> 8), (char)~size, (char)(~size >> 8)};
        stream.append(header, sizeof header);
        stream.append(bytes, first, size);
        first += size;
    }
    return stream + big_endian(adler32(bytes));
}

static std::string png_chunk(const std::string& type, const std::string& data) {
    return big_endian((uint32_t)data.size()) + type + data + big_endian(crc32(type + data));
}

static std::string png(const Image& image) {
    const std::string header = big_endian(image.width) + big_endian(image.height) +
                               // 8 bits, colour, deflate, adaptive filters, not interlaced
                               std::string("\x08\x02\x00\x00\x00", 5);
    const std::string no_filter(1, '\0');
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
           png_chunk("IDAT", zlib_stored(rows_from_the_top(image, no_filter))) + png_chunk("IEND", "");
}

static std::string ppm(const Image& image) {
    return "P6\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n" +
           rows_from_the_top(image, "");
}

void write_image(const std::string& path, const Image& image) {
    const bool is_png = path.size() >= 4 && path.compare(path.size() - 4, 4, ".png") == 0;
    const std::string bytes = is_png ? png(image) : ppm(image);
    FILE* file = fopen(path.c_str(), "wb");
    if (!file)
        fail("cannot write " + path);
    const bool written = fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (fclose(file) || !written)
        fail("cannot write " + path);
}
