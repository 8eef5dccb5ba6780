"""Seeds from FIRST_SEED on are scenes that the multigrid solves through a periodic seam: the axis of most cells is periodic
and of whole tiles, and its last solid reaches towards the last cell before the seam. They draw from numbers of their own, so
that no other seed changes."""
import random

from liquids import AXES

FIRST_SEED = 7000
TILE = {2: 16, 3: 8}  # cells
MARGIN = 1.2  # cells that solids keep from the sides of other scenes


def longest_axis(world):
    return world.cells.index(max(world.cells))


def fill_tiles(world):
    """Makes the longest axis one of whole tiles, by more cells."""
    axis, tile = longest_axis(world), TILE[world.dimension]
    world.cells[axis] = -(-world.cells[axis] // tile) * tile
    world.upper[axis] = world.lower[axis] + world.cells[axis] * world.h


def close_ring(world, sides):
    """Makes that axis periodic."""
    sides.update({f"{AXES[longest_axis(world)]} {end}": {"Type": "periodic"} for end in ("lower", "upper")})
    world.facts.periodic = True


def move_to_seam(world, solids, seed):
    """Moves all solids by the same, so that what is glued stays so."""
    step = random.Random(f"lockstep seam {seed}").uniform(0, MARGIN) * world.h
    for body in solids.values():
        body["Position"][longest_axis(world)] += step
