"""Parameter lists as nested dictionaries, and their XML."""
from xml.sax.saxutils import quoteattr


def is_a(value, kind):
    return isinstance(value, kind) and not isinstance(value, bool)


def type_and_text(value):
    """The type of a parameter, as the XML has it, and its text. Floats read back exactly."""
    if isinstance(value, bool):
        return "bool", "true" if value else "false"
    if is_a(value, int):
        return "int", str(value)
    if isinstance(value, float):
        return "double", repr(value)
    if isinstance(value, str):
        return "string", value
    kind = "int" if all(is_a(x, int) for x in value) else "double"
    kind = "string" if all(isinstance(x, str) for x in value) else kind
    return f"Array({kind})", "{" + ", ".join(type_and_text(x)[1] for x in value) + "}"


def xml_lines(name, content, indent=""):
    yield f"{indent}<ParameterList name={quoteattr(name)}>"
    for key, value in content.items():
        if isinstance(value, dict):
            yield from xml_lines(key, value, indent + "  ")
        else:
            kind, text = type_and_text(value)
            yield f'{indent}  <Parameter name={quoteattr(key)} type="{kind}" value={quoteattr(text)}/>'
    yield f"{indent}</ParameterList>"


def to_xml(name, content):
    """Dictionaries become lists; bool, int, float, str and lists of them parameters."""
    return "\n".join(xml_lines(name, content)) + "\n"
