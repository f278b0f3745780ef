#include "io/vtu_writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <span>

#include "exec/error.hpp"

namespace breccia {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

constexpr std::size_t block_size = 1 << 18;  // bytes before compression
constexpr int compression_level = 1;         // level 6 saves 10 % of the size for 5 times the time

template <class T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
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

/// The XML head and the binary tail of a file under construction.
class Document {
 public:
  void line(const std::string& text) { head_ += text + "\n"; }

  template <class T>
  void array(const std::string& attributes, std::span<const T> values, const std::string& unit) {
    const std::string tag = fmt::format(R"(<DataArray type="{}" {} format="appended" offset="{}")",
                                        type_name<T>(), attributes, tail_.size());
    if (unit.empty()) {
      line(tag + "/>");
    } else {
      line(tag + ">");
      line(R"(<InformationKey name="UNITS_LABEL" location="vtkDataArray">)" + escaped(unit) +
           "</InformationKey>");
      line("</DataArray>");
    }
    append(std::as_bytes(values));
  }

  std::string content() const {
    return head_ + "<AppendedData encoding=\"raw\">\n_" + tail_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  void append_number(std::uint64_t number) {
    tail_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }

  /// Number of blocks, their size, size of the last if it is shorter, compressed sizes, blocks.
  void append(std::span<const std::byte> bytes) {
    std::string packed;
    std::vector<std::uint64_t> sizes;
    for (std::size_t start = 0; start < bytes.size(); start += block_size) {
      const std::size_t size = std::min(block_size, bytes.size() - start);
      uLongf packed_size = compressBound(static_cast<uLong>(size));
      const std::size_t place = packed.size();
      packed.resize(place + packed_size);
      const int status = compress2(reinterpret_cast<Bytef*>(packed.data() + place), &packed_size,
                                   reinterpret_cast<const Bytef*>(bytes.data() + start),
                                   static_cast<uLong>(size), compression_level);
      if (status != Z_OK) throw DeviceError("no memory to compress a frame");
      packed.resize(place + packed_size);
      sizes.push_back(packed_size);
    }
    append_number(sizes.size());
    append_number(block_size);
    append_number(bytes.size() % block_size);
    for (const std::uint64_t size : sizes) append_number(size);
    tail_ += packed;
  }

  std::string head_, tail_;
};

void write_field_data(Document& document, const Frame& frame) {
  document.line("<FieldData>");
  document.array<double>(R"(Name="TIME" NumberOfTuples="1")", std::span(&frame.time, 1), "s");
  document.array<std::int64_t>(R"(Name="CYCLE" NumberOfTuples="1")", std::span(&frame.step, 1), "");
  if (!frame.groups.empty()) {
    std::string codes;
    for (const std::string& name : frame.groups) {
      for (const char c : name) codes += fmt::format("{} ", static_cast<unsigned char>(c));
      codes += "0 ";
    }
    document.line(fmt::format(
        R"(<Array type="String" Name="groups" NumberOfTuples="{}" format="ascii">{}</Array>)",
        frame.groups.size(), codes));
  }
  document.line("</FieldData>");
}

void write_fields(Document& document, const std::vector<FrameField>& fields, std::size_t items) {
  for (const FrameField& field : fields) {
    if (field.values.size() != items * static_cast<std::size_t>(field.components)) {
      throw InputError(fmt::format("field {} has {} values for {} items of {}", field.name,
                                   field.values.size(), items, field.components));
    }
    document.array<float>(
        fmt::format(R"(Name="{}" NumberOfComponents="{}")", escaped(field.name), field.components),
        field.values, field.unit);
  }
}

void write_points(Document& document, const Frame& frame) {
  std::vector<float> coordinates;
  coordinates.reserve(3 * frame.position.size());
  for (const Vec3& point : frame.position) {
    for (const double c : {point.x, point.y, point.z}) {
      coordinates.push_back(static_cast<float>(c));
    }
  }
  document.line("<Points>");
  document.array<float>(R"(Name="Points" NumberOfComponents="3")", coordinates, "m");
  document.line("</Points>");
}

/// Points of the cells one after the other.
std::vector<std::int32_t> connectivity_of(const Frame& frame, VtuCells cells) {
  if (cells == VtuCells::lines) return frame.lines;
  if (cells == VtuCells::triangles) return frame.triangles;
  std::vector<std::int32_t> numbers(frame.position.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int32_t>(i);
  return numbers;
}

std::size_t points_a_cell(VtuCells cells) {
  return cells == VtuCells::lines ? 2 : cells == VtuCells::triangles ? 3 : 1;
}

void write_cells(Document& document, const std::vector<std::int32_t>& connectivity,
                 VtuCells cells) {
  const std::size_t width = points_a_cell(cells);
  std::vector<std::int32_t> ends(connectivity.size() / width);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    ends[i] = static_cast<std::int32_t>((i + 1) * width);
  }
  const std::vector<std::uint8_t> types(ends.size(), static_cast<std::uint8_t>(cells));
  document.line("<Cells>");
  document.array<std::int32_t>(R"(Name="connectivity")", connectivity, "");
  document.array<std::int32_t>(R"(Name="offsets")", ends, "");
  document.array<std::uint8_t>(R"(Name="types")", types, "");
  document.line("</Cells>");
}

}  // namespace

std::string vtu_content(const Frame& frame, VtuCells cells) {
  const std::vector<std::int32_t> connectivity = connectivity_of(frame, cells);
  const std::size_t cell_count = connectivity.size() / points_a_cell(cells);
  Document document;
  document.line(R"(<?xml version="1.0"?>)");
  document.line(R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" )"
                R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)");
  document.line("<UnstructuredGrid>");
  write_field_data(document, frame);
  document.line(fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)",
                            frame.position.size(), cell_count));
  document.line("<PointData>");
  if (cells != VtuCells::lines) {
    if (!frame.radius.empty()) {
      const std::vector<float> radius(frame.radius.begin(), frame.radius.end());
      write_fields(document, {{"radius", "m", 1, radius}}, frame.position.size());
    }
    write_fields(document, frame.point_fields, frame.position.size());
  }
  document.line("</PointData>");
  document.line("<CellData>");
  if (cells == VtuCells::lines) write_fields(document, frame.line_fields, cell_count);
  if (cells == VtuCells::triangles) write_fields(document, frame.triangle_fields, cell_count);
  document.line("</CellData>");
  write_points(document, frame);
  write_cells(document, connectivity, cells);
  document.line("</Piece>");
  document.line("</UnstructuredGrid>");
  return document.content();
}

}  // namespace breccia
