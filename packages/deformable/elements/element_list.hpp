#pragma once
#include "deformable/elements/element_group.hpp"

namespace lockstep {

/// Base of all kinds of elements: a list of elements, each with an array `corners`. `Derived` is
/// the kind itself, which is copied for another selection of elements.
template <int dim, typename Element, typename Derived>
class ElementList : public ElementGroup<dim> {
 public:
  ElementCorners corners() const override {
    ElementCorners all{n_corners, {}};
    for (const Element& element : elements_)
      all.nodes.insert(all.nodes.end(), element.corners.begin(), element.corners.end());
    return all;
  }

  std::unique_ptr<ElementGroup<dim>> restricted(const std::vector<int>& kept,
                                                const std::vector<int>& number) const override {
    auto part = std::make_unique<Derived>(static_cast<const Derived&>(*this));
    std::vector<Element> selection;
    for (const int e : kept) {
      selection.push_back(elements_[e]);
      for (int& corner : selection.back().corners)
        corner = number[corner];
    }
    static_cast<ElementList&>(*part).elements_ = std::move(selection);
    return part;
  }

 protected:
  static constexpr int n_corners = static_cast<int>(std::tuple_size<decltype(Element::corners)>());
  std::vector<Element> elements_;
};

}  // namespace lockstep
