"""The common part of the movies of render and plot-frame: one scale of colours for all frames, and the way to an MP4 file."""
import subprocess

import numpy

from lockstep_frames import FramesError

MOST_PREVIEW_FRAMES = 50  # frames of a movie
SHOWN = 0.999             # part of a frame's values; one cell that is ten times as fast for one frame would leave all others dark


def range_of_colours(frames, is_magnitude, share=SHOWN):
    """Smallest and largest of the frames' values but for a share of each, so that colours do not flicker; magnitudes count from 0."""
    low, high = numpy.inf, -numpy.inf
    for values in frames:
        known = values[numpy.isfinite(values)]
        if known.size:
            low = min(low, float(numpy.quantile(known, 1 - share, method="lower")))
            high = max(high, float(numpy.quantile(known, share, method="higher")))
    if low > high:  # no frame has a value
        low = high = 0.0
    low = 0.0 if is_magnitude else low
    return [low, high if high > low else low + 1.0]


def write_movie(folder, frame_rate, path):
    """Makes a movie of the pictures 000000.png, 000001.png, ... in the folder, all of one size; a rim of white makes odd sizes even, which MP4 wants."""
    command = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(frame_rate), "-i", f"{folder}/%06d.png", "-c:v", "libx264",
               "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)]
    try:
        subprocess.run(command, check=True)
    except FileNotFoundError as error:
        raise FramesError("the program ffmpeg is missing; run tools/set-up --paraview.") from error
