#include "scene/values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace turbid {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

template <class Number>
bool parse_whole(std::string_view text, Number& number) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// The sRGB transfer function of IEC 61966-2-1, decoded.
double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

Spectrum read_hex_colour(std::string_view text, const SourceLocation& where) {
  unsigned bits = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), bits, 16);
  if (text.size() != 7 || error != std::errc() || end != text.data() + text.size())
    throw SceneError(where, "'" + std::string(text) + "' is not a colour, expected #rrggbb or one or three numbers");
  Spectrum result;
  for (int c = 0; c < 3; ++c) result[c] = static_cast<float>(srgb_to_linear(((bits >> (16 - 8 * c)) & 255) / 255.0));
  return result;
}

}  // namespace

std::vector<std::string> split_words(std::string_view text) {
  constexpr std::string_view kSeparators = ", \t\r\n";
  std::vector<std::string> words;
  for (size_t at = 0; (at = text.find_first_not_of(kSeparators, at)) != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kSeparators, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

double read_number(std::string_view text, const SourceLocation& where) {
  double number = 0;
  if (!parse_whole(text, number)) throw SceneError(where, "'" + std::string(text) + "' is not a number");
  // Numbers end up as floats.
  if (!std::isfinite(number) || std::abs(number) > static_cast<double>(std::numeric_limits<float>::max()))
    throw SceneError(where, "'" + std::string(text) + "' is not a finite number");
  return number;
}

std::vector<double> read_numbers(std::string_view text, const SourceLocation& where) {
  std::vector<double> numbers;
  for (const std::string& word : split_words(text)) numbers.push_back(read_number(word, where));
  return numbers;
}

int64_t read_integer(std::string_view text, const SourceLocation& where) {
  int64_t number = 0;
  if (!parse_whole(text, number)) throw SceneError(where, "'" + std::string(text) + "' is not an integer");
  return number;
}

bool read_boolean(std::string_view text, const SourceLocation& where) {
  std::string word(trimmed(text));
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  if (word == "true") return true;
  if (word == "false") return false;
  throw SceneError(where, "'" + std::string(text) + "' is not a boolean, expected true or false");
}

Imath::V3d read_vector(std::string_view text, const SourceLocation& where) {
  const std::vector<double> v = read_numbers(text, where);
  if (v.size() == 1) return {v[0], v[0], v[0]};
  if (v.size() != 3) throw SceneError(where, "expected 1 or 3 numbers, found " + std::to_string(v.size()));
  return {v[0], v[1], v[2]};
}

Spectrum read_rgb(std::string_view text, const SourceLocation& where) {
  if (const std::string_view word = trimmed(text); word.starts_with('#')) return read_hex_colour(word, where);
  const Imath::V3d v = read_vector(text, where);
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace turbid
