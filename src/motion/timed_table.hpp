#pragma once
#include <boost/math/interpolators/cubic_hermite.hpp>
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// One coordinate of a table in time: a monotone cubic, constant before and after.
class TimedColumn {
 public:
  /// Two or more ascending times [s], and as many values.
  TimedColumn(const std::vector<double>& times, const std::vector<double>& values);

  double value(double time) const;
  double slope(double time) const;  ///< per second

 private:
  double first_, last_;
  boost::math::interpolators::cubic_hermite<std::vector<double>> curve_;
};

/// Declares the "Times" of a table.
void declare_times(ParameterList& table);
/// The "Times" of a validated table, which `where` names in messages. Throws InputError unless two
/// or more ascend.
std::vector<double> read_times(const ParameterList& table, const std::string& where);
/// The columns of the rows of a table, `n_components` numbers for each time one after another;
/// empty if the parameter `name` is absent. Throws InputError if there are more or fewer.
std::vector<TimedColumn> read_columns(const ParameterList& table, const std::string& name,
                                      const std::vector<double>& times, int n_components,
                                      const std::string& where);

}  // namespace lockstep
