"""A screen in memory to draw on, as ParaView of Debian draws through X only.

Not xvfb-run: an X server starts anew when its last client leaves, unless told -noreset, and refuses who knocks meanwhile. ParaView looks at the screen, leaves and comes back at once, and
then ended by SIGABRT, seldom on an idle machine, nearly always where several drew. Two xvfb-run that begin together also choose the same number.
"""
import os
import secrets
import select
import struct
import subprocess
import tempfile
from pathlib import Path

SECONDS = 120  # until it is up; on a busy machine some
TRIES = 10     # each with a number of its own


class ScreenError(Exception):
    """There is no such server, or it did not come up."""


class VirtualScreen:
    """Use it in a `with`; `environment` is that of programs which draw there."""

    def __init__(self, width, height):
        self.folder = tempfile.TemporaryDirectory()
        cookie = Path(self.folder.name) / "cookie"
        cookie.write_bytes(_cookie())
        # Not the first ten, which hwloc, and so every MPI program, asks for graphics cards, and complains when refused.
        for _ in range(TRIES):
            number = 100 + secrets.randbelow(9000)
            if self._starts(["Xvfb", f":{number}", "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp", "-noreset", "-auth", cookie]):
                self.environment = dict(os.environ, DISPLAY=f":{number}", XAUTHORITY=str(cookie))
                return
        self.folder.cleanup()
        raise ScreenError(f"Xvfb, which gives ParaView a screen, did not start, {TRIES} times.")

    def _starts(self, command):
        """True if the server came up; where another has the number, or a file of one that was killed, it ends at once."""
        ready, its_end = os.pipe()
        try:
            self.server = subprocess.Popen([*command, "-displayfd", str(its_end)], pass_fds=(its_end,), stdin=subprocess.DEVNULL,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        except OSError as error:
            self.folder.cleanup()
            os.close(ready)
            raise ScreenError(f"Xvfb does not start: {error}; tools/set-up --paraview installs it.") from error
        finally:
            os.close(its_end)
        with os.fdopen(ready) as pipe:
            is_up = bool(select.select([pipe], [], [], SECONDS)[0]) and pipe.readline().strip() != ""
        if not is_up:
            self._stop()
        return is_up

    def _stop(self):
        self.server.terminate()
        self.server.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stop()
        self.folder.cleanup()


def _cookie():
    """An .Xauthority file of one entry, for any host and any number: family, address, number, name, data."""
    fields = (b"", b"", b"MIT-MAGIC-COOKIE-1", secrets.token_bytes(16))
    return struct.pack(">H", 0xFFFF) + b"".join(struct.pack(">H", len(field)) + field for field in fields)
