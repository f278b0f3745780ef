#pragma once
// A simulated rank whose own work takes as long as the test says, and whose messages reach any
// memory.

#include <utility>

#include "domain/communicator.hpp"

namespace breccia::mpi_testing {

class TimedRank final : public Communicator {
 public:
  explicit TimedRank(Communicator& ranks) : ranks_(ranks) {}
  int rank() const override { return ranks_.rank(); }
  int size() const override { return ranks_.size(); }
  std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                            const std::vector<Post>& from) override {
    return ranks_.prepare(to, from);
  }
  std::vector<Message> exchange(std::vector<Message> messages) override {
    return ranks_.exchange(std::move(messages));
  }
  void abort(int exit_code) override { ranks_.abort(exit_code); }
  bool reaches(Space) const override { return true; }  // also what is out of the host's reach
  double worked() const override { return worked_; }

  void work(double seconds) { worked_ += seconds; }

 private:
  Communicator& ranks_;
  double worked_ = 0.0;
};

}  // namespace breccia::mpi_testing
