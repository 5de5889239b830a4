// Encoding of the texts in vector files.
#pragma once

#include <string>

class GDALDataset;

namespace thawslide::gis {

// True for a Shapefile without a .cpg file whose .dbf file states the code page "ANSI", which means little, or none.
[[nodiscard]] bool has_unknown_encoding(GDALDataset& dataset);

// A text that is not UTF-8 is read as Windows-1252, which includes the letters of Latin-1. Letters are composed.
[[nodiscard]] std::string as_utf8(const std::string& text);

}  // namespace thawslide::gis
