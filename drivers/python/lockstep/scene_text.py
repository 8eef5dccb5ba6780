"""Scenes and settings that a script gives as Python's values, as the text that the compiled part reads."""
import math
import numbers
from collections.abc import Mapping, Sequence
from typing import Any, List
from xml.sax.saxutils import quoteattr

import numpy as np

from ._core import InputError

FORBIDDEN_IN_ARRAYS = ",{}"  # they part the components of an array


def plain(value: Any) -> Any:
    """Numpy's numbers and arrays as Python's; anything else as it is."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def is_array(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def is_formula(value: Any) -> bool:
    return isinstance(value, str) and value.strip().startswith("[") and value.strip().endswith("]")


def is_int(value: Any) -> bool:
    """True for whole numbers that an int of a parameter file holds; larger ones are doubles."""
    return isinstance(value, numbers.Integral) and not isinstance(value, bool) and -2**31 <= value < 2**31


def scalar_text(value: Any, where: str) -> str:
    """A bool, a number or a text as parameter files write it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if is_int(value):
        return str(int(value))
    if isinstance(value, numbers.Real):
        if not math.isfinite(value):
            raise InputError(f"{where} is {value}, but must be finite.")
        return repr(float(value))
    raise InputError(f"{where} is {value!r}; a parameter is a bool, a number, a text, or a tuple of numbers or texts.")


def scalar_type(value: Any) -> str:
    if is_int(value):
        return "int"
    return "bool" if isinstance(value, bool) else "string" if isinstance(value, str) else "double"


def array_type(values: Sequence[Any]) -> str:
    """The type of an array: texts, or formulas among them where some are numbers or in brackets."""
    if values and all(isinstance(value, str) and not is_formula(value) for value in values):
        return "Array(string)"
    if values and all(map(is_int, values)):
        return "Array(int)"
    return "Array(double)"


def component_text(value: Any, kind: str, where: str) -> str:
    text = scalar_text(value, where)
    if not isinstance(value, str):
        return text
    if kind == "Array(double)":  # beside numbers a text is a formula
        return text if is_formula(text) else f"[{text}]"
    if any(mark in text for mark in FORBIDDEN_IN_ARRAYS[1:]) or ("," in text and "(" not in text) or text != text.strip():
        raise InputError(f"{where} has the text {text!r}; in a tuple texts have no commas, braces and blanks at their ends.")
    return text


def parameter(name: str, value: Any, where: str) -> str:
    if is_array(value):
        values = [plain(one) for one in value]
        kind = array_type(values)
        text = "{" + ", ".join(component_text(one, kind, where) for one in values) + "}"
    else:
        kind = "double" if is_formula(value) else scalar_type(value)
        text = scalar_text(value, where)
    return f"<Parameter name={quoteattr(name)} type={quoteattr(kind)} value={quoteattr(text)}/>"


def xml_of(content: "Mapping[str, Any]", name: str = "Scene", path: str = "") -> str:
    """Nested dictionaries as XML: a dictionary is a list, a tuple or list an array. Raises InputError."""
    lines = [f"<ParameterList name={quoteattr(name)}>"]
    for key, given in content.items():
        if not isinstance(key, str):
            raise InputError(f"the dictionary of the scene: in \"{path}\", the name {key!r} is no text.")
        value, here = plain(given), f"{path}/{key}" if path else key
        if isinstance(value, Mapping):
            lines.append(xml_of(value, key, here))
        else:
            lines.append(parameter(key, value, f'the dictionary of the scene: "{here}"'))
    return "\n".join([*lines, "</ParameterList>"])


def setting_text(given: Any, where: str) -> str:
    """The value as `simulate --set` would write it."""
    value = plain(given)
    if is_array(value):
        return "{" + ", ".join(scalar_text(plain(one), where) for one in value) + "}"
    return scalar_text(value, where)


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
