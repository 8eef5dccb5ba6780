"""Bad input: each case ends with exit code 2, its own message, and nothing written."""
import concurrent.futures
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import bad_meshes
import bad_water
from bad_input import (BALL, BLOCK, BODY_TYPE, CELLS, DENSITY, DIMENSION, END, FAR_CORNERS, FLUID_DENSITY, GEOMETRY,
                       INFLOW, NAME, POSITION, RADIUS, SCENE_3D, SHAPE, SIDE, SLIDING, TWO_BALLS, UPPER, Case, value)
from program import SCENE, SIMULATE, simulate


def joint(kind, solids, more="", second=""):
    """A scene with a joint, and a second solid if it is given."""
    text = f"""<ParameterList name="Joints">
    <ParameterList name="Neck">
      <Parameter name="Type" type="string" value="{kind}"/>
      <Parameter name="Solids" type="Array(string)" value="{{{solids}}}"/>
      <Parameter name="Point" type="Array(double)" value="{{0.5, 0.5}}"/>
      {more}
    </ParameterList>
  </ParameterList>
  <ParameterList name="Solids">{second}"""
    return {"change": ('<ParameterList name="Solids">', text)}


def limits(bounds):
    return f'<ParameterList name="Limits">{bounds}</ParameterList>'


BONE = """<ParameterList name="Bone">
      <Parameter name="Type" type="string" value="rigid body"/>
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="0.1"/>
      </ParameterList>
      <Parameter name="Density" type="double" value="500"/>
      <Parameter name="Position" type="Array(double)" value="{0.5, 1.5}"/>
      MORE
    </ParameterList>"""
STATIC = '<ParameterList name="Motion"><Parameter name="Type" type="string" value="static"/></ParameterList>'
LOCKED = '<Parameter name="Locked" type="Array(string)" value="{x}"/>'
WINDOW = """  <ParameterList name="Observers">
    <ParameterList name="through">
      <Parameter name="Type" type="string" value="flow"/>
      <Parameter name="Lower" type="Array(double)" value="{1.5, 0}"/>
      <Parameter name="Upper" type="Array(double)" value="{1.5, 2}"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">"""

SPINDLE = value("Shape", "string", "spindle") + value("Sections", "Array(double)", "{-0.2, 0.1, 0.1, 0, 0.2, 0.2, 0.2}")


def source(shape, sizes):
    """A scene with a source of momentum."""
    return {"change": (FLUID_DENSITY, f'''{FLUID_DENSITY}<ParameterList name="Sources"><ParameterList name="Jet">
      {value("Shape", "string", shape)} {sizes} {value("Velocity", "Array(double)", "{1, 0}")}</ParameterList></ParameterList>''')}


def inverse_file(kind, more, where):
    """A solver file whose strategy has this inverse."""
    return {"inverse.xml": f'''<ParameterList name="Strategy"> {value("Type", "string", "schur-cg")}
      <ParameterList name="{where}"> {value("Type", "string", kind)} {more} </ParameterList> </ParameterList>'''}


MINRES_TEKO = (Path(__file__).resolve().parents[2] / "xml-params/solvers/minres-teko.xml").read_text()

