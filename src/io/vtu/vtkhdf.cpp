#include "io/vtu/vtkhdf.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

#ifdef BR_HDF5

#include <hdf5.h>
#include <zlib.h>

#include "io/vtu/hdf_handle.hpp"
#include "io/vtu/hdf_index.hpp"
#include "io/vtu/hdf_memory.hpp"

namespace breccia {

hid_t hdf_type(FrameNumber type) {
  switch (type) {
    case FrameNumber::float32:
      return H5T_IEEE_F32LE;
    case FrameNumber::float64:
      return H5T_IEEE_F64LE;
    case FrameNumber::int32:
      return H5T_STD_I32LE;
    case FrameNumber::int64:
      return H5T_STD_I64LE;
    case FrameNumber::uint8:
      return H5T_STD_U8LE;
  }
  return H5T_STD_U8LE;
}

namespace {

/// HDF5 takes files in memory that have one name for one file.
std::string name_in_memory() {
  static std::int64_t count = 0;
  return "frame" + std::to_string(++count);
}

void must(bool good) {
  if (!good) throw DeviceError("HDF5 has no memory for a frame");
}
/// Throws where HDF5 answers with a negative number.
template <class Number>
Number made(Number number) {
  must(number >= 0);
  return number;
}

/// A text of fixed length, as VTK reads them.
void put_text(hid_t object, const char* name, const std::string& text) {
  const Handle type(made(H5Tcopy(H5T_C_S1)), H5Tclose);
  made(H5Tset_size(type.id(), text.size()));
  made(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
  const Handle space(made(H5Screate(H5S_SCALAR)), H5Sclose);
  const Handle text_of(
      made(H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT)), H5Aclose);
  made(H5Awrite(text_of.id(), type.id(), text.data()));
}

void put_version(hid_t root) {
  constexpr hsize_t two = 2;
  constexpr std::array<std::int64_t, 2> version{1, 0};
  const Handle space(made(H5Screate_simple(1, &two, nullptr)), H5Sclose);
  const Handle to(
      made(H5Acreate2(root, "Version", H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT)),
      H5Aclose);
  made(H5Awrite(to.id(), H5T_NATIVE_INT64, version.data()));
}

/// Lists of datasets and groups keep their order and hold no time of day.
Handle plain_group(hid_t parent, const char* name) {
  const Handle order(made(H5Pcreate(H5P_GROUP_CREATE)), H5Pclose);
  made(H5Pset_link_creation_order(order.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  made(H5Pset_obj_track_times(order.id(), false));
  return {made(H5Gcreate2(parent, name, H5P_DEFAULT, order.id(), H5P_DEFAULT)), H5Gclose};
}

void put_count(hid_t root, const char* name, std::size_t count) {
  constexpr hsize_t one = 1;
  const auto number = static_cast<std::int64_t>(count);
  const Handle space(made(H5Screate_simple(1, &one, nullptr)), H5Sclose);
  const Handle plain(made(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  made(H5Pset_obj_track_times(plain.id(), false));
  const Handle to(
      made(H5Dcreate2(root, name, H5T_STD_I64LE, space.id(), H5P_DEFAULT, plain.id(), H5P_DEFAULT)),
      H5Dclose);
  made(H5Dwrite(to.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &number));
}

/// VTKHDF's name of an array that is no field; others keep their names.
std::string vtkhdf_name(const std::string& name) {
  if (name == "connectivity") return "Connectivity";
  if (name == "offsets") return "Offsets";
  if (name == "types") return "Types";
  return name;
}
bool is_field(const std::string& section) {
  return section == "PointData" || section == "CellData" || section == "FieldData";
}

void put_array(hid_t group, const HdfArray& array) {
  const int rank = array.components > 1 ? 2 : 1;
  const std::array<hsize_t, 2> size{array.rows, array.components};
  const Handle space(made(H5Screate_simple(rank, size.data(), nullptr)), H5Sclose);
  const Handle how(made(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  made(H5Pset_obj_track_times(how.id(), false));
  if (!array.chunks.empty()) {
    const std::array<hsize_t, 2> chunk{array.chunk_rows, array.components};
    made(H5Pset_chunk(how.id(), rank, chunk.data()));
    made(H5Pset_deflate(how.id(), 1));
  }
  const std::string name = is_field(array.section) ? array.name : vtkhdf_name(array.name);
  const Handle to(made(H5Dcreate2(group, name.c_str(), hdf_type(array.type), space.id(),
                                  H5P_DEFAULT, how.id(), H5P_DEFAULT)),
                  H5Dclose);
  std::array<hsize_t, 2> place{0, 0};
  for (const std::string_view chunk : array.chunks) {
    made(H5Dwrite_chunk(to.id(), H5P_DEFAULT, 0, place.data(), chunk.size(), chunk.data()));
    place[0] += array.chunk_rows;
  }
  if (!array.unit.empty()) put_text(to.id(), "units", array.unit);
}

void put_grid(hid_t file, const HdfGrid& grid) {
  const Handle root = plain_group(file, "VTKHDF");
  put_version(root.id());
  put_text(root.id(), "Type", "UnstructuredGrid");
  put_count(root.id(), "NumberOfPoints", grid.points);
  put_count(root.id(), "NumberOfCells", grid.cells);
  put_count(root.id(), "NumberOfConnectivityIds", grid.corners);
  const Handle fields[] = {plain_group(root.id(), "FieldData"), plain_group(root.id(), "PointData"),
                           plain_group(root.id(), "CellData")};
  for (const HdfArray& array : grid.arrays)
    put_array(array.section == "FieldData"   ? fields[0].id()
              : array.section == "PointData" ? fields[1].id()
              : array.section == "CellData"  ? fields[2].id()
                                             : root.id(),
              array);
}

class VtkhdfFile final : public FrameFile {
 public:
  explicit VtkhdfFile(const std::string& path) : FrameFile(path), content_(read_whole_file(path)) {
    try {
      entries_ = hdf_index(content_);
    } catch (const IoError& error) {
      fail(error.what());
    }
    points_ = count("NumberOfPoints");
    cells_ = count("NumberOfCells");
  }

  std::size_t points() const override { return points_; }
  std::size_t cells() const override { return cells_; }

  std::vector<double> numbers(const std::string& section, const std::string& name,
                              std::size_t items) const override {
    return values<double>(found(path_of(section, name)), items);
  }
  std::vector<std::int32_t> integers(const std::string& section, const std::string& name,
                                     std::size_t items) const override {
    const HdfEntry& entry = found(path_of(section, name));
    if (section != "Cells" || name != "offsets") return values<std::int32_t>(entry, items);
    std::vector<std::int32_t> ends = values<std::int32_t>(entry, items + 1);
    ends.erase(ends.begin());
    return ends;
  }
  std::vector<FrameField> fields(const std::string& section, std::size_t items) const override {
    std::vector<FrameField> result;
    for (const HdfEntry& entry : entries_) {
      if (!entry.path.starts_with(section + "/")) continue;
      FrameField& field = result.emplace_back(
          FrameField{entry.path.substr(section.size() + 1), entry.unit, components_of(entry), {}});
      field.values = values<float>(entry, items);
      if (entry.type == FrameNumber::int32) field.integers = values<std::int32_t>(entry, items);
    }
    return result;
  }
  std::vector<std::string> groups() const override {
    const std::vector<char> codes = field_data<char>("groups");
    return names_in({codes.begin(), codes.end()});
  }
  std::vector<double> walls(const std::string& name) const override {
    return field_data<double>(name);
  }

 private:
  static std::string path_of(const std::string& section, const std::string& name) {
    return is_field(section) ? section + "/" + name : vtkhdf_name(name);
  }

  const HdfEntry* find(const std::string& path) const {
    const auto at = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const HdfEntry& entry) { return entry.path == path; });
    return at == entries_.end() ? nullptr : &*at;
  }
  const HdfEntry& found(const std::string& path) const {
    const HdfEntry* const entry = find(path);
    if (entry == nullptr) fail("has no " + path);
    return *entry;
  }
  [[noreturn]] void damaged(const HdfEntry& entry) const {
    fail("array " + entry.path + (entry.problem.empty() ? " is damaged" : " " + entry.problem));
  }
  int components_of(const HdfEntry& entry) const {
    if (entry.components < 1 || entry.components > 64) damaged(entry);
    return static_cast<int>(entry.components);
  }

  std::string_view piece(const HdfEntry& entry, std::size_t number) const {
    if (number >= entry.pieces.size()) damaged(entry);
    const HdfPiece& at = entry.pieces[number];
    if (at.begin > content_.size() || at.size > content_.size() - at.begin) damaged(entry);
    return std::string_view(content_).substr(at.begin, at.size);
  }

  /// Bytes of an array as the file holds them, of `item` bytes a number.
  std::string bytes_of(const HdfEntry& entry, std::size_t item) const {
    const std::size_t row = item * static_cast<std::size_t>(components_of(entry));
    // zlib packs by 1032 at most
    const auto forged = [&](std::uint64_t rows) { return rows / 1100 > content_.size() / row; };
    if (!entry.problem.empty() || forged(entry.rows) || forged(entry.chunk_rows)) damaged(entry);
    const std::size_t size = entry.rows * row;
    if (size == 0) return "";
    if (entry.chunk_rows == 0) {
      const std::string_view whole = piece(entry, 0);
      if (whole.size() != size) damaged(entry);
      return std::string(whole);
    }
    std::string bytes(size, '\0'), unpacked;
    for (std::size_t first = 0; first < entry.rows; first += entry.chunk_rows) {
      const std::size_t rows = std::min<std::size_t>(entry.chunk_rows, entry.rows - first);
      std::string_view chunk = piece(entry, first / entry.chunk_rows);
      // The last chunk is full in files of other programs; this one's ends with the array.
      if (entry.packed) {
        unpacked.resize(entry.chunk_rows * row);
        chunk = unpack(chunk, unpacked);
      }
      if (chunk.size() < rows * row) damaged(entry);
      chunk.copy(bytes.data() + first * row, rows * row);
    }
    return bytes;
  }
  /// @returns nothing, which is too little, if that cannot be unpacked
  static std::string_view unpack(std::string_view from, std::string& to) {
    uLongf size = to.size();
    const bool good =
        ::uncompress(reinterpret_cast<Bytef*>(to.data()), &size,
                     reinterpret_cast<const Bytef*>(from.data()), from.size()) == Z_OK;
    return {to.data(), good ? size : 0};
  }

  template <class From, class To>
  static std::vector<To> converted(const std::string& bytes) {
    std::vector<From> from(bytes.size() / sizeof(From));
    if (!from.empty()) std::memcpy(from.data(), bytes.data(), from.size() * sizeof(From));
    if constexpr (std::is_same_v<From, To>) return from;
    std::vector<To> result(from.size());
    std::transform(from.begin(), from.end(), result.begin(),
                   [](From value) { return as<To>(value); });
    return result;
  }
  /// Whole numbers end at the bounds of To, as HDF5 converts them; bytes of a text stay bytes.
  template <class To, class From>
  static To as(From value) {
    if constexpr (std::is_integral_v<To> && sizeof(To) > 1 && sizeof(From) > 1) {
      using Limits = std::numeric_limits<To>;
      if (!(value > static_cast<From>(Limits::min()))) return Limits::min();
      if (value >= static_cast<From>(Limits::max())) return Limits::max();
    }
    return static_cast<To>(value);
  }

  template <class T>
  std::vector<T> values(const HdfEntry& entry, std::size_t rows) const {
    if (entry.rows != rows) damaged(entry);
    switch (entry.type) {
      case FrameNumber::float32:
        return converted<float, T>(bytes_of(entry, 4));
      case FrameNumber::float64:
        return converted<double, T>(bytes_of(entry, 8));
      case FrameNumber::int32:
        return converted<std::int32_t, T>(bytes_of(entry, 4));
      case FrameNumber::int64:
        return converted<std::int64_t, T>(bytes_of(entry, 8));
      case FrameNumber::uint8:
        break;
    }
    return converted<std::uint8_t, T>(bytes_of(entry, 1));
  }
  template <class T>
  std::vector<T> field_data(const std::string& name) const {
    const HdfEntry* const entry = find("FieldData/" + name);
    return entry == nullptr ? std::vector<T>{} : values<T>(*entry, entry->rows);
  }

  std::size_t count(const char* name) const {
    const std::int64_t number = values<std::int64_t>(found(name), 1).front();  // of one part
    if (number < 0 || number > std::int64_t{1} << 40)
      fail(std::string("its ") + name + " is damaged");
    return static_cast<std::size_t>(number);
  }

  std::string content_;
  std::vector<HdfEntry> entries_;
  std::size_t points_ = 0, cells_ = 0;
};

}  // namespace

bool has_hdf5() {
  return true;
}

std::string vtkhdf_content(const HdfGrid& grid) {
  const std::lock_guard lock(hdf_door());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle access(made(H5Pcreate(H5P_FILE_ACCESS)), H5Pclose);
  made(H5Pset_fapl_core(access.id(), 1 << 20, false));  // in memory, nothing on the disk
  const Handle create(made(H5Pcreate(H5P_FILE_CREATE)), H5Pclose);
  made(H5Pset_obj_track_times(create.id(), false));
  const Handle file(
      made(H5Fcreate(name_in_memory().c_str(), H5F_ACC_TRUNC, create.id(), access.id())), H5Fclose);
  put_grid(file.id(), grid);
  made(H5Fflush(file.id(), H5F_SCOPE_GLOBAL));
  const auto size = static_cast<std::size_t>(made(H5Fget_file_image(file.id(), nullptr, 0)));
  std::string content(size, '\0');
  made(H5Fget_file_image(file.id(), content.data(), size));
  return content;
}

std::unique_ptr<FrameFile> open_vtkhdf(const std::string& path) {
  return std::make_unique<VtkhdfFile>(path);
}

}  // namespace breccia

#else

namespace breccia {

bool has_hdf5() {
  return false;
}

std::string vtkhdf_content(const HdfGrid&) {
  throw InputError("this program is built without HDF5 (package libhdf5-dev)");
}

std::unique_ptr<FrameFile> open_vtkhdf(const std::string& path) {
  throw IoError(path + ": cannot read: this program is built without HDF5 (package libhdf5-dev)");
}

}  // namespace breccia

#endif
