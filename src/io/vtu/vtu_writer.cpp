#include "io/vtu/vtu_writer.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "exec/error.hpp"
#include "exec/tasks.hpp"
#include "io/vtu/tensors.hpp"

namespace breccia {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

constexpr std::size_t block_size = 1 << 18;  // bytes before compression
constexpr const char* field_data = "FieldData";
/// The head of the data. VTK 9.0 to 9.3 reads it in pieces of `read_size` bytes and takes it for
/// finished when it has seen this tag closed; with expat from 2.6 on, and Debian's 2.5.0-1+deb12u2,
/// it sees that in time only if a piece ends behind the name, and the tag is 42 to 49 bytes long.
constexpr std::string_view data_name = "<AppendedData";
constexpr std::string_view data_rest = "                  encoding=\"raw\">\n_";
constexpr std::size_t read_size = 4096;
constexpr int compression_level = 1;  // as small as zlib's level 1 in 2/5 of its time

template <class T>
constexpr FrameNumber type_of() {
  if constexpr (std::is_same_v<T, float>) return FrameNumber::float32;
  if constexpr (std::is_same_v<T, double>) return FrameNumber::float64;
  if constexpr (std::is_same_v<T, std::int32_t>) return FrameNumber::int32;
  if constexpr (std::is_same_v<T, std::int64_t>) return FrameNumber::int64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return FrameNumber::uint8;
}
const char* name_of(FrameNumber type) {
  constexpr const char* names[] = {"Float32", "Float64", "Int32", "Int64", "UInt8"};
  return names[static_cast<std::size_t>(type)];
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void append_number(std::string& text, std::uint64_t number) {
  text.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// In the format of zlib.
std::string packed_block(std::span<const std::byte> bytes) {
  using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
  const Compressor compressor(libdeflate_alloc_compressor(compression_level),
                              &libdeflate_free_compressor);
  if (!compressor) throw DeviceError("no memory to compress a frame");
  std::string packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                         packed.data(), packed.size()));
  return packed;
}

}  // namespace

FrameFormat frame_format(const std::string& word) {
  if (word != "vtkhdf") return FrameFormat::vtu;
  if (!has_hdf5())
    throw InputError(
        "vtkhdf: this program is built without HDF5 (package libhdf5-dev); \"vtu\" goes without");
  return FrameFormat::vtkhdf;
}

FramePlaces places_in(const Frame& whole) {
  FramePlaces places;
  places.whole = true;
  places.has_spheres = !whole.radius.empty();
  places.points = static_cast<std::int64_t>(whole.position.size());
  places.lines = static_cast<std::int64_t>(whole.lines.size() / 2);
  places.triangles = static_cast<std::int64_t>(whole.triangles.size() / 3);
  places.tetrahedra = static_cast<std::int64_t>(whole.tetrahedra.size() / 4);
  return places;
}

FrameBlocks::FrameBlocks(const Frame& part, const FramePlaces& places, FrameFormat format)
    : part_(part),
      places_(places),
      format_(format),
      radius_(part.radius.begin(), part.radius.end()),
      triangle_fields_(tensors_joined(part.triangle_fields)),
      tetrahedron_fields_(tensors_joined(part.tetrahedron_fields)) {
  coordinates_.reserve(3 * part.position.size());
  for (const Vec3& point : part.position)
    for (const double c : {point.x, point.y, point.z})
      coordinates_.push_back(static_cast<float>(c));
  time_ = add_made<double>(1, [time = part.time](std::size_t) { return time; });
  step_ = add_made<std::int64_t>(1, [step = part.step](std::size_t) { return step; });
  points_ = add_carried(Carrier::points, 3, std::span<const float>(coordinates_));
  if (places.tetrahedra > 0) {
    if (places.lines > 0) throw InputError("a frame of tetrahedra has triangles for its joints");
    list(elements_, Cells::tetrahedra);
    list(links_, Cells::triangles);
    return;
  }
  list(elements_, places.triangles == 0 ? Cells::vertices : Cells::triangles);
  list(links_, Cells::lines);
}

std::size_t FrameBlocks::items(Carrier carrier) const {
  return static_cast<std::size_t>(places_.count(carrier));
}
std::size_t FrameBlocks::own_items(Carrier carrier) const {
  return places_.whole ? items(carrier) : places_.of(carrier).size();
}

