#pragma once
#include "observers/carried_points.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "nodes".
template <int dim>
ParameterList nodes_parameters();

/// Place, displacement and velocity of points of a solid, a row a point.
template <int dim>
class Nodes : public Observer<dim> {
 public:
  explicit Nodes(const ParameterList& list);
  std::string name() const override { return "nodes"; }
  std::vector<ObservedColumn> columns() const override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;
  void save(CheckpointWriter& writer) const override { points_.save(writer); }
  void load(const CheckpointReader& reader) override { points_.load(reader); }

 private:
  CarriedPoints<dim> points_;
};

}  // namespace lockstep
