#include "io/vtu/vtu_reader.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>

#include "exec/error.hpp"
#include "io/frame_pair.hpp"
#include "io/json.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/tensors.hpp"
#include "io/vtu/vtkhdf.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

/// One tag of an XML file and the text behind it, up to the next tag.
struct Tag {
  std::string_view name;  ///< "/Piece" for an end
  std::map<std::string, std::string, std::less<>> attributes;
  std::string_view text;
};

std::string unescaped(std::string_view text) {
  constexpr std::pair<std::string_view, char> signs[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}};
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    bool replaced = false;
    for (const auto& [code, sign] : signs) {
      if (text.substr(i, code.size()) != code) continue;
      result += sign;
      i += code.size();
      replaced = true;
      break;
    }
    if (!replaced) result += text[i++];
  }
  return result;
}

/// The XML that ParaviewSeries writes: no comments, no > inside attributes.
std::vector<Tag> tags_of(std::string_view xml) {
  std::vector<Tag> tags;
  std::size_t open = xml.find('<');
  while (open != std::string_view::npos) {
    const std::size_t close = xml.find('>', open);
    if (close == std::string_view::npos) break;
    const std::size_t next = xml.find('<', close);
    const std::string_view inside = xml.substr(open + 1, close - open - 1);
    Tag tag;
    tag.name = inside.substr(0, inside.find_first_of(" \n/", 1));
    std::size_t place = inside.find(' ');
    while (place != std::string_view::npos) {
      const std::size_t start = inside.find_first_not_of(" \n", place);
      const std::size_t quote = inside.find("=\"", place);
      if (start == std::string_view::npos || quote == std::string_view::npos) break;
      const std::size_t end = inside.find('"', quote + 2);
      if (end == std::string_view::npos) break;
      tag.attributes.emplace(inside.substr(start, quote - start),
                             unescaped(inside.substr(quote + 2, end - quote - 2)));
      place = end + 1;
    }
    tag.text = xml.substr(close + 1, next == std::string_view::npos ? next : next - close - 1);
    tags.push_back(std::move(tag));
    open = next;
  }
  return tags;
}

/// A .vtu file in memory.
class VtuFile final : public FrameFile {
 public:
  explicit VtuFile(const std::string& path) : FrameFile(path), content_(read_whole_file(path)) {
    const std::string_view content(content_);
    const std::size_t end = content.find("<AppendedData");
    const std::size_t start = content.find('_', end);
    if (end == std::string_view::npos || start == std::string_view::npos) fail("has no data");
    tail_ = content.substr(start + 1);
    read_tags(tags_of(content.substr(0, end)));
  }

  std::size_t points() const override { return points_; }
  std::size_t cells() const override { return cells_; }

  std::vector<double> numbers(const std::string& section, const std::string& name,
                              std::size_t items) const override {
    return array<double>(section, name, items);
  }
  std::vector<std::int32_t> integers(const std::string& section, const std::string& name,
                                     std::size_t items) const override {
    return array<std::int32_t>(section, name, items);
  }

  std::vector<FrameField> fields(const std::string& section, std::size_t items) const override {
    std::vector<FrameField> result;
    for (const Array& array : arrays_) {
      if (array.section != section) continue;
      FrameField& field = result.emplace_back(
          FrameField{array.name, array.unit, array.components, values<float>(array, items)});
      if (array.type == "Int32") field.integers = values<std::int32_t>(array, items);
    }
    return result;
  }

  std::vector<std::string> groups() const override { return groups_; }

  std::vector<double> walls(const std::string& name) const override {
    const int width = name == "walls" ? 6 : 9;
    for (const Array& array : arrays_)
      if (array.section == "FieldData" && array.name == name && array.components == width &&
          array.tuples < 1U << 20)
        return values<double>(array, array.tuples);
    return {};
  }

 private:
  struct Array {
    std::string section, name, type, unit;
    int components;
    std::size_t offset, tuples;
  };

