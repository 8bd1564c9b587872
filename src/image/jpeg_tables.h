#pragma once
#include <string_view>

namespace turbid {

/// False when a Huffman table of a JPEG file claims more than 256 codes, which no table can have: stb_image would write
/// past the end of its table. True for files of other kinds.
bool has_sound_huffman_tables(std::string_view bytes);

}  // namespace turbid
