"""Checks what the compiler does not: which floor a file may know, and what no file may mention.

Usage: check_layout.py ROOT; prints one line a violation and fails if there is any.
"""
import re
import sys
from pathlib import Path

CODE_FOLDERS = ["src", "packages", "drivers", "tests", "template"]
TEXT_FOLDERS = CODE_FOLDERS + ["cmake", "docs", "notebooks", "tools", "xml-params", ".ci"]
TEXT_SUFFIXES = {".cpp", ".hpp", ".txt", ".cmake", ".in", ".md", ".py", ".pyi", ".ipynb", ".toml", ".sh", ".xml", ".json", ".js", ".css", ".html", ""}

# The sibling packages that a package may include.
SIBLINGS = {
    "transport": {"grid"},
    "staggered": {"grid", "transport"},
    "liquid": {"grid", "transport", "staggered"},
    "mac": {"grid", "transport", "staggered", "liquid"},
    "cutcell": {"faces"},
    "mixedface": {"faces"},
    "articulated": {"rigid", "deformable"},
    "strategies": {"multigrid"},
}
# The rooms of src from the ground up; a room knows the rooms of the same row and those before it.
FLOORS = [{"base"}, {"parameters"}, {"output", "scenes"}, {"motion", "geometry"}, {"linear"}, {"interfaces"},
          {"solve"}, {"coupling"}, {"stepping"}, {"programs"}, {"studies"}]
HEIGHT = {room: height for height, row in enumerate(FLOORS) for room in row}
HEAVY = re.compile(r"^(Stratimikos|Teko|MueLu|Belos)")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')
# Split so that this file does not accuse itself.
FORBIDDEN = {
    "a path of one machine": re.compile(r"\.\./" r"shared|/" r"work/|/" r"tmp/|/" r"root/|/" r"home/\w"),
    "an unfinished mark": re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX)\b"),
}
CLASS = re.compile(r"^class (\w+)([^;{]*)\{(.*?)^\};", re.MULTILINE | re.DOTALL)
MOST_PURE = 12  # functions that a new plug-in must write, its name among them
MOST_FILES = 39  # files of a folder of src, so that its room can be seen at a glance
UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
# Definitions of such a namespace at the start of a line: constants and types by name, functions with their parameter types,
# too.
CONSTANT_OR_TYPE = re.compile(r"^(?:(?:struct|class|enum class|enum)\s+(\w+)[^;{]*\{|(?:const|constexpr)\b[^=({\n]*?(\w+)(?:\[\w*\])?\s*[={])", re.MULTILINE)
FUNCTION = re.compile(r"^(?!const\b[^(]*=)[A-Za-z][^;={}()#]*?\b(\w+)\(([^;{}]*?)\)(?: const)? \{", re.MULTILINE)
MOST_HOMES = 2  # .cpp files that define functions of one class
MOST_BASES = 4
MOST_PARAMETERS = 6
MOST_LINES = 500  # a class has: its declaration and its members in .cpp files
COMMENT = re.compile(r"//.*")
# A function, or a constructor, that a .cpp file defines at the start of a line: up to its parameters, and behind them.
DEFINITION = re.compile(r"^[A-Za-z_][^;{}()=#]*?\b(~?\w+)\(", re.MULTILINE)
BODY = re.compile(r"\s*(?:const)?\s*(?:noexcept)?\s*(?::[^{;]*)?\{")
# The class of a member function whose definition begins a line.
MEMBER = re.compile(r"^(?!template (?!<)|using |#|  )(?:[\w:<>,&*~\s\[\]]*?[\s&*])?([A-Z]\w*)(?:<[\w, ]*>)?::(?:~?\w+|operator[^\s(]+)\(", re.MULTILINE)
OWNED = re.compile(r"^[A-Za-z_][^;{}()=#]*?\b([A-Z]\w*)(?:<[\w, ]*>)?::~?\w+\(", re.MULTILINE)
DECLARED = re.compile(r"^(?:class|struct) (\w+)[^;{]*\{.*?^\};", re.MULTILINE | re.DOTALL)
INHERITING = re.compile(r"^\s*(?:class|struct) (\w+)(?: final)?\s*:\s*([^;{]*)\{", re.MULTILINE)
DECLARATION = re.compile(r"[\w>&*\]] (\w+)\(([^(){};]*(?:\([^()]*\)[^(){};]*)*)\)\s*(?:const)?\s*(?:noexcept)?\s*(?:override)?\s*(?:= 0)?\s*[;{]")
PARAMETER = re.compile(r"^(?:const )?[\w:]+(?:<.*>)?(?:::\w+)?[\s&*]+(?:/\*)?\w*(?:\*/)?(?: = [^=]*)?$", re.DOTALL)
CONSOLE = re.compile(r"\bstd::(cout|cerr)\b")


