#include "app/film_recipe.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/film.hpp"
#include "exec/error.hpp"
#include "io/digest.hpp"
#include "report/packed_bytes.hpp"

namespace breccia::app {
namespace {

using Json = nlohmann::json;

constexpr std::string_view mark = "breccia-film:";
constexpr std::size_t longest = 100'000;      // of a comment: an argument of a program
constexpr std::size_t most_bytes = 16 << 20;  // of a recipe, unpacked

Json json_of(const std::vector<PngNote>& notes) {
  Json json = Json::array();
  for (const PngNote& note : notes) json.push_back({note.keyword, note.text});
  return json;
}
std::vector<PngNote> notes_in(const Json& json) {
  std::vector<PngNote> notes;
  for (const Json& note : json)
    notes.push_back({note.at(0).get<std::string>(), note.at(1).get<std::string>()});
  return notes;
}

bool hex_digits(std::string_view text, std::string& bytes) {
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    unsigned value = 0;
    const char* const end = text.data() + i + 2;
    const auto [stop, error] = std::from_chars(text.data() + i, end, value, 16);
    if (error != std::errc{} || stop != end) return false;
    bytes += static_cast<char>(value);
  }
  return text.size() % 2 == 0;
}

/// The content of a GIF's comments without the lengths of their pieces (GIF89a, section 24).
std::string gif_comments(const std::string& gif) {
  std::string text;
  for (std::size_t at = gif.find("\x21\xfe"); at != std::string::npos;
       at = gif.find("\x21\xfe", at)) {
    at += 2;
    while (at < gif.size() && gif[at] != '\0') {
      const auto length = static_cast<unsigned char>(gif[at]);
      text += gif.substr(at + 1, length);
      at += 1 + std::size_t{length};
    }
    if (text.find(mark) != std::string::npos) break;
  }
  return text;
}

}  // namespace

std::string digest_of_pixels(const Image& image) {
  return digest_text(digest(std::as_bytes(std::span(image.rgb))));
}

void FilmRecipe::add(std::vector<PngNote> notes, const Image& image) {
  pictures.push_back(std::move(notes));
  pixels.push_back(digest_of_pixels(image));
}

std::string comment_of(const FilmRecipe& recipe) {
  Json json{{"run", json_of(recipe.run)}, {"pixels", recipe.pixels}};
  json["pictures"] = Json::array();
  for (const std::vector<PngNote>& notes : recipe.pictures)
    json["pictures"].push_back(json_of(notes));
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string comment = fmt::format("{}{}:", mark, text.size());
  for (const char byte : report::deflated(text))
    comment += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return comment.size() < longest ? comment : "";
}

FilmRecipe film_recipe_in(const std::string& content, const std::string& path) {
  const std::string comments = path.ends_with(".gif") ? gif_comments(content) : "";
  const std::string_view text = path.ends_with(".gif") ? comments : content;
  const std::size_t begin = text.find(mark);
  if (begin == std::string_view::npos)
    throw InputError(path +
                     ": the film does not say how it can be made again; films of one run by "
                     "`render` do, unless they are very long or another program has changed them");
  const auto damaged = [&] { return InputError(path + ": the recipe in the film is damaged"); };
  const char* const from = text.data() + begin + mark.size();
  std::size_t size = 0;
  const auto [colon, error] = std::from_chars(from, text.data() + text.size(), size);
  if (error != std::errc{} || size > most_bytes || colon == text.data() + text.size() ||
      *colon != ':')
    throw damaged();
  std::string_view digits = text.substr(static_cast<std::size_t>(colon + 1 - text.data()));
  digits = digits.substr(0, digits.find_first_not_of("0123456789abcdef"));
  std::string packed;
  if (!hex_digits(digits.substr(0, digits.size() / 2 * 2), packed)) throw damaged();
  std::string unpacked(size, '\0');
  auto got = static_cast<uLongf>(size);
  if (uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &got,
                 reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      got != size)
    throw damaged();
  try {
    const Json json = Json::parse(unpacked);
    FilmRecipe recipe;
    recipe.run = notes_in(json.at("run"));
    recipe.pixels = json.at("pixels").get<std::vector<std::string>>();
    for (const Json& notes : json.at("pictures")) recipe.pictures.push_back(notes_in(notes));
    if (recipe.pictures.empty() || recipe.pictures.size() != recipe.pixels.size()) throw damaged();
    return recipe;
  } catch (const Json::exception&) {
    throw damaged();
  }
}

FilmReader::FilmReader(const std::string& path, int width, int height)
    : size_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      pipe_(decoded(path, width, height)) {}

FilmReader::~FilmReader() {
  ::pclose(pipe_);
}

std::vector<std::uint8_t> FilmReader::next() {
  std::vector<std::uint8_t> bytes(size_);
  if (std::fread(bytes.data(), 1, size_, pipe_) != size_) bytes.clear();
  return bytes;
}

}  // namespace breccia::app
