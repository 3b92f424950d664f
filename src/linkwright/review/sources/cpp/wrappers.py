"""Find classes of C++ whose constructor makes a topic, service, parameter or node with a name that it is given."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.packages import enclosing_package
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.cpp.calls import Call, find_calls
from linkwright.review.sources.cpp.helpers import KINDS_OF_NAMES, Helper, HelperUse, make_helpers, make_use
from linkwright.review.sources.cpp.text import blank_comments, find_arguments, find_closing_bracket
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, NameKind

_CLASS = re.compile(r"\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?(?::(?!:)[^;{}()]*)?\{")
_DEFINED_CONSTRUCTOR = re.compile(r"\b(?P<name>[A-Za-z_]\w*)\s*(?:<[^<>;(){}]*>)?\s*::\s*(?P=name)\s*(?=\()")
_INITIALIZERS = re.compile(r"\s*(?:noexcept\s*)?:(?!:)")
_INITIALIZER = re.compile(r"\s*[\w:]+\s*(?:<[^;(){}]*>\s*)?(?=[({])")
_COMMA = re.compile(r"\s*(?:\.\.\.\s*)?,")
_BODY = re.compile(r"\s*(?:noexcept\s*)?(?:try\s*)?\{")
_METHOD = re.compile(r"\b(?P<name>[A-Za-z_]\w*)\s*(?:<[^<>;(){}]*>)?\s*::\s*~?\w+\s*\([^;{}]*\{")
_KEPT = (
    r"(?:\b(?P<initialized>\w+)\s*[({{]\s*(?:std::move\s*\(\s*)?{name}\s*\)?\s*[)}}]|"
    r"\b(?P<assigned>\w+)\s*=\s*(?:std::move\s*\(\s*)?{name}\s*\)?\s*;)"
)
"""A member that gets a parameter of the constructor and nothing else."""
_TYPES = r"(?P<types><(?:[^<>;(){{}}]|<[^<>;(){{}}]*>)*>\s*)?"
_CONSTRUCTION = (
    rf"(?<![\w~.>])(?:make_(?:unique|shared)\s*<\s*(?:\w+::)*{{name}}\s*{_TYPES.replace('types', 'made')}>\s*|"
    rf"(?:\w+::)*{{name}}\s*{_TYPES}(?:\s\w+\s*)?)(?=[({{{{])"
)
"""The construction of an object, before its arguments: a variable, a temporary object or one behind a pointer."""
_DECLARATION = rf"(?<![\w~.>])(?:\w+::)*{{name}}\s*{_TYPES}\s(?P<variable>\w+)\s*;"
_NODE_BASE = re.compile(r"(?<!:)[:,]\s*(?:rclcpp(?:_lifecycle)?\s*::\s*)?(?P<name>(?:Lifecycle)?Node)\s*(?=[({])")
_MAX_BYTES = 1 << 20


def find_wrappers(text: str) -> list[Helper]:
    """Return the constructors in a C++ source without comments that make a name which their callers pass.

    Constructors of a class that take the name in different places are left out.
    """
    calls = [call for call in find_calls(text) if call.kind in KINDS_OF_NAMES and call.arguments]
    calls += _find_node_constructions(text)
    found = [
        helper
        for name, start, end in _find_constructors(text, calls)
        for helper in _read(text, name, start, end, calls)
    ]
    return [item for item in found if all(item.position == other.position for other in found if _is_same(item, other))]


def _find_node_constructions(text: str) -> Iterator[Call]:
    """Yield the constructions of a node in the initializer lists of classes that derive from it."""
    for match in _NODE_BASE.finditer(text):
        arguments = list(find_arguments(text, match.end()))
        if arguments:
            yield Call(NameKind.NODE, "Node", "", "", arguments, "", match.start("name"), is_action=False)


def _is_same(first: Helper, second: Helper) -> bool:
    return first.name == second.name and first.call.start == second.call.start


def _find_constructors(text: str, calls: Sequence[Call]) -> Iterator[tuple[str, int, int]]:
    """Yield the class of each defined constructor, with the offsets of its name and of its parameters."""
    if not calls:
        return
    for match in _DEFINED_CONSTRUCTOR.finditer(text):
        yield match["name"], match.start(), match.end()
    for declared in _CLASS.finditer(text):
        end = find_closing_bracket(text, declared.end() - 1)
        for match in re.finditer(rf"(?<![\w~.>:]){declared['name']}\s*(?=\()", text[declared.end() : end]):
            yield declared["name"], declared.start(), declared.end() + match.end()


def _read(text: str, name: str, start: int, parameters: int, calls: Sequence[Call]) -> Iterator[Helper]:
    """Yield what a constructor makes, also in methods of its class from members that keep a parameter."""
    closing = find_closing_bracket(text, parameters)
    end = _find_end(text, closing + 1)
    if end is None:
        return
    members = dict(_find_members(text, parameters, (closing, end)))
    kept = {member: parameter for parameter, member in members.items()}
    offsets, body = (start, parameters), (closing + 1, end)
    own = [call for call in calls if closing < call.start < end]
    others = [call for call in calls if call not in own and _is_in_class(text, name, call.start)] if members else []
    for helper in (
        *make_helpers(text, name, offsets, own, body),
        *make_helpers(text, name, offsets, [*own, *others], body, members),
    ):
        yield helper._replace(receiver=kept.get(helper.receiver, helper.receiver))


def _find_members(text: str, parameters: int, body: tuple[int, int]) -> Iterator[tuple[str, str]]:
    """Yield the parameters of a constructor, each with a member that only it sets.

    Args:
        text: the source without comments.
        parameters: the offset of the parameters.
        body: the offsets of the initializers and the body.
    """
    for begin, end in find_arguments(text, parameters):
        parameter = re.search(r"(\w+)\s*(?:=.*)?\Z", text[begin:end].strip(), re.DOTALL)
        kept = None if parameter is None else re.search(_KEPT.format(name=parameter[1]), text[slice(*body)])
        if parameter is not None and kept is not None:
            member = kept["initialized"] or kept["assigned"]
            if len(re.findall(rf"\b{member}\s*\+?=(?!=)", text)) <= (kept["assigned"] is not None):
                yield parameter[1], member


def _find_end(text: str, position: int) -> int | None:
    """Return the offset of the end of the body of a constructor, or None if it is only declared."""
    initializers = _INITIALIZERS.match(text, position)
    if initializers is not None:
        position = initializers.end()
        while initializer := _INITIALIZER.match(text, position):
            position = find_closing_bracket(text, initializer.end()) + 1
            comma = _COMMA.match(text, position)
            if comma is None:
                break
            position = comma.end()
    body = _BODY.match(text, position)
    return None if body is None else find_closing_bracket(text, body.end() - 1)


def _is_in_class(text: str, name: str, position: int) -> bool:
    """Return whether the code at an offset is in a method of a class."""
    for match in _CLASS.finditer(text):
        if match["name"] == name and match.end() <= position < find_closing_bracket(text, match.end() - 1):
            return True
    methods = [match for match in _METHOD.finditer(text) if match.end() <= position]
    return (
        bool(methods) and methods[-1]["name"] == name and position < find_closing_bracket(text, methods[-1].end() - 1)
    )


def find_wrapper_uses(text: str, headers: Sequence[str], wrappers: Sequence[Helper]) -> Iterator[HelperUse]:
    """Yield the constructions of wrapper classes with literal names in a C++ source without comments.

    Args:
        text: the source.
        headers: the texts of the headers that may declare members of its classes.
        wrappers: the constructors.
    """
    for wrapper in wrappers:
        name = re.escape(wrapper.name)
        constructions = [
            (match.start(), match.end(), match["types"] or match["made"] or "")
            for match in re.finditer(_CONSTRUCTION.format(name=name), text)
        ]
        for declared in (
            found for source in (*headers, text) for found in re.finditer(_DECLARATION.format(name=name), source)
        ):
            pattern = rf"(?<![\w.>])(?:this->)?{declared['variable']}\s*(?=[({{])"
            constructions += [
                (match.start(), match.end(), declared["types"] or "") for match in re.finditer(pattern, text)
            ]
        for start, end, types in dict.fromkeys(constructions):
            use = make_use(text, wrapper, list(find_arguments(text, end)), types)
            if use is not None:
                yield use._replace(call=_make_call(use, wrapper, text, start, end))


def _make_call(use: HelperUse, wrapper: Helper, text: str, start: int, end: int) -> Call:
    """Return the call of a wrapper, on the node handle that the construction passes."""
    arguments = [text[slice(*argument)].strip() for argument in find_arguments(text, end)]
    given = dict(zip(wrapper.parameters, arguments, strict=False))
    return use.call._replace(start=start, node=given.get(wrapper.receiver, ""))


def read_sources_of_headers(path: Path, text: str) -> list[str]:
    """Return the texts, without comments, of the sources of the package that define the included classes.

    Such a source has the name of an included header, and is beside the including source or below the folder ``src``.

    Args:
        path: the path of the source that includes the headers.
        text: its text.
    """
    package = enclosing_package(path.parent)
    if path.suffix in HEADER_SUFFIXES or package is None:
        return []
    stems = re.findall(r'^[ \t]*#[ \t]*include[ \t]*["<](?:[^">\n]*/)?(\w+)\.(?:hpp|hh|hxx|h)[">]', text, re.MULTILINE)
    return [
        blank_comments(file.read_text("utf-8", errors="replace"))
        for file in find_sources_of_headers(package[1], path.parent, stems)
        if file != path
    ]


def find_sources_of_headers(package: Path, folder: Path, stems: Sequence[str]) -> list[Path]:
    """Return the sources of a package in a folder, or below the folder ``src``, that have the names of headers."""
    suffixes = [suffix for suffix in CPP_SUFFIXES if suffix not in HEADER_SUFFIXES]
    names = list(dict.fromkeys(f"{stem}{suffix}" for stem in stems for suffix in suffixes))
    below = _list_files_by_name(package / "src")
    files = [*(folder / name for name in names), *sorted(file for name in names for file in below.get(name, ()))]
    return [
        file
        for file in dict.fromkeys(files)
        if file.is_file() and not file.is_symlink() and file.stat().st_size <= _MAX_BYTES
    ]


@cached_in_review(maxsize=16)
def _list_files_by_name(folder: Path) -> Mapping[str, list[Path]]:
    """Return the files below a folder by their names. All sources of a package search the same folder."""
    files: dict[str, list[Path]] = {}
    for file in folder.rglob("*"):
        files.setdefault(file.name, []).append(file)
    return files
