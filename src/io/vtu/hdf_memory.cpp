#ifdef BR_HDF5

#include "io/vtu/hdf_memory.hpp"

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // where HDF5 has its drivers since 1.13
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

namespace breccia {
namespace {

struct OpenFile {
  H5FD_t base;  // HDF5 knows its address, so it comes first
  std::string_view content;
  haddr_t allocated;
};
OpenFile& file_of(H5FD_t* base) {
  return *reinterpret_cast<OpenFile*>(base);
}
const OpenFile& file_of(const H5FD_t* base) {
  return *reinterpret_cast<const OpenFile*>(base);
}

H5FD_t* open_content(const char*, unsigned flags, hid_t access, haddr_t) {
  const auto* const content = static_cast<const std::string_view*>(H5Pget_driver_info(access));
  if (content == nullptr || (flags & H5F_ACC_RDWR) != 0) return nullptr;
  auto* const file = new (std::nothrow) OpenFile{{}, *content, 0};
  return file == nullptr ? nullptr : &file->base;
}
herr_t close_content(H5FD_t* base) {
  delete &file_of(base);
  return 0;
}

// Bytes read to here are not copied. HDF5 serves one thread at a time.
char nowhere;
HdfPiece shown{0, 0};

/// Bytes beyond the end are zero, as HDF5's own drivers have it.
herr_t read_content(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, void* to) {
  const std::string_view content = file_of(base).content;
  const std::string_view there = content.substr(std::min<haddr_t>(begin, content.size()), size);
  if (to == &nowhere) {
    shown = {begin, size};
    return there.size() == size ? 0 : -1;
  }
  there.copy(static_cast<char*>(to), there.size());
  std::memset(static_cast<char*>(to) + there.size(), 0, size - there.size());
  return 0;
}

hid_t driver() {
  static const hid_t id = [] {
    static H5FD_class_t how{};
#ifdef H5FD_CLASS_VERSION
    how.version = H5FD_CLASS_VERSION;
    how.value = static_cast<H5FD_class_value_t>(512);  // free for programs of one's own
#endif
    how.name = "content";
    how.maxaddr = HADDR_MAX;
    how.fc_degree = H5F_CLOSE_WEAK;
    how.fapl_size = sizeof(std::string_view);
    how.open = open_content;
    how.close = close_content;
    how.query = [](const H5FD_t*, unsigned long* features) -> herr_t {
      if (features != nullptr) *features = 0;
      return 0;
    };
    how.get_eoa = [](const H5FD_t* base, H5FD_mem_t) { return file_of(base).allocated; };
    how.set_eoa = [](H5FD_t* base, H5FD_mem_t, haddr_t end) -> herr_t {
      file_of(base).allocated = end;
      return 0;
    };
    how.get_eof = [](const H5FD_t* base, H5FD_mem_t) -> haddr_t {
      return file_of(base).content.size();
    };
    how.read = read_content;
    how.write = [](H5FD_t*, H5FD_mem_t, hid_t, haddr_t, std::size_t, const void*) -> herr_t {
      return -1;
    };
    return H5FDregister(&how);
  }();
  return id;
}

}  // namespace

hid_t access_to(const std::string_view& content) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  if (access >= 0 && H5Pset_driver(access, driver(), &content) >= 0) return access;
  H5Pclose(access);
  return -1;
}

std::optional<HdfPiece> chunk_at(hid_t dataset, const hsize_t* place) {
  std::uint32_t skipped = 0;
  if (H5Dread_chunk(dataset, H5P_DEFAULT, place, &skipped, &nowhere) < 0 || skipped != 0)
    return std::nullopt;
  return shown;
}

}  // namespace breccia

#endif
