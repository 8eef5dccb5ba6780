#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/generators.hpp"
#include "geometry/surface_snapshot.hpp"

namespace lockstep::test {

template <int dim>
SurfaceMesh<dim> moved(SurfaceMesh<dim> mesh, const Point<dim>& shift, double angle = 0) {
  Eigen::Matrix<double, dim, dim> rotation;
  if constexpr (dim == 2) {
    rotation = Eigen::Rotation2Dd(angle).toRotationMatrix();
  } else {
    rotation = Eigen::AngleAxisd(angle, Point<3>(1, 2, -0.5).normalized()).toRotationMatrix();
  }
  for (auto& x : mesh.vertices)
    x = rotation * x + shift;
  return mesh;
}

/// One solid per mesh.
template <int dim>
SurfaceSnapshot<dim> snapshot(const std::vector<SurfaceMesh<dim>>& meshes, bool closed = true) {
  SurfaceMesh<dim> all;
  std::vector<SolidDescription> solids;
  for (const auto& mesh : meshes) {
    SolidDescription solid;
    solid.closed = closed;
    solid.simplex_begin = static_cast<int>(all.simplices.size());
    solid.vertex_begin = static_cast<int>(all.vertices.size());
    for (auto simplex : mesh.simplices) {
      for (int& v : simplex)
        v += solid.vertex_begin;
      all.simplices.push_back(simplex);
    }
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    solid.simplex_end = static_cast<int>(all.simplices.size());
    solid.vertex_end = static_cast<int>(all.vertices.size());
    solids.push_back(solid);
  }
  return {all, solids};
}

}  // namespace lockstep::test
