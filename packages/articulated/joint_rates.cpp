#include "articulated/joint_rates.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/vector_sums.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

constexpr const char* group = "joints";
const std::string names_path = std::string(group) + "/names";
const std::string values_path = std::string(group) + "/values";

/// Zero where there is no entry. Rank 0 has all rows.
RCP<const LinearOperator> diagonal(const RCP<const Map>& map, const Eigen::VectorXd& entries) {
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map, map, 1));
  for (int row = 0; row < static_cast<int>(map->getNodeNumElements()); ++row) {
    const double entry = row < entries.size() ? entries[row] : 0;
    matrix->insertLocalValues(row, Teuchos::arrayView(&row, 1), Teuchos::arrayView(&entry, 1));
  }
  matrix->fillComplete(map, map);
  return as_operator(matrix);
}

template <int dim>
std::string joined_names(const Articulation<dim>& articulation) {
  std::string names;
  for (const Joint<dim>& joint : articulation.joints())
    names += joint.name + " " + joint.type + "\n";
  return names;
}

}  // namespace

template <int dim>
JointRates<dim>::JointRates(std::shared_ptr<Articulation<dim>> articulation,
                            const Communicator& comm, double start_time)
    : articulation_(std::move(articulation)),
      comm_(comm),
      map_(make_map(is_root(comm) ? articulation_->n_dofs() : 0, comm)),
      mass_(diagonal(map_, {})),
      time_(start_time) {}

template <int dim>
RCP<const LinearOperator> JointRates<dim>::implicit_force(double) const {
  if (!articulation_->any_acts())
    return Teuchos::null;
  return diagonal(map_, -articulation_->control().slope);
}

template <int dim>
void JointRates<dim>::explicit_momentum(double, double dt, Vector& momentum) const {
  momentum.putScalar(0);
  if (!articulation_->any_acts() || !is_root(comm_))
    return;
  const Eigen::VectorXd impulse = dt * articulation_->control().constant;
  std::copy_n(impulse.data(), impulse.size(), momentum.getDataNonConst().begin());
}

template <int dim>
std::optional<SolidWork> JointRates<dim>::solid_work(double time, double dt, const Vector& velocity,
                                                     const Vector& mean) const {
  SolidWork work;
  if (!articulation_->any_acts())
    return work;
  Vector impulse(map_);
  explicit_momentum(time, dt, impulse);
  apply(*implicit_force(dt), velocity, impulse, dt, 1);
  work.control = dot(impulse, mean);
  return work;
}

template <int dim>
std::vector<GlobalIndex> JointRates<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  const std::vector<char>& given = articulation_->given();
  for (int k = 0; k < articulation_->n_dofs() && is_root(comm_); ++k) {
    if (k >= articulation_->n_rates() || given[k])
      dofs.push_back(k);
  }
  return dofs;
}

template <int dim>
std::vector<double> JointRates<dim>::locked_velocities(double begin, double end) const {
  std::vector<double> values;
  for (const Joint<dim>& joint : articulation_->joints()) {
    if (!joint.control.any_given() || !is_root(comm_))
      continue;
    Eigen::VectorXd rates = joint.goal.rate;
    if (end > begin)
      rates = joint.kind->distance_to(joint.kind->pose_of(joint.q), joint.goal.q) / (end - begin);
    for (int k = 0; k < rates.size(); ++k) {
      if (joint.control.given(k))
        values.push_back(rates[k]);
    }
  }
  const auto& bodies = articulation_->bodies();
  for (int b = 0; b < static_cast<int>(bodies.size()) && is_root(comm_); ++b) {
    if (!bodies[b].prescribed())
      continue;
    const TwistVector<dim> twist = articulation_->prescribed_twist(b, begin, end);
    values.insert(values.end(), twist.data(), twist.data() + twist.size());
  }
  return values;
}

template <int dim>
Eigen::VectorXd JointRates<dim>::gather(const Vector& velocity) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(articulation_->n_rates());
  const auto values = velocity.getData();
  if (is_root(comm_))
    std::copy_n(values.begin(), all.size(), all.data());
  sum_over_ranks(comm_, all);
  return all;
}

template <int dim>
RCP<const Vector> JointRates<dim>::velocity() const {
  const RCP<Vector> result = make_vector(map_);
  const Eigen::VectorXd& rates = articulation_->rates();
  const auto values = result->getDataNonConst();
  auto next = values.begin();
  if (is_root(comm_)) {
    next = std::copy_n(rates.data(), rates.size(), next);
    for (int b = 0; b < static_cast<int>(articulation_->bodies().size()); ++b) {
      if (!articulation_->bodies()[b].prescribed())
        continue;
      const TwistVector<dim> twist = articulation_->prescribed_twist(b, time_, time_);
      next = std::copy_n(twist.data(), twist.size(), next);
    }
  }
  return result;
}

template <int dim>
void JointRates<dim>::set_velocity(const Vector& velocity) {
  articulation_->rates() = gather(velocity);
}

template <int dim>
void JointRates<dim>::move(const Vector& velocity, double time, double dt) {
  articulation_->update_coordinates(dt * gather(velocity));
  time_ = time + dt;
}

template <int dim>
StepBound JointRates<dim>::largest_stable_step() const {
  const double fastest = articulation_->fastest_turn();
  if (fastest == 0)
    return {};
  return {articulation_->options().largest_turn / fastest, "Largest Turn of joints",
          "A larger \"Time/Largest Turn\" allows more, at the price of energy."};
}

template <int dim>
std::vector<double> JointRates<dim>::state() const {
  std::vector<double> values{time_};
  const Eigen::VectorXd& rates = articulation_->rates();
  values.insert(values.end(), rates.data(), rates.data() + rates.size());
  for (const Joint<dim>& joint : articulation_->joints())
    values.insert(values.end(), joint.q.data(), joint.q.data() + joint.q.size());
  return values;
}

template <int dim>
void JointRates<dim>::set_state(const std::vector<double>& values) {
  auto next = values.begin();
  time_ = *next++;
  for (double& rate : articulation_->rates())
    rate = *next++;
  for (Joint<dim>& joint : articulation_->joints()) {
    for (double& coordinate : joint.q)
      coordinate = *next++;
  }
}

template <int dim>
void JointRates<dim>::save(CheckpointWriter& writer) const {
  writer.file().create_group(group);
  writer.file().write_text(names_path, joined_names(*articulation_));
  writer.file().write_replicated(values_path, state());
}

template <int dim>
void JointRates<dim>::load(const CheckpointReader& reader) {
  const Hdf5File& file = reader.file();
  check_input(file.exists(names_path) && file.read_text(names_path) == joined_names(*articulation_),
              "{}: the checkpoint does not hold the joints of this scene; restart with the scene "
              "that wrote it.",
              file.path());
  const std::vector<double> values = file.read_all<double>(values_path);
  check_input(values.size() == state().size(),
              "{}: the checkpoint's joints are incomplete; restart from another one.", file.path());
  set_state(values);
}

template class JointRates<2>;
template class JointRates<3>;

}  // namespace lockstep
