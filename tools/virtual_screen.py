"""A screen in memory to draw on, as ParaView of Debian draws through X only.

Not xvfb-run: an X server starts anew when its last client leaves, unless told -noreset, and refuses who knocks meanwhile. ParaView looks at the screen, leaves and comes back at once, and
then ended by SIGABRT, seldom on an idle machine, nearly always where several drew. Two xvfb-run that begin together also choose the same number; here the server finds one that is free,
and says so when it is ready.
"""
import os
import secrets
import select
import struct
import subprocess
import tempfile
from pathlib import Path

SECONDS = 120  # until it is up; on a busy machine some


class ScreenError(Exception):
    """There is no such server, or it did not come up."""


class VirtualScreen:
    """Use it in a `with`; `environment` is that of programs which draw there."""

    def __init__(self, width, height):
        self.folder = tempfile.TemporaryDirectory()
        cookie = Path(self.folder.name) / "cookie"
        cookie.write_bytes(_cookie())
        read_end, write_end = os.pipe()
        try:
            self.server = subprocess.Popen(
                ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp", "-noreset", "-auth", cookie],
                pass_fds=(write_end,), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        except OSError as error:
            raise ScreenError(f"Xvfb does not start: {error}; tools/set-up --paraview installs it.") from error
        finally:
            os.close(write_end)
        number = self._read_number(read_end)
        self.environment = dict(os.environ, DISPLAY=f":{number}", XAUTHORITY=str(cookie))

    def _read_number(self, pipe):
        with os.fdopen(pipe) as file:
            ready = select.select([file], [], [], SECONDS)[0]
            number = file.readline().strip() if ready else ""
        if not number:
            self.__exit__()
            raise ScreenError(f"Xvfb, which gives ParaView a screen, was not ready after {SECONDS} s." if not ready
                              else "Xvfb, which gives ParaView a screen, ended at once.")
        return number

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()
        self.folder.cleanup()


def _cookie():
    """An .Xauthority file of one entry, for any host and any number: family, address, number, name, data."""
    fields = (b"", b"", b"MIT-MAGIC-COOKIE-1", secrets.token_bytes(16))
    return struct.pack(">H", 0xFFFF) + b"".join(struct.pack(">H", len(field)) + field for field in fields)
