#include "scenes/copies.hpp"

#include "base/errors.hpp"
#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/validate.hpp"
#include "scenes/random_positions.hpp"
#include "scenes/solids_path.hpp"

namespace lockstep {
namespace {

constexpr int most_copies = 100000;

using Places = std::vector<std::vector<double>>;

std::vector<double> reals(const ParameterList& list, const std::string& name) {
  return list.get<ParameterArray<double>>(name).toVector();
}

/// The place of a solid, the origin if it gives none.
std::vector<double> position_of(const ParameterList& solid, int dimension) {
  if (solid.isType<ParameterArray<double>>("Position") &&
      solid.get<ParameterArray<double>>("Position").size() == dimension)
    return reals(solid, "Position");
  return std::vector<double>(dimension, 0.);
}

/// The radius of a ball; 0 for any other shape.
double ball_radius(const ParameterList& solid) {
  if (!solid.isSublist("Geometry"))
    return 0;
  const ParameterList& geometry = solid.sublist("Geometry");
  const bool ball = geometry.isType<std::string>("Shape") &&
                    geometry.get<std::string>("Shape") == "ball" &&
                    geometry.isType<double>("Radius");
  return ball ? geometry.get<double>("Radius") : 0;
}

Places lattice(const ParameterList& copies, const std::vector<double>& first,
               const std::string& where) {
  const auto count = copies.get<ParameterArray<int>>("Count");
  const std::vector<double> spacing = reals(copies, "Spacing");
  double total = 1;
  for (const int n : count)
    total *= n;
  check_input(total <= most_copies, "{}: {:g} copies are more than {}.", where, total, most_copies);
  Places places{first};
  for (std::size_t axis = 0; axis < first.size(); ++axis) {
    Places next;
    for (int i = 0; i < count[axis]; ++i) {
      for (std::vector<double> place : places) {
        place[axis] += i * spacing[axis];
        next.push_back(std::move(place));
      }
    }
    places = std::move(next);
  }
  return places;
}

Places given_positions(const ParameterList& copies, int dimension, const std::string& where) {
  const std::vector<double> numbers = reals(copies, "Points");
  check_input(!numbers.empty() && numbers.size() % dimension == 0,
              "{}: \"Points\" has {} numbers; it takes {} a copy, one after the other.", where,
              numbers.size(), dimension);
  Places places;
  for (std::size_t i = 0; i < numbers.size(); i += dimension)
    places.emplace_back(numbers.begin() + i, numbers.begin() + i + dimension);
  return places;
}

/// All solids of one scene on their way from what is written to what is simulated.
class Copier {
 public:
  Copier(Document& document, int dimension, const Variables& constants)
      : document_(document),
        source_(document.source),
        dimension_(dimension),
        constants_(constants) {}

  void run() {
    const ParameterList written = document_.list.sublist(solids_path);
    ParameterList& solids = document_.list.sublist(solids_path);
    for (const auto& [name, entry] : entries(written)) {
      if (entry.isList() && written.sublist(name).isParameter("Copies"))
        solids.remove(name);
    }
    evaluate_formulas(solids, constants_, source_, solids_path);
    for (const auto& [name, entry] : entries(solids)) {
      if (entry.isList())
        occupy(solids.sublist(name));
    }
    for (const auto& [name, entry] : entries(written)) {
      if (!entry.isList() || !written.sublist(name).isParameter("Copies"))
        continue;
      ParameterList uncopied = written.sublist(name);
      uncopied.remove("Copies");
      keep_mistakes(uncopied, "Copies", [&, &name = name] { copy(name, written.sublist(name)); });
      if (uncopied.isParameter("Copies"))  // the solid's other mistakes are told, too
        solids.sublist(name) = evaluated(uncopied, join_path(solids_path, name), 1);
    }
  }

 private:
  void occupy(const ParameterList& solid) {
    if (const double radius = ball_radius(solid); radius > 0)
      occupied_.push_back({position_of(solid, dimension_), radius});
  }

