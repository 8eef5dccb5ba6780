#pragma once
#include <vector>

namespace lockstep {

/// Lone vertices would become nodes without mass: they go, the order of the others stays. Simplices
/// are arrays of vertex numbers. `labels`: one of each vertex, which goes with it, or none.
template <typename Vertices, typename Simplices>
void drop_unused_vertices(Vertices& vertices, Simplices& simplices, std::vector<long>& labels) {
  std::vector<int> number(vertices.size(), -1);
  for (const auto& simplex : simplices) {
    for (const int v : simplex)
      number[v] = 0;
  }
  int n_used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0)
      continue;
    number[v] = n_used;
    if (!labels.empty())
      labels[n_used] = labels[v];
    vertices[n_used++] = vertices[v];
  }
  vertices.resize(n_used);
  if (!labels.empty())
    labels.resize(n_used);
  for (auto& simplex : simplices) {
    for (int& v : simplex)
      v = number[v];
  }
}

}  // namespace lockstep
