#include "parameters/teko_library.hpp"

#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A library of one factory, whose parameters begin in line 4, and of "CG".
std::string checking(const std::string& parameters, const std::vector<TekoFactory>& own = {}) {
  const Document document = read_xml_string(
      "<ParameterList>\n<ParameterList name=\"Library\">\n<ParameterList name=\"Outer\">\n" +
          parameters +
          "</ParameterList>\n<ParameterList name=\"CG\">"
          "<Parameter name=\"Type\" type=\"string\" value=\"Belos\"/>"
          "<Parameter name=\"Solver Type\" type=\"string\" value=\"Block CG\"/></ParameterList>\n"
          "</ParameterList></ParameterList>",
      "solver.xml");
  return input_error([&] {
    check_teko_library(document.list.sublist("Library"), document.source, "Library", own);
  });
}

std::string text(const std::string& name, const std::string& value) {
  return fmt::format("<Parameter name=\"{}\" type=\"string\" value=\"{}\"/>\n", name, value);
}

TEST(TekoLibrary, AcceptsWhatTekoReads) {
  EXPECT_EQ(checking(text("Type", "Block Jacobi") + text("Inverse Type", "CG") +
                     text("Inverse Type 2", "Ifpack2")),
            "");
  EXPECT_EQ(checking(text("Type", "NS SIMPLE") + text("Inverse Velocity Type", "CG") +
                     text("Explicit Velocity Inverse Type", "AbsRowSum")),
            "");
}

TEST(TekoLibrary, RefusesAMisspeltParameterOfAFactory) {
  EXPECT_EQ(
      checking(text("Type", "Block Jacobi") + text("Invers Type", "CG")),
      "solver.xml, line 5: in \"Library/Outer\", \"Invers Type\" is not a parameter of \"Block "
      "Jacobi\". Did you mean \"Inverse Type\"?\nValid here: \"Inverse Type\", \"Inverse Type "
      "#\".");
  EXPECT_THAT(checking(text("Type", "NS SIMPLE") + text("Inverse Type 1", "CG")),
              StartsWith("solver.xml, line 5: in \"Library/Outer\", \"Inverse Type 1\" is not a "
                         "parameter of \"NS SIMPLE\"."));
}

TEST(TekoLibrary, ChecksFactoriesForOneBlock) {
  EXPECT_EQ(checking(text("Type", "Diagonal Scaling") + text("Inverse Factory", "CG")), "");
  EXPECT_EQ(checking(text("Type", "Neumann Series") + text("Scaling Type", "Diagonal")), "");
  EXPECT_THAT(checking(text("Type", "Diagonal Scaling") + text("Inverse Type", "CG")),
              HasSubstr("\"Inverse Type\" is not a parameter of \"Diagonal Scaling\""));
  EXPECT_THAT(checking(text("Type", "Neumann Series") + text("Number of Term", "3")),
              HasSubstr("Did you mean \"Number of Terms\"?"));
  EXPECT_THAT(
      checking(text("Type", "Iterative Preconditioner") + text("Preconditioner Type", "GC")),
      HasSubstr("\"Preconditioner Type\" is \"GC\""));
}

TEST(TekoLibrary, RefusesUnknownTypesAndInverses) {
  EXPECT_THAT(checking(text("Type", "Block Jacoby")),
              StartsWith("solver.xml, line 4: in \"Library/Outer\", \"Type\" is \"Block Jacoby\", "
                         "which is no factory. Did you mean \"Block Jacobi\"?\nValid here: "));
  EXPECT_THAT(
      checking(text("Type", "Block Jacobi") + text("Inverse Type 1", "Ifpak2")),
      StartsWith("solver.xml, line 5: in \"Library/Outer\", \"Inverse Type 1\" is \"Ifpak2\", "
                 "which is neither in the library nor a type. Did you mean \"Ifpack2\"?"));
  EXPECT_EQ(
      checking(text("Inverse Type", "CG")),
      "solver.xml, line 3: in \"Library/Outer\", the parameter \"Type\" (string) is required; "
      "it names the factory.");
}

TEST(TekoLibrary, KnowsTheFactoriesOfTheProgram) {
  const std::vector<TekoFactory> own = {{"Coupled", {"Fluid Inverse Type"}}};

  EXPECT_EQ(checking(text("Type", "Coupled") + text("Fluid Inverse Type", "CG"), own), "");
  EXPECT_THAT(checking(text("Type", "Coupled") + text("Fluid Invers Type", "CG"), own),
              StartsWith("solver.xml, line 5: in \"Library/Outer\", \"Fluid Invers Type\" is not a "
                         "parameter of \"Coupled\". Did you mean \"Fluid Inverse Type\"?"));
}

}  // namespace
}  // namespace lockstep::test
