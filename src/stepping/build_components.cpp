#include "stepping/build_components.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "base/errors.hpp"
#include "base/wait_for_all.hpp"
#include "base/xml_text.hpp"
#include "coupling/attached_nodes.hpp"
#include "coupling/automatic_coupling.hpp"
#include "output/xdmf.hpp"
#include "parameters/shape_sizes.hpp"
#include "parameters/source.hpp"
#include "stepping/sound_lists.hpp"

namespace lockstep {
namespace {

/// Mesh files are given relative to the scene.
void resolve_files(ParameterList& list, const std::string& scene_file) {
  for (auto entry = list.begin(); entry != list.end(); ++entry) {
    const std::string name = list.name(entry);
    if (list.isSublist(name)) {
      resolve_files(list.sublist(name), scene_file);
    } else if (name == "File" && !list.get<std::string>(name).empty()) {
      list.set(name, resolve_path(scene_file, list.get<std::string>(name)));
    }
  }
}

/// Frames and checkpoints keep solids under their names, as far as HDF5 and ParaView can.
void check_solid_names(const ParameterList& solids) {
  std::map<std::string, std::string> stored;
  for (const auto& entry : solids) {
    const std::string& name = entry.first;
    check_input(std::none_of(name.begin(), name.end(),
                             [](unsigned char c) { return std::iscntrl(c) != 0; }),
                "In \"Solids\", the name \"{}\" holds a line break or another control character; "
                "write it in one line.",
                xml_escaped(name));
    check_input(name.find_first_not_of('.') != std::string::npos,
                "In \"Solids\", \"{}\" cannot be stored as a name; use letters or digits.", name);
    for (const std::string& kept : {name, name + " elements"}) {
      const auto [other, is_new] = stored.emplace(xdmf::stored_name(kept), name);
      check_input(
          is_new,
          "In \"Solids\", \"{}\" and \"{}\" would be stored under one name, \"{}\"; give one "
          "of them another.",
          other->second, name, other->first);
    }
  }
}

/// Refuses bodies far longer than the domain by their vertices, which alone tell how long a mesh
/// from a file is.
template <int dim>
void check_body_lengths(const SolidSystem<dim>& solids, double domain_length, Mistakes& mistakes) {
  constexpr double most_domains = 1000;
  const SurfaceMesh<dim> surface = solids.surface();
  for (const SolidDescription& solid : solids.solids()) {
    Box<dim> box;
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
      box.extend(surface.vertices[v]);
    mistakes.collect([&] {
      check_input(box.isEmpty() || box.sizes().maxCoeff() <= most_domains * domain_length,
                  "The solid \"{}\" is {:g} m long, in a domain of {:g} m; lengths are in metres: "
                  "scale its mesh (\"Scale\").",
                  solid.name, box.isEmpty() ? 0. : box.sizes().maxCoeff(), domain_length);
    });
  }
}

/// Leaves of the velocities what the joints admit, as after an impact.
template <int dim>
void admit_velocities(SolidSystem<dim>& solids, double time) {
  solids.begin_step(time, 0);
  const RCP<const Vector> momentum = solids.explicit_momentum(time, 0);
  solids.set_velocity(*solids.velocity_of(*momentum, 0, solids.constraints(time, time)));
}

/// Makes the coupling of a scene. `note` becomes the reason of an automatic choice.
template <int dim>
std::unique_ptr<Coupling<dim>> build_coupling(const Registries<dim>& registries,
                                              const ParameterList& list,
                                              const SolidSystem<dim>& solids,
                                              const FluidDiscretization<dim>& fluid,
                                              std::string& note) {
  const auto type = list.get<std::string>("Type");
  if (type != automatic_coupling_type)
    return registries.couplings.create(type, list);
  const CouplingChoice choice = automatic_coupling(*solids.snapshot(), fluid.smallest_length(),
                                                   fluid.density(fluid.bounds().center()));
  note = choice.reason;
  ParameterList chosen = registries.couplings.valid_parameters(choice.type);
  chosen.set("Correct Buoyancy", list.get<bool>("Correct Buoyancy"));
  return registries.couplings.create(choice.type, chosen);
}

/// Builds the parts of a scene one after the other. What needs a part that failed is left out, or
/// built on a stand-in for it.
template <int dim>
class SceneBuilder {
 public:
  SceneBuilder(const Registries<dim>& registries, const ParameterList& scene,
               const std::string& scene_file, const Communicator& comm)
      : registries_(registries), scene_(scene), scene_file_(scene_file), comm_(comm) {}

