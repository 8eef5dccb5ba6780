"""The part of tools/render that runs inside pvbatch; its one argument is a description in JSON."""
import itertools
import json
import math
import sys

from paraview import simple

simple._DisableFirstRenderCameraReset()

SOLID_COLOURS = [(.80, .36, .25), (.30, .50, .72), (.87, .70, .30), (.45, .65, .42), (.58, .45, .68), (.55, .55, .55)]

SMOKE_COLOUR = (.68, .7, .73)
# Colours of a cloud of another field, from the smallest value to the largest: slow fluid is hardly there, fast fluid glows.
CLOUD_COLOURS = [(.76, .87, .95), (.30, .62, .85), (.16, .34, .66), (.55, .20, .50), (.93, .42, .20)]
WATER, WATER_COLOUR = "water", (.24, .56, .86)


def open_grids(job, names):
    """A reader of some of the grids of the run."""
    # An absolute path: ParaView's readers lose relative ones.
    reader = simple.XDMFReader(FileNames=[job["index"]])
    reader.UpdatePipelineInformation()
    # A grid that comes back in each frame is listed as name, name[1], ...
    reader.GridStatus = [grid for grid in reader.GridStatus.Available if grid.split("[")[0] in names]
    return reader


def is_smoke(job):
    return job["volume"] and job["field"] == "smoke"


