"""Observers of a tank of water at rest: pressures are rho g depth, tables survive a restart and do not
depend on the number of ranks. Usage: check_observers.py SIMULATE MPIEXEC"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

SIMULATE, MPIEXEC = sys.argv[1:3]

SCENE = """<ParameterList name="Scene">
  <Parameter name="Dimension" type="int" value="2"/>
  <ParameterList name="Domain">
    <Parameter name="Upper" type="Array(double)" value="{2, 3}"/>
    <Parameter name="Cells" type="Array(int)" value="{32, 48}"/>
    <ParameterList name="Sides">
      <ParameterList name="y upper">
        <Parameter name="Type" type="string" value="open"/>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="1000"/>
    <Parameter name="Gravity" type="Array(double)" value="{0, -10}"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Type" type="string" value="rigid body"/>
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="0.3"/>
      </ParameterList>
      <Parameter name="Density" type="double" value="1000"/>
      <Parameter name="Position" type="Array(double)" value="{1, 1}"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Observers">
    <ParameterList name="gauges">
      <Parameter name="Type" type="string" value="points"/>
      <Parameter name="Points" type="Array(double)" value="{0.3, 0.51, 1.71, 2.5, 1, 1}"/>
    </ParameterList>
    <ParameterList name="surface flow">
      <Parameter name="Type" type="string" value="flow"/>
      <Parameter name="Lower" type="Array(double)" value="{0, 2.9}"/>
      <Parameter name="Upper" type="Array(double)" value="{2, 2.9}"/>
      <Parameter name="Interval" type="double" value="0.02"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">
    <Parameter name="End" type="double" value="0.04"/>
    <Parameter name="Fixed Step" type="double" value="0.01"/>
  </ParameterList>
  <ParameterList name="Solver">
    <Parameter name="Tolerance" type="double" value="1e-12"/>
  </ParameterList>
  <ParameterList name="Output">
    <Parameter name="Frames" type="bool" value="false"/>
  </ParameterList>
</ParameterList>
"""


# Tank with 1.83 m of water, through which a line stands, and across which one lies.
LEVEL = """    <ParameterList name="Free Surface"> <ParameterList name="Liquid"> <ParameterList name="Pool">
      <Parameter name="Type" type="string" value="level"/> <Parameter name="Height" type="double" value="1.83"/>
    </ParameterList> </ParameterList> </ParameterList>
"""
GAUGES = "".join(f"""    <ParameterList name="{name}">
      <Parameter name="Type" type="string" value="gauge"/>
      <Parameter name="Points" type="Array(double)" value="{ends}"/>
    </ParameterList>
""" for name, ends in (("standing", "{0.4, 0.2, 0.4, 2.9}"), ("slanting", "{0.4, 2.83, 1.6, 0.83}")))
GRAVITY = '<Parameter name="Gravity" type="Array(double)" value="{0, -10}"/>\n'
GAUGED = SCENE.replace(GRAVITY, GRAVITY + LEVEL).replace('  <ParameterList name="Observers">\n', '  <ParameterList name="Observers">\n' + GAUGES)


def run(folder, ranks, *arguments):
    command = [MPIEXEC, "--oversubscribe", "-np", str(ranks)] if ranks > 1 else []
    command += [SIMULATE, str(folder / "scene.xml"), "--quiet", *arguments]
    subprocess.run(command, check=True, timeout=120)


def table(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.xml").write_text(SCENE)
        run(folder, 1, "--output", str(folder / "one"))
        run(folder, 2, "--output", str(folder / "two"))
        run(folder, 1, "--output", str(folder / "again"), "--steps", "2")
        checkpoint = str(sorted((folder / "again").glob("checkpoint-*.h5"))[-1])
        run(folder, 1, "--output", str(folder / "again"), "--restart", checkpoint)

        gauges = table(folder / "one" / "gauges.csv")
        assert len(gauges) == 5 * 3, len(gauges)  # the start and four steps
        for row in gauges[3:]:
            inside = row["point"] == "3"
            assert row["in_fluid"] == ("0" if inside else "1"), row
            depth = 0 if inside else 3 - float(row["y"])
            # Linear between the centres of cells, so exact.
            assert abs(float(row["pressure"]) - 1e4 * depth) < 1e-6, row
            assert abs(float(row["vy"])) < 1e-9, row
        flow = table(folder / "one" / "surface flow.csv")
        assert [row["step"] for row in flow] == ["0", "2", "4"], flow
        assert abs(float(flow[-1]["open_area"]) - 2) < 1e-12, flow
        for name in ("gauges.csv", "surface flow.csv"):
            text = (folder / "one" / name).read_text()
            assert text == (folder / "again" / name).read_text(), f"{name} differs after a restart"
            for mine, theirs in zip(table(folder / "one" / name), table(folder / "two" / name)):
                for key, value in mine.items():
                    assert abs(float(value) - float(theirs[key])) < 1e-6, (name, key, value, theirs[key])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.xml").write_text(GAUGED)
        for ranks in (1, 2):
            run(folder, ranks, "--output", str(folder / str(ranks)))
            standing, slanting = (table(folder / str(ranks) / f"{gauge}.csv") for gauge in ("standing", "slanting"))
            assert len(standing) == 5, len(standing)
            for row in standing:
                assert abs(float(row["wet_length"]) - 1.63) < 1e-6 and abs(float(row["top"]) - 1.63) < 1e-6, row
            for row in slanting:  # half of it, and its head is wet
                assert abs(float(row["wet_length"]) - 5.44**.5 / 2) < 1e-6, row
                assert abs(float(row["top"]) - 5.44**.5) < 1e-12, row
    print("observers: pressures, restart and ranks agree")


main()
