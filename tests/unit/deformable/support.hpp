#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "base/errors.hpp"
#include "coupling/solid_system.hpp"
#include "deformable/deformable_solids.hpp"
#include "deformable/reading/deformable_parameters.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {

/// The message of the InputError that `action` throws, or "".
template <typename Action>
std::string error(const Action& action) {
  try {
    action();
  } catch (const InputError& failure) {
    return failure.what();
  }
  return "";
}

inline std::string box(const std::string& size, const std::string& spacing) {
  return geometry("box", numbers("Size", size) + number("Mesh Spacing", spacing));
}
inline std::string material(const std::string& type, const std::string& youngs_modulus = "100",
                            const std::string& poisson_ratio = "0.3") {
  return list("Material", text("Type", type) + number("Young&apos;s Modulus", youngs_modulus) +
                              number("Poisson&apos;s Ratio", poisson_ratio));
}
inline std::string pinned(const std::string& lower, const std::string& upper,
                          const std::string& directions) {
  return list("Pinned", list("some", numbers("Lower", lower) + numbers("Upper", upper) +
                                         texts("Locked", directions)));
}

/// A law that ships, by its name.
template <int dim>
std::unique_ptr<Material<dim>> make_material(const std::string& name, const LameConstants& lame) {
  ParameterList list;
  list.set("Young's Modulus", lame.mu * (3 * lame.lambda + 2 * lame.mu) / (lame.lambda + lame.mu));
  list.set("Poisson's Ratio", lame.lambda / (2 * (lame.lambda + lame.mu)));
  return shipped_materials<dim>().create(name, list);
}

/// A body as a scene file has it.
template <int dim>
ParameterList body_list(const std::string& content) {
  return scene_list(content, deformable_body_parameters<dim>());
}
template <int dim>
DeformableBody<dim> body(const std::string& content, const std::string& name = "body") {
  return read_deformable_body<dim>(name, body_list<dim>(content), 0.1);
}

/// A model of bodies "0", "1", ...
template <int dim>
std::unique_ptr<DeformableSolids<dim>> model(const std::vector<std::string>& contents,
                                             const Point<dim>& gravity = Point<dim>::Zero()) {
  std::vector<DeformableBody<dim>> bodies;
  for (const auto& content : contents)
    bodies.push_back(body<dim>(content, std::to_string(bodies.size())));
  return std::make_unique<DeformableSolids<dim>>("deformable body", std::move(bodies), gravity,
                                                 world());
}

/// One model as all the solids there are.
template <int dim>
struct Alone {
  explicit Alone(std::unique_ptr<DeformableSolids<dim>> made)
      : solids(*made), system(stack(std::move(made)), world()) {}
  static std::vector<std::unique_ptr<SolidModel<dim>>> stack(
      std::unique_ptr<DeformableSolids<dim>> made) {
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(std::move(made));
    return models;
  }
  /// A step without fluid: S1 to t + dt/2, move, S2.
  void step(double dt);

  DeformableSolids<dim>& solids;
  SolidSystem<dim> system;
  double time = 0;  ///< [s]
};

/// Observed order in time of how far to the right a model without fluid reaches at 0.01 s, from
/// 200, 400 and 800 steps.
double order_of_motion(const std::function<std::unique_ptr<DeformableSolids<2>>()>& make);

}  // namespace lockstep::test
