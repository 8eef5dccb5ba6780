"""Scenes for tests, written as Python dictionaries."""


def xml(name, content):
    """A parameter list as text: dictionaries become sublists, tuples arrays."""
    lines = [f'<ParameterList name="{name}">']
    for key, value in content.items():
        if isinstance(value, dict):
            lines.append(xml(key, value))
            continue
        kind = {str: "string", int: "int", float: "double", bool: "bool"}.get(type(value))
        if isinstance(value, tuple):
            kind = f"Array({ {int: 'int', str: 'string'}.get(type(value[0]), 'double') })"
            value = "{" + ", ".join(map(str, value)) + "}"
        text = str(value).lower() if kind == "bool" else value
        lines.append(f'<Parameter name="{key}" type="{kind}" value="{text}"/>')
    return "\n".join([*lines, "</ParameterList>"])