CASES = [
    # The command line.
    Case("no such option", "--ouput", arguments=["--ouput", "here"]),
    Case("a view from nowhere", ["\"View\"", "\"Direction\" is zero"], sets=["View/Direction={0, 0, 0}"], scene=SCENE_3D),
    Case("a view of two numbers", ["\"Direction\"", "needs 3"], sets=["View/Direction={0, 1}"], scene=SCENE_3D),
    Case("number of steps", "--steps", arguments=["--steps", "many"]),
    *[Case(f"{n} steps", ["--steps", "whole number from 1"], arguments=[f"--steps={n}"])
      for n in ("-3", "0", "99999999999999999999", "1.5")],
    Case("a joint to nothing", ["\"Neck\"", "\"Bal\"", "did you mean \"Ball\""], **joint("hinge", "space, Bal")),
    Case("a joint of 3D", ["\"ball\"", "hinge", "slider", "weld"], **joint("ball", "space, Ball")),
    Case("a joint that nothing moves", ["\"Neck\"", "two prescribed solids"],
         **joint("hinge", "space, Bone", second=BONE.replace("MORE", STATIC))),
    Case("a joint to a locked body", ["\"Bone\" is jointed", "\"Locked\"", "space"],
         **joint("hinge", "Ball, Bone", second=BONE.replace("MORE", LOCKED))),
    Case("a joint of one body", ["\"Neck\"", "with itself"], **joint("weld", "Ball, Ball")),
    Case("a spring with two gains", ["\"Neck\" has both \"Natural Frequency\" and \"Stiffness\"", "leave out one"],
         **joint("hinge", "space, Ball", value("Control", "string", "proportional derivative") +
                 value("Natural Frequency", "double", 3) + value("Stiffness", "double", 3))),
    Case("a spring without gain", ["\"Neck\"", "has no \"Natural Frequency\"", "\"Stiffness\""],
         **joint("hinge", "space, Ball", value("Control", "string", "proportional derivative"))),
    *[Case(f"{parameter} that nothing uses", ["\"Neck\" has", f"\"{parameter}\"", f"\"{control}\" control", "does not use"],
           **joint("hinge", "space, Ball", value("Control", "string", control) + value(parameter, "double", 3) + more))
      for parameter, control, more in (
          ("Stiffness", "free", ""), ("Natural Frequency", "free", ""), ("Damping", "free", ""),
          ("Largest Torque", "prescribed", ""), ("Damping Ratio", "prescribed", ""),
          ("Largest Torque", "prescribed rate", value("Natural Frequency", "double", 3)),
          ("Damping", "proportional derivative", value("Natural Frequency", "double", 3)),
          ("Damping Ratio", "proportional derivative", value("Stiffness", "double", 3)))],
    Case("a target of a free joint", ["\"Neck\" has \"Target\"", "\"Control\""],
         **joint("hinge", "space, Ball", '<ParameterList name="Target">' + value("Value", "double", 1) + "</ParameterList>")),
    Case("a limit above another", ["\"Neck\"", "lower limit 0.5 above its upper limit -0.5"],
         **joint("hinge", "space, Ball", limits(value("Lower", "double", .5) + value("Upper", "double", -.5)))),
    Case("a limit beyond the start", ["\"Neck\" starts at 0", "above its upper limit -0.5"],
         **joint("hinge", "space, Ball", limits(value("Upper", "double", -.5)))),
    Case("limits of a motor", ["\"Neck\" is under \"prescribed\" control", "leave out its limits"],
         **joint("hinge", "space, Ball", limits(value("Upper", "double", .5)) + value("Control", "string", "prescribed"))),
    Case("limits without contact", ["\"Neck\" has limits", "\"Contact/Type\" must not be \"none\""],
         sets=["Contact/Type=none"], **joint("hinge", "space, Ball", limits(value("Upper", "double", .5)))),
    Case("joints and the paper's masses", ["\"paper diagonal\"", "cannot be combined with joints"],
         sets=["Coupling/Type=mixed face", "Coupling/Lumping=paper diagonal"], **joint("hinge", "space, Ball")),
    Case("a slider without axis", "\"Axis\"", **joint("slider", "space, Ball")),
    Case("another dimension", ["--set", "2 dimensions"], sets=["Dimension=3"]),
    Case("--set without value", "--set \"Time/End\"", sets=["Time/End"]),
    Case("--set of a list that is not there", ["--set", "\"Tim\"", "Did you mean \"Time\""], sets=["Tim/End=1"]),
    Case("--set of an unknown name", ["\"Ned\"", "Did you mean \"End\""], sets=["Time/Ned=1"]),
    Case("--set of a former name", ["in \"Contact\", \"Slop\" is always 0.05 cells now"], sets=["Contact/Slop=0.1"]),
    Case("--set of a renamed one", ["in \"Solver\", \"Viscous Tolerance\" is called \"Tolerance\" now", "\"Viscous Solve\""],
         sets=["Solver/Viscous Tolerance=1e-9"]),
    Case("--set of a wrong type", ["--set \"Time/End=soon\"", "not a number"], sets=["Time/End=soon"]),
    Case("--set out of bounds", ["--set", "greater than 0"], sets=["Time/CFL=-1"]),
    Case("--set of a whole list", "is a list", sets=["Time=1"]),
    Case("a restart from nothing", ["none.h5", "does not exist"], arguments=["--restart", "none.h5"]),
    Case("a restart from another file", ["scene.xml", "is not a checkpoint"], arguments=["--restart", "scene.xml"]),
    Case("a restart from no name", "--restart names no file", arguments=["--restart", ""]),
    Case("an output folder without a name", "--output names no folder", arguments=["--output", ""]),
    Case("a restart from a pipe", ["pipe.h5", "pipe, not a file"], arguments=["--restart", "pipe.h5"]),
    Case("a solver file that is a pipe", ["pipe.h5", "pipe, not a file"], sets=["Solver/File=pipe.h5"]),
    Case("a solver file that is a device", ["/dev/zero", "device, not a file"], sets=["Solver/File=/dev/zero"]),
    Case("an end before the start", ["--end-time", "later than the start"], arguments=["--end-time", "-1"]),
    Case("an output folder that is a file", "scene.xml", arguments=["--output", "scene.xml"]),

    # The file as XML.
    Case("not closed", ["scene.xml, line", "not well-formed"], change=("</ParameterList>\n</ParameterList>\n", "")),
    Case("empty", "is empty", scene=""),
    Case("another element", ["<Parametr>", "Did you mean <Parameter>?"],
         change=(END, '<Parametr name="End" type="double" value="0.5"/>')),
    Case("another attribute", ["\"vale\"", "Did you mean \"value\"?"],
         change=(END, '<Parameter name="End" type="double" vale="0.5"/>')),
    Case("a name of ten megabytes", ["has 10000000 characters", "line"],
         change=(END, END + value("x" * 10 ** 7, "double", "1"))),
    Case("a list with a name of ten megabytes", ["has 10000000 characters", "line"],
         change=(NAME, f'<ParameterList name="{"x" * 10 ** 7}">')),
    Case("a name twice", ["\"End\" is given twice", "line"], change=(END, END + "\n" + END)),
    Case("text between elements", "stands between the elements", change=(END, END + " later")),
    Case("an unknown type", "unknown type \"float\"", change=(END, value("End", "float", "0.5"))),

    # Values.
    Case("not a number", ["line", "\"End\" is \"abc\", which is not a number"],
         change=(END, value("End", "double", "abc"))),
    Case("a long word", ["\"End\" is \"" + 60 * "9" + "...\""],
         change=(END, value("End", "double", 100000 * "9" + "x"))),
    Case("a long array", "...", change=(CELLS, value("Cells", "Array(int)", "{" + 5000 * "1," + "1}"))),
    Case("a long setting", "...", sets=["Time/End=" + 100000 * "x"]),
    Case("a long name", "...", change=(END, END + value(100000 * "x", "double", "1"))),
    Case("not an integer", "\"1e3\", which is not an integer", change=(END, END + value("Steps", "int", "1e3"))),
    Case("nan", "must be finite", change=(END, value("End", "double", "nan"))),
    Case("infinity", "must be finite", change=(END, value("End", "double", "inf"))),
    Case("a decimal comma", "the decimal mark is a point", change=(END, value("End", "double", "0,5"))),
    Case("a broken array", "component 2", change=(CELLS, value("Cells", "Array(int)", "{12, x}"))),
    Case("a wrong type", ["\"End\"", "has type \"int\", but needs \"double\""],
         change=(END, value("End", "int", "1"))),
    Case("too few components", ["\"Cells\"", "needs 2"], change=(CELLS, value("Cells", "Array(int)", "{12}"))),
    Case("not a bool", "a bool is true or false", change=(END, END + value("x", "bool", "maybe"))),
    Case("out of bounds", ["\"Density\" is -1", "greater than 0"],
         change=(FLUID_DENSITY, value("Density", "double", "-1"))),

    # Names.
    Case("a misspelt parameter", ["line", "in \"Fluid\"", "Did you mean \"Density\""],
         change=(FLUID_DENSITY, value("Densty", "double", "1000"))),
    Case("a misspelt list", "Did you mean \"Fluid\"",
         change=('<ParameterList name="Fluid">', '<ParameterList name="Fliud">')),
    Case("an unknown plug-in", ["\"Type\" is \"rigid boby\"", "did you mean \"rigid body\""],
         change=(BODY_TYPE, value("Type", "string", "rigid boby"))),
    Case("an unknown fluid", "\"lattice boltzmann\"", sets=["Fluid/Type=lattice boltzmann"]),
    Case("an unknown strategy", ["\"schur\"", "one of"], sets=["Solver/Strategy/Type=schur"]),
    *[Case(f"{name} of {number}", ["--set", f"is {number}, but must be greater than 0 and less than 1"],
           sets=[f"Solver/{name}={number}"])
      for name in ("Tolerance", "Viscous Solve/Tolerance", "Strategy/Tolerance") for number in ("0", "1", "1e30")],
    *[Case(f"an inverse with {name} {number}", [expected],
           sets=["Solver/File=inverse.xml"], files=inverse_file(kind, value(name, of, number), where))
      for where, kind, name, of, number, expected in (
          ("Solid Inverse", "Conjugate Gradients", "Tolerance", "double", "-1", '"Tolerance" is -1, but must be'),
          ("Solid Inverse", "Conjugate Gradients", "Maximum Iterations", "int", "0", '"Maximum Iterations" is 0, but must be'),
          ("Solid Inverse", "Block Diagonal", "Largest Block", "int", "-7", '"Largest Block" is -7, but must be'),
          ("Pressure Inverse", "Multigrid", "Sweeps", "int", "2000000000", '"Sweeps" (int, from 1 to 100)'),
          ("Pressure Inverse", "Ifpack2", "Prec Type", "string", "RILUKK", '"Prec Type" is "RILUKK"'))],
    *[Case(f"a misspelt inverse {kind}", expected, sets=["Solver/File=inverse.xml"], files=inverse_file(kind, "", where))
      for where, kind, expected in (
          ("Pressure Inverse", "Mutligrid", ["Did you mean \"Multigrid\"", "There are: Automatic, Multigrid, Ifpack2"]),
          ("Solid Inverse", "Automtic", ["Did you mean \"Automatic\""]))],
    *[Case(f"the strategy {name}, which is a list now", [f'no strategy "{name}" any more', f"xml-params/solvers/{file}.xml"],
           sets=["Solver/File=old.xml"],
           files={"old.xml": f'<ParameterList name="Solver">{value("Type", "string", name)}</ParameterList>'})
      for name, file in (("gauss-seidel", "gauss-seidel"), ("solid-schur", "minres-teko"))],
    Case("a strategy that is a list now, by --set", ['no strategy "gauss-seidel" any more', "xml-params/solvers/gauss-seidel.xml"],
         sets=["Solver/Strategy/Type=gauss-seidel", "Solver/Strategy/Tolerance=1e-9"]),
    Case("a strategy that is a list now, in the scene", ['no strategy "uzawa" any more', "xml-params/solvers/uzawa.xml"],
         files={"old.xml": f'<ParameterList name="Scene"><ParameterList name="Solver"><ParameterList name="Strategy">{value("Type", "string", "uzawa")}</ParameterList></ParameterList></ParameterList>'},
         sets=["Include=old.xml", "Solver/Strategy/Tolerance=1e-9"]),
    *[Case(f"a list of Stratimikos with {what}", expected, sets=["Solver/File=list.xml"], files={"list.xml": MINRES_TEKO.replace(*change)})
      for what, change, expected in (
          ("a misspelt key of Teko", ("Fluid Inverse Type", "Fluid Inverse Tipe"), '"Fluid Inverse Tipe" is not a parameter of "SPD Block Diagonal"'),
          ("a solver that Belos has not", ('"MINRES"', '"MINRESS"'), "MINRESS"),
          ("a package that is no Belos", ('value="Belos"', 'value="Amesos2"'), '"Linear Solver Type" is "Amesos2"'),
          ("an inverse that is not there", ('value="Schur"', 'value="Schurr"'), "Schurr"))],
    Case("a solver file that is not there", ["none.xml", "Cannot read"], sets=["Solver/File=none.xml"]),
    Case("a decimal comma in a formula", ["line", "\"1000*0,5\" is 2 numbers"],
         change=(DENSITY, value("Density", "double", "[1000*0,5]"))),
    Case("a number that no double can hold in a formula", ["cannot evaluate \"500*1e999\"", "1e999"],
         change=(DENSITY, value("Density", "double", "[500*1e999]"))),
    Case("a plug-in of a library that is not loaded", ["\"Type\" is \"my-body\"", "--plug-in FILE"],
         change=(BODY_TYPE, BODY_TYPE.replace("rigid body", "my-body"))),
    Case("no plug-in", "\"Type\"", change=(BODY_TYPE, "")),
    Case("no dimension", ["\"Dimension\"", "required"], change=(DIMENSION, "")),
    Case("one dimension", ["\"Dimension\" is 1", "2 or 3"], change=(DIMENSION, value("Dimension", "int", "1"))),

    # The domain.
    Case("cells that are not squares", "the cells must be as long along every axis", sets=["Domain/Cells={12, 12}"]),
    Case("no cells", "at least 1", sets=["Domain/Cells={0, 24}"]),
    Case("corners the wrong way round", "above the lower one", sets=["Domain/Upper={-1, 2}"]),
    Case("one periodic side", "only one of \"x lower\" and \"x upper\" is periodic",
         change=(SIDE, value("Type", "string", "periodic"))),
    Case("an unknown side", ["\"weir\"", "one of"], change=(SIDE, value("Type", "string", "weir"))),
    Case("a wall that leaves", "would leave the domain",
         change=(SIDE, SIDE + value("Velocity", "Array(double)", "{1, 0}"))),
    Case("an inward-blowing open side", "has no meaning on a side of type \"open\"",
         change=(SIDE, value("Type", "string", "open") + value("Velocity", "Array(double)", "{1, 0}"))),
    *[Case(f"{parameter} of an open side", f"\"{parameter}\" has no meaning on a side of type \"open\"",
           change=(SIDE, value("Type", "string", "open") + value(parameter, "double", "1")))
      for parameter in ("Smoke", "Temperature")],
    Case("pressure of a wall", "\"Pressure\" has no meaning on a side of type \"wall\"",
         change=(SIDE, SIDE + value("Pressure", "double", "1"))),
    Case("a wall that leaves by a formula", "would leave the domain",
         change=(SIDE, SIDE + value("Velocity", "Array(double)", "{[sin(t)], 0}"))),
    *[Case(f"{parameter} of a side", f"\"{parameter}\" is gone: \"Velocity\" may be a formula",
           change=(SIDE, INFLOW + value(parameter, kind, text)))
      for parameter, kind, text in (("Ramp Time", "double", "1"), ("End", "double", "1"), ("Profile", "string", "parabolic"))],
    Case("bad formulas of a side", ["There are 2 mistakes", "line ", "\"Velocity\": cannot evaluate \"(6*Y*(1 - y))\"", "Did you mean \"y\"",
                                    "\"Temperature\": cannot evaluate \"((sin(t)\""],
         change=(SIDE, value("Type", "string", "inflow") + value("Velocity", "Array(double)", "{[6*Y*(1 - y)], 0}") + value("Temperature", "double", "[(sin(t]"))),
    Case("a warm inflow of a fluid without temperature", ["x lower", "the fluid carries none", "\"Fluid/Temperature\""],
         change=(SIDE, INFLOW + value("Temperature", "double", "300"))),
    Case("an end before the start of the file", "must be later", change=(END, value("End", "double", "-1"))),

    # The fluid.
    Case("warm fluid without temperature", "has no temperature", sets=["Fluid/Thermal Expansion=0.1"]),
    Case("heavy smoke without smoke", "carries no smoke", sets=["Fluid/Smoke Weight=0.1"]),

    Case("a source in a box the wrong way round", ["\"Sources/Jet\"", "\"Upper\" must not be below \"Lower\""],
         **source("box", value("Lower", "Array(double)", "{0.6, 0}") + value("Upper", "Array(double)", "{0.4, 1}"))),
    Case("a ball with corners", ["\"Sources/Jet\"", "the shape \"ball\" has no \"Lower\""],
         **source("ball", value("Lower", "Array(double)", "{0.2, 0}") + value("Upper", "Array(double)", "{0.4, 1}"))),
    Case("a source outside of the domain", ["\"Jet\"", "outside of the domain"],
         **source("box", value("Lower", "Array(double)", "{1.2, 0}") + value("Upper", "Array(double)", "{1.4, 1}"))),
    Case("a box with a radius", "the shape \"box\" has no \"Radius\"", **source("box", value("Radius", "double", 1))),

    # The bodies.
    Case("a swing of nothing", ["\"Ball/Motion\"", "moves nothing", "\"static\""],
         change=(DENSITY, DENSITY + SLIDING.replace("{0, 0.1}", "{0, 0}"))),
    Case("a table of nothing", ["\"Ball/Motion\"", "moves nothing", "\"Displacements\""],
         change=(DENSITY, DENSITY + '<ParameterList name="Motion">' + value("Type", "string", "table") +
                 value("Times", "Array(double)", "{0, 1}") + "</ParameterList>")),
    Case("a lock on a lock", ["\"Ball\"", "\"x\" twice in \"Locked\""],
         change=(DENSITY, DENSITY + value("Locked", "Array(string)", "{x, y, x}"))),
    Case("a body in millimetres", ["\"Ball/Geometry\"", "300 m long, in a domain of 2 m", "elements"], scene=SCENE_3D,
         change=(RADIUS, value("Radius", "double", "150"))),
    Case("a body of a thousand domains", ["\"Ball/Geometry\"", "6000 m long, in a domain of 2 m", "metres"],
         change=(RADIUS, value("Radius", "double", "3000"))),
    Case("a mesh of too many elements", ["\"Ball/Geometry\"", "elements"], scene=SCENE_3D,
         change=(RADIUS, RADIUS + value("Mesh Spacing", "double", "1e-4"))),
    Case("a flat spindle with widths", ["\"Sections\"", "has 7 numbers; it takes 2"],
         change=[(BODY_TYPE, value("Type", "string", "deformable body")), (GEOMETRY, SPINDLE),
                 (DENSITY, DENSITY + '<ParameterList name="Material">' + value("Young's Modulus", "double", "1e4") + "</ParameterList>")]),
    Case("a body without mass", ["\"Ball\"", "no mass"], change=(DENSITY, "")),
    Case("a body with two masses", "leave out one", change=(DENSITY, DENSITY + value("Mass", "double", "1"))),
    Case("a volume with a surface density", "has no \"Surface Density\"",
         change=(DENSITY, value("Surface Density", "double", "1"))),
    Case("a volume with a thickness", ["\"Ball\"", "has no \"Thickness\""],
         change=(DENSITY, DENSITY + value("Thickness", "double", "1"))),
    Case("a negative radius", ["\"Radius\" is -0.3", "greater than 0"],
         change=(RADIUS, value("Radius", "double", "-0.3"))),
    Case("a ball without radius", "needs \"Radius\"", change=(RADIUS, "")),
    Case("a ball with a length", "has no \"Length\"", change=(RADIUS, RADIUS + value("Length", "double", "1"))),
    Case("a shape nobody knows", "did you mean \"ball\"", change=(SHAPE, value("Shape", "string", "bal"))),
    Case("a locked dof that is not there", ["\"z\"", "one of"],
         change=(POSITION, POSITION + value("Locked", "Array(string)", "{z}"))),
    Case("a locked dof that moves", "starts with a velocity",
         change=(POSITION, POSITION + value("Locked", "Array(string)", "{x}") +
                 value("Velocity", "Array(double)", "{1, 0}"))),

    # Observers.
    Case("a window beside the fluid", ["the window of a flow lies outside of the fluid", "along x it reaches from 1.5 to 1.5 m"],
         change=('  <ParameterList name="Time">', WINDOW)),

    # Impossible scenes.
    Case("an inflow into a closed tank", ["At the start", "inflow \"x lower\" pushes in", "closed in"],
         change=(SIDE, INFLOW)),
    Case("a piston in a closed tank", "solid \"Ball\" ",
         change=[(GEOMETRY, BLOCK), (DENSITY, SLIDING), (POSITION, value("Position", "Array(double)", "{0.5, 1}"))]),

    # Limits.
    Case("more cells than memory", ["\"Cells\"", "GB"], change=(CELLS, value("Cells", "Array(int)", "{500000, 1000000}"))),
    Case("a body of too many elements", ["Ball/Geometry", "elements"],
         change=(RADIUS, value("Radius", "double", "3e9"))),
    Case("a corner too far away", ["\"Domain\"", "origin"], change=(UPPER, FAR_CORNERS)),
    Case("a start too late", ["\"Start\"", "nearer to 0"],
         change=(END, value("Start", "double", "1e300") + value("End", "double", "2e300"))),
    Case("too many nested lists", ["scene.xml, line", "nested more than"],
         scene="<ParameterList name=\"a\">\n" * 100000 + "</ParameterList>\n" * 100000),
    Case("a solid without a letter", ["\".\"", "cannot be stored"], change=(NAME, '<ParameterList name=".">')),
    Case("a solid in two lines", ["line break", "one line"], change=(NAME, '<ParameterList name="Ball&#10;2">')),
    Case("two solids stored as one", ["\"B 1\"", "\"B_1\"", "another"], change=(BALL, TWO_BALLS)),
]


