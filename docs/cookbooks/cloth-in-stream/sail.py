"""Runs sail.yaml, and holds the force on the cloth and its shape against two references: sail.png."""
import lockstep
import numpy as np
from plot_style import outputs_of, panels, save
from scipy.optimize import brentq

DENSITY, SPAN, LENGTH = 1000, .375, .45
y = np.linspace(-.5, .5, 129)


def momentum(run, x):
    """What flows through the line at x, with the pressure on it [N/m]."""
    _, pressure, velocity = run.sample([(x, height) for height in y])
    return np.trapz(pressure + DENSITY * velocity[:, 0] ** 2, y)


forces, balances = [], []
with lockstep.Run("sail.yaml", "run") as run:
    while run.step():
        forces.append((run.time, run.bodies()["Cloth"]["force"][0]))
        if run.n_steps % 5 == 0:
            balances.append((run.time, momentum(run, -.8) - momentum(run, 1.5)))
    nodes, speed = run.nodes("Cloth"), np.linalg.norm(run.fields()["velocity"], axis=-1)

half_angle = brentq(lambda a: np.sin(a) / a - SPAN / LENGTH, .1, 3)
radius = LENGTH / (2 * half_angle)
arc_sag, sag = radius * (1 - np.cos(half_angle)), nodes[:, 0].max()
print(f"force {forces[-1][1]:.1f} N/m, momentum balance {balances[-1][1]:.1f} N/m: "
      f"{100 * abs(forces[-1][1] / balances[-1][1] - 1):.1f} % apart")
print(f"sag {1000 * sag:.1f} mm, circular arc {1000 * arc_sag:.1f} mm: {100 * abs(sag / arc_sag - 1):.1f} % apart")

figure, ((upper,), (lower,)) = panels(2, 1, figsize=(6.5, 4.6), height_ratios=(5, 4))
image = upper.imshow(speed, origin="lower", extent=(-1, 2, -.5, .5), cmap="Blues")
figure.colorbar(image, ax=upper, pad=.02, label="speed [m/s]")
angles = np.linspace(-half_angle, half_angle)
upper.plot(*nodes[np.argsort(nodes[:, 1])].T, color="C3", label="cloth")
angles = np.linspace(-half_angle, half_angle)
upper.plot(arc_sag - radius + radius * np.cos(angles), radius * np.sin(angles), "k--", linewidth=.8, label="circular arc")
upper.set(xlabel="x [m]", ylabel="y [m]")
upper.legend(loc="upper left")
lower.plot(*np.array(forces).T, label="on the cloth")
lower.plot(*np.array(balances).T, "k--", linewidth=.8, label="momentum balance")
lower.set(xlabel="time [s]", ylabel="force [N/m]", ylim=(0, 500))
lower.legend(loc="lower right")
save(figure, outputs_of("sail.png", None))
