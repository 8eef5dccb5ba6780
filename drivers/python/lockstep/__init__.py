"""Monolithic two-way coupling of incompressible fluids to solids and shells: runs that a script steps, reads and steers.

    with lockstep.Run("scene.xml", "output") as run:
        while run.step():
            print(run.time, run.bodies()["Ball"]["position"])

Units are SI throughout. On several ranks every rank makes the same calls with the same arguments.
"""
from ._core import InputError, OutputError, SolveError, __version__
from .run import Grid, Run

for _error in (InputError, OutputError, SolveError):
    _error.__module__ = __name__

__all__ = ["Grid", "InputError", "OutputError", "Run", "SolveError", "__version__"]