  Components<dim> build() {
    build_fluid();
    build_solids();
    const ParameterList& strategy = scene_.sublist("Solver").sublist("Strategy");
    mistakes_.collect([&] {
      components_.strategy =
          registries_.strategies.create(strategy.get<std::string>("Type"), strategy);
    });
    if (components_.solids && mistakes_.empty())
      mistakes_.collect([&] {
        components_.coupling =
            build_coupling(registries_, scene_.sublist("Coupling"), *components_.solids,
                           *components_.fluid, components_.coupling_note);
      });
    if (components_.fluid && type_of("Contact") != "none")
      mistakes_.collect([&] { build_contact(); });
    mistakes_.throw_all();
    return std::move(components_);
  }

 private:
  std::string type_of(const char* list) const {
    return scene_.sublist(list).get<std::string>("Type");
  }

  void build_fluid() {
    ParameterList list = scene_.sublist("Fluid");
    resolve_files(list, scene_file_);
    setting_.start_time = scene_.sublist("Time").get<double>("Start");
    setting_.comm = comm_;
    mistakes_.collect([&] {
      components_.fluid =
          registries_.fluids.create(type_of("Fluid"), list, scene_.sublist("Domain"), comm_);
    });
    if (const auto* fluid = components_.fluid.get()) {
      setting_.smallest_length = fluid->smallest_length();
      setting_.gravity = fluid->gravity();
      setting_.fluid_density = fluid->density(fluid->bounds().center());
      return;
    }
    go_on_together();
    // Meshes of solids of any size become as coarse as they may be.
    setting_.smallest_length = 1e6;
    setting_.gravity = -9.81 * Point<dim>::Unit(1);
    setting_.fluid_density = 1000;
  }

  /// Ends the run if not all ranks have the mistakes found so far: what is built is built on all.
  void go_on_together() const {
    if (!wait_for_all(comm_))
      mistakes_.throw_all();
  }

  double domain_length() const {
    return components_.fluid ? components_.fluid->bounds().sizes().maxCoeff()
                             : std::numeric_limits<double>::infinity();
  }

  /// Solids of a type that are not far too large.
  NamedLists lists_of(const std::string& type) {
    NamedLists lists;
    ListMistakes too_large;
    const ParameterList& solids = scene_.sublist("Solids");
    for (const auto& [name, entry] : entries(solids)) {
      if (solids.sublist(name).template get<std::string>("Type") != type)
        continue;
      lists.emplace_back(name, solids.sublist(name));
      resolve_files(lists.back().second, scene_file_);
      Mistakes own;
      if (lists.back().second.isSublist("Geometry"))
        own.collect([&, &name = name] {
          check_body_size(lists.back().second.sublist("Geometry"), setting_.smallest_length,
                          domain_length(), dim, name);
        });
      too_large.add(name, own.messages());
      if (!own.empty())
        lists.pop_back();
    }
    too_large.tell(mistakes_);
    return lists;
  }

  void build_solids() {
    mistakes_.collect([&] { check_solid_names(scene_.sublist("Solids")); });
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    for (const auto& plugin : registries_.solids) {
      NamedLists lists = lists_of(plugin.name);
      if (lists.empty())
        continue;
      const auto build = [&](const NamedLists& some) {
        return registries_.solids.create(plugin.name, ParameterList(), some, setting_);
      };
      if (auto model = build_sound(
              lists, build, [&] { return wait_for_all(comm_); }, mistakes_))
        models.push_back(std::move(model));
    }
    std::unique_ptr<ConstraintModel> constraints = build_joints(models);
    check_carriers(models);
    if (!mistakes_.empty())
      return;
    mistakes_.collect([&] {
      const bool has_joints = constraints != nullptr;
      components_.solids =
          std::make_unique<SolidSystem<dim>>(std::move(models), comm_, std::move(constraints));
      check_body_lengths(*components_.solids, domain_length(), mistakes_);
      go_round_periodic_sides();
      if (has_joints && mistakes_.empty())
        admit_velocities(*components_.solids, setting_.start_time);
    });
  }

  void go_round_periodic_sides() {
    constexpr double cells_beyond = 4;  // surfaces farther outside of the domain act on no cell
    const FluidDiscretization<dim>* fluid = components_.fluid.get();
    if (fluid && fluid->is_periodic())
      components_.solids->go_round(fluid->bounds(), fluid->periodic_axes(),
                                   cells_beyond * fluid->smallest_length());
  }

