// Contents of the lists of Stratimikos, Teko and the sub-block inverses, and the operators built of
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Tpetra_Core.hpp>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/gathered_direct.hpp"
#include "solve/preconditioner.hpp"
#include "solve/solver_list.hpp"
#include "unit/solve/stratimikos_xml.hpp"

namespace lockstep::test {

namespace {

using ::testing::HasSubstr;
using Teuchos::ParameterList;

template <typename Error, typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// The message for the Teko solver with one piece of its XML replaced.
std::string complaint_about(const std::string& from, const std::string& to) {
  std::string xml = minres_with_teko;
  xml.replace(xml.find(from), from.size(), to);
  const auto list = Teuchos::getParametersFromXmlString(xml);
  return message_of<InputError>([&] { check_solver_list(*list); });
}

ParameterList inverse(const std::string& xml) {
  return *Teuchos::getParametersFromXmlString("<ParameterList>" + xml + "</ParameterList>");
}

std::string ifpack2(const std::string& type, const std::string& settings) {
  return R"(<Parameter name="Type" type="string" value="Ifpack2"/><Parameter name="Prec Type" )"
         R"(type="string" value=")" +
         type +
         R"("/><Parameter name="Overlap" type="int" value="0"/><ParameterList )"
         R"(name="Ifpack2 Settings">)" +
         settings + "</ParameterList>";
}

std::string typed(const std::string& type) {
  return R"(<Parameter name="Type" type="string" value=")" + type + R"("/>)";
}

}  // namespace

TEST(SolverList, MisspeltKeysAreRefusedAtEveryDepth) {
  EXPECT_THAT(complaint_about("Fluid Inverse Type", "Fluid Inverse Tipe"),
              HasSubstr("\"Fluid Inverse Tipe\" is not a parameter of \"SPD Block Diagonal\""));
  EXPECT_THAT(complaint_about("smoother: type", "smother: type"),
              HasSubstr("Did you mean \"smoother: type\"?"));
  EXPECT_THAT(complaint_about("fact: iluk level-of-fill", "fact: iluk level-of-fil"),
              HasSubstr("Did you mean \"fact: iluk level-of-fill\"?"));
  EXPECT_THAT(complaint_about("Maximum Iterations", "Maximum Iteration"),
              HasSubstr("Did you mean \"Maximum Iterations\"?"));
  EXPECT_THAT(complaint_about("Preconditioner Type\"", "Preconditioner Tipe\""),
              HasSubstr("Did you mean \"Preconditioner Type\"?"));
  EXPECT_THAT(
      complaint_about("value=\"Solid\"", "value=\"Sollid\""),
      HasSubstr(
          "is \"Sollid\", which is neither in the library nor a type. Did you mean \"Solid\"?"));
  const auto list = Teuchos::getParametersFromXmlString(minres_with_teko);
  EXPECT_NO_THROW(check_solver_list(*list));
}

TEST(SolverList, WrongCoarseSolverIsRefusedOnSeveralRanks) {
  const std::string message = complaint_about("\"RELAXATION\"", "\"KLU2\"");
  if (Tpetra::getDefaultComm()->getSize() > 1)
    EXPECT_THAT(message, HasSubstr("wrong on several ranks"));
  else
    EXPECT_EQ(message, "nothing was thrown");
}

TEST(Preconditioner, EveryTypeIsSymmetricPositiveDefinite) {
  const SaddleProblem problem(Tpetra::getDefaultComm(), {});
  const std::vector<std::string> lists = {
      typed("MueLu"),
      typed("Direct"),
      typed("Jacobi"),
      typed("Exact"),
      typed("Conjugate Gradients"),
      typed("Incomplete Cholesky"),
      ifpack2("RILUK", R"(<Parameter name="fact: iluk level-of-fill" type="int" value="0"/>)"),
      ifpack2("CHEBYSHEV", R"(<Parameter name="chebyshev: degree" type="int" value="4"/>)"),
      ifpack2(
          "RELAXATION",
          R"(<Parameter name="relaxation: type" type="string" value="Symmetric Gauss-Seidel"/>)")};
  for (const std::string& xml : lists) {
    SCOPED_TRACE(xml);
    EXPECT_NO_THROW(check_symmetric_positive(
        *preconditioner_from_list(problem.system.pressure_block(), inverse(xml), "test"), "test"));
  }
  EXPECT_NO_THROW(
      check_symmetric_positive(*preconditioner_from_list(problem.system.solid_block(),
                                                         inverse(typed("Block Diagonal")), "test"),
                               "test"));
}

