#include "laboratory/optimiser.hpp"

#include "exec/error.hpp"

#ifdef BR_NLOPT

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <memory>

namespace breccia::laboratory {
namespace {

constexpr double first_step = 0.1, least_step = 2e-3, farthest = 1.0;  // of logarithms of keys
constexpr double unit = 0.05;  // bound over misfits: it then moves about as far as the keys do

/// Function that NLopt calls; no exception may pass through it.
class Objective {
 public:
  using Row = std::vector<double>;
  Objective(std::size_t keys, const std::function<Row(const Row&)>& misfits)
      : keys_(keys), misfits_(misfits) {}

  Row misfits(const double* point) {
    const Row x(point, point + keys_);
    const auto known = known_.find(x);
    if (known != known_.end()) return known->second;
    Row found;
    try {
      if (!ended_) found = misfits_(x);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    if (found.empty()) {
      ended_ = true;
      nlopt_force_stop(search_);
      return Row(std::max<std::size_t>(count_, 1), 0.0);
    }
    count_ = found.size();
    if (largest(found) < least_) {
      least_ = largest(found);
      best_ = x;
    }
    return known_[x] = found;
  }
  static double largest(const Row& misfits) {
    double most = 0.0;
    for (const double one : misfits) most = std::max(most, std::abs(one));
    return most;
  }

  void search(nlopt_algorithm algorithm, const Row& from) {
    const bool bound = algorithm == NLOPT_LN_COBYLA;
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
        nlopt_create(algorithm, static_cast<unsigned>(keys_ + bound)), &nlopt_destroy);
    search_ = search.get();
    Row x = from, low, high;
    for (const double key : start_) {
      low.push_back(key - farthest);
      high.push_back(key + farthest);
    }
    const Row first = misfits(from.data());
    if (ended_) return finish();
    if (bound) {
      x.push_back(unit * largest(first));
      low.push_back(0.0);
      high.push_back(std::numeric_limits<double>::infinity());
    }
    nlopt_set_lower_bounds(search_, low.data());
    nlopt_set_upper_bounds(search_, high.data());
    nlopt_set_initial_step1(search_, first_step);
    nlopt_set_xtol_abs1(search_, least_step);
    if (bound) {
      nlopt_set_min_objective(search_, bound_of, this);
      nlopt_add_inequality_mconstraint(search_, static_cast<unsigned>(2 * count_), beyond_bound,
                                       this, nullptr);
    } else {
      nlopt_set_min_objective(search_, worst_of, this);
    }
    double value = 0.0;
    nlopt_optimize(search_, x.data(), &value);
    finish();
  }

  void begin_at(const Row& start) { start_ = start; }
  bool ended() const { return ended_; }
  const Row& best() const { return best_; }

 private:
  void finish() {
    search_ = nullptr;
    if (thrown_) std::rethrow_exception(thrown_);
  }
  static double bound_of(unsigned n, const double* x, double*, void*) { return x[n - 1]; }
  static double worst_of(unsigned, const double* x, double*, void* self) {
    return largest(static_cast<Objective*>(self)->misfits(x));
  }
  static void beyond_bound(unsigned m, double* result, unsigned n, const double* x, double*,
                           void* self) {
    const Row found = static_cast<Objective*>(self)->misfits(x);
    for (unsigned k = 0; k < m / 2; ++k) {
      result[2 * k] = unit * found[k] - x[n - 1];
      result[2 * k + 1] = -unit * found[k] - x[n - 1];
    }
  }

  std::size_t keys_, count_ = 0;
  const std::function<Row(const Row&)>& misfits_;
  nlopt_opt search_ = nullptr;
  Row start_, best_;
  double least_ = std::numeric_limits<double>::infinity();
  std::map<Row, Row> known_;
  bool ended_ = false;
  std::exception_ptr thrown_;
};

}  // namespace

bool has_nlopt() {
  return true;
}

void make_small(const std::string& method, std::vector<double> start,
                const std::function<std::vector<double>(const std::vector<double>&)>& misfits) {
  const std::map<std::string, nlopt_algorithm> algorithms{
      {"cobyla", NLOPT_LN_COBYLA}, {"sbplx", NLOPT_LN_SBPLX}, {"bobyqa", NLOPT_LN_BOBYQA}};
  const auto algorithm = algorithms.find(method);
  if (algorithm == algorithms.end()) throw InputError("there is no method " + method);
  Objective objective(start.size(), misfits);
  objective.begin_at(start);
  objective.search(algorithm->second, start);
  if (method == "cobyla" && !objective.ended()) objective.search(NLOPT_LN_SBPLX, objective.best());
}

}  // namespace breccia::laboratory

#else

namespace breccia::laboratory {

bool has_nlopt() {
  return false;
}

void make_small(const std::string& method, std::vector<double>,
                const std::function<std::vector<double>(const std::vector<double>&)>&) {
  throw InputError("--method " + method +
                   ": this program is built without NLopt (libnlopt-dev); nothing was run");
}

}  // namespace breccia::laboratory

#endif
