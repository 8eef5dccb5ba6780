"""Strategies of random scenes, and the inverses in them: those of limited use only in their domain."""
import random
from pathlib import Path

TOLERANCE = 1e-10
SOLVERS = Path(__file__).resolve().parents[2] / "xml-params/solvers"
LISTS = {"minres-teko", "block-lu", "gauss-seidel", "simple", "uzawa"}  # lists of the strategy stratimikos, as files
# Strategies that can solve every scene; the others are drawn where docs/solvers.md says they can.
GENERAL_STRATEGIES = ["schur-cg"] * 8 + ["pressure-schur", "direct", "paper"]
# In the place of schur-cg, in scenes of all kinds of solids and both couplings.
GENERAL_LISTS = ["minres-teko"] * 3 + ["simple", "block-lu"]


def strategy(world, coupling_list, solid_lists):
    """A strategy and inverses of its blocks; those of limited use only in their domain."""
    rng, facts = world.rng, world.facts
    # Apart from that of the scene, whose numbers stay what they are for a seed however many strategies there are.
    own = random.Random(str(rng.getstate()))
    names = list(GENERAL_STRATEGIES)
    limited = []
    rigid_only = facts.dynamic_rigid and not (facts.soft or facts.attached or facts.closed_shell)
    if rigid_only and coupling_list["Type"] == "mixed face":
        limited += ["minres-teko", "block-lu", "minres-teko", "block-elimination", "simple"]
        if facts.lightest >= 1:
            limited.append("gauss-seidel")
        if facts.lightest >= 20:
            limited += ["uzawa"] * 3
    name = rng.choice(limited if limited and rng.random() < 0.5 else names)
    chosen = {"Type": name, "Maximum Iterations": 5000}
    facts.strategy = name
    if name == "paper":
        rng.choice(["one", "other"])  # once a parameter; the seeds keep their scenes
    if name in ("schur-cg", "pressure-schur") and rng.random() < 0.25:
        kind = rng.choice(["MueLu", "Incomplete Cholesky", "Multigrid"])  # the last wants whole tiles along periodic axes
        chosen["Pressure Inverse"] = {"Type": "Automatic" if kind == "Multigrid" and world.facts.periodic else kind}
        facts.pressure_by_muelu = kind == "MueLu" and name == "pressure-schur"
    if name in ("schur-cg", "pressure-schur") and solid_lists and rng.random() < 0.25:
        kinds = ["Exact", "Jacobi", "Additive Multilevel", "MueLu"] if facts.soft else ["Exact", "Block Diagonal"]
        chosen["Solid Inverse"] = {"Type": rng.choice(kinds)}
        facts.solid_by_muelu = chosen["Solid Inverse"]["Type"] == "MueLu"
    if name == "schur-cg" and own.random() < 0.25:
        facts.strategy = own.choice(GENERAL_LISTS)
        facts.solid_by_muelu = False
        return {"Type": facts.strategy, "Maximum Iterations": 5000}
    return chosen


def solver(world, coupling_list, solid_lists):
    chosen = {"Tolerance": TOLERANCE, "Strategy": strategy(world, coupling_list, solid_lists)}
    if chosen["Strategy"]["Type"] in LISTS:
        chosen["File"] = str(SOLVERS / f"{chosen['Strategy'].pop('Type')}.xml")
    chosen["Viscous Solve"] = {"Tolerance": 1e-12}
    if world.facts.soft and world.rng.random() < 0.25:
        chosen["Newton Iterations"] = world.rng.randint(2, 3)
    return chosen