  void copy(const std::string& name, ParameterList solid) {
    const std::string path = join_path(solids_path, name), copies_path = join_path(path, "Copies");
    const std::string where =
        fmt::format("{}: {}", source_.place(copies_path), in_list(copies_path));
    check_input(solid.isSublist("Copies"), "{}: {}, \"Copies\" must be a list.",
                source_.place(copies_path), in_list(path));
    const ParameterList overrides = take_overrides(solid);
    const ParameterList copies = validated_copies(solid, path);
    solid.remove("Copies");
    const Written written{solid, overrides, path};
    const Places places = places_of(copies, written, where);
    for (const auto& [number, entry] : entries(overrides))
      check_override(number, entry, places.size(), where);
    for (std::size_t i = 0; i < places.size(); ++i)
      add_copy(name, written, static_cast<int>(i) + 1, places[i]);
  }

  /// A solid of which copies are made.
  struct Written {
    const ParameterList& solid;
    const ParameterList& overrides;
    std::string path;
  };

  static ParameterList take_overrides(ParameterList& solid) {
    ParameterList& copies = solid.sublist("Copies");
    ParameterList overrides;
    if (copies.isSublist("Overrides"))
      overrides = copies.sublist("Overrides");
    copies.remove("Overrides", false);
    return overrides;
  }

  ParameterList validated_copies(const ParameterList& solid, const std::string& path) const {
    ParameterList schema, given;
    declare_copies(schema, dimension_);
    given.sublist("Copies") = solid.sublist("Copies");
    evaluate_formulas(given, constants_, source_, path);
    validate(given, schema, source_, path);
    for (const auto& [name, entry] : entries(given.sublist("Copies")))
      check_input(!entry.isType<Formula>(), "{}: {}, \"{}\" takes a constant that is a mistake.",
                  source_.place(join_path(path, "Copies")), in_list(path), name);
    return given.sublist("Copies");
  }

  void check_override(const std::string& number, const ParameterEntry& entry, std::size_t n_copies,
                      const std::string& where) const {
    int which = 0;
    try {
      which = Teuchos::getValue<int>(parse_value(ValueType::integer, number));
    } catch (const InputError&) {
      which = 0;
    }
    check_input(entry.isList() && which >= 1 && which <= static_cast<int>(n_copies),
                "{}: in \"Overrides\", \"{}\" must be a list that bears the number of a copy, 1 to "
                "{}.",
                where, number, n_copies);
  }

  Places places_of(const ParameterList& copies, const Written& written,
                   const std::string& where) const {
    const std::string type = copies.get<std::string>("Type");
    if (type == "positions")
      return given_positions(copies, dimension_, where);
    if (type == "lattice")
      return lattice(copies, position_of(evaluated(written.solid, written.path, 1), dimension_),
                     where);
    return random_places(copies, written, where);
  }

  Places random_places(const ParameterList& copies, const Written& written,
                       const std::string& where) const {
    std::vector<double> radii;
    for (int number = 1; number <= copies.get<int>("Count"); ++number) {
      const bool given = copies.isParameter("Spacing");
      radii.push_back(
          given ? copies.get<double>("Spacing") / 2
                : ball_radius(evaluated(own_list(written, number).list, written.path, number)));
      check_input(radii.back() > 0,
                  "{}: \"Spacing\" [m] between the places is required for solids that "
                  "are no balls.",
                  where);
    }
    return random_positions(radii, reals(copies, "Lower"), reals(copies, "Upper"), occupied_,
                            copies.get<int>("Seed"), where);
  }