  template <class T>
  std::vector<T> array(const std::string& section, const std::string& name,
                       std::size_t items) const {
    for (const Array& array : arrays_) {
      if (array.section == section && array.name == name) return values<T>(array, items);
    }
    fail("has no " + section + " " + name);
  }

  std::size_t number(const Tag& tag, const std::string& name, std::size_t otherwise) const {
    const auto found = tag.attributes.find(name);
    if (found == tag.attributes.end()) return otherwise;
    std::size_t value = 0;
    const std::string& text = found->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > 1ULL << 40) {
      fail("its " + name + " is damaged");
    }
    return value;
  }

  static std::string word(const Tag& tag, const std::string& name) {
    const auto found = tag.attributes.find(name);
    return found == tag.attributes.end() ? "" : found->second;
  }

  void read_tags(const std::vector<Tag>& tags) {
    std::string section;
    for (const Tag& tag : tags) {
      if (tag.name == "Piece") {
        points_ = number(tag, "NumberOfPoints", 0);
        cells_ = number(tag, "NumberOfCells", 0);
      } else if (word(tag, "Name") == "groups" && section == "FieldData") {
        read_groups(tag.text);  // older files have an array of texts there
      } else if (tag.name == "DataArray") {
        const std::size_t components = number(tag, "NumberOfComponents", 1);
        if (components < 1 || components > 64) fail("its NumberOfComponents is damaged");
        arrays_.push_back({section, word(tag, "Name"), word(tag, "type"), "",
                           static_cast<int>(components), number(tag, "offset", 0),
                           number(tag, "NumberOfTuples", 0)});
      } else if (tag.name == "InformationKey" && !arrays_.empty()) {
        arrays_.back().unit = unescaped(tag.text);
      } else if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points" ||
                 tag.name == "Cells" || tag.name == "FieldData") {
        section = tag.name;
      }
    }
  }

  void read_groups(std::string_view codes) {
    std::string name;
    const char* place = codes.data();
    const char* const end = codes.data() + codes.size();
    while (place != end) {
      unsigned code = 0;
      const auto [stop, error] = std::from_chars(place, end, code);
      if (error != std::errc()) {
        ++place;
        continue;
      }
      place = stop;
      if (code != 0) {
        name += static_cast<char>(code);
        continue;
      }
      groups_.push_back(name);
      name.clear();
    }
  }

  std::uint64_t number_at(std::size_t place) const {
    if (place > tail_.size() || tail_.size() - place < sizeof(std::uint64_t)) fail("it is cut off");
    std::uint64_t value = 0;
    std::memcpy(&value, tail_.data() + place, sizeof value);
    return value;
  }

  /// Unpacks an array that must have `size` bytes.
  std::string bytes_of(const Array& array, std::size_t size) const {
    const std::uint64_t blocks = number_at(array.offset);
    const std::uint64_t block_size = number_at(array.offset + 8);
    const std::uint64_t header = 8 * (3 + blocks);
    const bool fits = blocks <= tail_.size() / 8 && block_size > 0 && block_size < 1U << 30 &&
                      (size + block_size - 1) / block_size == blocks &&
                      size / 1100 <= tail_.size();  // zlib packs by 1032 at most
    if (!fits) fail("array " + array.name + " is damaged");
    std::string bytes(size, '\0');
    std::size_t place = array.offset + header;
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const std::uint64_t packed = number_at(array.offset + 8 * (3 + block));
      if (place > tail_.size() || packed > tail_.size() - place) fail("it is cut off");
      const std::size_t start = block * block_size;
      const std::size_t wanted = std::min<std::size_t>(block_size, size - start);
      auto unpacked = static_cast<uLongf>(wanted);
      const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data() + start), &unpacked,
                                    reinterpret_cast<const Bytef*>(tail_.data() + place),
                                    static_cast<uLong>(packed));
      if (status != Z_OK || unpacked != wanted) fail("array " + array.name + " is damaged");
      place += packed;
    }
    return bytes;
  }

  template <class Stored, class T>
  std::vector<T> converted(const Array& array, std::size_t count) const {
    const std::string bytes = bytes_of(array, count * sizeof(Stored));
    std::vector<T> result(count);
    for (std::size_t i = 0; i < count; ++i) {
      Stored value;
      std::memcpy(&value, bytes.data() + i * sizeof(Stored), sizeof(Stored));
      result[i] = static_cast<T>(value);
    }
    return result;
  }

  template <class T>
  std::vector<T> values(const Array& array, std::size_t items) const {
    const std::size_t count = items * static_cast<std::size_t>(array.components);
    if (array.type == "Float32") return converted<float, T>(array, count);
    if (array.type == "Float64") return converted<double, T>(array, count);
    if (array.type == "Int32") return converted<std::int32_t, T>(array, count);
    if (array.type == "Int64") return converted<std::int64_t, T>(array, count);
    fail("array " + array.name + " has numbers of type " + array.type);
  }

  std::string content_;
  std::string_view tail_;
  std::size_t points_ = 0, cells_ = 0;
  std::vector<Array> arrays_;
  std::vector<std::string> groups_;
};

