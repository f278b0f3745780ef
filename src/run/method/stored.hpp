#pragma once
// Visitors of Simulation::each_stored.

#include <string>

#include "io/checkpoint.hpp"

namespace breccia {

/// Into a checkpoint.
struct Saving {
  CheckpointWriter& to;
  template <class T>
  void operator()(const std::string& name, const T& value) const {
    to.value(name, value);
  }
  template <class T>
  void where_kept(const std::string& name, const T& value) const {
    to.value(name, value);
  }
  template <class State>
  void fields(const char* prefix, State&& state) const {
    to.fields(prefix, state);
  }
};

/// Out of a checkpoint.
struct Loading {
  const CheckpointReader& from;
  template <class T>
  void operator()(const std::string& name, T& value) const {
    value = from.value<T>(name);
  }
  template <class T>
  void where_kept(const std::string& name, T& value) const {
    if (from.has(name)) value = from.value<T>(name);
  }
  template <class State>
  void fields(const char* prefix, State&& state) const {
    from.fields(prefix, state);
  }
};

}  // namespace breccia
