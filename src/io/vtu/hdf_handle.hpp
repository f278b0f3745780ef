#pragma once
// Parts shared by reading and writing by HDF5.

#include <hdf5.h>

#include <mutex>
#include <utility>

namespace breccia {

/// HDF5 serves one thread at a time.
inline std::mutex& hdf_door() {
  static std::mutex mutex;
  return mutex;
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

}  // namespace breccia
