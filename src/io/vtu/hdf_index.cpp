#ifdef BR_HDF5

#include "io/vtu/hdf_index.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <optional>

#include "exec/error.hpp"
#include "io/vtu/hdf_handle.hpp"
#include "io/vtu/hdf_memory.hpp"
#include "io/vtu/in_child.hpp"

namespace breccia {
namespace {

/// Of the types that this program writes; others are refused.
std::optional<FrameNumber> number_type(hid_t type) {
  for (const FrameNumber each : {FrameNumber::float32, FrameNumber::float64, FrameNumber::int32,
                                 FrameNumber::int64, FrameNumber::uint8})
    if (H5Tequal(type, hdf_type(each)) > 0) return each;
  return std::nullopt;
}

std::string unit_of(hid_t data) {
  if (H5Aexists(data, "units") <= 0) return "";
  const Handle text(H5Aopen(data, "units", H5P_DEFAULT), H5Aclose);
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

/// The index of a file that HDF5 has open.
class Look {
 public:
  Look(hid_t file, std::size_t size) : file_(file), size_(size) {}

  std::vector<HdfEntry> all() const {
    std::vector<HdfEntry> entries;
    for (const char* name :
         {"NumberOfPoints", "NumberOfCells", "Points", "Connectivity", "Offsets"})
      if (has(name)) entries.push_back(entry(name));
    for (const char* section : {"FieldData", "PointData", "CellData"})
      for (const std::string& name : names(section))
        entries.push_back(entry(std::string(section) + "/" + name));
    return entries;
  }

 private:
  bool has(const std::string& path) const {
    return H5Lexists(file_, "/VTKHDF", H5P_DEFAULT) > 0 &&
           H5Lexists(file_, ("/VTKHDF/" + path).c_str(), H5P_DEFAULT) > 0;
  }

  std::vector<std::string> names(const std::string& section) const {
    if (!has(section)) return {};
    const auto fail = [&]() -> IoError { return IoError("its " + section + " is damaged"); };
    const Handle group(H5Gopen2(file_, ("/VTKHDF/" + section).c_str(), H5P_DEFAULT), H5Gclose);
    H5G_info_t info{};
    if (!group.good() || H5Gget_info(group.id(), &info) < 0) throw fail();
    std::vector<std::string> result;
    for (hsize_t i = 0; i < std::min<hsize_t>(info.nlinks, 10'000); ++i) {
      const auto name_of = [&](H5_index_t order, char* to, std::size_t size) {
        return H5Lget_name_by_idx(group.id(), ".", order, H5_ITER_INC, i, to, size, H5P_DEFAULT);
      };
      std::array<char, 256> name{};  // files of other programs have no order but the alphabet
      if (name_of(H5_INDEX_CRT_ORDER, name.data(), name.size()) < 0 &&
          name_of(H5_INDEX_NAME, name.data(), name.size()) < 0)
        throw fail();
      name.back() = '\0';
      result.emplace_back(name.data());
    }
    return result;
  }

  HdfEntry entry(const std::string& path) const {
    HdfEntry entry;
    entry.path = path;
    entry.problem = "is damaged";
    const Handle data(H5Dopen2(file_, ("/VTKHDF/" + path).c_str(), H5P_DEFAULT), H5Dclose);
    if (!data.good()) return entry;
    const Handle space(H5Dget_space(data.id()), H5Sclose);
    const Handle type(H5Dget_type(data.id()), H5Tclose);
    const Handle how(H5Dget_create_plist(data.id()), H5Pclose);
    std::array<hsize_t, 2> size{0, 1};
    const int rank = space.good() ? H5Sget_simple_extent_ndims(space.id()) : -1;
    const bool flat = (rank == 1 || rank == 2) &&
                      H5Sget_simple_extent_dims(space.id(), size.data(), nullptr) == rank;
    const auto number = type.good() ? number_type(type.id()) : std::nullopt;
    if (!flat || !number || !how.good()) return entry;
    entry.type = *number;
    entry.rows = size[0];
    entry.components = size[1];
    entry.unit = unit_of(data.id());
    entry.problem = H5Pget_layout(how.id()) == H5D_CHUNKED ? chunks(data.id(), how.id(), entry)
                                                           : one_piece(data.id(), how.id(), entry);
    return entry;
  }

  /// @returns a problem, or nothing
  static std::string one_piece(hid_t data, hid_t how, HdfEntry& entry) {
    if (H5Pget_layout(how) != H5D_CONTIGUOUS || H5Pget_external_count(how) != 0)
      return "is neither chunked nor in one piece of this file";
    if (H5Pget_nfilters(how) != 0) return "is damaged";
    const haddr_t begin = H5Dget_offset(data);
    if (begin != HADDR_UNDEF) entry.pieces.push_back({begin, H5Dget_storage_size(data)});
    return "";
  }

  std::string chunks(hid_t data, hid_t how, HdfEntry& entry) const {
    unsigned flags = 0, options = 0;
    std::size_t values = 0;
    const int filters = H5Pget_nfilters(how);
    entry.packed = filters == 1 && H5Pget_filter2(how, 0, &flags, &values, nullptr, 0, nullptr,
                                                  &options) == H5Z_FILTER_DEFLATE;
    if (filters != 0 && !entry.packed) return "is packed by other filters than deflate";
    std::array<hsize_t, 2> chunk{0, 1}, place{0, 0};
    const int rank = H5Pget_chunk(how, 2, chunk.data());
    if (rank < 1 || rank > 2 || chunk[0] == 0 || chunk[1] != entry.components) return "is damaged";
    entry.chunk_rows = chunk[0];
    for (; place[0] < entry.rows; place[0] += chunk[0]) {
      const auto piece = chunk_at(data, place.data());
      if (!piece || entry.pieces.size() == size_ || place[0] + chunk[0] < chunk[0])
        return "is damaged";
      entry.pieces.push_back(*piece);
    }
    return "";
  }

  hid_t file_;
  std::size_t size_;  ///< of the file  [bytes]
};

// An index as bytes, from one process to the other, which trusts none of them.
template <class T>
void put(std::string& bytes, T number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}
void put(std::string& bytes, const std::string& text) {
  put(bytes, std::uint64_t{text.size()});
  bytes += text;
}
std::string bytes_of(const std::vector<HdfEntry>& entries) {
  std::string bytes;
  for (const HdfEntry& entry : entries) {
    for (const std::string* text : {&entry.path, &entry.problem, &entry.unit}) put(bytes, *text);
    for (const std::uint64_t number :
         {static_cast<std::uint64_t>(entry.type), entry.rows, entry.components, entry.chunk_rows,
          std::uint64_t{entry.packed}, std::uint64_t{entry.pieces.size()}})
      put(bytes, number);
    for (const HdfPiece& piece : entry.pieces) put(bytes, piece);
  }
  return bytes;
}

class Answer {
 public:
  explicit Answer(std::string_view bytes) : left_(bytes) {}

  std::vector<HdfEntry> entries() {
    std::vector<HdfEntry> entries;
    while (!left_.empty()) {
      HdfEntry& entry = entries.emplace_back();
      for (std::string* text : {&entry.path, &entry.problem, &entry.unit}) *text = taken(number());
      const std::uint64_t type = number();
      entry.type = static_cast<FrameNumber>(type);
      entry.rows = number();
      entry.components = number();
      entry.chunk_rows = number();
      entry.packed = number() != 0;
      if (type > static_cast<std::uint64_t>(FrameNumber::uint8)) broken();
      const std::uint64_t pieces = number();
      if (pieces > left_.size() / sizeof(HdfPiece)) broken();
      entry.pieces.resize(pieces);
      const std::string_view bytes = taken(pieces * sizeof(HdfPiece));
      if (pieces > 0) std::memcpy(entry.pieces.data(), bytes.data(), bytes.size());
    }
    return entries;
  }

 private:
  [[noreturn]] static void broken() { throw IoError("HDF5 does not survive what is in it"); }
  std::string_view taken(std::uint64_t size) {
    if (size > left_.size()) broken();
    const std::string_view bytes = left_.substr(0, size);
    left_.remove_prefix(size);
    return bytes;
  }
  std::uint64_t number() {
    std::uint64_t number = 0;
    std::memcpy(&number, taken(sizeof number).data(), sizeof number);
    return number;
  }

  std::string_view left_;
};

constexpr char index_follows = 'i', problem_follows = 'p', memory_is_missing = 'm';

std::string look_at(std::string_view content) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its messages would go to the terminal
  try {
    const Handle access(access_to(content), H5Pclose);
    const Handle file(access.good() ? H5Fopen("content", H5F_ACC_RDONLY, access.id()) : -1,
                      H5Fclose);
    if (!file.good()) throw IoError("it is no HDF5 file");
    return index_follows + bytes_of(Look(file.id(), content.size()).all());
  } catch (const IoError& error) {
    return std::string(1, problem_follows) + error.what();
  } catch (const std::bad_alloc&) {
    return std::string(1, memory_is_missing);
  }
}

}  // namespace

std::vector<HdfEntry> hdf_index(std::string_view content) {
  const std::lock_guard lock(hdf_door());
  const auto answer = answer_of_child([&] { return look_at(content); });
  if (!answer || answer->empty()) throw IoError("HDF5 does not survive what is in it");
  if (answer->front() == memory_is_missing) throw std::bad_alloc();
  if (answer->front() == problem_follows) throw IoError(answer->substr(1));
  return Answer(std::string_view(*answer).substr(1)).entries();
}

}  // namespace breccia

#endif
