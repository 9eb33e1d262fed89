#pragma once

#include <string>
#include <vector>

// Red, green and blue, 8 bits each; rows from the bottom up, as GL reads them.
struct Image {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

// PNG (uncompressed) where the name says so, else PPM.
void write_image(const std::string& path, const Image& image);
