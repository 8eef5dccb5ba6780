"""Heave and draft of the run in run/, beside linear theory and Archimedes: floating-body.png."""
import numpy as np
from heave_theory import swing_in_tank
from plot_style import legend_beside, outputs_of, panels, read_table, save

R, LIFT, HALF_WIDTH, DEPTH = .0762, .1, 12, 8  # [m]; the rest in R
_, rows = read_table("run/bodies.csv", [], ["time", "y"])
times = np.array([row["time"] for row in rows]) / np.sqrt(R / 9.81)
heights = np.array([row["y"] for row in rows]) / R

theory_times, theory = swing_in_tank(HALF_WIDTH, DEPTH, end=30, dt=.02)
error = heights / LIFT - np.interp(times, theory_times, theory)
print(f"first trough {heights[times < 4].min() / LIFT:.3f}, theory {theory[theory_times < 4].min():.3f}")
crest = (times > 4) & (times < 8)
print(f"first crest {heights[crest].max() / LIFT:.3f}, theory {theory[(theory_times > 4) & (theory_times < 8)].max():.3f}")
print(f"largest difference {100 * abs(error).max():.1f} % of the lift")

level = 2 * LIFT / (2 * HALF_WIDTH)  # by what the water rises as the disc, 2 R wide there, sinks in by the lift
draft = level - heights[times > 10].mean() + 1
print(f"draft {draft:.3f} R, Archimedes 1.000 R: {100 * abs(draft - 1):.1f} % off")

figure, ((upper,), (lower,)) = panels(2, 1, figsize=(6.5, 4.2), sharex=True, height_ratios=(2, 1))
lines = {"simulated": upper.plot(times, heights / LIFT, color="C0")[0],
         "linear theory": upper.plot(theory_times, theory, color="black", linestyle="--")[0],
         "at rest, Archimedes": upper.axhline(level / LIFT, color="C3", linewidth=.7)}
legend_beside(upper, lines)
upper.set_ylabel("height over the lift")
lower.plot(times, error, color="C0")
lower.set(xlabel=r"time over $\sqrt{R/g}$", ylabel="error over the lift")
save(figure, outputs_of("floating-body.png", None))
