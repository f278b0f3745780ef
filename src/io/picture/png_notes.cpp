#include "io/picture/png_notes.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t around = 12;       // length, type and check sum of a chunk  [bytes]
constexpr std::size_t header_end = 33;   // signature and IHDR
constexpr std::size_t most = 16u << 20;  // of texts, unpacked  [bytes]

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16 & 255),
          static_cast<char>(value >> 8 & 255), static_cast<char>(value & 255)};
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::uint32_t check_sum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string chunk(const PngNote& note) {
  uLongf size = ::compressBound(note.text.size());
  std::string packed(size, '\0');
  ::compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(note.text.data()), note.text.size());
  packed.resize(size);
  // Keyword; compressed, by deflate; no language; no translated keyword.
  const std::string data = note.keyword + std::string("\0\1\0\0\0", 5) + packed;
  return big_endian(static_cast<std::uint32_t>(data.size())) + "iTXt" + data +
         big_endian(check_sum("iTXt" + data));
}

/// Unpacks into `text`, up to `room` bytes; false if it is damaged or longer.
bool unpack(std::string_view packed, std::size_t room, std::string& text) {
  for (std::size_t size = 4096 + 4 * packed.size();; size *= 4) {
    uLongf length = std::min(size, room);
    text.assign(length, '\0');
    const int code = ::uncompress(reinterpret_cast<Bytef*>(text.data()), &length,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (code == Z_BUF_ERROR && size < room) continue;
    text.resize(code == Z_OK ? length : 0);
    return code == Z_OK;
  }
}

/// Cuts off and returns what stands before the next zero byte; false if there is none.
bool take_word(std::string_view& data, std::string& word) {
  const std::size_t end = data.find('\0');
  if (end == std::string_view::npos) return false;
  word = data.substr(0, end);
  data.remove_prefix(end + 1);
  return true;
}

/// The text of an iTXt chunk's data; false if it is damaged.
bool read(std::string_view data, std::size_t room, PngNote& note) {
  std::string language, translated;
  if (!take_word(data, note.keyword) || data.size() < 2) return false;
  const bool packed = data[0] != 0;
  data.remove_prefix(2);
  if (!take_word(data, language) || !take_word(data, translated)) return false;
  if (packed) return unpack(data, room, note.text);
  note.text = data;
  return note.text.size() <= room;
}

}  // namespace

std::string with_notes(const std::string& png, const std::vector<PngNote>& notes) {
  if (png.size() < header_end) return png;
  std::string chunks;
  for (const PngNote& one : notes) chunks += chunk(one);
  return png.substr(0, header_end) + chunks + png.substr(header_end);
}

std::vector<PngNote> notes_of(const std::string& png, const std::string& path) {
  if (!png.starts_with(signature)) throw InputError(path + ": this is no PNG picture");
  std::vector<PngNote> notes;
  std::size_t room = most;
  std::string_view rest = std::string_view(png).substr(signature.size());
  while (!rest.empty()) {
    const std::size_t length = rest.size() < around ? 0 : big_endian(rest);
    if (rest.size() < around || length > rest.size() - around)
      throw InputError(path + ": the picture is cut off");
    const std::string_view body = rest.substr(4, 4 + length);
    if (body.starts_with("iTXt")) {
      PngNote one;
      if (check_sum(body) != big_endian(rest.substr(8 + length)) ||
          !read(body.substr(4), room, one))
        throw InputError(path + ": a text in the picture is damaged or too long");
      room -= one.text.size();
      notes.push_back(std::move(one));
    }
    rest.remove_prefix(around + length);
  }
  return notes;
}

std::string note(const std::vector<PngNote>& notes, const std::string& keyword) {
  for (const PngNote& one : notes)
    if (one.keyword == keyword) return one.text;
  return {};
}

}  // namespace breccia