def source_files(root, suffixes, folders=CODE_FOLDERS):
    """All files below the folders of the tree at root whose suffix is one of these."""
    for folder in folders:
        for path in sorted((Path(root) / folder).rglob("*")):
            if path.is_file() and path.suffix in suffixes and "__pycache__" not in path.parts:
                yield path


def rooms(root, floor):
    folder = Path(root) / floor
    return {path.name for path in folder.iterdir() if path.is_dir()} if folder.is_dir() else set()


def include_violation(parts, include, packages):
    """Reason why a file at these path parts may not include this, or None."""
    target = include.split("/")[0]
    floor, room = parts[0], parts[1] if len(parts) > 2 else ""
    if floor in ("src", "packages") and target == "drivers":
        return "a library does not know the drivers"
    if floor == "src" and (target in packages or target == "packages"):
        return "src does not know the packages"
    if floor == "src" and HEIGHT.get(target, 0) > HEIGHT.get(room, len(FLOORS)):
        return f"src/{room} stands below src/{target}"
    if parts[:2] == ("packages", "shipped"):
        return None  # the list of all plug-ins
    if floor == "packages" and target in packages and target != room and target not in SIBLINGS.get(room, set()):
        return f"package {room} does not know package {target}"
    heavy_at_home = parts[:2] in (("src", "solve"), ("packages", "strategies")) and parts[-1].endswith(".cpp")
    if floor in ("src", "packages", "drivers") and HEAVY.match(include) and not heavy_at_home:
        return "heavy Trilinos headers belong in .cpp files of src/solve and packages/strategies"
    return None


def code_violations(path, root, packages):
    parts = path.relative_to(root).parts
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        reason = include_violation(parts, match.group(1), packages) if match else None
        if reason:
            yield f"{'/'.join(parts)}:{number}: {match.group(1)}: {reason}"
        if parts[0] in ("src", "packages") and parts[:2] != ("src", "programs") and CONSOLE.search(line):
            yield f"{'/'.join(parts)}:{number}: a library does not write to the console"


def text_violations(path, root):
    name = path.relative_to(root)
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        for what, pattern in FORBIDDEN.items():
            if pattern.search(line):
                yield f"{name}:{number}: {what}: {line.strip()[:80]}"


def interface_violations(path, root):
    """Interfaces that ask more of a plug-in than it must have; the rest belongs into side interfaces."""
    found = []
    for name, bases, body in CLASS.findall(path.read_text()):
        inherited = sum(base in bases for base in ("PlugIn", "OpenFractionRule"))
        n_pure = inherited + len(re.findall(r"= 0;", body))
        if n_pure > MOST_PURE:
            found.append(f"{path.relative_to(root)}: {name} has {n_pure} pure virtual functions, more than {MOST_PURE}")
    return found


def folder_violations(root):
    for folder in sorted(path for path in (root / "src").rglob("*") if path.is_dir() and path.name != "__pycache__"):
        n_files = sum(path.is_file() for path in folder.iterdir())
        if n_files > MOST_FILES:
            yield f"{folder.relative_to(root)}: {n_files} files, more than {MOST_FILES}: a room of its own for some of them"


def folder_loops(root):
    """The folders inside of a room are floors, too, and so are the files that stand in it beside them: who knows whom must
    not lead back."""
    knows = {}
    for path in source_files(root, {".cpp", ".hpp"}, ["src", "packages"]):
        *room, folder = (*path.relative_to(root).parts[:-1], "")[:3]
        for line in path.read_text().splitlines():
            match = INCLUDE.match(line)
            target = match.group(1).split("/") if match else []
            if target[:1] == room[1:2] and (other := target[1] if len(target) > 2 else "") != folder:
                knows.setdefault("/".join(room), {}).setdefault((folder, other), path.name)
    for room, edges in knows.items():
        reached = set(edges)
        while more := {(a, d) for a, b in reached for c, d in reached if b == c} - reached:
            reached |= more
        for (folder, other), file in edges.items():
            if (other, folder) in reached:
                yield f"{room}: {folder or 'what is in no folder'} knows {other or 'what is in no folder'} ({file}) in a loop"


def unnamed(text):
    """Names that the unnamed namespaces of a file define."""
    for part in UNNAMED.findall(text):
        for match in CONSTANT_OR_TYPE.finditer(part):
            yield match.group(1) or match.group(2)
        for name, parameters in FUNCTION.findall(part):
            types = [re.sub(r"\s*\w+$", "", parameter.strip()) for parameter in parameters.split(",")]
            yield f"{name}({', '.join(types)})"