  /// Notes the names of solids that nodes are attached to and the scene has not.
  void check_carriers(const std::vector<std::unique_ptr<SolidModel<dim>>>& models) {
    std::vector<std::string> carriers;
    for (const auto& model : models)
      for (const SolidDescription& solid : model->solids())
        if (solid.rigid && !solid.prescribed)
          carriers.push_back(solid.name);
    for (const auto& model : models) {
      std::set<std::string> sentences;
      for (const NodeAttachment<dim>& node : model->attachments())
        if (!scene_.sublist("Solids").isSublist(node.solid))
          sentences.insert(no_carrier(node.solid, node.line, carriers));
      try {
        throw_on_all(comm_, fmt::format("{}", fmt::join(sentences, "\n")),
                     static_cast<int>(ExitCode::bad_input));
      } catch (const InputError& error) {
        std::istringstream lines(error.what());
        for (std::string line; std::getline(lines, line);)
          mistakes_.add(line);
      }
    }
  }

  /// True if all solids that a joint names are there, or none of the scene has that name.
  bool has_its_solids(const ParameterList& joint,
                      const std::vector<std::unique_ptr<SolidModel<dim>>>& models) const {
    const auto is_built = [&](const std::string& name) {
      for (const auto& model : models)
        for (const SolidDescription& solid : model->solids())
          if (solid.name == name)
            return true;
      return false;
    };
    const auto& names = joint.get<ParameterArray<std::string>>("Solids");
    return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
      return is_built(name) || !scene_.sublist("Solids").isSublist(name);
    });
  }

  /// Returns null if there are none. Their own model comes after the others.
  std::unique_ptr<ConstraintModel> build_joints(
      std::vector<std::unique_ptr<SolidModel<dim>>>& models) {
    NamedLists joints;
    const ParameterList all = joint_lists();
    for (const auto& [name, entry] : entries(all))
      if (mistakes_.empty() || has_its_solids(all.sublist(name), models))
        joints.emplace_back(name, all.sublist(name));
    if (joints.empty())
      return nullptr;
    const ParameterList& shared = scene_.sublist("Articulation");
    const double turn = scene_.sublist("Time").get<double>("Largest Turn");
    const auto build = [&](const NamedLists& some) {
      return registries_.articulations.create(
          shared.get<std::string>("Type"), shared, some,
          JointSetting<dim>{models, setting_.start_time, turn, comm_, setting_.fluid_density});
    };
    const auto system = build_sound(
        joints, build, [&] { return wait_for_all(comm_); }, mistakes_);
    if (!system)
      return nullptr;
    mistakes_.collect([&] {
      const std::string limited = system->constraints->limited();
      check_input(limited.empty() || type_of("Contact") != "none",
                  "The joint \"{}\" has limits, which contact keeps; \"Contact/Type\" must not be "
                  "\"none\".",
                  limited);
    });
    models.push_back(std::move(system->rates));
    return std::move(system->constraints);
  }

  /// Empty where the program has no joints.
  ParameterList joint_lists() const {
    return scene_.isSublist("Joints") ? scene_.sublist("Joints") : ParameterList();
  }

  std::vector<std::pair<std::string, std::string>> jointed_pairs() const {
    std::vector<std::pair<std::string, std::string>> pairs;
    const ParameterList joints = joint_lists();
    for (const auto& [name, entry] : entries(joints)) {
      const auto& solids = joints.sublist(name).template get<ParameterArray<std::string>>("Solids");
      pairs.emplace_back(solids[0], solids[1]);
    }
    return pairs;
  }

  void build_contact() {
    const FluidDiscretization<dim>& fluid = *components_.fluid;
    ContactSetting<dim> setting;
    setting.domain = fluid.bounds();
    setting.smallest_length = fluid.smallest_length();
    setting.comm = comm_;
    for (const auto& [name, entry] : entries(scene_.sublist("Solids")))
      setting.solids.push_back(name);
    setting.jointed = jointed_pairs();
    setting.closed_sides = fluid.closed_sides();
    setting.wall_velocity = [&fluid](int axis, int end, double time) {
      return fluid.wall_velocity(axis, end, time);
    };
    components_.contact =
        registries_.contacts.create(type_of("Contact"), scene_.sublist("Contact"), setting);
  }

  const Registries<dim>& registries_;
  const ParameterList& scene_;
  const std::string& scene_file_;
  Communicator comm_;
  SolidSetting<dim> setting_;
  Components<dim> components_;
  Mistakes mistakes_;
};

}  // namespace

template <int dim>
Components<dim> build_components(const Registries<dim>& registries, const ParameterList& scene,
                                 const std::string& scene_file, const Communicator& comm) {
  return SceneBuilder<dim>(registries, scene, scene_file, comm).build();
}

template Components<2> build_components<2>(const Registries<2>&, const ParameterList&,
                                           const std::string&, const Communicator&);
template Components<3> build_components<3>(const Registries<3>&, const ParameterList&,
                                           const std::string&, const Communicator&);

}  // namespace lockstep
