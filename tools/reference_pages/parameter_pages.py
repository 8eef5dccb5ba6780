"""The pages of docs/parameters, one a plug-in, from what the programs say of their parameters: for tools/update-parameters."""
import re
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

HEAD = "<!-- Written by tools/update-parameters; change the docstrings in the code instead. -->\n"
# The lists whose "Type" names a plug-in: what it is called, and the start of its page's name.
KINDS = {
    "Fluid": ("Fluid", "fluid"),
    "Fluid (Type \"mac\")/Free Surface/Interface": ("Interface model", "interface"),
    "Solids": ("Solid", "solid"), "Coupling": ("Coupling", "coupling"), "Joints": ("Joint", "joint"),
    "Articulation": ("Articulation", "articulation"), "Contact": ("Contact model", "contact"),
    "Solver/Strategy": ("Solver strategy", "strategy"), "Observers": ("Observer", "observer"),
}
UNIT = re.compile(r",? ?\[((?:1|m|s|kg|N|Pa|K|rad|cells)(?:[\^/ ,\d]|\b(?:m|s|kg|N|Pa|K|rad)\b)*)\](?: \(2D: \[([^\]]+)\]\))?")
ALONE = "In 3D only. "
TABLE = "| Name | Type | Default | Unit | Allowed | Meaning |\n|---|---|---|---|---|---|\n"


@dataclass
class Section:
    """A list of parameters, under the path that a scene writes."""
    path: str
    documentation: str
    note: str
    rows: list = field(default_factory=list)


@dataclass
class Page:
    name: str
    title: str
    sections: list
    plug_in: tuple = None  # the list and the type


def both(three, two):
    """Text for three dimensions and, if it differs, for two."""
    return three if three == two else f"{three or 'any'} (2D: {two or 'any'})"


def unit_and_meaning(parameter):
    """The unit of a docstring, and the docstring without it."""
    text = parameter["documentation"]
    unit = UNIT.search(text) if "double" in parameter["type"] else None
    if not unit:
        return "", text
    meaning = text[:unit.start()] + text[unit.end():]
    return unit.group(1) + (f" (2D: {unit.group(2)})" if unit.group(2) else ""), meaning if meaning.strip(" .") else ""


def row_of(parameter, twin):
    """name, type, default, unit, allowed, meaning of a parameter in 3D and of the same in 2D."""
    (unit, meaning), (unit_2d, meaning_2d) = unit_and_meaning(parameter), unit_and_meaning(twin)
    kind, default, allowed = (both(parameter[key], twin[key]) for key in ("type", "default", "allowed"))
    return parameter["name"], kind, default, both(unit, unit_2d), allowed, both(meaning, meaning_2d)


def rows_of(three, two):
    """Rows of a list in 3D and of the same list in 2D, where either may be missing."""
    if not three or not two:
        return [row_of(parameter, parameter) for parameter in (three or two)["parameters"]]
    twins = {parameter["name"]: parameter for parameter in two["parameters"]}
    rows = []
    for parameter in three["parameters"]:
        twin = twins.pop(parameter["name"], None)
        row = row_of(parameter, twin or parameter)
        rows.append(row if twin else (*row[:5], "3D: " + row[5]))
    return rows + [(*row[:5], "2D: " + row[5]) for row in (row_of(twin, twin) for twin in twins.values())]


def sections_of(three, two):
    """The lists of a scene in 3D and 2D as one; each at its first place."""
    by_path = {entry["path"]: entry for entry in two}
    sections = []
    for entry in three + [entry for entry in two if entry["path"] not in {other["path"] for other in three}]:
        twin = by_path.get(entry["path"])
        alone = "" if two is three else ALONE if not twin else "In 2D only. " if entry is twin else ""
        sections.append(Section(entry["path"], alone + entry["documentation"], entry["note"],
                                rows_of(None if entry is twin else entry, twin)))
    return sections


def chosen(path):
    """The list and the type at the start of a section's path, if they name a plug-in; the deepest."""
    for place in sorted(KINDS, key=len, reverse=True):
        match = re.match(re.escape(place) + r" \(Type \"([^\"]+)\"\)", path)
        if match:
            return place, match.group(1)
    return None