def run(case):
    """Returns the reason why the program did not behave as the case wants; empty if it did."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in case.files.items():
            (Path(folder) / name).write_text(text)
        pipes = {"pipe.h5", "pipe.obj", "pipe.vtk"}
        for name in pipes:
            os.mkfifo(Path(folder) / name)
        before = {*case.files, "scene.xml", *pipes}
        arguments = [str(Path(folder) / a) if a in ("scene.xml", "none.h5", "pipe.h5") else a
                     for a in case.arguments]
        result = simulate(folder, *arguments, scene=case.scene)
        failures = []
        if result.returncode != 2:
            failures.append(f"exit code {result.returncode} instead of 2")
        failures += [f"no {text!r} in the message" for text in case.expected if text not in result.stderr]
        if len(result.stderr) > 2000:
            failures.append(f"a message of {len(result.stderr)} characters")
        if result.stderr.count("lockstep: ") != 1:
            failures.append("the message must come once")
        created = {path.name for path in Path(folder).iterdir()} - before
        if created:
            failures.append(f"{sorted(created)} was written")
        if failures:
            failures.append(f"\n{result.stderr}")
        return f"{case.name}: {'; '.join(failures)}" if failures else ""


class BadInput(unittest.TestCase):
    maxDiff = None

    def test_good_scene(self):
        for scene in (SCENE, SCENE_3D):
            with tempfile.TemporaryDirectory() as folder:
                result = simulate(folder, "--validate", scene=scene)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertFalse((Path(folder) / "output").exists(), "--validate must not write")

    def test_cases(self):
        cases = CASES + bad_meshes.CASES + bad_water.CASES
        self.assertGreaterEqual(len(cases), 30)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            failures = [failure for failure in pool.map(run, cases) if failure]
        self.assertFalse(failures, "\n".join(failures))

    def test_links_lead_nowhere(self):
        """Links in the way stay as they are, and so does what they point to."""
        for name, code in [("frames", 2), ("frames.h5.part", 4), ("history.csv.part", 4), ("input.xml.part", 4)]:
            with self.subTest(name=name), tempfile.TemporaryDirectory() as folder:
                output, elsewhere = Path(folder) / "output", Path(folder) / "elsewhere"
                output.mkdir()
                if name == "frames":
                    elsewhere.mkdir()
                    (elsewhere / "frame-000000.h5").write_text("precious")
                else:
                    elsewhere.write_text("precious")
                (output / name).symlink_to(elsewhere)
                result = simulate(folder, "--steps", 1)
                self.assertEqual(result.returncode, code, result.stderr)
                self.assertIn(name, result.stderr)
                kept = elsewhere / "frame-000000.h5" if name == "frames" else elsewhere
                self.assertEqual(kept.read_text(), "precious")
                self.assertTrue((output / name).is_symlink())

    def test_a_scene_that_is_a_pipe(self):
        with tempfile.TemporaryDirectory() as folder:
            pipe = Path(folder) / "scene.xml"
            os.mkfifo(pipe)
            result = subprocess.run([SIMULATE, str(pipe)], stderr=subprocess.PIPE, text=True, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("pipe, not a file", result.stderr)

    def test_two_ranks_say_it_once(self):
        with tempfile.TemporaryDirectory() as folder:
            result = simulate(folder, scene=SCENE.replace(DENSITY, ""), ranks=2)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("has no mass"), 1, result.stderr)
            self.assertFalse((Path(folder) / "output").exists())


if __name__ == "__main__":
    if not Path(SIMULATE).exists():
        raise SystemExit(f"{SIMULATE} is missing; set LOCKSTEP_SIMULATE to the program to test.")
    unittest.main()
