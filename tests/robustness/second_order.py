"""Seeds from FIRST_SEED on are scenes of rigid bodies, in a liquid below a gas where there is one, whose steps are of the second order in time."""
FIRST_SEED = 10000


def keep_rigid(content):
    """Takes what the scheme does not know out of a scene."""
    content["Solids"] = {name: body for name, body in content["Solids"].items() if body["Type"] == "rigid body"}


def set_order(content):
    content["Time"]["Order in Time"] = 2
