#include "strategies/common/pressure_inverse.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <limits>
#include <vector>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/matrix_rows.hpp"
#include "multigrid/pressure_layout.hpp"
#include "solve/added_mass_diagonal.hpp"
#include "solve/preconditioner.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

namespace {

/// Local rows to pin: of each null vector of A the row of lowest id in its support.
std::vector<int> pinned_rows(const NullSpace& space, const RCP<const Map>& map) {
  if (space.empty())
    return {};
  std::vector<GlobalIndex> lowest(space.regions().n_regions,
                                  std::numeric_limits<GlobalIndex>::max());
  for (const RowRegions::Run& run : space.regions().runs) {
    for (int row = run.begin; row < run.end; ++row)
      lowest[run.region] = std::min(lowest[run.region], map->getGlobalElement(row));
  }
  min_over_ranks(map->getComm(), lowest);
  std::vector<int> rows;
  for (const auto& parts : space.vectors()) {
    double largest = 0;
    for (const NullSpace::Part& part : parts)
      largest = std::max(largest, std::abs(part.value));
    GlobalIndex pinned = std::numeric_limits<GlobalIndex>::max();
    for (const NullSpace::Part& part : parts) {
      if (std::abs(part.value) > 1e-8 * largest)
        pinned = std::min(pinned, lowest[part.region]);
    }
    if (map->isNodeGlobalElement(pinned))
      rows.push_back(map->getLocalElement(pinned));
  }
  return rows;
}

/// The local rows whose diagonal vanishes beside the largest.
std::vector<int> empty_rows(const Vector& diagonal) {
  const double least = 1e-14 * diagonal.normInf();
  const auto values = diagonal.getData();
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(values.size()); ++row) {
    if (!(values[row] > least))
      rows.push_back(row);
  }
  return rows;
}

bool is_any(const RCP<const Map>& map, const std::vector<int>& rows) {
  return sum_all(map->getComm(), static_cast<GlobalIndex>(rows.size())) > 0;
}

/// The values to add to the diagonal of A before it is inverted approximately.
std::vector<double> diagonal_shift(const BlockSystem& system, const CrsMatrix& a, bool pin) {
  const auto map = a.getRowMap();
  const auto diagonal = diagonal_of(a);
  const auto values = diagonal->getData();
  std::vector<double> shift(values.size(), 0.0);
  const std::vector<int> empty = empty_rows(*diagonal);
  if (is_any(map, empty)) {
    const double largest = diagonal->normInf();
    const auto added = added_mass_diagonal(system, map);
    const auto added_values = added->getData();
    for (const int row : empty)
      shift[row] = added_values[row] > 0 ? added_values[row] : largest;
  }
  if (pin) {
    for (const int row : pinned_rows(system.pressure_null_space, map)) {
      if (shift[row] == 0)
        shift[row] = values[row];
    }
  }
  return shift;
}

RCP<const CrsMatrix> shifted(const RCP<const CrsMatrix>& a, const std::vector<double>& shift) {
  GlobalIndex n_shifted = 0;
  for (const double value : shift) {
    n_shifted += value != 0;
  }
  if (sum_all(a->getRowMap()->getComm(), n_shifted) == 0)
    return a;
  auto rows = rows_of(*a);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (shift[row] != 0)
      rows[row].push_back({a->getRowMap()->getGlobalElement(static_cast<int>(row)), shift[row]});
  }
  return matrix_from_rows(a->getRowMap(), rows);
}

}  // namespace

RCP<const CrsMatrix> regular_pressure_block(const BlockSystem& system,
                                            const RCP<const CrsMatrix>& a) {
  return shifted(a, diagonal_shift(system, *a, true));
}

namespace {

const std::string list_name = "Pressure Inverse";
/// Largest number of sweeps: more smooth no better than another cycle.
constexpr int most_sweeps = 100;

std::string type_of(const Teuchos::ParameterList& list) {
  return list.isType<std::string>("Type") ? list.get<std::string>("Type") : "";
}

void check_multigrid_list(const Teuchos::ParameterList& list) {
  for (const auto& entry : list) {
    const std::string& key = entry.first;
    const bool fits = key == "Type" ||
                      (key == "Sweeps" && entry.second.isType<int>() && list.get<int>(key) > 0 &&
                       list.get<int>(key) <= most_sweeps) ||
                      (key == "Cycle" && entry.second.isType<std::string>() &&
                       (list.get<std::string>(key) == "V" || list.get<std::string>(key) == "W"));
    check_input(
        fits,
        "\"{}\": \"{}\" is not a parameter of type \"Multigrid\", or has a value that it "
        "cannot have. It takes \"Sweeps\" (int, from 1 to {}) and \"Cycle\" (string, V or W).",
        list_name, key, most_sweeps);
  }
}

}  // namespace

