"""Errors of the study in study/, with the order that is fitted over all rungs: added-mass.png."""
import numpy as np
from plot_style import groups, outputs_of, panels, read_table, save, series_style, set_scales

_, rows = read_table("study/table.csv", ["series"], ["h", "value", "reference", "error"])
figure, ((axes,),) = panels(1, 1, figsize=(5, 3.4))
for number, (name, rungs) in enumerate(groups(rows, "series").items()):
    h, errors = np.array([[rung["h"], rung["error"]] for rung in rungs]).T
    order, factor = np.polyfit(np.log(h), np.log(errors), 1)
    print(f"{name}: added mass {rungs[-1]['value']:.4f}, exact {rungs[-1]['reference']:.4f}, "
          f"{100 * errors[-1]:.2f} % off on the finest grid, fitted order {order:.2f}")
    style = series_style(number)
    axes.plot(h, errors, **{**style, "linestyle": "none"}, label=name)
    axes.plot(h, np.exp(factor) * h ** order, color=style["color"], label=f"order {order:.2f}")
set_scales(axes, [row["h"] for row in rows], [row["error"] for row in rows])
axes.set(xlabel="h [m]", ylabel="relative error of the added mass")
axes.legend()
save(figure, outputs_of("added-mass.png", None))
