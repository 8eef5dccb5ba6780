#include "parameters/registry.hpp"

#include "parameters/suggestion.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

struct Shape {
  virtual ~Shape() = default;
  virtual double area() const = 0;
};
struct Square : Shape {
  explicit Square(double edge) : edge_(edge) {}
  double area() const override { return edge_ * edge_; }
  double edge_;
};

ParameterList square_parameters() {
  ParameterList valid;
  declare_positive(valid, "Edge", 1.0, "Edge length [m].");
  return valid;
}

Registry<Shape, double> shapes() {
  Registry<Shape, double> registry("shape");
  registry.add("square", "All edges equal.", square_parameters,
               [](const ParameterList& list, double scale) {
                 return std::make_unique<Square>(scale * list.get<double>("Edge"));
               });
  registry.add(
      "dot", "Nothing.", [] { return ParameterList(); },
      [](const ParameterList&, double) { return std::make_unique<Square>(0.0); });
  return registry;
}

TEST(Registry, CreatesByNameFromParametersAndArguments) {
  EXPECT_EQ(shapes().create("square", square_parameters(), 3.0)->area(), 9.0);
  EXPECT_EQ(shapes().kind(), "shape");
  EXPECT_TRUE(shapes().contains("dot"));
}

TEST(Registry, ListsInOrderOfRegistration) {
  std::vector<std::string> names;
  const auto registry = shapes();
  for (const auto& plugin : registry)
    names.push_back(plugin.name);

  EXPECT_THAT(names, ::testing::ElementsAre("square", "dot"));
  EXPECT_EQ(registry.schemas()[0].documentation, "All edges equal.");
  EXPECT_TRUE(registry.schemas()[0].parameters.isParameter("Edge"));
}

TEST(Registry, SchemasMayDependOnArguments) {
  RegistryOf<ParameterList(int n), double(const ParameterList&, double)> sums("sum");
  sums.add(
      "terms", "As many as are asked for.",
      [](int n) {
        ParameterList list;
        for (int k = 0; k < n; ++k)
          declare(list, std::to_string(k), 0.5, "A term [1].");
        return list;
      },
      [](const ParameterList& list, double scale) { return scale * list.numParams(); });
  EXPECT_EQ(sums.schemas(2)[0].parameters.numParams(), 2);
  EXPECT_EQ(sums.create("terms", sums.valid_parameters("terms", 3), 1.5), 4.5);
}

TEST(Registry, UnknownNameGetsASuggestionAndTheList) {
  EXPECT_EQ(input_error([] { shapes().create("sqare", ParameterList(), 1.0); }),
            "There is no shape \"sqare\". Did you mean \"square\"?\nRegistered:\n  square: All "
            "edges equal.\n  dot: Nothing.");
}

TEST(Registry, RefusesANameTwice) {
  auto registry = shapes();
  EXPECT_EQ(input_error([&] { registry.add("dot", "Again.", square_parameters, nullptr); }),
            "The shape \"dot\" is registered twice; give one of the two another name.");
}

TEST(Suggestion, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("Tolerance", "Tolerence"), 1);
  EXPECT_EQ(edit_distance("Density", "Desnity"), 1);
  EXPECT_EQ(edit_distance("DENSITY", "density"), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Suggestion, NamesOnlyWhatIsNear) {
  EXPECT_EQ(nearest_name("Viscosty", {"Density", "Viscosity"}), "Viscosity");
  EXPECT_EQ(nearest_name("Colour", {"Density", "Viscosity"}), "");
  EXPECT_EQ(nearest_name("x", {"y"}), "");
}

}  // namespace
}  // namespace lockstep::test
