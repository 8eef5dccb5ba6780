"""Stress of the strips in stiffening/ and plain/, from their elastic energy, beside the law itself: own-material.png."""
import numpy as np
from plot_style import outputs_of, panels, read_table, save
from scipy.optimize import minimize_scalar

YOUNG, POISSON, VOLUME, LENGTH = 1e5, .4, .4 * .1, .4  # [Pa], 1, [m^2], [m]
SHEAR, LAME = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))


def energy(along, across, stiffening):
    """The law of rubber.cpp at F = diag(along, across, 1), but for a constant [J/m^3]; the base is that of Smith et al. (2018)."""
    mu, bulk = 4 / 3 * SHEAR, LAME + 5 / 6 * SHEAR
    invariant, volume = along ** 2 + across ** 2 + 1, along * across
    base = mu / 2 * (invariant - 3 - np.log(invariant + 1)) + bulk / 2 * (volume - 1 - .75 * mu / bulk) ** 2
    return base + stiffening * (invariant - 3) ** 2


def stress(along, stiffening):
    """Of a strip that is free to contract [Pa]: the slope of its least energy."""
    least = [minimize_scalar(lambda across: energy(a, across, stiffening), bounds=(.1, 1.5), method="bounded",
                             options={"xatol": 1e-9}).fun for a in (along - 1e-3, along + 1e-3)]
    return (least[1] - least[0]) / 2e-3


figure, ((axes,),) = panels(1, 1, figsize=(5, 3.4))
for number, (run, stiffening) in enumerate({"stiffening": 1e4, "plain": 0}.items()):
    _, rows = read_table(f"{run}/history.csv", [], ["time", "elastic_energy"])
    stretches = 1 + .4 * np.array([row["time"] for row in rows]) / LENGTH
    energies = np.array([row["elastic_energy"] for row in rows]) / VOLUME
    middles = (stretches[1:] + stretches[:-1]) / 2
    measured, law = np.diff(energies) / np.diff(stretches), np.array([stress(a, stiffening) for a in middles])
    worst = abs(measured - law)[middles > 1.1].max() / law.max()
    print(f"{run}: stress at twice the length {measured[-1] / 1e3:.1f} kPa, the law's {law[-1] / 1e3:.1f} kPa; "
          f"at most {100 * worst:.2f} % of that apart")
    axes.plot(middles, law / 1e3, color=f"C{number}", label=f"{run}, the law")
    axes.plot(middles[4::8], measured[4::8] / 1e3, "o", color=f"C{number}", markerfacecolor="none", label=f"{run}, simulated")
axes.set(xlabel="length over that at rest", ylabel="stress [kPa]")
axes.legend()
save(figure, outputs_of("own-material.png", None))
