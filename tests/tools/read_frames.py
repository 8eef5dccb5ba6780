"""A user's first program on frames; docs/output.md quotes it. Usage: read_frames.py OUTPUT_DIR SOLID"""
import sys

# ... where tools/ is, or a copy of lockstep_frames.py
sys.path.insert(0, "tools")
from lockstep_frames import read_frames

for frame in read_frames(sys.argv[1]):
    fluid, solid = frame["fluid"], frame[sys.argv[2]]
    x, y = fluid.centres()[:2]                        # centres of the cells [m]
    velocity = fluid.values("velocity")               # [z][y][x][3], in 2D one layer [1][y][x][3] [m/s]
    points, triangles = solid.points(), solid.cells() # (n, 3) [m] and (n, corners)
    print(f"t = {frame.time:g} s: {len(triangles)} simplices around {points.mean(axis=0).round(3)},",
          f"at most {abs(velocity).max():.3g} m/s between x = {x[0]:g} and {x[-1]:g} m")
