#include "lines/lines.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/vector_sums.hpp"

namespace lockstep {

namespace {

constexpr int row_of_end(int line, int end, int dim) {
  return (2 * line + end) * dim;
}

/// A matrix with full blocks of the rows of each line, given by the slope between its ends.
template <int dim, typename Slope>
RCP<const LinearOperator> matrix_of_lines(const RCP<const Map>& map, const Slope& slope) {
  constexpr int n = 2 * dim;
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map, map, n));
  const int n_lines = static_cast<int>(map->getNodeNumElements()) / n;
  for (int line = 0; line < n_lines; ++line) {
    const Eigen::Matrix<double, dim, dim> block = slope(line);
    for (int row = 0; row < n; ++row) {
      std::array<int, n> columns{};
      std::array<double, n> entries{};
      for (int column = 0; column < n; ++column) {
        const double sign = row / dim == column / dim ? -1 : 1;
        columns[column] = row_of_end(line, 0, dim) + column;
        entries[column] = sign * block(row % dim, column % dim);
      }
      matrix->insertLocalValues(row_of_end(line, 0, dim) + row,
                                Teuchos::arrayView(columns.data(), n),
                                Teuchos::arrayView(entries.data(), n));
    }
  }
  matrix->fillComplete(map, map);
  return as_operator(matrix);
}

}  // namespace

template <int dim>
Lines<dim>::Lines(std::string type, std::vector<Line<dim>> lines, const Communicator& comm)
    : type_(std::move(type)), lines_(std::move(lines)), comm_(comm) {
  for (const Line<dim>& line : lines_) {
    SolidDescription solid;
    solid.name = line.name;
    solid.closed = false;
    solid.rigid = solid.prescribed = true;  // neither fluid nor contact has anything to ask of it
    solid.index_in_model = static_cast<int>(solids_.size());
    solids_.push_back(solid);
    before_.push_back(line.ends);
    velocity_.push_back({Point<dim>::Zero(), Point<dim>::Zero()});
  }
  map_ = make_map(is_root(comm) ? row_of_end(static_cast<int>(lines_.size()), 0, dim) : 0, comm);
  mass_ = matrix_of_lines<dim>(map_, [](int) {
    return Eigen::Matrix<double, dim, dim>(Eigen::Matrix<double, dim, dim>::Zero());
  });
}

template <int dim>
typename Lines<dim>::Law Lines<dim>::law(int line) const {
  const double lead = step_dt_ / 2;
  const Ends& now = lines_[line].ends;
  const Ends& then = before_[line];
  const Point<dim> way = now[1] - now[0];
  Law law{};
  if (!has_moved_) {
    const LineResponse<dim> response = lines_[line].law->response(way);
    law.spring = response.force;
    law.damper = {Point<dim>::Zero(), Point<dim>::Zero()};
    law.spring_slope = lead * response.stiffness;
    law.damper_slope = response.damping;
    return law;
  }
  const Point<dim> way_before = then[1] - then[0];
  const LineResponse<dim> response = lines_[line].law->response((way + way_before) / 2);
  law.spring_slope = lead * response.stiffness;
  law.damper_slope = response.damping / 2;
  const Point<dim> by_motion = law.spring_slope * (way - way_before) / step_dt_;
  const Point<dim> drag = law.damper_slope * (velocity_[line][1] - velocity_[line][0]);
  law.spring = {Point<dim>(response.force[0] - by_motion),
                Point<dim>(response.force[1] + by_motion)};
  law.damper = {drag, Point<dim>(-drag)};
  return law;
}

template <int dim>
RCP<const LinearOperator> Lines<dim>::implicit_force(double) const {
  return matrix_of_lines<dim>(map_, [this](int line) {
    const Law own = law(line);
    return Eigen::Matrix<double, dim, dim>(own.spring_slope + own.damper_slope);
  });
}

template <int dim>
void Lines<dim>::explicit_momentum(double, double dt, Vector& momentum) const {
  momentum.putScalar(0);
  if (dt == 0 || !is_root(comm_))
    return;
  const auto values = momentum.getDataNonConst();
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    const Law own = law(line);
    for (int end = 0; end < 2; ++end) {
      const Point<dim> impulse = dt * (own.spring[end] + own.damper[end]);
      std::copy_n(impulse.data(), dim, values.begin() + row_of_end(line, end, dim));
    }
  }
}

template <int dim>
void Lines<dim>::set_gravity(const Point<dim>& gravity) {
  check_input(
      type_ != "mooring line" || !gravity_ || *gravity_ == gravity,
      "The mooring line \"{}\" hangs under its weight, which \"Fluid/Gravity\" changes; make "
      "gravity numbers, or the line a \"spring\".",
      lines_.front().name);
  gravity_ = gravity;
}

template <int dim>
void Lines<dim>::begin_step(double, double dt) {
  step_dt_ = dt;
  has_moved_ = false;
}

