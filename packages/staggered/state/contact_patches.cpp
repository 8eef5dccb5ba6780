#include "staggered/state/contact_patches.hpp"

#include <algorithm>

#include "staggered/state/covered_sides.hpp"

namespace lockstep {

namespace {

/// A face of a patch, seen from an owned cell inside a solid: from there it is at an end (0 lower,
/// 1 upper) of an axis.
struct PatchFace {
  int cell = -1, axis = 0, end = 0;
  int other = -1;  ///< the cell of the other solid; -1: a wall
  int solid = -1;  ///< the solid of `cell`
};

template <int dim>
class PatchFinder {
 public:
  PatchFinder(const MacDomain<dim>& domain, MacGeometry<dim>& geometry)
      : domain_(domain),
        grid_(domain.grid),
        cells_(geometry.state.cells),
        surface_(*geometry.state.surface),
        geometry_(geometry) {}

  void find() {
    for (int cell = 0; cell < grid_.n_owned_cells(); ++cell)
      if (geometry_.near_surface(cell) && cells_[cell] == CellState::solid)
        for (int axis = 0; axis < dim; ++axis)
          for (int end = 0; end < 2; ++end)
            look_at(cell, axis, end);
    std::vector<GlobalIndex> mine;
    for (const PatchFace& face : faces_)
      mine.push_back(id_of(face.cell, face.axis, face.end));
    ids_ = gather_all(grid_.comm(), mine);
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  }
  bool empty() const { return ids_.empty(); }

  /// Makes the graph of the patches' faces and their control volumes.
  void add_volumes() {
    for (const PatchFace& face : faces_)
      link(face);
    const HangingGraph graph = graph_of_all_ranks();
    geometry_.contact_patches =
        std::make_shared<const HarmonicExtension>(graph, geometry_.pressure_map);
    set_weights(*geometry_.contact_patches);
    for (const PatchFace& face : faces_)
      geometry_.coupled_volumes.push_back(volume(face));
  }

 private:
  bool is_outside(int cell) const { return cell < 0 || cells_[cell] == CellState::outside; }

  Point<dim> face_center(int cell, int axis, int end) const {
    return grid_.center(cell) + (end - 0.5) * grid_.spacing() * Point<dim>::Unit(axis);
  }

  void look_at(int cell, int axis, int end) {
    const int other = grid_.neighbor(cell, axis, end);
    if (is_outside(other)) {
      if (!domain_.boundary.side(axis, end).closed())
        return;
      const int solid = solid_at(cell);
      if (solid >= 0 && !goes_through<dim>(domain_, surface_, solid, axis, end))
        faces_.push_back({cell, axis, end, -1, solid});
      return;
    }
    if (cells_[other] != CellState::solid)
      return;
    const int solid = solid_at(cell), neighbor = solid_at(other);
    if (solid >= 0 && neighbor >= 0 && solid != neighbor)
      faces_.push_back({cell, axis, end, other, solid});
  }

  /// The solid to which a cell belongs, looked up once.
  int solid_at(int cell) {
    constexpr int unknown = -2;
    solid_at_.resize(grid_.n_stored_cells(), unknown);
    if (solid_at_[cell] == unknown)
      solid_at_[cell] = solid_of_cell<dim>(surface_, grid_.center(cell), grid_.spacing());
    return solid_at_[cell];
  }

  /// Id of a face: from both of its cells and on all ranks the same.
  GlobalIndex id_of(int cell, int axis, int end) const {
    const int other = grid_.neighbor(cell, axis, end);
    const bool from_below = end == 1 || is_outside(other);
    return 2 * (dim * grid_.global_id(from_below ? cell : other) + axis) + (from_below ? end : 1);
  }

  /// Node of a face, or -1 if it is of no patch.
  int node_of(int cell, int axis, int end) const {
    const GlobalIndex id = id_of(cell, axis, end);
    const auto place = std::lower_bound(ids_.begin(), ids_.end(), id);
    return place != ids_.end() && *place == id ? static_cast<int>(place - ids_.begin()) : -1;
  }

  /// Links the face with what is beside its cell: cells with a pressure, or dry ones, and faces
  /// that go on in its plane or round a corner.
  void link(const PatchFace& face) {
    const int node = node_of(face.cell, face.axis, face.end);
    for (int across = 0; across < dim; ++across)
      for (int end = 0; end < 2 && across != face.axis; ++end) {
        const int beside = grid_.neighbor(face.cell, across, end);
        if (is_outside(beside))
          continue;
        if (cells_[beside] == CellState::fluid)
          add_rim(node, geometry_.unknown[beside], grid_.center(beside));
        else if (cells_[beside] == CellState::air && !geometry_.in_bubble(beside))
          add_rim(node, no_index, grid_.center(beside));
        else
          for (const int next :
               {node_of(beside, face.axis, face.end), node_of(face.cell, across, end)})
            if (next >= 0)
              links_.insert(links_.end(), {std::min(node, next), std::max(node, next)});
      }
  }

