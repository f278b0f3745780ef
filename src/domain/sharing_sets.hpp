#pragma once
// Which ranks hold an element: the sharing sets P(e) of Lukas et al. 2014, section 3.1.

#include <algorithm>
#include <cmath>
#include <vector>

#include "domain/partition.hpp"

namespace breccia {

/// A centre and how far a thing reaches from there.  [m]
struct Sphere {
  Vec3 centre;
  double radius = 0.0;
};

/// How far elements may go until they are shared out anew.
struct MigrationBuffer {
  double margin = 0.0;    ///< largest of a search  [m]
  double buffer = 0.0;    ///< way of an element of the mean size  [m]
  double per_size = 0.0;  ///< way of a larger one, over its size  [-]
};

/// An element is held by each rank that owns one which may touch it before elements are shared out
/// anew (docs/theory-domain.md, section 2). Most elements are of about one size: these are taken to
/// be everywhere in the rectangle of their rank. The few that are much larger are told of to all
/// ranks, one by one: they would widen what all others need.
class SharingSets {
 public:
  /// Every rank calls it with what it owns until now.
  /// @param elements  where they are
  /// @param owners    whose they will be
  void build(Communicator& ranks, const std::vector<Sphere>& elements,
             const std::vector<int>& owners, const MigrationBuffer& migration_buffer);

  /// Way from its place that an element of this radius may go.  [m]
  double buffer(double radius) const;
  bool is_large(double radius) const { return radius > common_; }
  /// Whether a large element has stayed within its buffer, with all its surface.
  bool is_within(const Sphere& now, const Sphere& then) const {
    const double grown = std::max(0.0, now.radius - then.radius);
    return largest(now.centre - then.centre) + grown <= buffer(then.radius);
  }

  /// Calls visit(rank), once or more, for each rank that owns an element which may touch this one
  /// after this one has gone `way` further, along each axis.
  /// @param partition  where rectangles were when the sets were built
  template <class Visit>
  void each_sharer(const Partition& partition, const Sphere& e, double way,
                   const Visit& visit) const {
    partition.each_near(e.centre, e.radius + common_ + reach() + migration_buffer_.buffer + way,
                        visit);
    const double near = e.radius + reach() + way;
    each_row(e.centre.x, near + widest_, [&, this](auto l, auto end) {
      const double low = e.centre.y - near - widest_, high = e.centre.y + near + widest_;
      l = std::partition_point(l, end, [low](const Large& f) { return f.centre.y < low; });
      for (; l != end && l->centre.y <= high; ++l)
        if (largest(l->centre - e.centre) <= near + l->width) visit(l->owner);
    });
  }

  Index large_count() const { return static_cast<Index>(large_.size()); }

 private:
  struct Large {
    Vec3 centre;
    double width;  ///< radius and buffer  [m]
    int owner;
  };
  void sort_into_rows();
  double reach() const { return 2.0 * migration_buffer_.margin; }
  static double largest(const Vec3& v) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  }
  /// Rows of the plane, parallel to y; what lies outside counts for the first or last one.
  std::size_t row_of(double x) const {
    const double row = (x - rows_begin_) / row_width_;
    const auto last = static_cast<double>(row_starts_.size() - 2);
    return row > 0.0 ? static_cast<std::size_t>(std::min(row, last)) : 0;
  }
  /// Calls visit(first, end) for the large elements of each row that is near.
  template <class Visit>
  void each_row(double x, double near, const Visit& visit) const {
    if (large_.empty()) return;
    const std::size_t last = row_of(x + near);
    for (std::size_t row = row_of(x - near); row <= last; ++row)
      visit(large_.begin() + row_starts_[row], large_.begin() + row_starts_[row + 1]);
  }

  MigrationBuffer migration_buffer_;
  double common_ = 0.0;  ///< largest radius of those that are not told of one by one  [m]
  double widest_ = 0.0, rows_begin_ = 0.0, row_width_ = 1.0;
  std::vector<Large> large_;       ///< by row, then by y
  std::vector<Index> row_starts_;  ///< first of each row, and the end
};

}  // namespace breccia
