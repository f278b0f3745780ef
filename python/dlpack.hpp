#pragma once
// A field as a DLPack capsule: what numpy, PyTorch, CuPy and JAX exchange arrays by.
//
// The structs are those of DLPack 0.8 (github.com/dmlc/dlpack, include/dlpack/dlpack.h), whose
// layout is fixed.

#include <pybind11/pybind11.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "breccia/breccia.hpp"

namespace dlpack {

namespace py = pybind11;

enum DeviceType : std::int32_t { cpu = 1, cuda = 2 };
enum Code : std::uint8_t { code_int = 0, code_uint = 1, code_float = 2 };

struct Device {
  DeviceType type;
  std::int32_t number;
};
struct DataType {
  std::uint8_t code, bits;
  std::uint16_t lanes;
};
struct Tensor {
  void* data;
  Device device;
  std::int32_t dimensions;
  DataType type;
  std::int64_t* shape;
  std::int64_t* strides;  ///< in numbers, not in bytes
  std::uint64_t byte_offset;
};
struct ManagedTensor {
  Tensor tensor;
  void* context;
  void (*deleter)(ManagedTensor*);
};
static_assert(sizeof(Tensor) == 48 && sizeof(ManagedTensor) == 64);

inline DataType type_of(br::NumberType type) {
  switch (type) {
    case br::NumberType::float32:
      return {code_float, 32, 1};
    case br::NumberType::int32:
      return {code_int, 32, 1};
    case br::NumberType::int16:
      return {code_int, 16, 1};
    case br::NumberType::uint8:
      return {code_uint, 8, 1};
    case br::NumberType::float64:
      break;
  }
  return {code_float, 64, 1};
}

/// A capsule keeps these alive: the field, and the simulation whose memory it may be.
struct Kept {
  br::Field field;
  py::object owner;
  std::vector<std::int64_t> strides;
  ManagedTensor managed{};
};

inline void let_go(ManagedTensor* managed) {
  const py::gil_scoped_acquire locked;
  delete static_cast<Kept*>(managed->context);
}

/// A capsule that nobody has taken lets its tensor go.
inline void let_go_if_untaken(PyObject* capsule) {
  if (std::strcmp(PyCapsule_GetName(capsule), "dltensor") != 0) return;
  auto* const managed = static_cast<ManagedTensor*>(PyCapsule_GetPointer(capsule, "dltensor"));
  managed->deleter(managed);
}

inline py::object capsule_of(br::Field&& field, const py::object& owner) {
  auto kept = std::make_unique<Kept>(Kept{std::move(field), owner, {}, {}});
  const DataType type = type_of(kept->field.type);
  for (const std::int64_t bytes : kept->field.strides) {
    if (bytes % (type.bits / 8) != 0)
      throw py::buffer_error(kept->field.name + ": DLPack cannot hold its strides");
    kept->strides.push_back(bytes / (type.bits / 8));
  }
  const bool on_gpu = kept->field.gpu >= 0;
  kept->managed = {{const_cast<void*>(kept->field.data),
                    {on_gpu ? cuda : cpu, on_gpu ? kept->field.gpu : 0},
                    static_cast<std::int32_t>(kept->field.shape.size()),
                    type,
                    kept->field.shape.data(),
                    kept->strides.data(),
                    0},
                   kept.get(),
                   let_go};
  PyObject* const capsule = PyCapsule_New(&kept->managed, "dltensor", let_go_if_untaken);
  if (capsule == nullptr) throw py::error_already_set();
  (void)kept.release();
  return py::reinterpret_steal<py::object>(capsule);
}

}  // namespace dlpack
