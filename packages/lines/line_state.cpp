// Checkpoints and frames of lines.
#include "base/errors.hpp"
#include "lines/lines.hpp"
#include "output/checkpoint.hpp"
#include "output/frames.hpp"

namespace lockstep {

namespace {

template <int dim>
std::string names_of_lines(const std::vector<Line<dim>>& lines) {
  std::string names;
  for (const Line<dim>& line : lines)
    names += line.name + "\n";
  return names;
}

}  // namespace

template <int dim>
template <typename Function>
void Lines<dim>::for_each_value(const Function& f) {
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    for (int end = 0; end < 2; ++end) {
      for (Point<dim>* vector :
           {&lines_[line].ends[end], &before_[line][end], &velocity_[line][end]}) {
        for (double& value : *vector)
          f(value);
      }
    }
  }
}

template <int dim>
std::vector<double> Lines<dim>::state() const {
  std::vector<double> values;
  const_cast<Lines<dim>*>(this)->for_each_value([&](double value) { values.push_back(value); });
  return values;
}

template <int dim>
void Lines<dim>::save(CheckpointWriter& writer) const {
  writer.file().create_group(type_);
  writer.file().write_text(type_ + "/names", names_of_lines(lines_));
  writer.file().write_replicated(type_ + "/values", state());
}

template <int dim>
void Lines<dim>::load(const CheckpointReader& reader) {
  const Hdf5File& file = reader.file();
  const std::string names = type_ + "/names";
  check_input(
      file.exists(names) && file.read_text(names) == names_of_lines(lines_),
      "{}: the checkpoint does not hold the solids of the type \"{}\" of this scene; restart "
      "with the scene that wrote it.",
      file.path(), type_);
  const std::vector<double> values = file.read_all<double>(type_ + "/values");
  check_input(values.size() == state().size(),
              "{}: the checkpoint's solids of the type \"{}\" are incomplete; restart from another "
              "one.",
              file.path(), type_);
  auto next = values.begin();
  for_each_value([&](double& value) { value = *next++; });
}

template <int dim>
void Lines<dim>::add_frames(std::vector<SurfaceFrame>& frames) const {
  for (const Line<dim>& line : lines_) {
    SurfaceFrame frame;
    frame.name = line.name;
    frame.dimension = dim;
    frame.simplex_size = 2;
    const std::vector<Point<dim>> shape = line.law->shape(line.ends[1] - line.ends[0]);
    const int n_pieces = static_cast<int>(shape.size()) - 1;
    const std::array<double, 2> tension = present(line).tension;
    SurfaceField field{"tension", "N", 1, SurfaceField::Place::simplices, {}};
    for (int k = 0; k <= n_pieces; ++k) {
      const Point<dim> place = line.ends[0] + shape[k];
      frame.vertices.insert(frame.vertices.end(), place.data(), place.data() + dim);
      if (k == n_pieces)
        continue;
      frame.simplices.insert(frame.simplices.end(), {k, k + 1});
      // Between those of the ends, by the height, along which tension grows.
      field.values.push_back(tension[0] + (tension[1] - tension[0]) * (k + 0.5) / n_pieces);
    }
    frame.fields.push_back(std::move(field));
    frames.push_back(std::move(frame));
  }
}

template void Lines<2>::save(CheckpointWriter&) const;
template void Lines<3>::save(CheckpointWriter&) const;
template void Lines<2>::load(const CheckpointReader&);
template void Lines<3>::load(const CheckpointReader&);
template void Lines<2>::add_frames(std::vector<SurfaceFrame>&) const;
template void Lines<3>::add_frames(std::vector<SurfaceFrame>&) const;

}  // namespace lockstep
