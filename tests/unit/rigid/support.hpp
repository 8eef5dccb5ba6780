#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "rigid/rigid_bodies.hpp"
#include "rigid/rigid_parameters.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {

constexpr double grid_spacing = 0.1;

inline std::string motion(const std::string& type, const std::string& content = "") {
  return list("Motion", text("Type", type) + content);
}

/// A body as a scene file has it.
template <int dim>
ParameterList body_list(const std::string& content) {
  return scene_list(content, rigid_body_parameters<dim>());
}
template <int dim>
RigidBody<dim> body(const std::string& content, double spacing = grid_spacing) {
  return read_rigid_body<dim>("body", body_list<dim>(content), spacing);
}

/// A model of bodies "0", "1", ...
template <int dim>
std::unique_ptr<RigidBodies<dim>> model(const std::vector<std::string>& contents,
                                        const Point<dim>& gravity = Point<dim>::Zero()) {
  std::vector<std::pair<std::string, ParameterList>> lists;
  for (const auto& content : contents)
    lists.emplace_back(std::to_string(lists.size()), body_list<dim>(content));
  return make_rigid_bodies<dim>(lists, grid_spacing, gravity, world());
}

/// A step without fluid: S1 to t + dt/2, move, S2.
template <int dim>
void free_step(RigidBody<dim>& body, double time, double dt) {
  const RigidVector<dim> half = body.momentum + midpoint_correction(body, body.momentum, dt / 2);
  move(body, velocity_of(body, body.pose.orientation, half), time, dt);
  set_velocity(body, velocity_of(body, body.pose.orientation, body.momentum));
}

/// Where the flow of a constant rigid field takes x in dt, by RK4.
template <int dim>
Point<dim> followed(const Twist<dim>& field, Point<dim> x, double dt) {
  const int n_steps = 400;
  const double step = dt / n_steps;
  for (int i = 0; i < n_steps; ++i) {
    const Point<dim> k1 = field.velocity(x), k2 = field.velocity(x + 0.5 * step * k1),
                     k3 = field.velocity(x + 0.5 * step * k2), k4 = field.velocity(x + step * k3);
    x += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return x;
}

}  // namespace lockstep::test
