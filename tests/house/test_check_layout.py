"""Each rule of check_layout.py must find a file that breaks it, and leave a proper tree alone."""
import tempfile
import unittest
from pathlib import Path

from check_layout import violations


class Rules(unittest.TestCase):
    def found(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for room in ("packages/grid", "packages/mac", "packages/rigid"):
                (Path(folder) / room).mkdir(parents=True)
            for name, text in files.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return list(violations(folder))

    def test_proper_tree(self):
        self.assertEqual(self.found({
            "src/solve/krylov.cpp": '#include <Teko_Utilities.hpp>\n#include "base/errors.hpp"\n',
            "packages/mac/fluid.cpp": '#include "grid/tiled_grid.hpp"\n#include "mac/fluid.hpp"\n',
        }), [])

    def test_includes_that_point_up(self):
        for name, include in [("src/base/a.cpp", "grid/tiled_grid.hpp"), ("src/base/a.cpp", "packages/grid/a.hpp"),
                              ("packages/grid/a.cpp", "drivers/simulate.hpp"), ("packages/grid/a.cpp", "mac/a.hpp"),
                              ("packages/rigid/a.hpp", "grid/a.hpp"), ("src/linear/a.hpp", "solve/a.hpp")]:
            with self.subTest(include=include):
                self.assertEqual(len(self.found({name: f'#include "{include}"\n'})), 1)

    def test_heavy_headers(self):
        for name in ("src/solve/krylov.hpp", "packages/grid/a.cpp", "src/base/a.cpp"):
            with self.subTest(name=name):
                self.assertEqual(len(self.found({name: "#include <MueLu_Level.hpp>\n"})), 1)

    def test_words(self):
        for text in ("see .." + "/shared/x", "/" + "tmp/x", "TO" + "DO", "std::" + "cout"):
            with self.subTest(text=text):
                self.assertEqual(len(self.found({"src/base/a.cpp": f"// {text}\n"})), 1)

    def test_clashes(self):
        def in_unnamed(text):
            return f"namespace lockstep {{\nnamespace {{\n{text}\n}}  // namespace\n}}\n"

        one = in_unnamed("constexpr int reach = 3;\n\nint twice(int i) {\n  return 2 * i;\n}")
        for text, n_clashes in [("constexpr double reach = 1e-3;", 1), ("struct reach {\n  int i;\n};", 1),
                                ("int twice(int number) {\n  return number + number;\n}", 1),
                                ("double twice(double x) {\n  return 2 * x;\n}", 0), ("  reach = 3;", 0)]:
            with self.subTest(text=text):
                self.assertEqual(len(self.found({"src/base/a.cpp": one, "src/base/b.cpp": in_unnamed(text)})), n_clashes)
                self.assertEqual(self.found({"src/base/a.cpp": one, "src/linear/b.cpp": in_unnamed(text)}), [])

    def test_loops_of_folders(self):
        def files(*includes):
            return {f"{name}{number}.cpp": f'#include "{include}"\n' for number, (name, include) in enumerate(includes)}

        mac, floors = "packages/mac", [("packages/mac/a", "mac/state/x.hpp"), ("packages/mac/viscosity/a", "mac/state/x.hpp"),
                                       ("packages/mac/viscosity/a", "mac/pressure/x.hpp"), ("packages/mac/pressure/a", "mac/state/x.hpp"),
                                       ("packages/mac/state/a", "mac/state/x.hpp"), ("packages/mac/state/a", "base/x.hpp")]
        self.assertEqual(self.found(files(*floors)), [])
        for name, include, length in [(f"{mac}/state/a", "mac/x.hpp", 2), (f"{mac}/state/a", "mac/pressure/x.hpp", 2),
                                      (f"{mac}/pressure/a", "mac/viscosity/x.hpp", 2), (f"{mac}/state/a", "mac/viscosity/x.hpp", 4)]:
            with self.subTest(name=name, include=include):
                self.assertEqual(len(self.found(files(*floors, (name, include)))), length)
        self.assertEqual(len(self.found(files(("src/solve/a", "solve/soft/x.hpp"), ("src/solve/soft/a", "solve/x.hpp")))), 2)

    def test_classes_in_pieces(self):
        files = {f"packages/mac/{i}.cpp": f"template <int dim>\nvoid Fluid<dim>::f{i}() {{}}\ntemplate void Fluid<2>::f{i}();\n" for i in range(2)}
        self.assertEqual(self.found({**files, "packages/mac/c.cpp": "template void Fluid<2>::g();\n"}), [])
        self.assertEqual(len(self.found({**files, "packages/mac/c.cpp": "const Name& Fluid<dim>::g() const {\n}\n"})), 1)

    def test_long_classes(self):
        def tree(n):
            members = "".join(f"template <int dim>\nvoid Fluid<dim>::f{i}() {{\n  run();\n}}\n" for i in range(n))
            return {"packages/mac/a.hpp": "class Fluid {\n  int a;\n};\n", "packages/mac/a.cpp": members + "template void Fluid<2>::f0();\n"}
        self.assertEqual(self.found(tree(160)), [])
        self.assertEqual(len(self.found(tree(170))), 1)

    def test_bases(self):
        self.assertEqual(self.found({"src/base/a.hpp": "class A : public B<1, 2>, public C, public D, E {\n};\n"}), [])
        self.assertEqual(len(self.found({"src/base/a.hpp": "class A : public B, public C, public D, public E, F {\n};\n"})), 1)

    def test_parameters(self):
        six = "int a, const B<C, D>& b, int c, double d = 0, const E& e, std::function<void(int, int)> f"
        self.assertEqual(self.found({"src/base/a.hpp": f"int f({six});\n"}), [])
        self.assertEqual(len(self.found({"src/base/a.hpp": f"int f({six}, int g);\n"})), 1)
        self.assertEqual(self.found({"src/base/a.cpp": "  return f(a + b, c, d, e, f, g, h);\n"}), [])

    def test_parameters_of_definitions(self):
        six = "int, C<int, int> a, void (*b)(int, int), int c,\n     int d, int e"
        self.assertEqual(self.found({"src/base/a.cpp": f"A::A({six}) : a_(a, 1) {{\n}}\n"}), [])
        for text in (f"template <int dim>\nA<dim>::A({six}, int f)\n    : a_(a), b_{{b}} {{\n}}\n", f"static int g({six}, int) {{\n}}\n"):
            with self.subTest(text=text):
                self.assertEqual(len(self.found({"src/base/a.cpp": text})), 1)
        self.assertEqual(self.found({"src/base/a.cpp": f"template int g({six}, int);\n"}), [])

    def test_full_folders(self):
        files = {f"src/base/a{i}.cpp": "" for i in range(39)}
        self.assertEqual(self.found(files), [])
        self.assertEqual(len(self.found({**files, "src/base/b.cpp": ""})), 1)


if __name__ == "__main__":
    unittest.main()
