"""Scenes and settings that a script gives as Python's values, as the text that the compiled part reads."""
import json
import math
import numbers
from collections.abc import Mapping, Sequence
from typing import Any, List

import numpy as np

from ._core import InputError


def plain(value: Any) -> Any:
    """Numpy's numbers and arrays as Python's; anything else as it is."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def is_array(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def is_formula(text: str) -> bool:
    return text.strip().startswith("[") and text.strip().endswith("]")


def scalar(given: Any, where: str) -> Any:
    """A bool, a text or a finite number, as JSON knows them."""
    value = plain(given)
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    if not isinstance(value, numbers.Real):
        raise InputError(f"{where} is {value!r}; a parameter is a bool, a number, a text, or a tuple of numbers or texts.")
    if not math.isfinite(value):
        raise InputError(f"{where} is {value}, but must be finite.")
    return float(value)


def array(given: Any, where: str) -> List[Any]:
    """Scalars; a text beside a number or a formula is a formula."""
    values = [scalar(one, where) for one in given]
    if all(isinstance(one, str) and not is_formula(one) for one in values):
        return values
    return [f"[{one}]" if isinstance(one, str) and not is_formula(one) else one for one in values]


def parameters(given: "Mapping[str, Any]", path: str) -> "dict[str, Any]":
    content = {}
    for key, one in given.items():
        if not isinstance(key, str):
            raise InputError(f"the dictionary of the scene: in \"{path}\", the name {key!r} is no text.")
        value, here = plain(one), f"{path}/{key}" if path else key
        where = f'the dictionary of the scene: "{here}"'
        if isinstance(value, Mapping):
            content[key] = parameters(value, here)
        else:
            content[key] = array(value, where) if is_array(value) else scalar(value, where)
    return content


def json_of(scene: "Mapping[str, Any]") -> str:
    """Nested dictionaries as JSON, which is YAML: a dictionary is a list, a tuple or list an array. Raises InputError."""
    return json.dumps(parameters(scene, ""), ensure_ascii=False)


def setting_text(given: Any, where: str) -> str:
    """The value as `simulate --set` would write it."""
    value = plain(given)
    if is_array(value):
        return "{" + ", ".join(setting_text(one, where) for one in value) + "}"
    value = scalar(value, where)
    return value if isinstance(value, str) else json.dumps(value)


def settings_of(given: "Mapping[str, Any]", path: str = "") -> List[str]:
    """{"Time/End": 2.0} or {"Time": {"End": 2.0}} as texts "Time/End=2.0"."""
    texts: List[str] = []
    for key, value in given.items():
        here = f"{path}/{key}" if path else str(key)
        if isinstance(value, Mapping):
            texts += settings_of(value, here)
        else:
            texts.append(f"{here}={setting_text(value, 'the setting ' + chr(34) + here + chr(34))}")
    return texts
