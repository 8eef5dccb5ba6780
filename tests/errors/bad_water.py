"""Bad input: water and air."""
from bad_input import NAME, Case, value
from program import SCENE

FREE_SURFACE = """<ParameterList name="Free Surface"> <ParameterList name="Liquid"> <ParameterList name="Pool">
  <Parameter name="Type" type="string" value="level"/> <Parameter name="Height" type="double" value="1.2"/>
  </ParameterList> </ParameterList> REST </ParameterList>"""


def water(rest="", liquid=None, solid="Ball"):
    """The good scene with a free surface."""
    scene = SCENE.replace(value("Order in Time", "int", "2"), FREE_SURFACE.replace("REST", rest)).replace(NAME, f'<ParameterList name="{solid}">')
    return {"scene": scene if liquid is None else scene.replace(value("Type", "string", "level") + " " +
                                                                value("Height", "double", "1.2"), liquid)}


def watch(*places):
    """Watched places: names, points and more."""
    lists = [f'<ParameterList name="{name}">' + value("Point", "Array(double)", point) + more + "</ParameterList>"
             for name, point, more in places]
    return water('<ParameterList name="Watch">' + "".join(lists) + "</ParameterList>")


def filled(name, text=None):
    """Liquid in what a file holds."""
    return {"files": [(name, text)] if text else [],
            **water(liquid=value("Type", "string", "mesh") + value("File", "string", name))}


def wave(*sets, **scene):
    """A side that sends in waves, and what is wrong with it."""
    side = "Domain/Sides/x lower/"
    good = ["Type=inflow", "Wave/Height=0.02", "Wave/Frequency=1"]
    return {"sets": [side + assignment for assignment in good] + [s if s.startswith("Fluid") else side + s for s in sets],
            **(scene or water())}


def gauge(ends):
    """XML that puts one into a scene."""
    time = '<ParameterList name="Time">'
    return time, ('<ParameterList name="Observers"> <ParameterList name="G">' + value("Type", "string", "gauge") +
                  value("Points", "Array(double)", ends) +
                  "</ParameterList> </ParameterList>" + time)


CASES = [
    Case("gas at less than no pressure", ["Gas Pressure", "above minus"],
         **water(value("Trapped Air", "string", "ideal gas") + value("Gas Pressure", "double", "-2e5"))),
    Case("an atmosphere that is nowhere", ["Atmosphere", "outside of the domain"],
         **water(value("Trapped Air", "string", "constant volume") + value("Atmosphere", "Array(double)", "{9, 9}"))),
    Case("half an atmosphere", ["Atmosphere", "has 1 numbers"],
         **water(value("Trapped Air", "string", "ideal gas") + value("Atmosphere", "Array(double)", "{0.5}"))),
    Case("trapped air between tiles that move", ["Trapped Air", "leave them out"],
         sets=["Fluid/Moving Tiles/Tile Margin=9"], **water(value("Trapped Air", "string", "ideal gas"))),
    Case("a solid with the water's name", ["\"water\"", "fluid's surface in frames"], **water(solid="water")),
    Case("a watch in a solid", ["watch \"Hold\"", "inside a solid"], **watch(("Hold", "{0.5, 0.5}", ""))),
    Case("a watch outside", ["watch \"Hold\"", "outside of the domain"], **watch(("Hold", "{0.5, 7}", ""))),
    Case("two watches of one column", ["\"Watch\"", "watch_B_1_volume"],
         **watch(("B 1", "{0.1, 0.1}", ""), ("B_1", "{0.1, 0.2}", ""))),
    Case("a watch that moves with nobody", ["watch \"Hold\"", "\"Boat\"", "no solid"],
         **watch(("Hold", "{0.1, 0.1}", value("Solid", "string", "Boat")))),
    Case("a watch of a hair", ["\"Radius\"", "greater than 0"],
         **watch(("Hold", "{0.1, 0.1}", value("Radius", "double", "0")))),
    Case("drops of nothing", ["\"Drops\"", "\"Volume Correction\"", "no drops"],
         **water('<ParameterList name="Interface">' + value("Type", "string", "particle level set") +
                 value("Drops", "string", "ballistic") + value("Volume Correction", "string", "none") + "</ParameterList>")),
    Case("a dry point in a solid", ["dry point 0.5, 0.5", "inside a solid"], **water(value("Dry Points", "Array(double)", "{0.5, 0.5}"))),
    Case("a dry point outside", ["dry point 0.5, 9", "outside of the domain"], **water(value("Dry Points", "Array(double)", "{0.5, 9}"))),
    Case("a wave on a wall", ["x lower", "\"Wave\" is for inflows", "\"wall\""], **wave("Type=wall")),
    Case("a wave in a full tank", ["x lower", "no surface"], **wave(scene=SCENE)),
    Case("a wave and a stream", ["x lower", "leave \"Velocity\""], **wave("Velocity={1, 0}")),
    Case("a wave along gravity", ["x lower", "gravity along the side"], **wave("Fluid/Gravity={-9.8, 0}")),
    Case("a wave on tilted water", ["x lower", "along an axis"], **wave("Fluid/Gravity={-1, -9.8}")),
    Case("a wave above the domain", ["x lower", "\"Height\"", "from 0 to 2 m"], **wave("Fluid/Free Surface/Liquid/Pool/Height=2.5")),
    Case("a wave on water of no level", ["x lower", "the one \"level\"", "there are 0"],
         **wave(**water(liquid=value("Type", "string", "box")))),
    Case("a wave that breaks", ["x lower", "breaks where it is 0.2"], **wave("Wave/Height=0.3")),
    Case("a wave that does not swing", ["\"Frequency\"", "greater than 0"], **wave("Wave/Frequency=0")),
    Case("a gauge without a length", ["gauge", "\"Points\"", "are one"], gauge("{0.1, 1, 0.1, 1}"), **water()),
    Case("a gauge in a full tank", ["gauge", "fills the domain"], gauge("{0.1, 1, 0.1, 2}")),
    Case("liquid in no file", ["pool.obj", "cannot open this surface file"], **filled("pool.obj")),
    Case("liquid in an open line", ["Pool", "pool.obj"], **filled("pool.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\n")),
]
