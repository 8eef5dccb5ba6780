#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Many boxes listed by the bins of a uniform lattice that they touch, for questions about places
/// much smaller than the whole. A handful of boxes is not worth bins and is looked through.
template <int dim>
class BoxBins {
 public:
  /// `boxes` must outlive the object and not change. Bins of `width` [m] cover `region`; what lies
  /// beyond it counts to the bins at its rim.
  void build(const std::vector<Box<dim>>& boxes, const Box<dim>& region, double width);
  void clear();
  /// The boxes that touch this one, in no order; replaces the content of `found`.
  void touching(const Box<dim>& box, std::vector<int>& found) const;
  bool any_touches(const Box<dim>& box) const;

 private:
  struct Range {
    Index<dim> begin, end;
  };
  Range range(const Box<dim>& box) const;
  int row_of(const Index<dim>& bin) const;
  /// Calls f(first bin, last bin + 1) for the rows of bins along axis 0 in the range.
  template <typename Function>
  void for_each_row(const Range& range, const Function& f) const;

  const std::vector<Box<dim>>* boxes_ = nullptr;
  Point<dim> lower_ = Point<dim>::Zero();
  double per_width_ = 0;    ///< bins a metre; 0: no bins
  Index<dim> count_{};      ///< of bins along each axis
  std::vector<int> start_;  ///< first item of each bin, and the end
  std::vector<int> items_;
  mutable std::vector<unsigned> seen_;  ///< the question that each box was last found for
  mutable unsigned question_ = 0;
};

}  // namespace lockstep
