"""The pages of docs/results: the commands that make each, and the files that its figures depend on.

A study's page depends on its files, on src/ and on those packages that its scenes use; which these are is read off the
lists and types in the scenes. Other pages stand in TOOL_PAGES. Paths are git's pathspecs, from the root of the tree.
"""
import csv
import dataclasses
import os
import re
import shlex
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STUDIES = "xml-params/studies"
RESULTS = "docs/results"
# A file that is new to a build changes too; a list of the files of a room changes no figure.
NOT_BUILD_FILES = ":(exclude)*CMakeLists.txt"
ANY_SOLVE = ["src/solve", "src/linear", "src/coupling", "packages/strategies", "packages/multigrid", "xml-params/solvers"]
SOLID_PACKAGES = {"rigid body": "rigid", "deformable body": "deformable", "cloth": "deformable", "spring": "lines", "rope": "lines", "mooring line": "lines"}
COUPLING_PACKAGES = {"mixed face": {"mixedface"}, "flux": {"cutcell"}, "automatic": {"mixedface", "cutcell"}}


@dataclasses.dataclass
class Page:
    name: str
    commands: list       # one after another, words of each; the first word is a path from the root
    paths: list          # paths that the figures depend on
    by_hand: str = ""    # reason why nobody but a person can make it again


@dataclasses.dataclass
class Tool:
    """The making of a page that is no study's: its commands, their scenes, and what else it depends on."""
    commands: list
    scenes: list = dataclasses.field(default_factory=list)
    paths: list = dataclasses.field(default_factory=list)
    by_hand: str = ""


