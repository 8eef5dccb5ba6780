"""Completes the folder of make_frames.py to what a run leaves: parameters, tables and a summary with round numbers."""
import json
import sys
from pathlib import Path

import make_frames

N_STEPS = 5  # steps of 0.1 s


def parameters(title, cells, view=""):
    dim = len(cells)
    lower = [str(x) for x in make_frames.ORIGIN[:2] + make_frames.ORIGIN[2:] * (dim == 3)]
    upper = [str(make_frames.ORIGIN[axis] + n * make_frames.H) for axis, n in enumerate(cells)]
    array = "{{{}}}".format
    return f"""<ParameterList name="{title}.xml">
  <Parameter name="Dimension" type="int" value="{dim}"/>
  <Parameter name="Title" type="string" value="{title}"/>
  <ParameterList name="Domain">
    <Parameter name="Lower" type="Array(double)" value="{array(', '.join(lower))}"/>
    <Parameter name="Upper" type="Array(double)" value="{array(', '.join(upper))}"/>
    <Parameter name="Cells" type="Array(int)" value="{array(', '.join(map(str, cells)))}"/>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="1" isDefault="true"/>
    <Parameter name="Gravity" type="Array(double)" value="{array(', '.join(['0', '-9.8', '0'][:dim]))}"/>
  </ParameterList>
{view}</ParameterList>
"""


def history():
    """Kinetic energy t squared; the iterations of S2 are the number of the step."""
    lines = ["# step [1]: number", "# time [s]: at the end", "# dt [s]: length", "# s2_iterations [1]: of S2",
             "# fluid_kinetic_energy [J]: ", "step,time,dt,s2_iterations,fluid_kinetic_energy"]
    lines += [f"{k},{0.1 * k},0.1,{k},{(0.1 * k) ** 2}" for k in range(1, N_STEPS + 1)]
    return "\n".join(lines) + "\n"


def bodies(dim):
    axes = "xyz"[:dim]
    lines = [f"# {axis} [m]: centre of mass" for axis in axes] + ["step,time,name," + ",".join(axes)]
    for k in range(1, N_STEPS + 1):
        lines.append(f"{k},{0.1 * k},body," + ",".join(str(1.4 + 0.02 * k) for _ in axes))
        lines.append(f"{k},{0.1 * k},other," + ",".join("1.6" for _ in axes))
    return "\n".join(lines) + "\n"


def joints():
    """A hinge that turns by 0.3 a step, and a slider that stands still: their rows alternate."""
    lines = ["# q [rad, m]: the coordinate", "# at_limit [1]: 1 if it is there", "step,time,name,q,at_limit"]
    for k in range(1, N_STEPS + 1):
        lines += [f"{k},{0.1 * k},knee,{0.3 * k},0", f"{k},{0.1 * k},slide,-2,1"]
    return "\n".join(lines) + "\n"


def main(folder, dim, title="a </script> in a title", view=""):
    make_frames.main(folder, dim)
    folder, text = Path(folder), title.replace("<", "&lt;")
    (folder / "used-parameters.xml").write_text(parameters(text, (8, 6, 4)[:dim], view))
    (folder / "input.xml").write_text(f"<!-- the scene of {title} -->\n")
    (folder / "history.csv").write_text(history())
    (folder / "bodies.csv").write_text(bodies(dim))
    (folder / "joints.csv").write_text(joints())
    stages = [{"name": name, "min_seconds": seconds, "mean_seconds": seconds, "max_seconds": seconds, "calls": N_STEPS}
              for name, seconds in (("step", 3.0), ("step / S2", 2.0))]
    (folder / "summary.json").write_text(json.dumps({
        "status": "done", "ranks": 1, "wall_seconds": 3.5, "largest_momentum_error": float("nan"), "stages": stages}))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
