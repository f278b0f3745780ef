#include "io/vtu/vtkhdf.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

#ifdef BR_HDF5

#include <hdf5.h>
#include <zlib.h>

namespace breccia {
namespace {

/// HDF5 serves one thread at a time.
std::mutex& door() {
  static std::mutex mutex;
  return mutex;
}

/// HDF5 takes files in memory that have one name for one file.
std::string name_in_memory() {
  static std::int64_t count = 0;
  return "frame" + std::to_string(++count);
}

/// An object of HDF5, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void must(bool good) {
  if (!good) throw DeviceError("HDF5 has no memory for a frame");
}
/// Throws where HDF5 answers with a negative number.
template <class Number>
Number made(Number number) {
  must(number >= 0);
  return number;
}

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
    access_.emplace(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    file_.emplace(opened(), H5Fclose);
    if (!file_->good()) fail("it is no HDF5 file");
    points_ = count("NumberOfPoints");
    cells_ = count("NumberOfCells");
  }
  ~VtkhdfFile() override {
    const std::lock_guard lock(door());
    file_.reset();
    access_.reset();
  }

  std::size_t points() const override { return points_; }
  std::size_t cells() const override { return cells_; }

  std::vector<double> numbers(const std::string& section, const std::string& name,
                              std::size_t items) const override {
    const std::lock_guard lock(door());
    return values<double>(path_of(section, name), items);
  }
  std::vector<std::int32_t> integers(const std::string& section, const std::string& name,
                                     std::size_t items) const override {
    const std::lock_guard lock(door());
    if (section != "Cells" || name != "offsets")
      return values<std::int32_t>(path_of(section, name), items);
    std::vector<std::int32_t> ends = values<std::int32_t>(path_of(section, name), items + 1);
    ends.erase(ends.begin());
    return ends;
  }
  std::vector<FrameField> fields(const std::string& section, std::size_t items) const override {
    const std::lock_guard lock(door());
    std::vector<FrameField> result;
    for (const std::string& name : names(section)) {
      const std::string path = "/VTKHDF/" + section + "/" + name;
      const Array array = opened_array(path, items);
      FrameField& field =
          result.emplace_back(FrameField{name, unit(array.data), array.components, {}});
      field.values = values_of<float>(array, items);
      if (array.type == FrameNumber::int32) field.integers = values_of<std::int32_t>(array, items);
    }
    return result;
  }
  std::vector<std::string> groups() const override {
    const std::lock_guard lock(door());
    const std::vector<char> codes = field_data<char>("groups");
    return names_in({codes.begin(), codes.end()});
  }
  std::vector<double> walls(const std::string& name) const override {
    const std::lock_guard lock(door());
    return field_data<double>(name.c_str());
  }

 private:
  struct Array {
    Handle data;
    std::size_t rows;
    int components;
    FrameNumber type;
  };

  /// Of the types that this program writes; others are refused.
  static std::optional<FrameNumber> number_type(hid_t type) {
    for (const FrameNumber each : {FrameNumber::float32, FrameNumber::float64, FrameNumber::int32,
                                   FrameNumber::int64, FrameNumber::uint8})
      if (H5Tequal(type, hdf_type(each)) > 0) return each;
    return std::nullopt;
  }
  static std::string path_of(const std::string& section, const std::string& name) {
    return "/VTKHDF/" + (is_field(section) ? section + "/" + name : vtkhdf_name(name));
  }

  /// The file as it is in memory: every file comes through one door.
  hid_t opened() {
    if (!access_->good() || content_.empty()) return -1;
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its messages would go to the terminal
    if (H5Pset_fapl_core(access_->id(), 1 << 20, false) < 0) return -1;
    if (H5Pset_file_image(access_->id(), content_.data(), content_.size()) < 0) return -1;
    return H5Fopen(name_in_memory().c_str(), H5F_ACC_RDONLY, access_->id());
  }