OTHER_PROGRAM = "it compares with another program: choose one, and name it with --against"
TOOL_PAGES = {
    "contact-rest": Tool(["tools/measure-rest"], [], ["tests/support/resting_cases.py", "src", "packages/contact", "packages/rigid", "packages/faces"]),
    "defaults": Tool(["tools/measure-defaults"], [f"{STUDIES}/soft-boat-scene.xml", f"{STUDIES}/beam-in-channel-scene.xml"]),
    "discretizations": Tool(["tools/compare-discretizations"], [], ["docs/results/heave-decay.csv", "tools/compare-discretizations"]),
    "histories": Tool(["tools/compare-histories --against OTHER/simulate"], ["xml-params/scenes/*.xml"], by_hand=OTHER_PROGRAM),
    "histories-ranks": Tool(["tools/compare-histories --ranks 2"], ["xml-params/scenes/*.xml"]),
    "house": Tool(["tools/measure-house"], [], ["src", "packages", "tools/measure-house"]),
    "interfaces": Tool(["tools/measure-interfaces"], [], [
        "tests/benchmarks/interfaces.cpp", "packages/liquid", "packages/staggered", "packages/transport", "packages/grid", "src/base", "src/geometry"]),
    "joints": Tool(["tools/measure-joints"], [f"{STUDIES}/pendulum-scene.xml", "xml-params/scenes/fish-2d.xml"], ["tests/joints"]),
    "messages": Tool(["tools/count-messages"], [
        f"{STUDIES}/step-cost-scene.xml", "xml-params/scenes/hundred-balls.xml", "xml-params/scenes/cloth-in-stream.xml"],
        ["tests/benchmarks/mpi_counter.cpp"]),
    "paper-sizes": Tool(["tools/measure-paper-sizes"], [f"xml-params/scenes/{name}.xml" for name in (
        "floating-boat", "buoyant-spheres-water", "fountain", "twenty-four-spheres", "torus-drop", "cloth-in-water", "cloth-bags",
        "balloon", "fish")]),
    "peers": Tool(["tools/measure-peers"], [], [*ANY_SOLVE, "tests/benchmarks/peers*", "tools/solver_cases.py"]),
    "plume-tiles": Tool(["tools/measure-tiles"], [
        f"{STUDIES}/plume-tiles-scene.xml", f"{STUDIES}/pool-tiles-scene.xml", "xml-params/scenes/plume-in-tall-room.xml"]),
    "presets": Tool(["tools/compare-presets"], [], ["xml-params/presets", "xml-params/studies", "tools/compare-presets", "packages"]),
    "ranks": Tool(["tools/measure-ranks"], [f"{STUDIES}/step-cost-scene.xml"], ["tests/benchmarks/mpi_counter.cpp"]),
    "robustness": Tool(["tests/robustness/random_scenes.py --seeds 0-199,1000-1099,2000-2099,3000-3099,4000-4099,5000-5099,8000-8099,9000-9099,10000-10099 "
                        "--quick --report docs/results/robustness.md",
                        "tests/robustness/random_scenes.py --seeds 7000-7299 --ranks 1 2 3 4 --report docs/results/robustness.md",
                        "tests/robustness/mutations.py --mutations 0-5399 --report docs/results/robustness.md"],
                       ["xml-params/scenes/*.xml"], ["tests/robustness", "drivers", "packages"]),
    "scenes": Tool(["tools/measure-scenes --against OTHER/simulate"], ["xml-params/scenes/*.xml", f"{STUDIES}/soft-cost-scene.xml"],
                   ["tools/solver_cases.py"], by_hand=OTHER_PROGRAM),
    "soft-cost": Tool(["tools/measure-soft"], [f"{STUDIES}/soft-cost-scene.xml", f"{STUDIES}/soft-cost-rigid-scene.xml"]),
    "solver-cost": Tool(["tools/measure-solvers",
                         "tools/measure-solvers --cases 'free top, ball 1e-3' 'free top, 30 balls 1e-3' --strategies minres-teko",
                         "tools/measure-solvers --cells 64 96 160 --cases 'free top, ball 1' --strategies schur-cg"],
                        [], [*ANY_SOLVE, "packages/mac/pressure", "packages/faces", "packages/mixedface", "tools/solver_cases.py"]),
    "step-cost": Tool(["tools/measure-step --steps 8"], [f"{STUDIES}/step-cost-scene.xml"], ["xml-params/solvers/paper.xml", "packages/strategies"]),
    "strategies-complexity": Tool(["tools/compare-strategies complexity"], [], [*ANY_SOLVE, "tools/compare-strategies", "tools/solver_cases.py"]),
    "strategies-hard-cases": Tool(["tools/compare-strategies hard-cases"], [
        f"{STUDIES}/{name}-scene.xml" for name in ("density-ratio", "pockets", "pockets-overlap", "pockets-piston", "time-step", "units")],
        [*ANY_SOLVE, "packages/liquid", "tools/compare-strategies", "tools/solver_cases.py"]),
    "strategies-iterations": Tool(["tools/compare-strategies iterations"], [], [
        *ANY_SOLVE, "packages/mac/pressure", "packages/faces", "packages/mixedface", "tools/compare-strategies", "tools/solver_cases.py"]),
    "strategies-joints": Tool(["tools/compare-strategies joints"], [], [
        *ANY_SOLVE, "packages/mac/pressure", "packages/faces", "packages/mixedface", "packages/articulated", "tools/compare-strategies",
        "tools/solver_cases.py"]),
    "strategies-paper": Tool(["tools/compare-strategies paper"], [f"xml-params/scenes/{name}.xml" for name in (
        "buoyant-spheres-water", "torus-drop", "cloth-in-water", "balloon")], [*ANY_SOLVE, "xml-params/presets", "tools/compare-strategies"]),
    "strategies-scenes": Tool(["tools/compare-strategies scenes"], ["xml-params/scenes/*.xml"], [*ANY_SOLVE, "tools/compare-strategies"]),
    "strategies-systems": Tool(["tools/compare-strategies systems"], [], [*ANY_SOLVE, "tests/data", "drivers/solve.cpp"]),
    "swimming": Tool(["tools/measure-swimming"], ["xml-params/scenes/fish-2d.xml", "xml-params/scenes/fish.xml"]),
    "viscous-coupling": Tool(["tools/compare-viscous-coupling"], [], ["tools/compare-viscous-coupling"]),
    "water-cost": Tool(["tools/measure-water --cells 64 96 128 --ranks 1"], [f"{STUDIES}/water-cost-scene.xml"]),
}


def settings_of(element, path=""):
    """(path, value) of every parameter below, and (path/, "") of every list: "Solids/Ball/Type", "rigid body"."""
    for child in element:
        name = path + child.get("name", "")
        if child.tag == "ParameterList":
            yield name + "/", ""
            yield from settings_of(child, name + "/")
        elif child.tag == "Parameter":
            yield name, child.get("value", "")


def assignments_of(study):
    """Assignments in the "Set" of a study, its series, factors and samples: "Coupling/Type", "flux"."""
    for path, value in settings_of(study):
        if path.split("/")[-1] == "Set":
            for assignment in value.split(";"):
                name, _, assigned = assignment.strip().partition("=")
                yield name, assigned


def parsed(root, file):
    return xml.etree.ElementTree.parse(Path(root) / file).getroot()


def beside(file, name):
    """The path from the root of what `file` names; a formula in it may be anything."""
    return os.path.normpath(os.path.join(os.path.dirname(file), re.sub(r"\[.*?\]", "*", name)))