def slug(text):
    return re.sub(r"[^\w]+", "-", text.lower()).strip("-")


def scene_pages(sections):
    """A page for every plug-in, in the order of the reference, and one for all else."""
    pages, rest = {}, Page("scene", "What every scene may say", [])
    for section in sections:
        plug_in = chosen(section.path)
        if plug_in and plug_in not in pages:
            title, prefix = KINDS[plug_in[0]]
            pages[plug_in] = Page(f"{prefix}-{slug(plug_in[1])}", f"{title} \"{plug_in[1]}\"", [], plug_in)
        if plug_in:
            pages[plug_in].sections.append(section)
        elif section.path not in KINDS:
            rest.sections.append(section)
    return [rest, *pages.values()]


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def heading_of(page, section):
    """Heading of a section on its page, where the page's own list goes without saying."""
    root = page.sections[0].path if page.plug_in else ""
    return section.path[len(root):].lstrip("/")


def parts_of(page, place):
    """The contents of the list at sections[place] and of all below it, by their paths within it."""
    path = page.sections[place].path
    below = [section for section in page.sections[place:] if section.path == path or section.path.startswith(path + "/")]
    return [(section.path[len(path):], section.documentation.removeprefix(ALONE), section.note, section.rows) for section in below]


def like_an_earlier_one(page, place):
    """The list beside the one at sections[place] that stands before it and says the same of the same parameters."""
    folder, _, name = page.sections[place].path.rpartition("/")
    for other, section in enumerate(page.sections[:place]):
        if name and section.path.rpartition("/")[0] == folder and section.rows and parts_of(page, other) == parts_of(page, place):
            return section
    return None


def body(page):
    """The tables of a page, each under its heading; lists like one before are named only."""
    lines, skipped = [], None
    for place, section in enumerate(page.sections):
        if skipped and section.path.startswith(skipped + "/"):
            continue
        heading = heading_of(page, section)
        if heading:
            lines.append(f"## {heading}\n")
        twin = like_an_earlier_one(page, place)
        if twin:
            skipped = section.path
            alone = "In 3D only: as" if section.documentation.startswith(ALONE) else "As"
            lines.append(f"{alone} [{heading_of(page, twin)}](#{anchor(heading_of(page, twin))}).\n")
            continue
        # The docstring of the plug-in stands at the head of its page.
        texts = [] if page.plug_in and not heading else [section.documentation]
        lines += [f"{text}\n" for text in (*texts, section.note) if text]
        if section.path in KINDS:
            lines.append(f"{links_to_types(section)}\n")
        elif section.rows:
            lines.append(TABLE + "".join(f"| {' | '.join(map(cell, row))} |\n" for row in section.rows))
    return "\n".join(lines)


def links_to_types(section):
    """Links of a list whose types have pages of their own."""
    allowed = next(row[4] for row in section.rows if row[0] == "Type")
    return ", ".join(f"[{kind}]({KINDS[section.path][1]}-{slug(kind)}.md)" for kind in re.findall(r'"([^"]+)"', allowed))


def how_to_choose(page, default):
    place, kind = page.plug_in
    listed = re.sub(r" \(Type \"[^\"]+\"\)", "", place)
    if place in ("Solids", "Joints", "Observers"):
        return (f"A list under a name of your own in `{listed}`:\n\n```xml\n<ParameterList name=\"{listed}\">\n"
                f"  <ParameterList name=\"NAME\">\n    <Parameter name=\"Type\" type=\"string\" value=\"{kind}\"/>\n"
                "    ...\n```\n")
    solver = place == "Solver/Strategy" and f"xml-params/solvers/{kind}.xml"
    settings = f"Its settings, for `Solver/File`: [{solver}](../../{solver}).\n" if solver and (ROOT / solver).exists() else ""
    if kind == default:
        return f"What a scene has whose `{listed}/Type` says nothing else.\n" + (settings and "\n" + settings)
    if settings:
        return settings
    return f"`--set \"{listed}/Type={kind}\"`, or in the scene's file:\n\n" + nested(listed.split("/"), kind)


