"""The part of tools/render that runs inside pvbatch; its one argument is a description in JSON."""
import json
import sys

from paraview import simple

simple._DisableFirstRenderCameraReset()

SOLID_COLOURS = [(.80, .36, .25), (.30, .50, .72), (.87, .70, .30), (.45, .65, .42), (.58, .45, .68), (.55, .55, .55)]

SMOKE_COLOUR = (.68, .7, .73)
WATER, WATER_COLOUR = "water", (.32, .56, .78)


def open_grids(job, names):
    """A reader of some of the grids of the run."""
    # An absolute path: ParaView's readers lose relative ones.
    reader = simple.XDMFReader(FileNames=[job["index"]])
    reader.UpdatePipelineInformation()
    # A grid that comes back in each frame is listed as name, name[1], ...
    reader.GridStatus = [grid for grid in reader.GridStatus.Available if grid.split("[")[0] in names]
    return reader


def colour_range(job, source):
    """Smallest and largest value of the field over the chosen times, so that colours do not flicker."""
    low, high = float("inf"), -float("inf")
    for time in job["times"]:
        source.UpdatePipeline(time)
        array = source.CellData.GetArray(job["field"])
        a, b = array.GetRange(-1 if job["is_vector"] else 0)
        low, high = min(low, a), max(high, b)
    return (low, high) if high > low else (low, low + 1.0)


def show_fluid(job, view):
    fluid = open_grids(job, job["boxes"])
    low, high = colour_range(job, fluid)
    bounds = fluid.GetDataInformation().GetBounds()
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
        shown = simple.Slice(Input=fluid, SliceType="Plane")
        shown.SliceType.Origin = centre
        shown.SliceType.Normal = [float(i == job["axis"]) for i in range(3)]
    display = simple.Show(shown, view)
    display.SetRepresentationType(representation)
    display.Ambient, display.Diffuse = 1.0, 0.0  # colours as in the bar, without shading
    where = "POINTS" if job["volume"] else "CELLS"
    simple.ColorBy(display, (where, job["field"], "Magnitude") if job["is_vector"] else (where, job["field"]))
    table = simple.GetColorTransferFunction(job["field"])
    table.ApplyPreset("Viridis (matplotlib)", True)
    table.RescaleTransferFunction(low, high)
    is_smoke = job["volume"] and job["field"] == "smoke"
    if is_smoke:  # lit, and as grey as it is
        table.RGBPoints = [low, *SMOKE_COLOUR, high, *SMOKE_COLOUR]
        display.Shade, display.Ambient, display.Diffuse = 1, 0.75, 0.45
    opacity = simple.GetOpacityTransferFunction(job["field"])
    opacity.Points = [low, 0.0, 0.5, 0.0, high, 0.6, 0.5, 0.0]
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = job["field"], "magnitude" if job["is_vector"] else ""
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.86, 0.35], 0.3
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.2g", "%.2g"
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    display.SetScalarBarVisibility(view, not is_smoke)
    return bounds


def show_solids(job, view):
    bounds = None
    for number, name in enumerate(name for name in job["surfaces"] if name != WATER):
        solid = open_grids(job, [name])
        solid.UpdatePipeline(job["times"][0])
        shown = solid
        if job["dim"] == 3:  # round bodies look round, edges stay edges
            shown = simple.ExtractSurface(Input=simple.MergeBlocks(Input=solid))
            shown = simple.GenerateSurfaceNormals(Input=shown, FeatureAngle=50)
        display = simple.Show(shown, view)
        display.SetRepresentationType("Surface")
        display.ColorArrayName = ["POINTS", ""]  # ColorBy(display, None) fails on multiblock data
        display.AmbientColor = display.DiffuseColor = SOLID_COLOURS[number % len(SOLID_COLOURS)]
        if job["dim"] == 3:  # what faces away from the light is not black
            display.Ambient, display.Diffuse = 0.25, 0.85
        display.LineWidth = 3
        box = solid.GetDataInformation().GetBounds()
        bounds = box if bounds is None else [pick(a, b) for pick, a, b in
                                             zip((min, max) * 3, bounds, box)]
    return bounds


def show_water(job, view):
    """Its surface and its walls, so that what is in it shines through."""
    # Grids that differ from frame to frame come as many blocks; one surface has normals throughout.
    surface = simple.ExtractSurface(Input=simple.MergeBlocks(Input=open_grids(job, [WATER])))
    display = simple.Show(simple.GenerateSurfaceNormals(Input=surface, FeatureAngle=60), view)
    display.SetRepresentationType("Surface")
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = WATER_COLOUR
    display.Opacity, display.Specular, display.SpecularPower = 0.45, 0.6, 40


def show_drops(job, view):
    drops = simple.Glyph(Input=open_grids(job, job["drops"]), GlyphType="Sphere")
    drops.ScaleArray, drops.ScaleFactor = ["POINTS", "radius"], 2.0  # the sphere's radius is a half
    drops.OrientationArray, drops.GlyphMode = ["POINTS", "No orientation array"], "All Points"
    display = simple.Show(drops, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = WATER_COLOUR


def show_outline(job, view):
    fluid = open_grids(job, job["boxes"])
    fluid.UpdatePipeline(job["times"][0])
    box = simple.Show(simple.Outline(Input=fluid), view)
    box.AmbientColor = box.DiffuseColor = [0.4, 0.4, 0.4]
    return fluid.GetDataInformation().GetBounds()


def place_camera(job, view, bounds):
    centre = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
    view.CameraFocalPoint = centre
    if job["dim"] == 2:
        view.CameraParallelProjection = 1
        direction, up = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
    else:
        direction, up = job["direction"], [float(axis == job["up"]) for axis in range(3)]
    view.CameraPosition = [c + d for c, d in zip(centre, direction)]
    view.CameraViewUp = up
    view.ResetCamera(*bounds)
    if job["dim"] == 3:
        # The view's properties do not know yet where ResetCamera went; the camera does.
        focus, eye = job["centre"] or centre, view.GetActiveCamera().GetPosition()
        view.CameraPosition = [f + (e - c) / job["zoom"] for f, e, c in zip(focus, eye, centre)]
        view.CameraFocalPoint = focus


def main():
    job = json.loads(sys.argv[1])
    view = simple.CreateView("RenderView")
    view.ViewSize = job["size"]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.UseFXAA = int(not job["fast"])
    bounds = show_fluid(job, view) if job["field"] else None
    if job["boxes"] and job["dim"] == 3:
        bounds = show_outline(job, view)
    solid_bounds = show_solids(job, view)
    if WATER in job["surfaces"]:
        show_water(job, view)
        # Peels of what shines through, so that nearer and farther faces are told apart.
        view.DepthPeeling = int(not job["fast"])
    if job["drops"]:
        show_drops(job, view)
    place_camera(job, view, bounds or solid_bounds)
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
