#include "liquid/drops/drops.hpp"

#include <algorithm>
#include <cmath>

#include "transport/largest_move.hpp"

namespace lockstep {

namespace {
/// Least distance of a drop from a closed side [cells].
constexpr double drops_to_side = 1e-3;
/// Distance that drops keep from solids [cells]; in corners, half of it after each attempt.
constexpr double clearance_of_drops = 0.1;
constexpr int attempts = 8;
const char* const file_name = "fluid/drops";

/// Position, velocity, volume.
template <int dim>
constexpr int numbers_of_drop = 2 * dim + 1;

template <int dim>
void pack(const Drop<dim>& drop, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), drop.position.begin(), drop.position.end());
  numbers.insert(numbers.end(), drop.velocity.begin(), drop.velocity.end());
  numbers.push_back(drop.volume);
}

template <int dim>
Drop<dim> unpack(const double* numbers) {
  Drop<dim> drop;
  for (int a = 0; a < dim; ++a) {
    drop.position[a] = numbers[a];
    drop.velocity[a] = numbers[dim + a];
  }
  drop.next = drop.velocity;
  drop.volume = numbers[2 * dim];
  return drop;
}
}  // namespace

template <int dim>
bool Drops<dim>::stop_at_sides(Point<dim>& place, Point<dim>& velocity) const {
  const double h = domain_.spacing();
  for (int a = 0; a < dim; ++a) {
    if (domain_.boundary.periodic(a))
      continue;
    const double lower = domain_.grid.lower()[a];
    const double upper = lower + domain_.grid.n_cells()[a] * h;
    for (int end = 0; end < 2; ++end) {
      const double inside = end == 0 ? place[a] - lower : upper - place[a];
      const bool is_closed = domain_.boundary.side(a, end).prescribed();
      if (inside >= (is_closed ? drops_to_side * h : 0))
        continue;
      if (!is_closed)
        return false;
      place[a] = end == 0 ? lower + drops_to_side * h : upper - drops_to_side * h;
      velocity[a] = end == 0 ? std::max(velocity[a], 0.0) : std::min(velocity[a], 0.0);
    }
  }
  return true;
}

template <int dim>
typename Drops<dim>::Fate Drops<dim>::stop_at_solids(const MovingSurface<dim>& surface,
                                                     double reach, Fate fate, Drop<dim>& drop,
                                                     Point<dim>& to) {
  const SurfaceSnapshot<dim>&before = *surface.before, &after = *surface.after;
  const double h = domain_.spacing();
  std::vector<int> candidates;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    Box<dim> way(drop.position);
    way.extend(to);
    const Point<dim> margin = Point<dim>::Constant(reach + 1e-6 * h);
    before.touching({way.min() - margin, way.max() + margin}, candidates);
    if (candidates.empty())
      return fate;
    std::optional<SurfacePoint<dim>> hit =
        swept_over<dim>(before, after, drop.position, to, candidates);
    if (!hit)
      return fate;
    const auto corners = before.corners(hit->simplex), moved = after.corners(hit->simplex);
    Point<dim> start = Point<dim>::Zero(), end = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k) {
      start += hit->barycentric[k] * corners[k];
      end += hit->barycentric[k] * moved[k];
    }
    hit->position = start;
    const Point<dim> of_surface = surface.velocity(*hit);
    Point<dim> normal = area_vector<dim>(moved).normalized();
    if (area_vector<dim>(corners).dot(drop.position - corners[0]) < 0)
      normal = -normal;
    const double approach = normal.dot(drop.next - of_surface);
    hit->position = end;
    to = end + std::pow(0.5, attempt) * clearance_of_drops * h * normal;
    if (approach < 0) {
      drop.next -= approach * normal;
      state_.pushes.push_back({*hit, end, drop.volume * approach * normal});
    }
    fate = stop_at_sides(to, drop.next) ? Fate::stays : Fate::leaves;
  }
  return Fate::has_no_room;
}

template <int dim>
double Drops<dim>::fly(const MovingSurface<dim>& surface, const Point<dim>& gravity, double dt) {
  state_.pushes.clear();
  state_.fallen.clear();
  state_.is_due = true;
  state_.by_gravity = dt * gravity;
  const bool has_solids = surface.before && !surface.before->empty() && surface.after;
  const double reach = state_.drops.empty() ? 0 : largest_move(surface);
  std::vector<Drop<dim>> still_there;
  double without_room = 0;
  for (Drop<dim> drop : state_.drops) {
    drop.next = drop.velocity + state_.by_gravity;
    Point<dim> to = drop.position + 0.5 * dt * (drop.velocity + drop.next);
    const std::size_t n_pushes = state_.pushes.size();
    Fate fate = stop_at_sides(to, drop.next) ? Fate::stays : Fate::leaves;
    if (has_solids)
      fate = stop_at_solids(surface, reach, fate, drop, to);
    if (fate != Fate::stays) {
      without_room += fate == Fate::has_no_room ? drop.volume : 0;
      state_.pushes.resize(n_pushes);
      continue;
    }
    drop.position = domain_.grid.wrap(to);
    // Where the drop gives it, so that no angular momentum is gained.
    for (std::size_t i = n_pushes; i < state_.pushes.size(); ++i)
      state_.pushes[i].place = to;
    still_there.push_back(drop);
  }
  state_.drops = std::move(still_there);
  redistribute();
  return without_room;
}

