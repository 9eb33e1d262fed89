#include "samples.h"

#include "../shared/fail.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>

#include <cstdio>
#include <vector>

void write_channel(Imf::MultiPartInputFile& file, int part, const std::string& channel, const std::string& path) {
    const Imf::Header& header = file.header(part);
    const Imf::Channel* found = header.channels().findChannel(channel);
    if (!found)
        fail("there is no channel " + channel + " in part " + std::to_string(part));
    const size_t size = found->type == Imf::HALF ? 2 : 4;
    const Imath::Box2i window = header.dataWindow();
    const size_t width = (size_t)(window.max.x - window.min.x) + 1, height = (size_t)(window.max.y - window.min.y) + 1;
    std::vector<char> samples(width * height * size);

    Imf::FrameBuffer buffer;
    buffer.insert(channel, Imf::Slice::Make(found->type, samples.data(), window, size, width * size));
    Imf::InputPart input(file, part);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);

    FILE* out = fopen(path.c_str(), "wb");
    if (!out || fwrite(samples.data(), 1, samples.size(), out) != samples.size() || fclose(out) != 0)
        fail("cannot write " + path);
}
