"""One step of a scene by the Python module: one_step.py SCENE OUTPUT [LIBRARY OF PLUG-INS]..."""
import sys

import lockstep

with lockstep.Run(sys.argv[1], sys.argv[2], plug_ins=sys.argv[3:]) as run:
    run.step()
    print(run.n_steps, "step")
