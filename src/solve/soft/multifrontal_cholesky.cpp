#include "solve/soft/multifrontal_cholesky.hpp"

#include <metis.h>

#include <algorithm>
#include <numeric>

namespace lockstep {

namespace {

/// A graph in lists, without the diagonal.
struct Graph {
  std::vector<idx_t> begin{0}, neighbors;
  int size() const { return static_cast<int>(begin.size()) - 1; }
};

Graph graph_of(const MultifrontalCholesky::Matrix& lower) {
  using Iterator = MultifrontalCholesky::Matrix::InnerIterator;
  const int n = static_cast<int>(lower.rows());
  std::vector<idx_t> count(n + 1, 0);
  const auto for_each_pair = [&](const auto& f) {
    for (int column = 0; column < n; ++column)
      for (Iterator entry(lower, column); entry; ++entry)
        if (entry.row() > column)
          f(static_cast<int>(entry.row()), column);
  };
  for_each_pair([&](int row, int column) {
    ++count[row + 1];
    ++count[column + 1];
  });
  Graph graph;
  std::partial_sum(count.begin(), count.end(), count.begin());
  graph.begin = count;
  graph.neighbors.resize(count.back());
  for_each_pair([&](int row, int column) {
    graph.neighbors[count[row]++] = column;
    graph.neighbors[count[column]++] = row;
  });
  for (int i = 0; i < n; ++i)
    std::sort(graph.neighbors.begin() + graph.begin[i],
              graph.neighbors.begin() + graph.begin[i + 1]);
  return graph;
}

/// Neighbouring rows that see the same rows, as those of a mesh node do, are one vertex: returns
/// the first row of each, and the number of rows.
std::vector<int> groups_of(const Graph& graph) {
  const int n = graph.size();
  std::vector<int> first{0};
  const auto sees_same = [&](int i) {  // as i - 1, but for themselves
    auto a = graph.neighbors.begin() + graph.begin[i - 1];
    auto b = graph.neighbors.begin() + graph.begin[i];
    const auto a_end = b, b_end = graph.neighbors.begin() + graph.begin[i + 1];
    if (a_end - a != b_end - b)
      return false;
    bool connected = false;
    while (true) {
      if (a != a_end && *a == i) {
        connected = true;
        ++a;
      }
      if (b != b_end && *b == i - 1)
        ++b;
      if (a == a_end || b == b_end)
        return connected && a == a_end && b == b_end;
      if (*a++ != *b++)
        return false;
    }
  };
  for (int i = 1; i < n; ++i)
    if (!sees_same(i))
      first.push_back(i);
  first.push_back(n);
  return first;
}

Graph quotient(const Graph& graph, const std::vector<int>& first) {
  std::vector<int> group(graph.size());
  const int n = static_cast<int>(first.size()) - 1;
  for (int g = 0; g < n; ++g)
    std::fill(group.begin() + first[g], group.begin() + first[g + 1], g);
  Graph result;
  for (int g = 0; g < n; ++g) {
    int last = -1;
    for (idx_t k = graph.begin[first[g]]; k < graph.begin[first[g] + 1]; ++k) {
      const int other = group[graph.neighbors[k]];
      if (other != g && other != last)
        result.neighbors.push_back(last = other);
    }
    result.begin.push_back(static_cast<idx_t>(result.neighbors.size()));
  }
  return result;
}

/// order[k]: the vertex that is eliminated k-th.
std::vector<int> dissection(Graph& graph) {
  idx_t n = graph.size();
  std::vector<idx_t> order(n), place(n);
  if (graph.neighbors.empty())
    std::iota(order.begin(), order.end(), 0);
  else
    METIS_NodeND(&n, graph.begin.data(), graph.neighbors.data(), nullptr, nullptr, order.data(),
                 place.data());
  return {order.begin(), order.end()};
}

/// The elimination tree of a graph in that order, by places in it (Liu 1990).
std::vector<int> elimination_tree(const Graph& graph, const std::vector<int>& order,
                                  const std::vector<int>& place) {
  const int n = graph.size();
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int k = 0; k < n; ++k)
    for (idx_t e = graph.begin[order[k]]; e < graph.begin[order[k] + 1]; ++e) {
      int i = place[graph.neighbors[e]];
      while (i >= 0 && i < k) {
        const int next = ancestor[i];
        ancestor[i] = k;
        if (next < 0)
          parent[i] = k;
        i = next;
      }
    }
  return parent;
}

/// Children before parents, each subtree in one piece.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(n + 1);
  for (int i = 0; i < n; ++i)
    children[parent[i] < 0 ? n : parent[i]].push_back(i);
  std::vector<int> result;
  std::vector<std::pair<int, std::size_t>> stack{{n, 0}};
  while (!stack.empty()) {
    auto& [vertex, next] = stack.back();
    if (next < children[vertex].size()) {
      stack.emplace_back(children[vertex][next++], 0);
    } else {
      if (vertex < n)
        result.push_back(vertex);
      stack.pop_back();
    }
  }
  return result;
}

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[order[k]] = static_cast<int>(k);
  return place;
}

