"""The page itself: its parts and three.js in one text."""
import html
import json
import time
from pathlib import Path

from lockstep_frames import FramesError

PARTS = Path(__file__).resolve().parent
THREE = Path("/usr/share/javascript/three")  # files of Debian's libjs-three
LIBRARIES = [THREE / "build/three.min.js", THREE / "examples/js/controls/OrbitControls.js"]
SCRIPTS = ["data.js", "colours.js", "geometry.js", "cloud.js", "player.js", "plots.js", "curves.js", "page.js"]


def write_page(runs, differences, blobs=None, refresh=None):
    """The page as text. Without blobs it asks for them and, every `refresh` seconds, for the runs, where it came from."""
    missing = [path for path in LIBRARIES if not path.is_file()]
    if missing:
        raise FramesError(f"{missing[0]} is missing; tools/set-up installs it (libjs-three).")
    data = {"runs": runs, "differences": differences, "written": time.strftime("%Y-%m-%d %H:%M:%S")}
    if blobs is not None:
        data["blobs"] = blobs.as_text()
    if refresh is not None:
        data["refresh"] = refresh
    title = " and ".join(dict.fromkeys(run["title"] or run["folder"] for run in runs))
    scripts = [path.read_text() for path in LIBRARIES] + [(PARTS / name).read_text() for name in SCRIPTS]
    page = (PARTS / "page.html").read_text()
    for name, text in (("title", html.escape(title)), ("style", (PARTS / "page.css").read_text()),
                       ("scripts", "\n".join(f"<script>\n{text}\n</script>" for text in scripts)),
                       ("data", to_json(data))):
        page = page.replace("{{" + name + "}}", text, 1)
    return page


def to_json(data):
    """JSON as a page may hold it: nothing in it ends a script; numbers that are none become null."""
    return json.dumps(without_nan(data), allow_nan=False, separators=(",", ":")).replace("</", "<\\/")


def without_nan(value):
    if isinstance(value, dict):
        return {key: without_nan(of) for key, of in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(of) for of in value]
    return None if isinstance(value, float) and value != value else value
