"""Strategies of random scenes, and the inverses in them: those of limited use only in their domain."""

TOLERANCE = 1e-10
# Strategies that can solve every scene; the others are drawn where docs/solvers.md says they can.
GENERAL_STRATEGIES = ["schur-cg"] * 8 + ["pressure-schur", "direct", "paper"]
NEEDS_FLUID_ALONE = {"bramble-pasciak", "uzawa", "block-lu", "solid-schur"}  # refuse a region that a solid closes
BELOS_STRATEGIES = {"block-lu", "gauss-seidel", "simple"}


def strategy(world, coupling_list, solid_lists):
    """A strategy and inverses of its blocks; those of limited use only in their domain."""
    rng, facts = world.rng, world.facts
    names = list(GENERAL_STRATEGIES)
    limited = []
    rigid_only = facts.dynamic_rigid and not (facts.soft or facts.attached or facts.closed_shell)
    if rigid_only and coupling_list["Type"] == "mixed face":
        limited += ["solid-schur", "block-lu", "bramble-pasciak", "block-elimination", "simple"]
        if facts.lightest >= 1:
            limited.append("gauss-seidel")
        if facts.lightest >= 20:
            limited += ["uzawa"] * 3
    name = rng.choice(limited if limited and rng.random() < 0.5 else names)
    chosen = {"Type": name, "Maximum Iterations": 5000}
    facts.strategy = name
    facts.needs_full_ranks = name in BELOS_STRATEGIES
    if name == "paper":
        chosen["Krylov Method"] = rng.choice(["Belos MINRES", "Lockstep MINRES"])
        facts.needs_full_ranks = chosen["Krylov Method"] == "Belos MINRES"
    if name in ("schur-cg", "pressure-schur") and rng.random() < 0.25:
        kind = rng.choice(["MueLu", "Incomplete Cholesky", "Multigrid"])  # the last wants whole tiles along periodic axes
        chosen["Pressure Inverse"] = {"Type": "Automatic" if kind == "Multigrid" and world.facts.periodic else kind}
        facts.pressure_by_muelu = kind == "MueLu" and name == "pressure-schur"
    if name in ("schur-cg", "pressure-schur") and solid_lists and rng.random() < 0.25:
        kinds = ["Exact", "Jacobi", "Additive Multilevel", "MueLu"] if facts.soft else ["Exact", "Block Diagonal"]
        chosen["Solid Inverse"] = {"Type": rng.choice(kinds)}
        facts.solid_by_muelu = chosen["Solid Inverse"]["Type"] == "MueLu"
    return chosen


def solver(world, coupling_list, solid_lists):
    chosen = {"Tolerance": TOLERANCE, "Strategy": strategy(world, coupling_list, solid_lists)}
    chosen["Viscous Tolerance"] = 1e-12
    if world.facts.soft and world.rng.random() < 0.25:
        chosen["Newton Iterations"] = world.rng.randint(2, 3)
    return chosen
