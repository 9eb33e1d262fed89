#pragma once

#include <ImfMultiPartInputFile.h>

#include <string>

// Writes the samples of a channel in the data window to a file, of the size that they are stored with.
void write_channel(Imf::MultiPartInputFile& file, int part, const std::string& channel, const std::string& path);