std::size_t FrameBlocks::add(Array array) {
  array.first_block = blocks_.size();
  // A chunk of HDF5 has whole items.
  array.block_bytes =
      format_ == FrameFormat::vtu ? block_size : block_size / array.width * array.width;
  for (std::size_t begin = 0; begin < array.bytes; begin += array.block_bytes)
    blocks_.push_back({arrays_.size(), begin, std::min(array.block_bytes, array.bytes - begin)});
  arrays_.push_back(std::move(array));
  return arrays_.size() - 1;
}
template <class Number>
std::size_t FrameBlocks::add_carried(Carrier carrier, std::size_t width,
                                     std::span<const Number> own) {
  const std::size_t bytes = width * sizeof(Number);
  return add({carrier, bytes, bytes * items(carrier), std::as_bytes(own), {}, 0, 0});
}
/// Number i of the array is value(i).
template <class Number, class Value>
std::size_t FrameBlocks::add_made(std::size_t count, const Value& value, std::size_t components) {
  const auto make = [value](std::size_t begin, std::span<std::byte> to) {
    for (std::size_t done = 0; done < to.size(); done += sizeof(Number)) {
      const auto number = static_cast<Number>(value((begin + done) / sizeof(Number)));
      std::memcpy(to.data() + done, &number, sizeof number);
    }
  };
  return add({Carrier::none, components * sizeof(Number), count * sizeof(Number), {}, make, 0, 0});
}

void FrameBlocks::place(Document& document, Entry entry) {
  std::string& head = document.text.back();
  head +=
      fmt::format(R"(<DataArray type="{}" Name="{}" )", name_of(entry.type), escaped(entry.name));
  if (entry.components > 1) head += fmt::format(R"(NumberOfComponents="{}" )", entry.components);
  if (entry.section == field_data) head += fmt::format(R"(NumberOfTuples="{}" )", entry.rows);
  head += R"(format="appended" offset=")";
  if (entry.unit.empty())
    document.text.emplace_back("\"/>\n");
  else
    document.text.emplace_back(
        "\">\n"
        R"(<InformationKey name="UNITS_LABEL" location="vtkDataArray">)" +
        escaped(entry.unit) + "</InformationKey>\n</DataArray>\n");
  document.entries.push_back(std::move(entry));
}

/// Names of the bodies as numbers, each ended by 0: readers other than VTK's know no arrays of
/// texts.
void FrameBlocks::list_groups(Document& document) {
  if (part_.groups.empty()) return;
  std::string codes;
  for (const std::string& name : part_.groups) codes += name + '\0';
  if (format_ == FrameFormat::vtkhdf) {
    const std::size_t count = codes.size();
    const auto code = [codes](std::size_t i) { return static_cast<unsigned char>(codes[i]); };
    place(document, {field_data, "groups", "", type_of<std::uint8_t>(), count, 1,
                     add_made<std::uint8_t>(count, code)});
    return;
  }
  std::string& head = document.text.back();
  head += fmt::format(
      R"(<DataArray type="UInt8" Name="groups" NumberOfTuples="{}" format="ascii">)", codes.size());
  for (const char code : codes) head += fmt::format("{} ", static_cast<unsigned char>(code));
  head += "</DataArray>\n";
}

/// Planes without end by point and normal; the others by their triangles.
void FrameBlocks::list_walls(Document& document) {
  std::vector<double> planes, triangles;
  const auto add = [](std::vector<double>& to, const Vec3& v) {
    to.insert(to.end(), {v.x, v.y, v.z});
  };
  for (const FrameWall& wall : part_.walls) {
    for (const Vec3& corner : wall.corners) add(triangles, corner);
    if (!wall.corners.empty()) continue;
    add(planes, wall.point);
    add(planes, wall.normal);
  }
  const auto list = [&](const char* name, const std::vector<double>& numbers, std::size_t width) {
    if (numbers.empty()) return;
    const auto number = [numbers](std::size_t i) { return numbers[i]; };
    place(document, {field_data, name, "", type_of<double>(), numbers.size() / width, width,
                     add_made<double>(numbers.size(), number, width)});
  };
  list("walls", planes, 6);
  list("wall_triangles", triangles, 9);
}

