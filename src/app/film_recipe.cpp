#include "app/film_recipe.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <span>

#include "app/film.hpp"
#include "exec/error.hpp"
#include "io/digest.hpp"
#include "io/json.hpp"
#include "report/packed_bytes.hpp"

namespace breccia::app {
namespace {

constexpr std::string_view mark = "breccia-film:";
constexpr std::size_t most_parts = 1000;      // of a picture
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

Image grid(const std::vector<Image>& images, int columns) {
  const auto count = static_cast<int>(images.size());
  const int rows = (count + columns - 1) / columns;
  const int width = images.front().width, height = images.front().height;
  Image whole{columns * width, rows * height, {}};
  const auto line = static_cast<std::ptrdiff_t>(3 * whole.width);
  whole.rgb.assign(static_cast<std::size_t>(line * whole.height), 255);
  for (int i = 0; i < count; ++i)
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* const from =
          &images[static_cast<std::size_t>(i)].rgb[static_cast<std::size_t>(3 * y * width)];
      std::copy_n(
          from, 3 * width,
          whole.rgb.begin() + line * ((i / columns) * height + y) + 3 * (i % columns) * width);
    }
  return whole;
}

std::string digest_of_pixels(const Image& image) {
  return digest_text(digest(std::as_bytes(std::span(image.rgb))));
}

std::string text_of(const FilmRecipe& recipe) {
  Json json{{"columns", recipe.columns},
            {"pictures", Json::array()},
            {"pixels", recipe.pixels},
            {"runs", Json::array()}};
  for (const std::vector<PngNote>& notes : recipe.runs) json["runs"].push_back(json_of(notes));
  for (const std::vector<RecipePart>& picture : recipe.pictures) {
    Json parts = Json::array();
    for (const RecipePart& part : picture)
      parts.push_back({{"notes", json_of(part.notes)}, {"run", part.run}});
    json["pictures"].push_back(std::move(parts));
  }
  return json_text(json);
}

FilmRecipe recipe_of_text(const std::string& text, const std::string& path) {
  const auto damaged = [&] { return InputError(path + ": the recipe in it is damaged"); };
  try {
    const Json json = read_json(text);
    FilmRecipe recipe;
    recipe.columns = json.at("columns").get<int>();
    recipe.pixels = json.at("pixels").get<std::vector<std::string>>();
    for (const Json& notes : json.at("runs")) recipe.runs.push_back(notes_in(notes));
    const int runs = static_cast<int>(recipe.runs.size());
    for (const Json& parts : json.at("pictures")) {
      std::vector<RecipePart>& picture = recipe.pictures.emplace_back();
      for (const Json& part : parts) {
        picture.push_back({part.at("run").get<int>(), notes_in(part.at("notes"))});
        if (picture.back().run < 0 || picture.back().run >= runs) throw damaged();
      }
      if (picture.empty() || picture.size() > most_parts) throw damaged();
    }
    if (recipe.pictures.empty() || recipe.columns < 1 || recipe.columns > int(most_parts))
      throw damaged();
    return recipe;
  } catch (const Json::exception&) {
    throw damaged();
  }
}

std::string comment_of(const FilmRecipe& recipe) {
  const std::string text = text_of(recipe);
  std::string comment = fmt::format("{}{}:", mark, text.size());
  for (const char byte : report::deflated(text))
    comment += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text.size() <= most_bytes ? comment : "";
}

FilmRecipe recipe_in(const std::string& content, const std::string& path) {
  const std::string comments = path.ends_with(".gif") ? gif_comments(content) : "";
  const std::string_view text = path.ends_with(".gif") ? comments : content;
  const std::size_t begin = text.find(mark);
  if (begin == std::string_view::npos)
    throw InputError(path +
                     ": it does not say how it can be made again; films and drawings by `render` "
                     "do, unless another program has changed them");
  const auto damaged = [&] { return InputError(path + ": the recipe in it is damaged"); };
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
  return recipe_of_text(unpacked, path);
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