void declare_pressure_inverse(Teuchos::ParameterList& list, const std::string& doc) {
  declare_inverse(list, list_name,
                  doc +
                      " \"Type\" may also be Automatic (Multigrid where the fluid allows it, else "
                      "MueLu) or Multigrid (\"Sweeps\", 2; \"Cycle\", V).");
}

Teuchos::ParameterList pressure_inverse_list(const Teuchos::ParameterList& list,
                                             const std::string& standard_type) {
  Teuchos::ParameterList standard;
  standard.set("Type", standard_type);
  if (!list.isSublist(list_name) || list.sublist(list_name).numParams() == 0)
    return standard;
  const Teuchos::ParameterList& given = list.sublist(list_name);
  const std::string type = type_of(given);
  if (type != "Multigrid" && type != "Automatic")
    return inverse_list(list, list_name, standard, {"Automatic", "Multigrid"});
  if (type == "Multigrid")
    check_multigrid_list(given);
  else
    check_input(given.numParams() == 1, "\"{}\": type \"Automatic\" takes no other parameters.",
                list_name);
  return given;
}

Teuchos::ParameterList incomplete_cholesky_list(const Teuchos::ParameterList& given) {
  return pressure_inverse_list(given, "Incomplete Cholesky");
}

bool is_multigrid(const Teuchos::ParameterList& list, const BlockSystem& system) {
  const std::string type = type_of(list);
  return type == "Multigrid" || (type == "Automatic" && PressureLayout::why_not(system).empty());
}

MultigridOptions multigrid_options(const Teuchos::ParameterList& list) {
  MultigridOptions options;
  if (list.isParameter("Sweeps"))
    options.n_sweeps = list.get<int>("Sweeps");
  if (list.isParameter("Cycle"))
    options.is_w_cycle = list.get<std::string>("Cycle") == "W";
  return options;
}

RCP<const LinearOperator> multigrid_in_fluid_order(const BlockSystem& system,
                                                   const MultigridOptions& options) {
  const auto layout = PressureLayout::make(system, options, nullptr);
  const auto r_layout = make_vector(layout->map()), z_layout = make_vector(layout->map());
  return action_operator(domain_map(*system.pressure_block()), [=](const Vector& r, Vector& z) {
    layout->to_layout(r, *r_layout);
    apply(*layout->inverse(), *r_layout, *z_layout);
    layout->from_layout(*z_layout, z);
  });
}

bool leaves_rows_empty(const RCP<const LinearOperator>& pressure_block) {
  const auto a = assembled(pressure_block);
  return !a.is_null() && is_any(a->getRowMap(), empty_rows(*diagonal_of(*a)));
}

std::string inverse_type(const Teuchos::ParameterList& list, bool is_multigrid) {
  if (is_multigrid)
    return "Multigrid";
  return type_of(list) == "Automatic" ? "MueLu" : type_of(list);
}

RCP<const LinearOperator> pressure_inverse(const BlockSystem& system,
                                           const Teuchos::ParameterList& given) {
  Teuchos::ParameterList list(given);
  if (type_of(list) == "Automatic") {  // whatever it says of the multigrid
    list = Teuchos::ParameterList();
    list.set("Type", inverse_type(given, false));
  }
  auto op = system.pressure_block();
  if (const auto a = assembled(op); !a.is_null()) {
    const std::string type = type_of(list);
    // types that solve exactly, or nearly so, which fails for a singular A
    const bool factors = type == "Incomplete Cholesky" || type == "Ifpack2" || type == "Direct" ||
                         type == "Exact" || type == "Conjugate Gradients";
    // MueLu factors its coarsest level. If that is singular, the iteration can project out null
    // vectors that are also those of the system, but not those of regions that a soft shell closes;
    // and a region of a few cells can come down to a row of zeros, whose inverse is not finite.
    const bool has_pockets = system.pressure_null_space.size() > system.null_space.size() ||
                             system.pressure_null_space.size() > 1;
    const auto regular =
        shifted(a, diagonal_shift(system, *a, factors || (type == "MueLu" && has_pockets)));
    if (regular != a)
      op = as_operator(regular);
  }
  return preconditioner_from_list(op, list, "pressure block of the " + system.name);
}

}  // namespace lockstep