def show_fluid(job, view):
    fluid = open_grids(job, job["boxes"])
    low, high = job["range"]
    bounds = job["bounds"]
    shown, representation = fluid, "Surface"
    if job["volume"]:
        # Volumes are drawn from one image with values at its points: the cells' centres. Between them smoke is interpolated,
        # so that a shell which holds it seems to let it through by up to half a cell.
        shown = simple.ResampleToImage(Input=fluid)
        shown.UseInputBounds = 0
        shown.SamplingBounds = [bounds[i] + 0.5 * job["spacing"][i // 2] * (1 - 2 * (i % 2)) for i in range(6)]
        shown.SamplingDimensions = job["n_cells"]
        representation = "Volume"
    elif job["dim"] == 3:
        centre = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
        if job["position"] is not None:
            centre[job["axis"]] = job["position"]
        # Values at the cells' corners: the plane goes over smoothly from cell to cell.
        shown = simple.Slice(Input=simple.CellDatatoPointData(Input=fluid), SliceType="Plane")
        shown.SliceType.Origin = centre
        shown.SliceType.Normal = [float(i == job["axis"]) for i in range(3)]
    display = simple.Show(shown, view)
    display.SetRepresentationType(representation)
    display.Ambient, display.Diffuse = 1.0, 0.0  # colours as in the bar, without shading
    where = "POINTS" if job["dim"] == 3 else "CELLS"
    simple.ColorBy(display, (where, job["field"], "Magnitude") if job["is_vector"] else (where, job["field"]))
    table = simple.GetColorTransferFunction(job["field"])
    table.ApplyPreset("Viridis (matplotlib)", True)
    table.RescaleTransferFunction(low, high)
    if is_smoke(job):  # lit, and as grey as it is
        table.RGBPoints = [low, *SMOKE_COLOUR, high, *SMOKE_COLOUR]
        display.Shade, display.Ambient, display.Diffuse = 1, 0.75, 0.45
    elif job["volume"]:
        table.ColorSpace = "RGB"
        places = [low + (high - low) * i / (len(CLOUD_COLOURS) - 1) for i in range(len(CLOUD_COLOURS))]
        table.RGBPoints = [number for place, colour in zip(places, CLOUD_COLOURS) for number in (place, *colour)]
    opacity = simple.GetOpacityTransferFunction(job["field"])
    opacity.Points = [low, 0.0, 0.5, 0.0, high, 0.6, 0.5, 0.0]
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = job["field"], "magnitude" if job["is_vector"] else ""
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.9, 0.35], 0.3
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.2g", "%.2g"
    # Words are as large as in a picture of the usual size, so that none is cut off.
    bar.TitleFontSize = bar.LabelFontSize = bar.ScalarBarThickness = max(round(16 * job["size"][1] / 960), 6)
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    display.SetScalarBarVisibility(view, not is_smoke(job))


def show_solids(job, view):
    solids = [name for name in job["surfaces"] if name != WATER]
    # One reader for all of a colour: each reads the whole index, which is long where there are many.
    for number, colour in enumerate(SOLID_COLOURS[:len(solids)]):
        shown = solid = open_grids(job, solids[number::len(SOLID_COLOURS)])
        if job["dim"] == 3:  # round bodies look round, edges stay edges
            shown = simple.ExtractSurface(Input=simple.MergeBlocks(Input=solid))
            shown = simple.GenerateSurfaceNormals(Input=shown, FeatureAngle=50)
        display = simple.Show(shown, view)
        display.SetRepresentationType("Surface")
        display.ColorArrayName = ["POINTS", ""]  # ColorBy(display, None) fails on multiblock data
        display.AmbientColor = display.DiffuseColor = colour
        if job["dim"] == 3:  # faces away from the light are not black
            display.Ambient, display.Diffuse = 0.25, 0.85
        display.LineWidth = 3


def show_water(job, view):
    """Its surface and its walls, so that what is in it shines through."""
    # Grids that differ from frame to frame come as many blocks; one surface has normals throughout.
    surface = simple.ExtractSurface(Input=simple.MergeBlocks(Input=open_grids(job, [WATER])))
    display = simple.Show(simple.GenerateSurfaceNormals(Input=surface, FeatureAngle=60), view)
    display.SetRepresentationType("Surface")
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = WATER_COLOUR
    display.Opacity, display.Specular, display.SpecularPower = 0.4, 0.8, 60
    display.Ambient, display.Diffuse = 0.22, 0.92


def show_drops(job, view):
    drops = simple.Glyph(Input=open_grids(job, job["drops"]), GlyphType="Sphere")
    drops.ScaleArray, drops.ScaleFactor = ["POINTS", "radius"], 2.0  # the sphere's radius is a half
    drops.OrientationArray, drops.GlyphMode = ["POINTS", "No orientation array"], "All Points"
    display = simple.Show(drops, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = WATER_COLOUR


def show_outline(job, view):
    fluid = open_grids(job, job["boxes"])
    box = simple.Show(simple.Outline(Input=fluid), view)
    box.AmbientColor = box.DiffuseColor = [0.4, 0.4, 0.4]


def place_camera(job, view):
    bounds = job["bounds"]
    centre = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
    view.CameraFocalPoint = centre
    if job["dim"] == 2:
        view.CameraParallelProjection = 1
        view.CameraPosition, view.CameraViewUp = [centre[0], centre[1], centre[2] + 1], (0.0, 1.0, 0.0)
        view.ResetCamera(*bounds)
        return
    back = normalized(job["direction"])
    focus = job["centre"] or centre
    away = distance_to_all(job, back, view.CameraViewAngle) / job["zoom"]
    view.CameraFocalPoint = focus
    view.CameraPosition = [f + away * b for f, b in zip(focus, back)]
    view.CameraViewUp = [float(axis == job["up"]) for axis in range(3)]


def distance_to_all(job, back, angle):
    """From the middle of the domain to an eye that has every corner of it in the picture; as in the player of tools/report."""
    right = normalized(cross([float(axis == job["up"]) for axis in range(3)], back))
    above = cross(back, right)
    slope = math.tan(math.radians(angle) / 2)
    # Beside the bar of colours, and the same on the other side.
    aside = slope * job["size"][0] / job["size"][1] * (0.8 if job["field"] and not is_smoke(job) else 1)
    half = [0.5 * (job["bounds"][2 * i + 1] - job["bounds"][2 * i]) for i in range(3)]
    corners = [[sign * length for sign, length in zip(signs, half)] for signs in itertools.product((-1, 1), repeat=3)]
    return 1.04 * max(dot(p, back) + max(abs(dot(p, above)) / slope, abs(dot(p, right)) / aside) for p in corners)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalized(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def main():
    job = json.loads(sys.argv[1])
    view = simple.CreateView("RenderView")
    view.ViewSize = job["size"]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.UseFXAA = int(not job["fast"])
    if job["field"]:
        show_fluid(job, view)
    if job["boxes"] and job["dim"] == 3:
        show_outline(job, view)
    show_solids(job, view)
    if WATER in job["surfaces"]:
        show_water(job, view)
        # Peels of what shines through, so that nearer and farther faces are told apart.
        view.DepthPeeling = int(not job["fast"])
    if job["drops"]:
        show_drops(job, view)
    place_camera(job, view)
    if job["fast"]:
        view.GetRenderWindow().SetMultiSamples(0)
    for time, picture in zip(job["times"], job["pictures"]):
        view.ViewTime = time
        simple.Render(view)
        simple.SaveScreenshot(picture, view, ImageResolution=job["size"])
    if job["state"]:
        scene = simple.GetAnimationScene()  # a state opens at its time, not at the view's
        scene.UpdateAnimationUsingDataTimeSteps()
        scene.AnimationTime = job["times"][-1]
        simple.SaveState(job["state"])


main()