void FrameBlocks::list_field_data(Document& document) {
  document.text.back() += "<FieldData>\n";
  place(document, {field_data, "TIME", "s", type_of<double>(), 1, 1, time_});
  place(document, {field_data, "CYCLE", "", type_of<std::int64_t>(), 1, 1, step_});
  list_groups(document);
  list_walls(document);
  document.text.back() += "</FieldData>\n";
}

void FrameBlocks::list_fields(Document& document, const std::vector<FrameField>& fields,
                              Carrier carrier) {
  for (const FrameField& field : fields) {
    const auto width = static_cast<std::size_t>(field.components);
    if (field.integers)
      list_field(document, field.name, field.unit, width, *field.integers, carrier);
    else
      list_field(document, field.name, field.unit, width, field.values, carrier);
  }
}

template <class Number>
void FrameBlocks::list_field(Document& document, const std::string& name, const std::string& unit,
                             std::size_t width, const std::vector<Number>& values,
                             Carrier carrier) {
  if (values.size() != own_items(carrier) * width)
    throw InputError(fmt::format("field {} has {} values for {} items of {}", name, values.size(),
                                 own_items(carrier), width));
  place(document,
        {carrier == Carrier::points ? "PointData" : "CellData", name, unit, type_of<Number>(),
         items(carrier), width, add_carried(carrier, width, std::span<const Number>(values))});
}

FrameBlocks::CellKind FrameBlocks::kind_of(Cells cells) const {
  switch (cells) {
    case Cells::lines:
      return {Carrier::lines, 2, &part_.lines, &part_.line_fields};
    case Cells::triangles:
      return {Carrier::triangles, 3, &part_.triangles, &triangle_fields_};
    case Cells::tetrahedra:
      return {Carrier::tetrahedra, 4, &part_.tetrahedra, &tetrahedron_fields_};
    case Cells::vertices:
      break;
  }
  return {Carrier::points, 1, nullptr, nullptr};
}

void FrameBlocks::list_cells(Document& document, Cells cells) {
  const auto number = [](std::size_t i) { return i; };
  const auto [carrier, width, corners, fields] = kind_of(cells);
  const std::size_t connectivity =
      corners == nullptr ? add_made<std::int32_t>(items(Carrier::points), number)
                         : add_carried(carrier, width, std::span<const std::int32_t>(*corners));
  document.text.back() += "<Cells>\n";
  document.cells = items(carrier);
  document.corners = width * document.cells;
  const auto index = type_of<std::int32_t>();
  place(document, {"Cells", "connectivity", "", index, document.corners, 1, connectivity});
  // Behind each cell; VTKHDF has the first one's begin as well.
  const std::size_t first = format_ == FrameFormat::vtu ? 1 : 0;
  const std::size_t count = document.cells + 1 - first;
  const std::size_t ends = add_made<std::int32_t>(
      count, [first, corners_of = width](std::size_t i) { return (i + first) * corners_of; });
  place(document, {"Cells", "offsets", "", index, count, 1, ends});
  const std::size_t types =
      add_made<std::uint8_t>(items(carrier), [cells](std::size_t) { return cells; });
  place(document, {"Cells", "types", "", type_of<std::uint8_t>(), document.cells, 1, types});
  document.text.back() += "</Cells>\n";
}

void FrameBlocks::list(Document& document, Cells cells) {
  const CellKind kind = kind_of(cells);
  const Carrier carrier = kind.carrier;
  const bool joints = &document == &links_;
  document.text.back() =
      "<?xml version=\"1.0\"?>\n"
      R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" )"
      R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)"
      "\n<UnstructuredGrid>\n";
  list_field_data(document);
  document.text.back() += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                                      items(Carrier::points), items(carrier));
  document.text.back() += "<PointData>\n";
  if (!joints) {
    if (places_.has_spheres) list_field(document, "radius", "m", 1, radius_, Carrier::points);
    list_fields(document, part_.point_fields, Carrier::points);
  }
  document.text.back() += "</PointData>\n<CellData>\n";
  if (kind.fields != nullptr) list_fields(document, *kind.fields, carrier);
  document.text.back() += "</CellData>\n<Points>\n";
  place(document, {"Points", "Points", "m", type_of<float>(), items(Carrier::points), 3, points_});
  document.text.back() += "</Points>\n";
  list_cells(document, cells);
  document.text.back() += "</Piece>\n</UnstructuredGrid>\n";
}

