"""Contents of a run's used-parameters.xml: all parameters, and how its scene wants to be shown."""
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from lockstep_frames import FramesError

FILE = "used-parameters.xml"


def read_parameters(folder):
    """(name with its lists, value, is the default) of all parameters."""
    path = Path(folder) / FILE
    found = []

    def visit(element, above):
        for child in element:
            name = above + child.get("name")
            if child.tag == "ParameterList":
                visit(child, name + "/")
            else:
                found.append((name, child.get("value"), child.get("isDefault") == "true"))
    try:
        visit(ElementTree.parse(path).getroot(), "")
    except ElementTree.ParseError as error:
        raise FramesError(f"{path} is not proper XML: {error}.") from error
    return found


def numbers(text):
    return [float(word) for word in text.strip(" {}").split(",")]


def leading_number(formula):
    """The number that a formula begins with, -9.81 of "-9.81*(1 + sin(t))"; 0 if there is none."""
    number = re.match(r"[\s(]*(-?[\d.]+(?:[eE][-+]?\d+)?)", formula)
    return float(number[1]) if number else 0.


def up_axis(values):
    """Against gravity, by the sizes with which its formulas begin; y if there is none. `values`: of the parameters, by name."""
    gravity = [leading_number(part) for part in re.split(r",(?![^(]*\))", values.get("Fluid/Gravity", "{0, 0, 0}").strip(" {}"))]
    axis = max(range(len(gravity)), key=lambda i: abs(gravity[i]))
    return axis if gravity[axis] < 0 else 1


def view_of(values):
    """The list "View" of a scene, with what it leaves open filled in: to the front, the right and above."""
    up = up_axis(values)
    return {
        "up": up,
        "direction": numbers(values.get("View/Direction", "{0.45, -1, 0.35}" if up == 2 else "{0.45, 0.35, 1}")),
        "centre": numbers(values["View/Center"]) if "View/Center" in values else None,
        "zoom": float(values.get("View/Zoom", 1)),
        "field": values.get("View/Field"),
        "volume": values.get("View/Style") == "volume",
        "time": float(values["View/Time"]) if "View/Time" in values else None,
    }


def read_view(folder):
    """View of a run; of a folder without parameters, that of a scene which says nothing."""
    known = (Path(folder) / FILE).is_file()
    return view_of({name: value for name, value, _ in read_parameters(folder)} if known else {})