std::unique_ptr<FrameFile> opened(const std::string& path) {
  if (path.ends_with(".hdf")) return open_vtkhdf(path);
  return std::make_unique<VtuFile>(path);
}

std::vector<std::int32_t> connectivity(const FrameFile& file, std::size_t points_a_cell) {
  std::vector<std::int32_t> numbers =
      file.integers("Cells", "connectivity", points_a_cell * file.cells());
  for (const std::int32_t number : numbers) {
    if (number < 0 || static_cast<std::size_t>(number) >= file.points()) {
      file.fail("a cell names a point that does not exist");
    }
  }
  return numbers;
}

/// Corners of each cell; the first one speaks for all.
int corners_of_cells(const FrameFile& file) {
  if (file.cells() == 0) return 0;
  return file.integers("Cells", "offsets", file.cells()).front();
}

/// Times and files of a collection.
struct Entry {
  double time;
  std::string file;
};
std::vector<Entry> entries_of_pvd(const std::string& path) {
  const std::string content = read_whole_file(path);
  std::vector<Entry> entries;
  for (const Tag& tag : tags_of(content)) {
    if (tag.name != "DataSet") continue;
    const auto time = tag.attributes.find("timestep"), file = tag.attributes.find("file");
    Entry entry{};
    bool good = time != tag.attributes.end() && file != tag.attributes.end();
    if (good) {
      const std::string& text = time->second;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), entry.time);
      good = error == std::errc() && std::isfinite(entry.time);
      entry.file = file->second;
    }
    if (!good) throw IoError(path + ": cannot read: an entry has no time or no file");
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<Entry> entries_of_series(const std::string& path) {
  const Json json = read_json(read_whole_file(path));
  const auto fail = [&]() -> IoError { return IoError(path + ": cannot read: it is no series"); };
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) throw fail();
  std::vector<Entry> entries;
  for (const Json& file : json["files"]) {
    const bool good = file.is_object() && file.contains("name") && file["name"].is_string() &&
                      file.contains("time") && file["time"].is_number();
    if (!good) throw fail();
    entries.push_back({file["time"].get<double>(), file["name"].get<std::string>()});
  }
  return entries;
}

std::vector<Entry> entries_of(const std::string& folder, const std::string& kind) {
  if (!holds_frames(folder))
    throw IoError(folder + (std::filesystem::is_directory(folder)
                                ? ": cannot be read: there are no frames of a run in this folder"
                                : ": cannot be read: there is no such folder"));
  if (format_of_frames(folder) == FrameFormat::vtkhdf)
    return entries_of_series(folder + "/" + kind + ".hdf.series");
  return entries_of_pvd(folder + "/" + kind + ".pvd");
}

}  // namespace