TEST(Preconditioner, UnsymmetricSmootherIsCaught) {
  const SaddleProblem problem(Tpetra::getDefaultComm(), {});
  const auto forward = preconditioner_from_list(
      problem.system.pressure_block(),
      inverse(
          ifpack2("RELAXATION",
                  R"(<Parameter name="relaxation: type" type="string" value="Gauss-Seidel"/>)")),
      "test");
  EXPECT_GT(symmetry_defect(*forward), 1e-3);
  EXPECT_THROW(check_symmetric_positive(*forward, "test"), SolveError);
}

/// A solid that fills the whole domain leaves no unknowns.
TEST(Preconditioner, NoUnknownsNeedNoFactors) {
  const auto none = rcp(new Map(0, 0, Tpetra::getDefaultComm()));
  const auto direct = gathered_direct(matrix_from_rows(none, {}), "nothing");
  Vector x(none), y(none);
  apply(*direct, x, y);
  EXPECT_EQ(y.getGlobalLength(), 0u);
}

TEST(Preconditioner, BadListsAreRefused) {
  const auto complaint = [](const std::string& xml) {
    return message_of<InputError>([&] { check_preconditioner_list(inverse(xml), "here"); });
  };
  EXPECT_THAT(complaint(typed("Jakobi")), HasSubstr("Did you mean \"Jacobi\"?"));
  EXPECT_THAT(complaint(typed("Ifpack2")), HasSubstr("needs the parameter \"Prec Type\""));
  EXPECT_THAT(complaint(typed("Conjugate Gradients") + R"(<ParameterList name="Preconditioner">)" +
                        typed("MueLoo") + "</ParameterList>"),
              HasSubstr("here, \"Preconditioner\": there is no inverse of type \"MueLoo\""));
  EXPECT_THAT(complaint(""), HasSubstr("\"Type\" (string) is missing"));
  EXPECT_THAT(complaint(ifpack2("RILUKK", "")),
              HasSubstr("\"Prec Type\" is \"RILUKK\", which is no preconditioner"));
  EXPECT_THAT(complaint(ifpack2("Relaxation", "")), HasSubstr("nothing was thrown"));
  const auto with = [&](const char* type, const char* name, const char* kind, const char* value) {
    return complaint(typed(type) + "<Parameter name=\"" + name + "\" type=\"" + kind +
                     "\" value=\"" + value + "\"/>");
  };
  EXPECT_THAT(with("Block Diagonal", "Largest Block", "int", "-1"),
              HasSubstr("\"Largest Block\" is -1, but must be between 1 and 10000"));
  for (const char* value : {"-1e-3", "0", "1"})
    EXPECT_THAT(with("Conjugate Gradients", "Tolerance", "double", value),
                HasSubstr("but must be between 1e-15 and 0.5"));
  EXPECT_THAT(with("Conjugate Gradients", "Maximum Iterations", "int", "0"),
              HasSubstr("\"Maximum Iterations\" is 0"));
  const auto with_others = message_of<InputError>([] {
    check_preconditioner_list(inverse(typed("Mutligrid")), "here", {"Automatic", "Multigrid"});
  });
  EXPECT_THAT(with_others,
              HasSubstr("Did you mean \"Multigrid\"? There are: Automatic, Multigrid, "));
  EXPECT_THAT(complaint(typed("Jacobi") + R"(<Parameter name="Omega" type="double" value="1"/>)"),
              HasSubstr("\"Omega\" is not a parameter"));
  EXPECT_THAT(complaint(ifpack2("RILUK", R"(<Parameter name="fact: fil" type="int" value="0"/>)")),
              HasSubstr("\"fact: fil\" is not a parameter"));
}

}  // namespace lockstep::test
