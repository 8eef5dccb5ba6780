"""Runs `simulate` on a small scene that tests bend to their needs."""
import os
import subprocess
import zlib
from pathlib import Path

SIMULATE = os.environ.get("LOCKSTEP_SIMULATE", "build/release/drivers/simulate")
SOLVE = os.environ.get("LOCKSTEP_SOLVE", "build/release/drivers/solve")
CONVERGE = os.environ.get("LOCKSTEP_CONVERGE", "build/release/drivers/converge")
MPIEXEC = os.environ.get("LOCKSTEP_MPIEXEC", "mpirun")

SCENE = """<ParameterList name="Scene">
  <Parameter name="Dimension" type="int" value="2"/>
  <ParameterList name="Domain">
    <Parameter name="Upper" type="Array(double)" value="{1, 2}"/>
    <Parameter name="Cells" type="Array(int)" value="{12, 24}"/>
    <ParameterList name="Sides">
      <ParameterList name="x lower">
        <Parameter name="Type" type="string" value="wall"/>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="1000"/>
    <Parameter name="Viscosity" type="double" value="0.5"/>
    <Parameter name="Order in Time" type="int" value="2"/>
    <Parameter name="Gravity" type="Array(double)" value="{0, -9.8}"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Type" type="string" value="rigid body"/>
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="0.3"/>
      </ParameterList>
      <Parameter name="Density" type="double" value="500"/>
      <Parameter name="Position" type="Array(double)" value="{0.5, 0.5}"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">
    <Parameter name="End" type="double" value="0.5"/>
    <Parameter name="Fixed Step" type="double" value="0.01"/>
  </ParameterList>
</ParameterList>
"""


def command(folder, *arguments, ranks=1):
    """Scene folder/scene.xml, output in folder/output, unless the arguments say otherwise."""
    start = [SIMULATE] if ranks == 1 else [MPIEXEC, "--oversubscribe", "-np", str(ranks), SIMULATE]
    given = list(arguments)
    if not any(str(argument).startswith("--output") for argument in given):
        given += ["--output", str(Path(folder) / "output")]
    return [*start, str(Path(folder) / "scene.xml"), *map(str, given)]


def simulate(folder, *arguments, scene=SCENE, ranks=1):
    """Runs to the end; stdout and stderr are kept apart."""
    (Path(folder) / "scene.xml").write_text(scene)
    return subprocess.run(command(folder, *arguments, ranks=ranks), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=600)


def with_checksum(content):
    """The line that the programs put at the end of their HDF5 files."""
    return content + f"\nLockstep CRC-32 {zlib.crc32(content):08x} of {len(content):020} bytes\n".encode()


def without_checksum(content):
    return content[:len(content) - (len(with_checksum(b"")))]