bool holds_frames(const std::string& folder) {
  return std::filesystem::exists(folder + "/elements.pvd") ||
         std::filesystem::exists(folder + "/elements.hdf.series");
}

FrameFormat format_of_frames(const std::string& folder) {
  return std::filesystem::exists(folder + "/elements.hdf.series") ? FrameFormat::vtkhdf
                                                                  : FrameFormat::vtu;
}

std::vector<double> frame_times(const std::string& folder) {
  std::vector<double> times;
  for (const Entry& entry : entries_of(folder, "elements")) times.push_back(entry.time);
  return times;
}

namespace {

/// A frame of two kinds of files: bodies, and what joins them.
Frame read_kinds(const std::string& folder, int index, const char* bodies, const char* joints) {
  const std::vector<Entry> entries = entries_of(folder, bodies);
  if (index < 0 || static_cast<std::size_t>(index) >= entries.size()) {
    throw InputError(fmt::format("frame {} does not exist: {} holds {} frames, counted from 0",
                                 index, folder, entries.size()));
  }
  const auto number = static_cast<std::size_t>(index);
  const std::unique_ptr<FrameFile> file = opened(folder + "/" + entries[number].file);
  const FrameFile& elements = *file;
  Frame frame;
  frame.time = elements.numbers("FieldData", "TIME", 1).front();
  frame.step = static_cast<std::int64_t>(elements.numbers("FieldData", "CYCLE", 1).front());
  frame.groups = elements.groups();
  const auto walls = elements.walls("walls"), ended = elements.walls("wall_triangles");
  for (std::size_t i = 0; i + 5 < walls.size(); i += 6)
    frame.walls.push_back(
        {{walls[i], walls[i + 1], walls[i + 2]}, {walls[i + 3], walls[i + 4], walls[i + 5]}});
  if (!ended.empty()) frame.walls.emplace_back();
  for (std::size_t i = 0; i + 8 < ended.size(); i += 9)
    for (std::size_t k = i; k < i + 9; k += 3)
      frame.walls.back().corners.push_back({ended[k], ended[k + 1], ended[k + 2]});
  const auto coordinates = elements.numbers("Points", "Points", elements.points());
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3) {
    frame.position.push_back({coordinates[i], coordinates[i + 1], coordinates[i + 2]});
  }
  frame.point_fields = elements.fields("PointData", elements.points());
  if (!frame.point_fields.empty() && frame.point_fields.front().name == "radius") {
    const std::vector<float>& radius = frame.point_fields.front().values;
    frame.radius.assign(radius.begin(), radius.end());
    frame.point_fields.erase(frame.point_fields.begin());
  }
  const int corners = corners_of_cells(elements);
  if (corners == 3) {
    frame.triangles = connectivity(elements, 3);
    frame.triangle_fields = tensors_parted(elements.fields("CellData", elements.cells()), true);
  } else if (corners == 4) {
    frame.tetrahedra = connectivity(elements, 4);
    frame.tetrahedron_fields = tensors_parted(elements.fields("CellData", elements.cells()), false);
  }
  const std::vector<Entry> link_entries = entries_of(folder, joints);
  if (number < link_entries.size()) {
    const std::unique_ptr<FrameFile> other = opened(folder + "/" + link_entries[number].file);
    const FrameFile& links = *other;
    if (links.points() != elements.points()) links.fail("it has other points than the elements");
    const bool solid = !frame.tetrahedra.empty();
    (solid ? frame.triangles : frame.lines) = connectivity(links, solid ? 3 : 2);
    (solid ? frame.triangle_fields : frame.line_fields) = links.fields("CellData", links.cells());
  }
  return frame;
}

bool lists(const std::string& folder, const std::string& kind) {
  const char* const list = format_of_frames(folder) == FrameFormat::vtu ? ".pvd" : ".hdf.series";
  return std::filesystem::exists(folder + "/" + kind + list);
}

