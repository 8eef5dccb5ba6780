#pragma once
#include <vector>

namespace lockstep {

/// Lone vertices would become nodes without mass: they go, the order of the others stays. `Mesh`
/// has `vertices` and `simplices` of vertex numbers.
template <typename Mesh>
void drop_unused_vertices(Mesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& simplex : mesh.simplices) {
    for (const int v : simplex)
      number[v] = 0;
  }
  int n_used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0)
      continue;
    number[v] = n_used;
    mesh.vertices[n_used++] = mesh.vertices[v];
  }
  mesh.vertices.resize(n_used);
  for (auto& simplex : mesh.simplices) {
    for (int& v : simplex)
      v = number[v];
  }
}

}  // namespace lockstep
