#include "deformable/node_space.hpp"

#include <metis.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <numeric>

#include "base/errors.hpp"
#include "base/signals.hpp"

namespace lockstep {

namespace {

/// The dofs of nodes with these global numbers.
template <int dim>
std::vector<GlobalIndex> dofs_of(const std::vector<int>& global_nodes) {
  std::vector<GlobalIndex> dofs;
  for (const int node : global_nodes) {
    for (int a = 0; a < dim; ++a)
      dofs.push_back(GlobalIndex(dim) * node + a);
  }
  return dofs;
}

template <int dim>
std::vector<Point<dim>> points(const Vector& values) {
  const auto data = values.getData();
  std::vector<Point<dim>> result(data.size() / dim);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = Eigen::Map<const Point<dim>>(data.get() + dim * i);
  return result;
}

/// Marks the nodes of elements that touch a node of `rank`.
std::vector<char> seen_nodes(const std::vector<ElementCorners>& elements,
                             const std::vector<int>& rank_of_node, int rank) {
  std::vector<char> seen(rank_of_node.size(), 0);
  for (std::size_t n = 0; n < seen.size(); ++n)
    seen[n] = rank_of_node[n] == rank;
  for (const ElementCorners& kind : elements) {
    for (std::size_t e = 0; e < kind.nodes.size(); e += kind.n_corners) {
      const auto begin = kind.nodes.begin() + e, end = begin + kind.n_corners;
      if (std::any_of(begin, end, [&](int n) { return rank_of_node[n] == rank; })) {
        std::for_each(begin, end, [&](int n) { seen[n] = 1; });
      }
    }
  }
  return seen;
}

}  // namespace

std::vector<int> partition_nodes(int n_nodes, const std::vector<ElementCorners>& elements,
                                 int n_parts) {
  std::vector<int> parts(n_nodes, 0);
  if (n_parts == 1)
    return parts;
  if (n_nodes <= n_parts) {
    std::iota(parts.begin(), parts.end(), 0);
    return parts;
  }
  const NodeMatrix<2> pattern(n_nodes, elements);
  std::vector<idx_t> row_begin{0}, neighbors;
  for (int row = 0; row < n_nodes; ++row) {
    for (int k = pattern.row_begin(row); k < pattern.row_end(row); ++k) {
      if (pattern.column(k) != row)
        neighbors.push_back(pattern.column(k));
    }
    row_begin.push_back(static_cast<idx_t>(neighbors.size()));
  }
  idx_t n = n_nodes, n_constraints = 1, n_wanted = n_parts, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  const auto metis = n_parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  std::vector<idx_t> result(n_nodes, 0);
  const HeldSignals held;
  const int status = metis(&n, &n_constraints, row_begin.data(), neighbors.data(), nullptr, nullptr,
                           nullptr, &n_wanted, nullptr, nullptr, options, &cut, result.data());
  check_input(status == METIS_OK,
              "METIS could not divide the {} nodes of the deformable bodies among {} ranks (status "
              "{}); use fewer ranks.",
              n_nodes, n_parts, status);
  parts.assign(result.begin(), result.end());
  return parts;
}

template <int dim>
NodeSpace<dim>::NodeSpace(int n_nodes, const std::vector<ElementCorners>& elements,
                          const Communicator& comm) {
  const int rank = comm->getRank();
  numbers_.rank = partition_nodes(n_nodes, elements, comm->getSize());
  std::vector<int> order(n_nodes);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [this](int a, int b) { return numbers_.rank[a] < numbers_.rank[b]; });
  numbers_.global.resize(n_nodes);
  for (int i = 0; i < n_nodes; ++i)
    numbers_.global[order[i]] = i;

  const std::vector<char> seen = seen_nodes(elements, numbers_.rank, rank);
  for (int n = 0; n < n_nodes; ++n) {
    if (numbers_.rank[n] == rank)
      originals_.push_back(n);
  }
  n_owned_ = static_cast<int>(originals_.size());
  for (int n = 0; n < n_nodes; ++n) {
    if (seen[n] && numbers_.rank[n] != rank)
      originals_.push_back(n);
  }
  numbers_.local.assign(n_nodes, -1);
  std::vector<int> global;
  for (int i = 0; i < n_local(); ++i) {
    numbers_.local[originals_[i]] = i;
    global.push_back(numbers_.global[originals_[i]]);
  }
  map_ = make_map(n_owned_ * dim, comm);
  const std::vector<GlobalIndex> dofs = dofs_of<dim>(global);
  overlap_map_ = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                             Teuchos::arrayViewFromVector(dofs), 0, comm));
  import_ = rcp(new Import(map_, overlap_map_));
}

template <int dim>
std::vector<Point<dim>> NodeSpace<dim>::owned(const Vector& values) const {
  return points<dim>(values);
}

template <int dim>
std::vector<Point<dim>> NodeSpace<dim>::with_ghosts(const Vector& values) const {
  Vector overlap(overlap_map_);
  overlap.doImport(values, *import_, Tpetra::INSERT);
  return points<dim>(overlap);
}

template <int dim>
RCP<Vector> NodeSpace<dim>::vector(const Nodes& owned) const {
  const auto result = make_vector(map_);
  const auto data = result->getDataNonConst();
  for (int i = 0; i < n_owned_; ++i) {
    for (int a = 0; a < dim; ++a)
      data[dim * i + a] = owned[i][a];
  }
  return result;
}

template <int dim>
RCP<const CrsMatrix> NodeSpace<dim>::matrix(const NodeMatrix<dim>& blocks) const {
  const bool first = pattern_.is_null();
  std::vector<std::size_t> row_sizes;
  for (int row = 0; first && row < n_owned_; ++row) {
    row_sizes.insert(row_sizes.end(), dim, dim * (blocks.row_end(row) - blocks.row_begin(row)));
  }
  const RCP<CrsMatrix> result =
      first ? rcp(new CrsMatrix(map_, overlap_map_, Teuchos::arrayViewFromVector(row_sizes)))
            : rcp(new CrsMatrix(pattern_->getCrsGraph()));
  std::vector<int> columns;
  std::vector<double> values;
  for (int row = 0; row < n_owned_; ++row) {
    columns.clear();
    for (int k = blocks.row_begin(row); k < blocks.row_end(row); ++k) {
      for (int b = 0; b < dim; ++b)
        columns.push_back(dim * blocks.column(k) + b);
    }
    for (int a = 0; a < dim; ++a) {
      values.clear();
      for (int k = blocks.row_begin(row); k < blocks.row_end(row); ++k) {
        for (int b = 0; b < dim; ++b)
          values.push_back(blocks.block(k)(a, b));
      }
      if (first) {
        result->insertLocalValues(dim * row + a, Teuchos::arrayViewFromVector(columns),
                                  Teuchos::arrayViewFromVector(values));
      } else {
        result->replaceLocalValues(dim * row + a, Teuchos::arrayViewFromVector(columns),
                                   Teuchos::arrayViewFromVector(values));
      }
    }
  }
  result->fillComplete(map_, map_);
  pattern_ = result;
  return result;
}

template class NodeSpace<2>;
template class NodeSpace<3>;

}  // namespace lockstep