  bool has(const std::string& path) const {
    for (std::size_t end = 0; end != std::string::npos;) {
      end = path.find('/', end + 1);
      if (H5Lexists(file_->id(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    }
    return true;
  }

  /// @param rows  that it must have; none: any number
  Array opened_array(const std::string& path, std::size_t rows,
                     std::size_t none = std::size_t(-1)) const {
    const std::string name = path.substr(sizeof "/VTKHDF/" - 1);
    if (!has(path)) fail("has no " + name);
    Array array{
        {H5Dopen2(file_->id(), path.c_str(), H5P_DEFAULT), H5Dclose}, 0, 1, FrameNumber::uint8};
    if (!array.data.good()) fail("array " + name + " is damaged");
    const Handle space(H5Dget_space(array.data.id()), H5Sclose);
    const Handle type(H5Dget_type(array.data.id()), H5Tclose);
    std::array<hsize_t, 2> size{0, 1};
    const int rank = space.good() ? H5Sget_simple_extent_ndims(space.id()) : -1;
    const bool flat = (rank == 1 || rank == 2) &&
                      H5Sget_simple_extent_dims(space.id(), size.data(), nullptr) == rank;
    // zlib packs by 1032 at most
    const auto number = type.good() ? number_type(type.id()) : std::nullopt;
    const bool fits = flat && number && size[1] >= 1 && size[1] <= 64 &&
                      size[0] / 1100 <= content_.size() && (rows == none || size[0] == rows);
    if (!fits) fail("array " + name + " is damaged");
    array.rows = size[0];
    array.components = static_cast<int>(size[1]);
    array.type = *number;
    return array;
  }

  /// Bytes of an array as the file holds them. Chunks are unpacked here: HDF5 trusts the sizes and
  /// filters that a damaged file states, and reads beyond its own buffers then.
  std::string bytes_of(const Array& array, std::size_t item) const {
    const std::size_t row = item * static_cast<std::size_t>(array.components);
    // zlib packs by 1032 at most
    const auto forged = [&](hsize_t rows) { return rows * row / 1100 > content_.size(); };
    if (forged(array.rows)) fail("an array is damaged");
    std::string bytes(array.rows * row, '\0');
    if (bytes.empty()) return bytes;
    const Handle how(H5Dget_create_plist(array.data.id()), H5Pclose);
    if (!how.good()) fail("an array is damaged");
    if (H5Pget_layout(how.id()) != H5D_CHUNKED) {
      const Handle type(H5Dget_type(array.data.id()), H5Tclose);
      if (H5Pget_nfilters(how.id()) != 0 ||
          H5Dread(array.data.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
        fail("an array is damaged");
      return bytes;
    }
    const bool packed = only_deflate(how.id());
    std::array<hsize_t, 2> chunk{0, 1}, place{0, 0};
    const int rank = H5Pget_chunk(how.id(), 2, chunk.data());
    if (rank < 1 || rank > 2 || chunk[0] == 0 || chunk[0] > (hsize_t{1} << 31) ||
        forged(chunk[0]) || chunk[1] != static_cast<hsize_t>(array.components))
      fail("an array is damaged");
    std::string raw, whole(std::min<std::size_t>(chunk[0], array.rows) * row, '\0');
    for (; place[0] < array.rows; place[0] += chunk[0]) {
      const std::size_t rows = std::min<std::size_t>(chunk[0], array.rows - place[0]);
      raw_chunk(array, place, raw);
      // The last chunk is full in files of other programs; this one's ends with the array.
      if (packed) whole.resize(chunk[0] * row);
      const std::string_view content = packed ? unpacked(raw, whole) : std::string_view(raw);
      if (content.size() < rows * row) fail("an array is damaged");
      content.copy(bytes.data() + place[0] * row, rows * row);
    }
    return bytes;
  }
  bool only_deflate(hid_t how) const {
    const int filters = H5Pget_nfilters(how);
    if (filters == 0) return false;
    unsigned flags = 0, options = 0;
    std::size_t values = 0;
    if (filters != 1 || H5Pget_filter2(how, 0, &flags, &values, nullptr, 0, nullptr, &options) !=
                            H5Z_FILTER_DEFLATE)
      fail("an array is packed by other filters than deflate");
    return true;
  }
  void raw_chunk(const Array& array, const std::array<hsize_t, 2>& place, std::string& raw) const {
    hsize_t size = 0;
    std::uint32_t skipped = 0;
    if (H5Dget_chunk_storage_size(array.data.id(), place.data(), &size) < 0 ||
        size > content_.size())
      fail("an array is damaged");
    raw.resize(size);
    if (size == 0 ||
        H5Dread_chunk(array.data.id(), H5P_DEFAULT, place.data(), &skipped, raw.data()) < 0 ||
        skipped != 0)
      fail("an array is damaged");
  }
  std::string_view unpacked(const std::string& raw, std::string& to) const {
    uLongf size = to.size();
    if (::uncompress(reinterpret_cast<Bytef*>(to.data()), &size,
                     reinterpret_cast<const Bytef*>(raw.data()), raw.size()) != Z_OK)
      fail("an array is damaged");
    return {to.data(), size};
  }

  template <class From, class To>
  static std::vector<To> converted(const std::string& bytes) {
    std::vector<From> from(bytes.size() / sizeof(From));
    std::memcpy(from.data(), bytes.data(), bytes.size());
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
  std::vector<T> values_of(const Array& array, std::size_t rows) const {
    if (array.rows != rows) fail("an array is damaged");
    switch (array.type) {
      case FrameNumber::float32:
        return converted<float, T>(bytes_of(array, 4));
      case FrameNumber::float64:
        return converted<double, T>(bytes_of(array, 8));
      case FrameNumber::int32:
        return converted<std::int32_t, T>(bytes_of(array, 4));
      case FrameNumber::int64:
        return converted<std::int64_t, T>(bytes_of(array, 8));
      case FrameNumber::uint8:
        break;
    }
    return converted<std::uint8_t, T>(bytes_of(array, 1));
  }
  template <class T>
  std::vector<T> values(const std::string& path, std::size_t rows) const {
    return values_of<T>(opened_array(path, rows), rows);
  }
  template <class T>
  std::vector<T> field_data(const char* name) const {
    const std::string path = std::string("/VTKHDF/FieldData/") + name;
    if (!has(path)) return {};
    const Array array = opened_array(path, std::size_t(-1));
    return values_of<T>(array, array.rows);
  }

  std::size_t count(const char* name) const {
    const std::int64_t number =
        values<std::int64_t>(std::string("/VTKHDF/") + name, 1).front();  // of one part
    if (number < 0 || number > std::int64_t{1} << 40)
      fail(std::string("its ") + name + " is damaged");
    return static_cast<std::size_t>(number);
  }

  std::vector<std::string> names(const std::string& section) const {
    const std::string path = "/VTKHDF/" + section;
    if (!has(path)) return {};
    const Handle group(H5Gopen2(file_->id(), path.c_str(), H5P_DEFAULT), H5Gclose);
    H5G_info_t info{};
    if (!group.good() || H5Gget_info(group.id(), &info) < 0) fail("its " + section + " is damaged");
    std::vector<std::string> result;
    for (hsize_t i = 0; i < std::min<hsize_t>(info.nlinks, 10'000); ++i) {
      const auto name_of = [&](H5_index_t order, char* to, std::size_t size) {
        return H5Lget_name_by_idx(group.id(), ".", order, H5_ITER_INC, i, to, size, H5P_DEFAULT);
      };
      std::array<char, 256> name{};  // files of other programs have no order but the alphabet
      if (name_of(H5_INDEX_CRT_ORDER, name.data(), name.size()) < 0 &&
          name_of(H5_INDEX_NAME, name.data(), name.size()) < 0)
        fail("its " + section + " is damaged");
      result.emplace_back(name.data());
    }
    return result;
  }

  static std::string unit(const Handle& data) {
    if (H5Aexists(data.id(), "units") <= 0) return "";
    const Handle text(H5Aopen(data.id(), "units", H5P_DEFAULT), H5Aclose);
    const Handle type(text.good() ? H5Aget_type(text.id()) : -1, H5Tclose);
    if (!type.good() || H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0)
      return "";
    std::string unit(std::min<std::size_t>(H5Tget_size(type.id()), 1 << 10), '\0');
    const Handle space(H5Aget_space(text.id()), H5Sclose);
    if (unit.size() != H5Tget_size(type.id()) || H5Sget_simple_extent_npoints(space.id()) != 1 ||
        H5Aread(text.id(), type.id(), unit.data()) < 0)
      return "";
    return unit.substr(0, unit.find('\0'));
  }

  std::string content_;
  std::optional<Handle> access_, file_;
  std::size_t points_ = 0, cells_ = 0;
};

}  // namespace

bool has_hdf5() {
  return true;
}

std::string vtkhdf_content(const HdfGrid& grid) {
  const std::lock_guard lock(door());
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
  const std::lock_guard lock(door());
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
