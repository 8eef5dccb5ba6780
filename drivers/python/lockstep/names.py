"""Dictionaries and objects that answer an unknown name with the near one."""
from typing import TYPE_CHECKING, Any, Dict

from ._core import nearest_name


class NearNames:
    """An object whose AttributeError says which name was meant."""

    if not TYPE_CHECKING:  # type checkers would take any name for one that there is
        def __getattr__(self, name: str) -> Any:
            nearest = "" if name.startswith("_") else nearest_name(name, [known for known in dir(self) if not known.startswith("_")])
            meant = f' Did you mean "{nearest}"?' if nearest else ""
            raise AttributeError(f'A {type(self).__name__} has no attribute "{name}".{meant}')


class Named(Dict[str, Any]):
    """A dictionary whose KeyError says which names there are, and which of them was meant."""

    def __init__(self, kind: str, content: Dict[str, Any]) -> None:
        super().__init__(content)
        self._kind = kind

    def __missing__(self, name: str) -> Any:
        names = [str(known) for known in self]
        nearest = nearest_name(str(name), names)
        meant = f' Did you mean "{nearest}"?' if nearest else ""
        known = ", ".join(f'"{one}"' for one in names) or "none"
        raise KeyError(f'There is no {self._kind} "{name}".{meant} There are: {known}.')