std::vector<int> merged(const std::vector<int>& a, const std::vector<int>& b, int least) {
  std::vector<int> result;
  std::set_union(std::lower_bound(a.begin(), a.end(), least), a.end(),
                 std::lower_bound(b.begin(), b.end(), least), b.end(), std::back_inserter(result));
  return result;
}

}  // namespace

void MultifrontalCholesky::analyze(const Matrix& lower) {
  const Graph rows = graph_of(lower);
  const std::vector<int> first = groups_of(rows);
  Graph graph = quotient(rows, first);
  const int n = graph.size();
  std::vector<int> order = dissection(graph);
  {
    const std::vector<int> parent = elimination_tree(graph, order, inverse_of(order));
    std::vector<int> reordered;
    for (const int k : postorder(parent))
      reordered.push_back(order[k]);
    order = std::move(reordered);
  }
  const std::vector<int> place = inverse_of(order);
  const std::vector<int> parent = elimination_tree(graph, order, place);

  // Supernodes of vertices: begin, end, and the vertices below. A child that ends where its parent
  // begins joins it where that stores few zeros.
  struct Group {
    int begin, end;
    std::vector<int> below;
  };
  std::vector<Group> groups;
  std::vector<int> group_of(n);
  std::vector<std::vector<int>> children(n);
  for (int k = 0; k < n; ++k)
    if (parent[k] >= 0)
      children[parent[k]].push_back(k);
  std::vector<std::vector<int>> reach(n);  // rows below a vertex that ends a supernode
  for (int k = 0; k < n; ++k) {
    std::vector<int> below;
    for (idx_t e = graph.begin[order[k]]; e < graph.begin[order[k] + 1]; ++e)
      if (place[graph.neighbors[e]] > k)
        below.push_back(place[graph.neighbors[e]]);
    std::sort(below.begin(), below.end());
    for (const int child : children[k])
      below = merged(below, reach[child], k + 1);
    bool joins = false;
    if (k > 0 && parent[k - 1] == k) {
      Group& last = groups.back();
      const double n_columns = last.end - last.begin;
      const double now = last.below.size(), then = below.size() + 1.0;
      const double zeros = n_columns * (then - now);
      constexpr double few = 0.1, always = 48;  // numbers of vertices
      joins = zeros <= few * (n_columns + 1) * (n_columns + then) || zeros <= always;
    }
    for (const int child : children[k])
      if (!(joins && child == k - 1))
        reach[child] = {};
    if (joins) {
      groups.back().end = k + 1;
      groups.back().below = below;
      reach[k - 1] = {};
    } else {
      groups.push_back({k, k + 1, below});
    }
    group_of[k] = static_cast<int>(groups.size()) - 1;
    reach[k] = std::move(below);
  }

  // from vertices to the rows of the matrix that each stands for
  std::vector<int> begin_of(n + 1, 0);
  for (int k = 0; k < n; ++k)
    begin_of[k + 1] = begin_of[k] + first[order[k] + 1] - first[order[k]];
  place_of_.resize(lower.rows());
  for (int k = 0; k < n; ++k)
    for (int i = first[order[k]]; i < first[order[k] + 1]; ++i)
      place_of_[i] = begin_of[k] + i - first[order[k]];
  nodes_.clear();
  for (const Group& group : groups) {
    Supernode node;
    node.begin = begin_of[group.begin];
    node.end = begin_of[group.end];
    for (const int k : group.below)
      for (int i = begin_of[k]; i < begin_of[k + 1]; ++i)
        node.below.push_back(i);
    node.parent = group.below.empty() ? -1 : group_of[group.below.front()];
    nodes_.push_back(std::move(node));
  }
}

double MultifrontalCholesky::n_operations() const {
  double n = 0;
  for (const Supernode& node : nodes_)
    for (int column = 0; column < node.n_columns(); ++column) {
      const double rows = node.n_rows() - column;
      n += 0.5 * rows * rows;
    }
  return n;
}