def nested(lists, kind):
    """The lists, one in the other, with the type in the last."""
    indents = ["  " * depth for depth in range(len(lists) + 1)]
    lines = [f"{indents[depth]}<ParameterList name=\"{name}\">" for depth, name in enumerate(lists)]
    lines.append(f"{indents[-1]}<Parameter name=\"Type\" type=\"string\" value=\"{kind}\"/>")
    return "```xml\n" + "\n".join(lines) + "\n" + indents[-1] + "...\n```\n"


def links(paths):
    return ", ".join(f"[{path.stem}](../../{'/'.join(path.parts[-3:])})" for path in paths)


def who_uses(used, scenes):
    """One or two sentences on the shipped scenes and studies that use a plug-in."""
    in_scenes, in_studies = used
    others = [scene for scene in scenes if scene not in in_scenes]
    if not others:
        text = f"All {len(scenes)} shipped scenes use it"
    elif len(others) < len(scenes) / 2:
        text = f"{len(in_scenes)} of the {len(scenes)} shipped scenes use it: all but {links(others)}"
    elif in_scenes:
        text = f"Scenes that use it: {links(in_scenes)}"
    else:
        text = "No shipped scene uses it"
    few = 12
    more = f" and {len(in_studies) - few} more" if len(in_studies) > few else ""
    return text + (f".\n\nStudies: {links(in_studies[:few])}{more}.\n" if in_studies else "; nor does a study.\n" if not in_scenes else ".\n")


def contents(page):
    """Links to the lists of a long page: the upper two levels."""
    headings = [heading_of(page, section) for section in page.sections]
    upper = [heading for heading in headings if heading and heading.count("/") < 1]
    return " · ".join(f"[{heading}](#{anchor(heading)})" for heading in upper) + "\n" if len(upper) > 3 else ""


def plug_in_text(page, default, used, scenes):
    return "\n".join(part for part in (
        f"{HEAD}# {page.title}\n", f"{page.sections[0].documentation.rstrip('.')}.\n", how_to_choose(page, default),
        who_uses(used, scenes), contents(page), body(page)) if part)


def plain_text(page, introduction):
    return "\n".join(part for part in (f"{HEAD}# {page.title}\n", introduction, contents(page), body(page)) if part)


def index_text(pages, defaults, used, scenes):
    """The list of all pages, and of all parameters by name."""
    lines = [HEAD + "# Parameters\n", "One page a plug-in, both dimensions on one: what differs in 2D stands in brackets. "
             "`simulate --parameters` and `converge --parameters` print the same.\n",
             "- [What every scene may say](scene.md): the box and its sides, solver, time, output, view, constants, copies",
             "- [What a study may say](study.md)\n",
             "| list of a scene | plug-in | what it is for | scenes that use it |\n|---|---|---|---|"]
    for page in pages:
        if page.plug_in:
            place, kind = page.plug_in
            star = " (default)" if defaults.get(place) == kind else ""
            n_scenes = len(used.get(page.plug_in, ([], []))[0])
            lines.append(f"| `{re.sub(r' .Type [^/]*', '', place)}` | [{kind}]({page.name}.md){star} | "
                         f"{cell(page.sections[0].documentation)} | {n_scenes} of {len(scenes)} |")
    lines += ["\n## By name\n", "| parameter | where |\n|---|---|"]
    places = {}
    for page in pages:
        kind = KINDS[page.plug_in[0]][0].lower() if page.plug_in else ""
        for section in page.sections:
            for row in section.rows:
                places.setdefault(row[0], {}).setdefault(kind, {})[page.name] = page.plug_in[1] if page.plug_in else page.name
    for name in sorted(set(places) - {"Type"}, key=str.lower):
        where = "; ".join(f"{kind} ".lstrip() + ", ".join(f"[{short}]({page}.md)" for page, short in there.items())
                          for kind, there in places[name].items())
        lines.append(f"| {name} | {where} |")
    return "\n".join(lines) + "\n"
