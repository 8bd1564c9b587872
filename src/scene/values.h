#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "scene/document.h"

namespace turbid {

/// Readers of the text in value="...". They throw SceneError at `where`, saying what was found and what was expected.

/// Words between spaces, tabs, line ends and commas.
std::vector<std::string> split_words(std::string_view text);

/// One number, nothing else; infinity and NaN are refused.
double read_number(std::string_view text, const SourceLocation& where);
/// Numbers between commas or spaces.
std::vector<double> read_numbers(std::string_view text, const SourceLocation& where);
int64_t read_integer(std::string_view text, const SourceLocation& where);
/// true or false, in any case of letters.
bool read_boolean(std::string_view text, const SourceLocation& where);
/// Three numbers, or one for all three.
Imath::V3d read_vector(std::string_view text, const SourceLocation& where);
/// Linear RGB: one or three numbers; or #rrggbb, which is sRGB-encoded.
Spectrum read_rgb(std::string_view text, const SourceLocation& where);

}  // namespace turbid