double MultifrontalCholesky::n_stored() const {
  double n = 0;
  for (const Supernode& node : nodes_)
    n += static_cast<double>(node.n_columns()) * node.n_rows();
  return n;
}

bool MultifrontalCholesky::factorize(const Matrix& lower) {
  const int n = static_cast<int>(lower.rows());
  // The entries of the ordered lower triangle, by column.
  std::vector<int> begin(n + 1, 0), row;
  std::vector<double> value;
  const auto for_each_entry = [&](const auto& f) {
    for (int column = 0; column < n; ++column)
      for (Matrix::InnerIterator entry(lower, column); entry; ++entry)
        if (entry.row() >= column) {
          const int a = place_of_[entry.row()], b = place_of_[column];
          f(std::max(a, b), std::min(a, b), entry.value());
        }
  };
  for_each_entry([&](int, int column, double) { ++begin[column + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  row.resize(begin.back());
  value.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for_each_entry([&](int i, int column, double entry) {
    row[next[column]] = i;
    value[next[column]++] = entry;
  });

  std::vector<std::vector<int>> children(nodes_.size());
  for (std::size_t s = 0; s < nodes_.size(); ++s)
    if (nodes_[s].parent >= 0)
      children[nodes_[s].parent].push_back(static_cast<int>(s));
  std::vector<Eigen::MatrixXd> updates(nodes_.size());
  std::vector<int> in_front(n);
  for (std::size_t s = 0; s < nodes_.size(); ++s) {
    Supernode& node = nodes_[s];
    const int n_columns = node.n_columns(), n_below = static_cast<int>(node.below.size());
    for (int i = node.begin; i < node.end; ++i)
      in_front[i] = i - node.begin;
    for (int i = 0; i < n_below; ++i)
      in_front[node.below[i]] = n_columns + i;
    // Entries above the diagonal have no meaning.
    Eigen::MatrixXd& factor = node.factor;
    Eigen::MatrixXd& update = updates[s];
    factor.setZero(n_columns + n_below, n_columns);
    update.setZero(n_below, n_below);
    for (int column = node.begin; column < node.end; ++column)
      for (int k = begin[column]; k < begin[column + 1]; ++k)
        factor(in_front[row[k]], column - node.begin) += value[k];
    for (const int child : children[s]) {
      const std::vector<int>& places = nodes_[child].below;
      const Eigen::MatrixXd& from = updates[child];
      const int size = static_cast<int>(places.size());
      for (int j = 0; j < size; ++j) {
        const int column = in_front[places[j]];
        double* to = column < n_columns
                         ? factor.data() + static_cast<std::ptrdiff_t>(column) * factor.rows()
                         : update.data() +
                               static_cast<std::ptrdiff_t>(column - n_columns) * n_below -
                               n_columns;
        for (int i = j; i < size; ++i)
          to[in_front[places[i]]] += from(i, j);
      }
      updates[child].resize(0, 0);
    }
    auto top = factor.topRows(n_columns);
    Eigen::Ref<Eigen::MatrixXd> pivots(top);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factored(pivots);
    if (factored.info() != Eigen::Success)
      return false;
    if (n_below == 0)
      continue;
    auto bottom = factor.bottomRows(n_below);
    pivots.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(bottom);
    update.selfadjointView<Eigen::Lower>().rankUpdate(bottom, -1);
  }
  return true;
}

void MultifrontalCholesky::solve(Eigen::VectorXd& x) const {
  Eigen::VectorXd ordered(x.size()), part;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    ordered[place_of_[i]] = x[i];
  for (const Supernode& node : nodes_) {
    auto own = ordered.segment(node.begin, node.n_columns());
    node.factor.topRows(node.n_columns()).triangularView<Eigen::Lower>().solveInPlace(own);
    part.noalias() = node.factor.bottomRows(node.below.size()) * own;
    for (std::size_t i = 0; i < node.below.size(); ++i)
      ordered[node.below[i]] -= part[i];
  }
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    auto own = ordered.segment(node->begin, node->n_columns());
    part.resize(node->below.size());
    for (std::size_t i = 0; i < node->below.size(); ++i)
      part[i] = ordered[node->below[i]];
    own.noalias() -= node->factor.bottomRows(node->below.size()).transpose() * part;
    node->factor.topRows(node->n_columns())
        .triangularView<Eigen::Lower>()
        .transpose()
        .solveInPlace(own);
  }
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = ordered[place_of_[i]];
}

}  // namespace lockstep
