#pragma once
// Arrays of the library's inside as fields of the public header.

#include "breccia/breccia.hpp"
#include "exec/device.hpp"
#include "run/method/state_array.hpp"

namespace br {

inline NumberType number_type_of(breccia::NumberType type) {
  switch (type) {
    case breccia::NumberType::float32:
      return NumberType::float32;
    case breccia::NumberType::int32:
      return NumberType::int32;
    case breccia::NumberType::int16:
      return NumberType::int16;
    case breccia::NumberType::uint8:
      return NumberType::uint8;
    case breccia::NumberType::float64:
      break;
  }
  return NumberType::float64;
}

inline Field field_of(breccia::StateArray&& array) {
  return {std::move(array.name),      std::move(array.unit),
          number_type_of(array.type), array.data,
          std::move(array.shape),     std::move(array.strides),
          std::move(array.memory),    array.on_device ? breccia::device_in_use() : -1};
}

}  // namespace br
