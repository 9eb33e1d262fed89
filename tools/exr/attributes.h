#pragma once

#include <ImfMultiPartInputFile.h>

#include <string>

// {"parts":[{"attributes":{NAME:{"type","value"}},"channels":{NAME:TYPE}}]}; values of types unknown here are null.
std::string json_of(const Imf::MultiPartInputFile& file);