def with_included(root, scene):
    """(file, settings) of a scene and of what it includes."""
    settings = list(settings_of(parsed(root, scene)))
    yield scene, settings
    for path, value in settings:
        if path == "Include":
            for name in value.strip("{}").split(","):
                yield from with_included(root, beside(scene, name.strip()))


def strategies_of(root, settings, files):
    """Names of the strategies that a scene and its solver files choose, and the default, which a study's other series may have."""
    chosen = {value for path, value in settings if path == "Solver/Strategy/Type"}
    for file in files:
        if "/solvers/" in file and (Path(root) / file).exists():
            chosen.add(dict(settings_of(parsed(root, file)))["Type"])
    return chosen | {"schur-cg"}


def packages_of(settings, strategies):
    """The folders of packages/ that run in a scene with these lists and types."""
    paths = [path for path, _ in settings]

    def types(where, otherwise):
        return {value for path, value in settings if re.fullmatch(where, path)} or {otherwise}

    packages = {"grid", "transport", "staggered", "mac", "multigrid", "strategies/common"} | {f"strategies/{name.replace('-', '_')}" for name in strategies}
    if any(re.match("Solids/.", path) for path in paths):
        packages |= {SOLID_PACKAGES[name] for name in types("Solids/[^/]*/Type", "rigid body")}
        # The default always counts: one series may have it where another one says something else.
        packages |= {"faces"}.union(*(COUPLING_PACKAGES[name] for name in types("Coupling/Type", "automatic")))
        if types("Contact/Type", "gauss seidel") != {"none"}:
            packages.add("contact")
    for word, package in (("Joints/", "articulated"), ("Observers/", "observers"), ("Fluid/Free Surface/", "liquid")):
        if any(path.startswith(word) for path in paths):
            packages.add(package)
    return packages


def paths_of_scenes(root, scenes, assignments=()):
    """Paths that runs of these scenes depend on, with these changes of them."""
    all_files, packages = set(), set()
    for scene in scenes:
        settings, files = list(assignments), [beside(scene, value) for path, value in assignments if path.endswith("/File")]
        for file, found in with_included(root, scene):
            settings += found
            files += [file, *(beside(file, value) for path, value in found if path.endswith("/File") and value)]
        all_files |= set(files)
        packages |= packages_of(settings, strategies_of(root, settings, files))
    return [*sorted(all_files), "src", *(f"packages/{name}" for name in sorted(packages)), NOT_BUILD_FILES]


def study_page(root, name):
    file = f"{STUDIES}/{name}.xml"
    study = parsed(root, file)
    scenes = sorted({beside(file, value) for path, value in settings_of(study) if path.split("/")[-1] == "Scene"})
    return Page(name, [["tools/results", name]], [file, *paths_of_scenes(root, scenes, list(assignments_of(study)))])


def tool_page(root, name):
    tool = TOOL_PAGES[name]
    scenes = sorted(str(path.relative_to(root)) for pattern in tool.scenes for path in Path(root).glob(pattern))
    paths = paths_of_scenes(root, scenes) if scenes else [NOT_BUILD_FILES]
    # Paths that a tool names itself count, also where its scenes leave them out.
    paths = [path for path in paths if not (path.startswith(":(exclude)packages") and any("packages" in own for own in tool.paths))]
    return Page(name, [shlex.split(command) for command in tool.commands], [*tool.paths, *paths], tool.by_hand)


def page_of(root, name):
    """The page docs/results/NAME.md; None if nothing is known of it."""
    if (Path(root) / STUDIES / f"{name}.xml").exists():
        return study_page(root, name)
    return tool_page(root, name) if name in TOOL_PAGES else None


def names_of_pages(root):
    return sorted(path.stem for path in (Path(root) / RESULTS).glob("*.md") if path.name != "README.md")


def seconds_of(root, name):
    """Seconds that the page took when it was made, as far as its table or its text says so; else None."""
    text = (Path(root) / RESULTS / f"{name}.md").read_text()
    table = Path(root) / RESULTS / f"{name}.csv"
    rows = list(csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#"))) if table.exists() else []
    if rows and "wall_seconds" in rows[0]:
        # Every quantity has a row of each run: no two runs take the same nanoseconds.
        runs = {(row["series"], row["wall_seconds"]): row for row in rows if row["wall_seconds"]}.values()
        return sum(float(row["wall_seconds"]) * int(row.get("samples") or 1) / int(row.get("at_a_time") or 1) for row in runs)
    said = re.findall(r"^([0-9]+) s of a core\.", text, re.MULTILINE)
    return sum(map(float, said)) if said else None