template <int dim>
std::vector<GlobalIndex> Lines<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  for (int line = 0; is_root(comm_) && line < static_cast<int>(lines_.size()); ++line) {
    for (int end = 0; end < 2; ++end) {
      for (int a = 0; lines_[line].solids[end].empty() && a < dim; ++a)
        dofs.push_back(row_of_end(line, end, dim) + a);
    }
  }
  return dofs;
}

template <int dim>
std::vector<NodeAttachment<dim>> Lines<dim>::attachments() const {
  std::vector<NodeAttachment<dim>> nodes;
  for (int line = 0; is_root(comm_) && line < static_cast<int>(lines_.size()); ++line) {
    for (int end = 0; end < 2; ++end) {
      if (lines_[line].solids[end].empty())
        continue;
      NodeAttachment<dim> node;
      for (int a = 0; a < dim; ++a)
        node.dofs[a] = row_of_end(line, end, dim) + a;
      node.position = lines_[line].ends[end];
      node.solid = lines_[line].solids[end];
      node.line = lines_[line].name;
      nodes.push_back(node);
    }
  }
  return nodes;
}

/// The weight of lines, and torques of forces that were taken at the middle of the way.
template <int dim>
Momentum<dim> Lines<dim>::external_impulse(double, double dt) const {
  Momentum<dim> total;
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    const Law own = law(line);
    for (int end = 0; end < 2; ++end)
      total.add(lines_[line].ends[end], dt * (own.spring[end] + own.damper[end]));
  }
  return total;
}

template <int dim>
std::vector<typename Lines<dim>::Ends> Lines<dim>::gather(const Vector& values) const {
  std::vector<double> all(2 * dim * lines_.size(), 0);
  if (is_root(comm_)) {
    const auto mine = values.getData();
    std::copy(mine.begin(), mine.end(), all.begin());
  }
  sum_over_ranks(comm_, all);
  std::vector<Ends> result(lines_.size());
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    for (int end = 0; end < 2; ++end)
      result[line][end] = Eigen::Map<const Point<dim>>(&all[row_of_end(line, end, dim)]);
  }
  return result;
}

template <int dim>
std::vector<Momentum<dim>> Lines<dim>::momentum_of_each(const Vector& generalized_momentum) const {
  const std::vector<Ends> values = gather(generalized_momentum);
  std::vector<Momentum<dim>> all(lines_.size());
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    for (int end = 0; end < 2; ++end)
      all[line].add(lines_[line].ends[end], values[line][end]);
  }
  return all;
}

template <int dim>
std::optional<SolidWork> Lines<dim>::solid_work(double, double dt, const Vector& velocity,
                                                const Vector& mean) const {
  const std::vector<Ends> end = gather(velocity), middle = gather(mean);
  SolidWork work;
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    const Law own = law(line);
    const Point<dim> opening = middle[line][1] - middle[line][0];
    const Point<dim> at_end = end[line][1] - end[line][0];
    work.elastic -= dt * opening.dot(own.spring_slope * at_end);
    work.damping -= dt * opening.dot(own.damper_slope * at_end);
    for (int k = 0; k < 2; ++k) {
      work.elastic += dt * own.spring[k].dot(middle[line][k]);
      work.damping += dt * own.damper[k].dot(middle[line][k]);
    }
  }
  return work;
}

template <int dim>
RCP<const Vector> Lines<dim>::velocity() const {
  const RCP<Vector> result = make_vector(map_);
  const auto values = result->getDataNonConst();
  for (int line = 0; is_root(comm_) && line < static_cast<int>(lines_.size()); ++line) {
    for (int end = 0; end < 2; ++end)
      std::copy_n(velocity_[line][end].data(), dim, values.begin() + row_of_end(line, end, dim));
  }
  return result;
}

template <int dim>
void Lines<dim>::set_velocity(const Vector& velocity) {
  velocity_ = gather(velocity);
}

template <int dim>
void Lines<dim>::move(const Vector& velocity, double, double dt) {
  const std::vector<Ends> values = gather(velocity);
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    before_[line] = lines_[line].ends;
    for (int end = 0; end < 2; ++end)
      lines_[line].ends[end] += dt * values[line][end];
  }
  has_moved_ = true;
}

template <int dim>
std::vector<SolidState<dim>> Lines<dim>::states() const {
  std::vector<SolidState<dim>> all;
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    const Line<dim>& one = lines_[line];
    SolidState<dim> state;
    state.name = one.name;
    state.center_of_mass = (one.ends[0] + one.ends[1]) / 2;
    state.velocity = (velocity_[line][0] + velocity_[line][1]) / 2;
    state.elastic_energy = present(one).energy - one.law->weight().dot(one.ends[0]);
    all.push_back(state);
  }
  return all;
}

template <int dim>
std::vector<LineState> Lines<dim>::line_states() const {
  std::vector<LineState> all;
  for (const Line<dim>& line : lines_)
    all.push_back({line.name, (line.ends[1] - line.ends[0]).norm(), present(line).tension});
  return all;
}

template class Lines<2>;
template class Lines<3>;

}  // namespace lockstep
