#pragma once
// How long or large the joints of a set are: random lengths by their law.

#include <string>
#include <vector>

#include "core/random.hpp"

namespace breccia::prepare {

/// A normally distributed number of mean 0 and deviation 1, by Box and Muller; of an item's draws
/// it takes two.
double normal_of(const Random& random, std::uint64_t item, std::uint32_t draw);

/// Lengths, all alike or drawn.
struct LengthLaw {
  std::string law;         ///< constant, exponential, lognormal or power
  double mean, deviation;  ///< before least and most; deviation: of lognormal ones  [m]
  double exponent;         ///< power: density l^-exponent from least to most  [-]
  double least, most;      ///< others are drawn again; 0: no limit  [m]

  /// Of an item; it takes draws from 10 on. @throws InputError  if none fits in 1000 tries
  double drawn(const Random& random, std::uint64_t item) const;
  /// `most`, or without it all of constant ones and ten means of others.  [m]
  double longest() const;
  /// Problems of the keys `word`, `word`_deviation, least and most, each after the name of its set.
  std::vector<std::string> problems(const std::string& word) const;

 private:
  double once(const Random& random, std::uint64_t item, std::uint32_t draw) const;
};

}  // namespace breccia::prepare