std::string FrameBlocks::packed(const Block& block) const {
  const Array& array = arrays_[block.array];
  if (array.carrier != Carrier::none)
    return packed(block, array.own.subspan(block.begin, block.size));
  std::vector<std::byte> made(block.size);
  array.make(block.begin, made);
  return packed(block, made);
}
std::string FrameBlocks::packed(const Block& block, std::span<const std::byte> bytes) const {
  const Array& array = arrays_[block.array];
  const bool is_short = bytes.size() < array.block_bytes && block.begin > 0;
  if (format_ == FrameFormat::vtu || !is_short) return packed_block(bytes);
  std::vector<std::byte> filled(array.block_bytes);  // the last chunk of HDF5 is as long as any
  std::copy(bytes.begin(), bytes.end(), filled.begin());
  return packed_block(filled);
}

std::string FrameBlocks::hdf_content(const Document& document,
                                     const std::vector<std::string>& packed) const {
  HdfGrid grid{items(Carrier::points), document.cells, document.corners, {}};
  for (const Entry& entry : document.entries) {
    const Array& array = arrays_[entry.array];
    HdfArray& to = grid.arrays.emplace_back(
        HdfArray{entry.section, entry.name, entry.unit, entry.type, entry.rows, entry.components});
    to.chunk_rows = std::min(
        entry.rows, array.block_bytes /
                        (array.bytes / std::max<std::size_t>(entry.rows, 1) + (array.bytes == 0)));
    for (std::size_t begin = 0, b = array.first_block; begin < array.bytes;
         begin += array.block_bytes)
      to.chunks.emplace_back(packed[b++]);
  }
  return vtkhdf_content(grid);
}

/// Behind the head each array: number of blocks, their size, size of the last if it is shorter,
/// compressed sizes, blocks.
std::string FrameBlocks::content(const Document& document,
                                 const std::vector<std::string>& packed) const {
  if (format_ == FrameFormat::vtkhdf) return hdf_content(document, packed);
  const auto each_block = [&](const Array& array, auto&& visit) {
    for (std::size_t begin = 0, b = array.first_block; begin < array.bytes; begin += block_size)
      visit(packed[b++]);
  };
  std::string content;
  std::uint64_t offset = 0;
  for (std::size_t k = 0; k < document.entries.size(); ++k) {
    content += document.text[k] + std::to_string(offset);
    offset += 3 * sizeof offset;
    each_block(arrays_[document.entries[k].array],
               [&](const std::string& block) { offset += sizeof offset + block.size(); });
  }
  const std::string end = "\n</AppendedData>\n</VTKFile>\n";
  content += document.text.back();
  content.append(read_size - 1 - (content.size() + data_name.size() - 1) % read_size, ' ');
  content += data_name;
  content += data_rest;
  content.reserve(content.size() + offset + end.size());
  for (const Entry& entry : document.entries) {
    const Array& array = arrays_[entry.array];
    append_number(content, (array.bytes + block_size - 1) / block_size);
    append_number(content, block_size);
    append_number(content, array.bytes % block_size);
    each_block(array, [&](const std::string& block) { append_number(content, block.size()); });
    each_block(array, [&](const std::string& block) { content += block; });
  }
  return content + end;
}

FrameContents FrameBlocks::contents(const std::vector<std::string>& packed) const {
  return {part_.time, content(elements_, packed), content(links_, packed)};
}

FrameContents contents_of(const Frame& whole, int threads, FrameFormat format) {
  const FramePlaces places = places_in(whole);
  const FrameBlocks files(whole, places, format);
  const std::vector<FrameBlocks::Block>& blocks = files.blocks();
  std::vector<std::string> packed(blocks.size());
  for_each_task(threads, static_cast<int>(blocks.size()), [&](int i) {
    const auto b = static_cast<std::size_t>(i);
    packed[b] = files.packed(blocks[b]);
  });
  return files.contents(packed);
}

}  // namespace breccia