std::vector<FrameContact> read_contacts(const std::string& folder, int index, const char* kind) {
  const std::vector<Entry> entries = entries_of(folder, kind);
  const auto number = static_cast<std::size_t>(index);
  if (number >= entries.size()) return {};
  const std::unique_ptr<FrameFile> file = opened(folder + "/" + entries[number].file);
  const std::size_t count = file->cells();
  std::vector<FrameContact> contacts(count);
  if (count == 0) return contacts;
  const std::vector<std::int32_t> ends = connectivity(*file, 2);
  const std::vector<double> place = file->numbers("Points", "Points", file->points()),
                            force = file->numbers("CellData", "force_on_b", count);
  const std::vector<std::int32_t> a = file->integers("CellData", "a", count),
                                  b = file->integers("CellData", "b", count),
                                  wall = file->integers("CellData", "wall", count);
  if (place.size() != 3 * file->points() || force.size() != 3 * count)
    file->fail("its points or forces are not vectors");
  const auto vector_at = [](const std::vector<double>& of, std::size_t i) {
    return Vec3{of[3 * i], of[3 * i + 1], of[3 * i + 2]};
  };
  for (std::size_t i = 0; i < count; ++i)
    contacts[i] = {a[i], wall[i] < 0 ? b[i] : -1 - wall[i],
                   vector_at(place, static_cast<std::size_t>(ends[2 * i])),
                   vector_at(place, static_cast<std::size_t>(ends[2 * i + 1])),
                   vector_at(force, i)};
  return contacts;
}

/// Adds the bolts, from the file that holds them.
void add_bolts(const std::string& folder, int index, Frame& frame) {
  if (!lists(folder, "bolts")) return;
  frame.bolted = true;
  const std::vector<Entry> entries = entries_of(folder, "bolts");
  const auto number = static_cast<std::size_t>(index);
  if (number >= entries.size()) return;
  const std::unique_ptr<FrameFile> file = opened(folder + "/" + entries[number].file);
  const std::size_t count = file->cells();
  if (count == 0) return;
  const std::vector<std::int32_t> ends = connectivity(*file, 2),
                                  bolt = file->integers("CellData", "bolt", count);
  const std::vector<double> place = file->numbers("Points", "Points", file->points()),
                            force = file->numbers("CellData", "force", count),
                            across = file->numbers("CellData", "across", count),
                            slip = file->numbers("CellData", "slip", count);
  if (place.size() != 3 * file->points() || force.size() != count || across.size() != count ||
      slip.size() != count)
    file->fail("its points are no vectors, or its forces are some");
  const auto point = [&](std::size_t i) {
    const auto from = 3 * static_cast<std::size_t>(ends[i]);
    return Vec3{place[from], place[from + 1], place[from + 2]};
  };
  for (std::size_t i = 0; i < count; ++i)
    frame.bars.push_back({point(2 * i), point(2 * i + 1), static_cast<float>(force[i]),
                          static_cast<float>(across[i]), static_cast<float>(slip[i]), bolt[i]});
}

}  // namespace

bool add_contacts_of(const std::string& folder, int index, Frame& frame) {
  if (!lists(folder, "contacts")) return false;
  frame.contacts = read_contacts(folder, index, "contacts");
  if (!lists(folder, contacts_of_solids)) return true;
  Frame solids;
  solids.contacts = read_contacts(folder, index, contacts_of_solids);
  join_contacts(frame, solids);
  return true;
}

Frame read_frame(const std::string& folder, int index) {
  Frame frame = read_kinds(folder, index, "elements", "links");
  if (lists(folder, frame_of_solids))
    frame = paired(frame, read_kinds(folder, index, frame_of_solids, joints_of_solids));
  add_bolts(folder, index, frame);
  return frame;
}

}  // namespace breccia
