#include "linear/null_space.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "linear/vector_sums.hpp"

namespace lockstep {

std::shared_ptr<const RowRegions> RowRegions::from(const RCP<const Map>& map, int n_regions,
                                                   const std::vector<int>& region_of_row) {
  auto regions = std::make_shared<RowRegions>();
  regions->map = map;
  regions->n_regions = n_regions;
  for (int row = 0; row < static_cast<int>(region_of_row.size()); ++row) {
    const int region = region_of_row[row];
    if (region < 0)
      continue;
    auto& runs = regions->runs;
    if (!runs.empty() && runs.back().end == row && runs.back().region == region)
      runs.back().end = row + 1;
    else
      runs.push_back({row, row + 1, region});
  }
  return regions;
}

std::vector<double> RowRegions::sums_of(const Vector& x) const {
  std::vector<double> sums(n_regions, 0);
  const auto values = x.getData();
  for (const Run& run : runs)
    sums[run.region] += sum(values.getRawPtr() + run.begin, run.end - run.begin);
  sum_over_ranks(map->getComm(), sums);
  return sums;
}

std::vector<double> RowRegions::n_rows() const {
  std::vector<double> counts(n_regions, 0);
  for (const Run& run : runs)
    counts[run.region] += run.end - run.begin;
  sum_over_ranks(map->getComm(), counts);
  return counts;
}

RCP<Vector> RowRegions::numbers() const {
  const auto result = make_vector(map);
  result->putScalar(-1);
  const auto values = result->getDataNonConst();
  for (const Run& run : runs)
    std::fill(values.begin() + run.begin, values.begin() + run.end, run.region);
  return result;
}

namespace {

/// x += the value of each region, on its rows.
void add(const RowRegions& regions, const std::vector<double>& value, Vector& x) {
  const auto values = x.getDataNonConst();
  for (const RowRegions::Run& run : regions.runs) {
    const double change = value[run.region];
    if (change == 0)
      continue;
    for (int row = run.begin; row < run.end; ++row)
      values[row] += change;
  }
}

}  // namespace

RCP<Vector> NullSpace::vector(std::size_t k) const {
  const auto result = make_vector(regions_->map);
  std::vector<double> factors(size(), 0);
  factors[k] = 1;
  add_vectors(*this, factors, *result);
  return result;
}

NullSpace NullSpace::moved_to(const RCP<const Map>& map, const std::vector<int>& place) const {
  if (empty())
    return {};
  std::vector<int> region_of_row(map->getNodeNumElements(), -1);
  for (const RowRegions::Run& run : regions_->runs) {
    for (int row = run.begin; row < run.end; ++row)
      region_of_row[place[row]] = run.region;
  }
  return {RowRegions::from(map, regions_->n_regions, region_of_row), vectors_};
}

NullSpace null_space_of(const std::vector<RCP<const Vector>>& vectors) {
  if (vectors.empty())
    return {};
  using Values = std::vector<double>;  // values of all vectors in one row
  const RCP<const Map> map = vectors.front()->getMap();
  const std::size_t n_rows = map->getNodeNumElements();
  std::vector<Values> of_row(n_rows);
  for (const auto& vector : vectors) {
    const auto values = vector->getData();
    for (std::size_t row = 0; row < n_rows; ++row)
      of_row[row].push_back(values[row]);
  }
  const auto distinct = [](std::vector<Values> all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  };
  Values mine;
  for (const Values& values : distinct(of_row))
    mine.insert(mine.end(), values.begin(), values.end());
  const Values gathered = gather_all(map->getComm(), mine);
  std::vector<Values> regions;
  for (auto begin = gathered.begin(); begin != gathered.end(); begin += vectors.size())
    regions.emplace_back(begin, begin + vectors.size());
  regions = distinct(std::move(regions));
  std::vector<int> region_of_row(n_rows);
  for (std::size_t row = 0; row < n_rows; ++row)
    region_of_row[row] = static_cast<int>(
        std::lower_bound(regions.begin(), regions.end(), of_row[row]) - regions.begin());
  std::vector<std::vector<NullSpace::Part>> parts(vectors.size());
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (regions[r][k] != 0)
        parts[k].push_back({static_cast<int>(r), regions[r][k]});
    }
  }
  return {RowRegions::from(map, static_cast<int>(regions.size()), region_of_row), parts};
}

std::vector<double> components(const NullSpace& space, const Vector& x) {
  std::vector<double> result;
  if (space.empty())
    return result;
  const std::vector<double> sums = space.regions().sums_of(x);
  for (const auto& parts : space.vectors()) {
    double component = 0;
    for (const NullSpace::Part& part : parts)
      component += part.value * sums[part.region];
    result.push_back(component);
  }
  return result;
}

void add_vectors(const NullSpace& space, const std::vector<double>& factors, Vector& x) {
  if (space.empty())
    return;
  std::vector<double> values(space.regions().n_regions, 0);
  for (std::size_t k = 0; k < space.size(); ++k) {
    for (const NullSpace::Part& part : space.vectors()[k])
      values[part.region] += factors[k] * part.value;
  }
  add(space.regions(), values, x);
}

double project_out(const NullSpace& space, Vector& x) {
  std::vector<double> removed = components(space, x);
  double squares = 0;
  for (double& component : removed) {
    squares += component * component;
    component = -component;
  }
  add_vectors(space, removed, x);
  return std::sqrt(squares);
}

double relative_part_removed(const NullSpace& space, Vector& x) {
  if (space.empty())
    return 0;
  const double before = x.norm2();
  const double removed = project_out(space, x);
  // Where nearly all is removed, what is left still holds round-off of the first projection.
  project_out(space, x);
  return before > 0 ? removed / before : 0;
}

}  // namespace lockstep
