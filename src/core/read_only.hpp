#pragma once
// The part of a world that its case gives and that no step writes.

namespace breccia {

/// Key to ReadOnly::change, complete in core/set_up.hpp alone. scripts/check_includes.py lets only
/// the folders `setup`, the benchmarks and the tests include that file.
struct SetUp;

/// Constants of a run: `->` and `*` give them const, so that a kernel or a step that wrote one
/// would not compile.
template <class Case>
class ReadOnly {
 public:
  const Case* operator->() const { return &case_; }
  const Case& operator*() const { return case_; }

  /// For writing: set-up, and configure() where a stage of the case begins.
  Case& change(const SetUp&) { return case_; }
  /// Visits the arrays that kernels read, to place or move them: their items stay.
  template <class Visit>
  void each_array(Visit&& visit) {
    case_.each_array(visit);
  }

 private:
  Case case_;
};

}  // namespace breccia
