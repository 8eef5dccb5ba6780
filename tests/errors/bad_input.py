"""Cases of bad input: the difference from a good scene, and the words that the message must contain."""
from program import SCENE


class Case:
    """A difference from the good scene, and the words that the message must contain."""

    def __init__(self, name, expected, change=(), sets=(), arguments=(), files=(), scene=None):
        self.name, self.expected = name, [expected] if isinstance(expected, str) else expected
        self.arguments = [*arguments]
        for assignment in sets:
            self.arguments += ["--set", assignment]
        self.files = dict(files)
        self.scene = scene if scene is not None else SCENE
        for old, new in change if isinstance(change, list) else [change] if change else []:
            assert self.scene.count(old) == 1, f"{name}: {old!r} must occur once"
            self.scene = self.scene.replace(old, new)


def value(name, type_name, text):
    return f'<Parameter name="{name}" type="{type_name}" value="{text}"/>'


SHAPE = value("Shape", "string", "ball")
RADIUS = value("Radius", "double", "0.3")
GEOMETRY = f"{SHAPE}\n        {RADIUS}"
DENSITY = value("Density", "double", "500")
FLUID_DENSITY = value("Density", "double", "1000")
DIMENSION = value("Dimension", "int", "2")
CELLS = value("Cells", "Array(int)", "{12, 24}")
SIDE = value("Type", "string", "wall")
END = value("End", "double", "0.5")
BODY_TYPE = value("Type", "string", "rigid body")
POSITION = value("Position", "Array(double)", "{0.5, 0.5}")
INFLOW = value("Type", "string", "inflow") + value("Velocity", "Array(double)", "{1, 0}")
UPPER = value("Upper", "Array(double)", "{1, 2}")
FAR_CORNERS = value("Lower", "Array(double)", "{1e15, 0}") + value("Upper", "Array(double)", "{1000000000000001, 2}")
NAME = '<ParameterList name="Ball">'
BALL = SCENE[SCENE.index(NAME):SCENE.index("    </ParameterList>\n  </ParameterList>\n  <ParameterList name=\"Time\"")]
TWO_BALLS = (BALL.replace(NAME, '<ParameterList name="B 1">') + "</ParameterList>\n" +
             BALL.replace(NAME, '<ParameterList name="B_1">').replace("{0.5, 0.5}", "{0.5, 1.5}"))
# A block from wall to wall that slides along the tank.
BLOCK = value("Shape", "string", "box") + value("Size", "Array(double)", "{1.2, 0.4}")
SLIDING = """<ParameterList name="Motion"> <Parameter name="Type" type="string" value="sinusoid"/>
  <Parameter name="Amplitude" type="Array(double)" value="{0, 0.1}"/>
  <Parameter name="Frequency" type="double" value="1"/> </ParameterList>"""
SCENE_3D = (SCENE.replace(DIMENSION, value("Dimension", "int", "3"))
            .replace("{1, 2}", "{1, 2, 1}").replace("{12, 24}", "{6, 12, 6}")
            .replace("{0, -9.8}", "{0, -9.8, 0}").replace("{0.5, 0.5}", "{0.3, 0.3, 0.3}"))

SOFT_SCENE_3D = (SCENE_3D.replace(BODY_TYPE, value("Type", "string", "deformable body"))
                 .replace(DENSITY, DENSITY + '<ParameterList name="Material">' +
                          value("Young's Modulus", "double", "1e4") + "</ParameterList>"))