  /// Returns the list of a copy: its own overrides before all else; `place` where they have none.
  Document own_list(const Written& written, int number,
                    const std::vector<double>& place = {}) const {
    const std::string key = std::to_string(number);
    Document copy{ParameterList(), {source_.file, {}}};
    if (written.overrides.isSublist(key)) {
      copy.list = written.overrides.sublist(key);
      for (const auto& [name_there, entry] : entries(copy.list))
        copy.source.places[name_there] =
            source_.place(join_path(written.path, "Copies/Overrides/" + key + "/" + name_there));
    }
    if (!place.empty() && !copy.list.isParameter("Position"))
      copy.list.set("Position", ParameterArray<double>(place));
    merge(copy, "", part_of(written.solid, written.path));
    return copy;
  }

  ParameterList evaluated(ParameterList solid, const std::string& path, int number) const {
    Variables variables = constants_;
    variables["copy"] = number;
    evaluate_formulas(solid, variables, source_, path);
    return solid;
  }

  void add_copy(const std::string& name, const Written& written, int number,
                const std::vector<double>& place) {
    const std::string copy_name = fmt::format("{} {}", name, number);
    ParameterList& solids = document_.list.sublist(solids_path);
    check_input(!solids.isParameter(copy_name),
                "{}: copy {} of \"{}\" has the name of another solid; rename one of the two.",
                source_.place(join_path(written.path, "Copies")), number, name);
    const Document copy = own_list(written, number, place);
    for (const auto& [path_there, line] : copy.source.places)
      source_.places[join_path(join_path(solids_path, copy_name), path_there)] = line;
    source_.places[join_path(solids_path, copy_name)] = source_.place(written.path);
    ParameterList& added = solids.sublist(copy_name);
    added = evaluated(copy.list, join_path(solids_path, copy_name), number);
    added.setName(solids.name() + "->" + copy_name);
    occupy(added);
  }

  /// A list of the document as a document of its own.
  Document part_of(const ParameterList& list, const std::string& path) const {
    Document part{list, {source_.place(path), {}}};
    const std::string prefix = path + "/";
    for (auto it = source_.places.lower_bound(prefix);
         it != source_.places.end() && it->first.rfind(prefix, 0) == 0; ++it)
      part.source.places[it->first.substr(prefix.size())] = it->second;
    return part;
  }

  Document& document_;
  Source& source_;
  int dimension_;
  const Variables& constants_;
  std::vector<OccupiedPlace> occupied_;  ///< by the balls so far
};

}  // namespace

void declare_copies(ParameterList& solid, int dimension) {
  ParameterList lattice, positions, random;
  declare_vector(lattice, "Count", ParameterArray<int>(dimension, 2), dimension,
                 "Copies along each axis; the first stands at the solid's own \"Position\".");
  set_between(lattice, "Count", 1, most_copies);
  declare_required_vector<double>(lattice, "Spacing", dimension,
                                  "Spacing from one copy to the next along each axis [m].");
  declare_required<ParameterArray<double>>(
      positions, "Points", "Where they stand, a component an axis, one copy after the other [m].");
  declare_required<int>(random, "Count", "How many.");
  set_between(random, "Count", 1, most_copies);
  declare_required_vector<double>(random, "Lower", dimension,
                                  "Corner of the box that holds their positions [m].");
  declare_required_vector<double>(random, "Upper", dimension,
                                  "Corner of the box that holds their positions [m].");
  declare_optional<double>(
      random, "Spacing",
      "Least distance between two positions [m]; balls touch at most if it is left out.");
  declare(random, "Seed", 1, "Another one gives other places.");
  declare_typed_sublist(
      solid, "Copies",
      "Makes many solids of one, named \"NAME 1\", \"NAME 2\" and so on. Formulas of the solid may "
      "use the number of the copy, `copy`. A list \"Overrides\" may hold lists \"1\", \"2\", ... "
      "with "
      "what is different in that copy.",
      {{"lattice", "Copies in rows, planes and lattices.", lattice},
       {"positions", "Copies at given positions.", positions},
       {"random", "Copies at random positions in a box, at a distance from each other.", random}});
}

void make_copies(Document& document, int dimension, const Variables& constants) {
  if (document.list.isSublist(solids_path))
    Copier(document, dimension, constants).run();
}

}  // namespace lockstep