def clashes(root):
    """A room may be compiled as one (LOCKSTEP_UNITY), so that no two of its files may define the same."""
    homes = {}
    for path in source_files(root, {".cpp"}, ["src", "packages", "tests/unit"]):
        parts = path.relative_to(root).parts
        room = parts[:3] if parts[0] == "tests" else parts[:2]
        for name in set(unnamed(path.read_text())):
            homes.setdefault((room, name), []).append("/".join(parts))
    for (_, name), files in homes.items():
        if len(files) > 1:
            yield f"{' and '.join(files)}: both define {name}: share it, or call one of them something else"


def listed(text):
    """The parts between commas that are in no brackets."""
    depth, parts = 0, [""]
    for c in text:
        depth += (c in "<([{") - (c in ">)]}")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts]


def definitions(text, pattern=DEFINITION):
    """(match, end of its parameters) of what a .cpp file without comments defines at the start of a line by such a pattern."""
    for match in pattern.finditer(text):
        end, depth = match.end(), 1
        while depth > 0 and end < len(text):
            depth += (text[end] == "(") - (text[end] == ")")
            end += 1
        if BODY.match(text, end):
            yield match, end


def sizes(root):
    """By name the .cpp files that classes are defined in, their bases, and the parameters of functions: the most that one has."""
    homes, bases, parameters = {}, {}, {}
    for path in source_files(root, {".cpp", ".hpp"}, ["src", "packages", "drivers"]):
        text = COMMENT.sub("", path.read_text())
        if path.suffix == ".cpp":
            for name in MEMBER.findall(text):
                homes.setdefault((path.relative_to(root).parts[:2], name), set()).add(path)
            for match, end in definitions(text):
                name, taken = match.group(1), listed(text[match.end():end - 1])
                if len(taken) > MOST_PARAMETERS:
                    parameters[name] = max(parameters.get(name, 0), len(taken))
        for name, of in INHERITING.findall(text):
            bases[name] = max(bases.get(name, 0), len(listed(of)))
        for name, of in DECLARATION.findall(text):
            taken = listed(of)
            if len(taken) > parameters.get(name, MOST_PARAMETERS) and all(map(PARAMETER.match, taken)):
                parameters[name] = len(taken)
    files = {}
    for (_, name), paths in homes.items():
        files[name] = max(files.get(name, 0), len(paths))
    return files, bases, parameters


def class_lines(root):
    """By name the lines of classes, which end where a line begins with their closing brace, as formatted code has it."""
    lines = {}
    for path in source_files(root, {".cpp", ".hpp"}, ["src", "packages", "drivers"]):
        text = COMMENT.sub("", path.read_text())
        room = path.relative_to(root).parts[:2]
        pieces = [(match.group(1), match.start(), match.end()) for match in DECLARED.finditer(text)]
        if path.suffix == ".cpp":
            pieces += [(match.group(1), match.start(), text.find("\n}\n", end)) for match, end in definitions(text, OWNED)]
        for name, begin, end in pieces:
            lines[room, name] = lines.get((room, name), 0) + text.count("\n", begin, end) + 1
    return {name: n for (_, name), n in sorted(lines.items(), key=lambda one: one[1])}


def size_violations(root):
    rules = [(".cpp files", MOST_HOMES), ("bases", MOST_BASES), ("parameters", MOST_PARAMETERS), ("lines", MOST_LINES)]
    for (what, most), found in zip(rules, (*sizes(root), class_lines(root))):
        for name, n in sorted(found.items()):
            if n > most:
                yield f"{name} has {n} {what}, more than {most}"


def violations(root):
    root = Path(root)
    packages = rooms(root, "packages")
    for path in source_files(root, {".cpp", ".hpp"}):
        yield from code_violations(path, root, packages)
    for path in sorted((root / "src" / "interfaces").glob("*.hpp")):
        yield from interface_violations(path, root)
    yield from folder_violations(root)
    yield from folder_loops(root)
    yield from clashes(root)
    yield from size_violations(root)
    # In a worktree .git is a file that holds a path.
    top = [path for path in sorted(root.iterdir())
           if path.is_file() and path.suffix in TEXT_SUFFIXES and path.name != ".git"]
    for path in [*source_files(root, TEXT_SUFFIXES, TEXT_FOLDERS), *top]:
        yield from text_violations(path, root)


if __name__ == "__main__":
    found = list(violations(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