  void add_rim(int node, GlobalIndex unknown, const Point<dim>& center) {
    rim_.insert(rim_.end(), {static_cast<GlobalIndex>(node), unknown});
    rim_centers_.insert(rim_centers_.end(), center.begin(), center.end());
  }

  HangingGraph graph_of_all_ranks() {
    HangingGraph graph;
    graph.n_nodes = static_cast<int>(ids_.size());
    links_ = gather_all(grid_.comm(), links_);
    for (std::size_t k = 0; k < links_.size(); k += 2)
      graph.links.push_back({static_cast<int>(links_[k]), static_cast<int>(links_[k + 1])});
    const auto before = [](const auto& a, const auto& b) {
      return std::make_pair(a.node, a.other) < std::make_pair(b.node, b.other);
    };
    const auto same = [](const auto& a, const auto& b) {
      return a.node == b.node && a.other == b.other;
    };
    std::sort(graph.links.begin(), graph.links.end(), before);
    graph.links.erase(std::unique(graph.links.begin(), graph.links.end(), same), graph.links.end());
    rim_ = gather_all(grid_.comm(), rim_);
    rim_centers_ = gather_all(grid_.comm(), rim_centers_);
    for (std::size_t k = 0; k < rim_.size(); k += 2)
      graph.rim.push_back({static_cast<int>(rim_[k]), rim_[k + 1]});
    return graph;
  }

  /// Finds the place of each node at which a linear pressure has its value, and the part that rims
  /// with a pressure have in it.
  void set_weights(const HarmonicExtension& patches) {
    const std::size_t n_rim = rim_.size() / 2;
    std::vector<double> at_rim(n_rim);
    for (std::size_t k = 0; k < n_rim; ++k)
      at_rim[k] = rim_[2 * k + 1] == no_index ? 0 : 1;
    weights_ = patches.extended(at_rim);
    centers_.assign(ids_.size(), Point<dim>::Zero());
    for (int a = 0; a < dim; ++a) {
      for (std::size_t k = 0; k < n_rim; ++k)
        at_rim[k] = rim_[2 * k + 1] == no_index ? 0 : rim_centers_[dim * k + a];
      const std::vector<double> values = patches.extended(at_rim);
      for (std::size_t node = 0; node < ids_.size(); ++node)
        centers_[node][a] = weights_[node] > 0 ? values[node] / weights_[node] : 0;
    }
  }

  ControlVolume<dim> volume(const PatchFace& face) const {
    ControlVolume<dim> volume;
    volume.direction = face.axis;
    volume.center = face_center(face.cell, face.axis, face.end);
    volume.open_center = volume.center;
    volume.density = geometry_.face_table.regular().density;
    volume.area = geometry_.face_table.area();
    volume.open_fraction = 0;
    volume.at_prescribed_side = face.other < 0;
    volume.id = id_of(face.cell, face.axis, face.end);
    const Point<dim> inner = grid_.center(face.cell);
    PressureSide<dim>& own = volume.sides[1 - face.end];
    own.kind = SideKind::solid;
    own.solid = face.solid;
    own.center = inner;
    PressureSide<dim>& patch = volume.sides[face.end];
    patch.kind = SideKind::patch;
    patch.patch = node_of(face.cell, face.axis, face.end);
    patch.center = centers_[patch.patch];
    patch.weight = weights_[patch.patch];
    Point<dim> across = Point<dim>::Constant(0.5 * grid_.spacing());
    across[face.axis] = 0;
    volume.box = Box<dim>(inner - across, inner + across);
    volume.box.extend(volume.center - across);
    volume.box.extend(volume.center + across);
    return volume;
  }

  const MacDomain<dim>& domain_;
  const TiledGrid<dim>& grid_;
  const std::vector<CellState>& cells_;
  const SurfaceSnapshot<dim>& surface_;
  MacGeometry<dim>& geometry_;
  std::vector<int> solid_at_;        ///< by cell
  std::vector<PatchFace> faces_;     ///< seen from cells of this rank
  std::vector<GlobalIndex> ids_;     ///< ids of all ranks' faces, sorted: their places are nodes
  std::vector<GlobalIndex> links_;   ///< pairs of nodes
  std::vector<GlobalIndex> rim_;     ///< pairs of a node and an unknown, or no_index: dry
  std::vector<double> rim_centers_;  ///< centres of the cells of these unknowns [m]
  std::vector<double> weights_;      ///< by node
  std::vector<Point<dim>> centers_;  ///< by node [m]
};

}  // namespace

template <int dim>
void add_contact_patches(const MacDomain<dim>& domain, MacGeometry<dim>& geometry) {
  PatchFinder<dim> patches(domain, geometry);
  patches.find();
  if (!patches.empty())
    patches.add_volumes();
}

template void add_contact_patches<2>(const MacDomain<2>&, MacGeometry<2>&);
template void add_contact_patches<3>(const MacDomain<3>&, MacGeometry<3>&);

}  // namespace lockstep
