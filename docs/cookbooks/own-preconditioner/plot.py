"""Iterations and seconds on the stored system, iterations a step of the runs: own-preconditioner.png."""
from pathlib import Path

import numpy as np
from plot_style import outputs_of, panels, read_table, save, series_style

_, solvers = read_table("compared/solvers.csv", ["file"], ["iterations", "setup_seconds", "solve_seconds", "error"])
names = [Path(row["file"]).stem for row in solvers]
for name, row in zip(names, solvers):
    print(f"{name}: {row['iterations']:.0f} iterations, {row['error']:.0e} from the direct solution")

shown = len(names) - 1  # without the direct solver
figure, ((left, middle, right),) = panels(1, 3, figsize=(9, 2.9))
colours = [f"C{number}" for number in range(shown)]
left.bar(names[:shown], [row["iterations"] for row in solvers[:shown]], color=colours)
for axes in (left, middle):
    axes.set_axisbelow(True)
left.set_ylabel("iterations, stored system")
setup = [1000 * row["setup_seconds"] for row in solvers[:shown]]
middle.bar(names[:shown], setup, color=colours, alpha=.4, label="set-up")
middle.bar(names[:shown], [1000 * row["solve_seconds"] for row in solvers[:shown]], bottom=setup, color=colours, label="solve")
middle.set_ylabel("milliseconds: set-up (pale), solve")
places = {}
for number, name in enumerate(names[:shown]):
    _, rows = read_table(f"{name}/history.csv", [], ["step", "s1_iterations", "s2_iterations"])
    right.plot([row["step"] for row in rows], [row["s2_iterations"] for row in rows], **series_style(number), label=name)
    print(f"{name}, the run: {sum(row['s1_iterations'] + row['s2_iterations'] for row in rows):.0f} iterations in {len(rows)} steps")
    _, bodies = read_table(f"{name}/bodies.csv", [], ["x", "y"])
    places[name] = np.array([[body["x"], body["y"]] for body in bodies])
print(f"discs of schur-cg and triangle: at most {abs(places['schur-cg'] - places['triangle']).max():.0e} m apart")
right.set(xlabel="step", ylabel="iterations of S2", ylim=(0, None))
right.legend()
save(figure, outputs_of("own-preconditioner.png", None))
