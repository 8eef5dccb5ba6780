#include "lines/register_lines.hpp"

#include "lines/line_parameters.hpp"

namespace lockstep {

namespace {

/// One model of all lines of a type; null if there are none.
template <int dim, typename Read>
std::unique_ptr<SolidModel<dim>> model_of_lines(const std::string& type, const Read& read,
                                                const NamedLists& lists,
                                                const SolidSetting<dim>& setting) {
  if (lists.empty())
    return nullptr;
  std::vector<Line<dim>> lines;
  for (const auto& [name, list] : lists)
    lines.push_back(read(name, list));
  return std::make_unique<Lines<dim>>(type, std::move(lines), setting.comm);
}

}  // namespace

template <int dim>
void register_lines(SolidRegistry<dim>& solids) {
  solids.add("spring", "Spring and damper between points of two rigid bodies, or of one and space.",
             spring_parameters<dim>,
             [](const ParameterList&, const NamedLists& lists, const SolidSetting<dim>& setting) {
               return model_of_lines<dim>("spring", read_spring<dim>, lists, setting);
             });
  solids.add("rope",
             "Spring and damper between points of two rigid bodies, or of one and space, that does "
             "nothing while it is shorter than at rest.",
             rope_parameters<dim>,
             [](const ParameterList&, const NamedLists& lists, const SolidSetting<dim>& setting) {
               return model_of_lines<dim>("rope", read_rope<dim>, lists, setting);
             });
  solids.add("mooring line",
             "Line under its weight in the fluid between points of two rigid bodies, or of one and "
             "space: an elastic catenary, at rest in every moment. Fluid does not see it.",
             mooring_line_parameters<dim>,
             [](const ParameterList&, const NamedLists& lists, const SolidSetting<dim>& setting) {
               const auto read = [&setting](const std::string& name, const ParameterList& list) {
                 return read_mooring_line<dim>(name, list, setting.gravity);
               };
               return model_of_lines<dim>("mooring line", read, lists, setting);
             });
}

template void register_lines<2>(SolidRegistry<2>&);
template void register_lines<3>(SolidRegistry<3>&);

}  // namespace lockstep
