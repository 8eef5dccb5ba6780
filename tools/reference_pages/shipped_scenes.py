"""Uses of plug-ins by the scenes and studies in xml-params/: for tools/update-parameters."""
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def content(element):
    """The lists and values of a ParameterList, by name."""
    return {child.get("name"): content(child) if child.tag == "ParameterList" else child.get("value", "")
            for child in element if child.tag in ("ParameterList", "Parameter")}


def merged(weak, strong):
    """Both; where they differ, what `strong` says."""
    both = dict(weak)
    for name, value in strong.items():
        lists = isinstance(value, dict) and isinstance(both.get(name), dict)
        both[name] = merged(both[name], value) if lists else value
    return both


def read_scene(path):
    """A scene's lists and values, those of what it includes among them."""
    scene = content(ElementTree.parse(path).getroot())
    for name in re.findall(r"[^\s{},]+", scene.get("Include", "")):
        scene = merged(read_scene(path.parent / name), scene)
    return scene


def sublists(scene, name):
    return [value for value in scene.get(name, {}).values() if isinstance(value, dict)]


def strategy_of(scene, folder, default):
    solver = scene.get("Solver", {})
    if "Type" in solver.get("Strategy", {}):
        return solver["Strategy"]["Type"]
    if "File" in solver:
        return content(ElementTree.parse(folder / solver["File"]).getroot()).get("Type", default)
    return default


def plug_ins_of(path, defaults):
    """The (list, type) of all plug-ins of a scene. `defaults`: the type of a list that names none."""
    scene = read_scene(path)

    def one(place):
        return place, scene.get(place, {}).get("Type", defaults[place])
    used = {one(place) for place in ("Fluid", "Coupling", "Contact")}
    used |= {(place, entry["Type"]) for place in ("Joints", "Observers") for entry in sublists(scene, place)}
    used |= {("Solids", entry.get("Type", scene.get("Defaults", {}).get("Type"))) for entry in sublists(scene, "Solids")}
    used.add(("Solver/Strategy", strategy_of(scene, path.parent, defaults["Solver/Strategy"])))
    if "Joints" in scene:
        used.add(one("Articulation"))
    surface = scene.get("Fluid", {}).get("Free Surface")
    if surface is not None:
        used.add(("Free Surface/Interface", surface.get("Interface", {}).get("Type", defaults["Free Surface/Interface"])))
    return used


def assigned_types(text, places):
    """The (list, type) that a study sets, as in Coupling/Type=flux."""
    pairs = {(place, kind.strip()) for place, kind in re.findall(r"([\w /]+)/Type=([\w -]+)", text)}
    return {(place, kind) for path, kind in pairs for place in places if path.strip().endswith(place)}


def uses(defaults):
    """(list, type) -> the scenes, and the studies, that use it; and how many scenes there are."""
    scenes = sorted((ROOT / "xml-params/scenes").glob("*.xml"))
    found = {}
    for path in scenes:
        for plug_in in plug_ins_of(path, defaults):
            found.setdefault(plug_in, ([], []))[0].append(path)
    for path in sorted((ROOT / "xml-params/studies").glob("*.xml")):
        root = ElementTree.parse(path).getroot()
        if root.get("name") != "Study":
            continue
        used = assigned_types(path.read_text(), defaults)
        for name in {entry.get("value") for entry in root.iter("Parameter") if entry.get("name") == "Scene"}:
            used |= plug_ins_of(path.parent / name, defaults)
        for plug_in in used:
            found.setdefault(plug_in, ([], []))[1].append(path)
    return found, scenes