template <int dim>
void Drops<dim>::take(const Condition& has_fallen) {
  std::size_t n_kept = 0;
  for (const Drop<dim>& drop : state_.drops) {
    if (!has_fallen(drop)) {
      state_.drops[n_kept++] = drop;
      continue;
    }
    state_.fallen.push_back(drop);
    state_.fallen.back().velocity = drop.next - state_.by_gravity;
  }
  state_.drops.resize(n_kept);
}

template <int dim>
void Drops<dim>::remove(const Condition& goes) {
  state_.drops.erase(std::remove_if(state_.drops.begin(), state_.drops.end(), goes),
                     state_.drops.end());
}

template <int dim>
Momentum<dim> Drops<dim>::speed_up() {
  Momentum<dim> given;
  if (!state_.is_due)
    return given;
  state_.is_due = false;
  for (Drop<dim>& drop : state_.drops) {
    given.add(drop.position, drop.volume * (drop.next - drop.velocity));
    drop.velocity = drop.next;
  }
  return given;
}

template <int dim>
Momentum<dim> Drops<dim>::momentum() const {
  Momentum<dim> mine;
  for (const Drop<dim>& drop : state_.drops)
    mine.add(drop.position, drop.volume * drop.velocity);
  return mine;
}

template <int dim>
double Drops<dim>::kinetic_energy() const {
  double mine = 0;
  for (const Drop<dim>& drop : state_.drops)
    mine += 0.5 * drop.volume * drop.velocity.squaredNorm();
  return mine;
}

template <int dim>
void Drops<dim>::count() {
  DropsReport& report = state_.report;
  report = {static_cast<long long>(state_.drops.size()), 0};
  for (const Drop<dim>& drop : state_.drops)
    report.volume += drop.volume;
  sum_over_ranks(domain_.grid.comm(), report.n, report.volume);
}

template <int dim>
void Drops<dim>::redistribute() {
  const TiledGrid<dim>& grid = domain_.grid;
  if (grid.comm()->getSize() == 1)
    return;
  const int rank = grid.comm()->getRank();
  const auto is_mine = [&](const Drop<dim>& drop) {
    const int cell = grid.cell_containing(drop.position);
    return cell >= 0 && grid.owned(cell);
  };
  const auto first = std::stable_partition(state_.drops.begin(), state_.drops.end(), is_mine);
  std::vector<double> leaving;
  for (auto drop = first; drop != state_.drops.end(); ++drop) {
    leaving.push_back(rank);
    pack(*drop, leaving);
    leaving.insert(leaving.end(), drop->next.begin(), drop->next.end());
  }
  state_.drops.erase(first, state_.drops.end());
  leaving = gather_all(grid.comm(), leaving);
  std::vector<Drop<dim>> drops;
  std::vector<int> holder;
  for (std::size_t i = 0; i < leaving.size(); i += 1 + numbers_of_drop<dim> + dim) {
    holder.push_back(static_cast<int>(leaving[i]));
    drops.push_back(unpack<dim>(&leaving[i + 1]));
    for (int a = 0; a < dim; ++a)
      drops.back().next[a] = leaving[i + 1 + numbers_of_drop<dim> + a];
  }
  hand_out(drops, holder);
}

template <int dim>
void Drops<dim>::hand_out(const std::vector<Drop<dim>>& drops, const std::vector<int>& holder) {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<char> has_owner(drops.size(), 0);
  for (std::size_t i = 0; i < drops.size(); ++i) {
    const int cell = grid.cell_containing(drops[i].position);
    if (cell < 0 || !grid.owned(cell))
      continue;
    has_owner[i] = 1;
    state_.drops.push_back(drops[i]);
  }
  max_over_ranks(grid.comm(), has_owner);
  for (std::size_t i = 0; i < drops.size(); ++i)
    if (!has_owner[i] && holder[i] == grid.comm()->getRank())
      state_.drops.push_back(drops[i]);
}

template <int dim>
void Drops<dim>::save(CheckpointWriter& checkpoint) const {
  const Communicator& comm = domain_.grid.comm();
  std::vector<double> numbers;
  for (const Drop<dim>& drop : state_.drops) {
    numbers.push_back(comm->getRank());
    pack(drop, numbers);
  }
  numbers = gather_all(comm, numbers);
  // Not empty, with or without drops.
  numbers.insert(numbers.begin(), static_cast<double>(comm->getSize()));
  checkpoint.file().write_replicated(file_name, numbers);
}

template <int dim>
void Drops<dim>::load(const CheckpointReader& checkpoint) {
  const Communicator& comm = domain_.grid.comm();
  const auto numbers = checkpoint.file().read_all<double>(file_name);
  checkpoint.check(numbers.size() % (1 + numbers_of_drop<dim>) == 1, "its drops are incomplete");
  const bool same_ranks = numbers[0] == comm->getSize();
  std::vector<Drop<dim>> drops;
  std::vector<int> holder;
  for (std::size_t i = 1; i < numbers.size(); i += 1 + numbers_of_drop<dim>) {
    holder.push_back(same_ranks ? static_cast<int>(numbers[i]) : 0);
    drops.push_back(unpack<dim>(&numbers[i + 1]));
  }
  clear();
  if (same_ranks) {  // in the same order
    for (std::size_t i = 0; i < drops.size(); ++i)
      if (holder[i] == comm->getRank())
        state_.drops.push_back(drops[i]);
  } else {
    hand_out(drops, holder);
  }
  count();
}

template class Drops<2>;
template class Drops<3>;

}  // namespace lockstep
