"""Find the parameters that sources read with their own functions, and SDF elements."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

_TEMPLATE = r"(?:<[^<>()]*(?:<[^<>]*>)?[^<>()]*>\s*)?"
_VERB = r"(?:get|read|load|declare|retrieve|fetch|init|require|register)"
_TYPED = r"declare_?(?:[dD]ouble|[iI]nt(?:eger)?|[bB]ool|[sS]tring|[fF]loat)(?:_?[aA]rray|_?[vV]ector)?"
"""A function that declares a parameter of a type, such as ``declare_double``."""
_FUNCTION = re.compile(
    rf"_?{_VERB}(?:\w*_)?(?:[Pp]aram|[Pp]arameter)_?|_?{_VERB}\w*[a-z](?:Param|Parameter)_?|{_TYPED}"
)
_CALL = re.compile(rf"\b(?P<name>\w*[Pp]aram(?:eter)?_?|{_TYPED})\s*{_TEMPLATE}(?=\()")
_NAME = re.compile(r"[~/]?[A-Za-z]\w*(?:[./]\w+)*")
_FILE = re.compile(r".*\.(?:ya?ml|json|xml|urdf|srdf)")
_SDF = r"\b\w*[sS][dD][fF]\w*"
_READ = rf"\s*(?:->|\.)\s*(?:Get(?:Element|Attribute)?|Has(?:Element|Attribute)|FindElement)\s*{_TEMPLATE}\(\s*"
_ELEMENT = (
    rf"{{receiver}}{_READ}\"(?P<own>\w+)\"|"
    rf"\b\w*Param\w*\s*{_TEMPLATE}\(\s*\*?{{receiver}}\s*,\s*\"(?P<passed>\w+)\""
)
"""The pattern of a read element; ``{receiver}`` is the pattern of the variables with elements."""
_CHAINED = re.compile(rf"\b(?:Get|GetNext|GetFirst|Find)Element\s*\([^()]*\)(?={_READ}\"(?P<own>\w+)\")")
"""An element that is read from another one in the same expression, such as ``sdf->GetElement("a")->Get<int>("b")``."""
_CONSTANT_ELEMENT = rf"{{receiver}}{_READ}(?P<constant>[A-Za-z_]\w*)\s*(?:\[[^\[\]]*\]\s*)?(?=[,)])"
_TEXTS = r"\b{name}\s*(?:\[[^\[\]]*\]\s*)?=?\s*(?:\{{\s*)?\"\w+\"(?:\s*,\s*\"\w+\")*\s*(?:,\s*)?\}}?\s*;"
"""The definition of a constant text or of an array of them."""
_DECLARED = re.compile(
    r"(?:\bsdf\s*::\s*Element(?:Const)?Ptr|\bshared_ptr\s*<\s*(?:const\s+)?sdf\s*::\s*Element(?:\s+const)?\s*>)"
    r"\s*(?:const\s*)?&?\s*(?P<name>\w+)\s*[=;,){(]"
)
_ASSIGNED = re.compile(
    r"\b(?P<name>\w+)\s*=\s*(?:this\s*->\s*)?(?P<receiver>\w+)\s*(?:->|\.)\s*"
    r"(?:GetElement|GetNextElement|GetFirstElement|FindElement)\s*\("
)
_GAZEBO = re.compile(r"\b\w*gazebo_ros\w*\s*(?:->|\.)\s*$")
_DEFAULT = re.compile(r"\s*,\s*(?P<value>-?[\d.]+(?:e-?\d+)?f?|true|false|\"[^\"\\]*\")\s*[,)]")
_MAX_BRANCH_CHARACTERS = 400


class ReadElement(NamedTuple):
    """An element of SDF that a plugin reads.

    Attributes:
        name: the tag of the element.
        default: the literal default; empty if there is none.
        start: the offset of the tag.
    """

    name: str
    default: str
    start: int


def reads_parameter(function: str) -> bool:
    """Return whether a function name such as ``getRequiredParam`` means to read a parameter."""
    return _FUNCTION.fullmatch(function) is not None


def is_parameter_name(text: str) -> bool:
    """Return whether a text can be the name of a parameter, and not that of a file."""
    return _NAME.fullmatch(text) is not None and _FILE.fullmatch(text) is None


def is_known_to_be_set(text: str, name: str, position: int) -> bool:
    """Return whether a call is in the branch of a condition that a parameter is set, so that its default is unused.

    Args:
        text: the source without comments.
        name: the name of the parameter.
        position: the offset of the call.
    """
    call = rf"(?:hasParam|has_parameter|has)\s*\(\s*\"[~/]*{re.escape(name)}\"\s*\)"
    condition = rf"\bif\s*\([^;{{}}!|]*\b{call}[^;{{}}|]*\{{?[^{{}}]*\Z"
    return re.search(condition, text[max(0, position - _MAX_BRANCH_CHARACTERS) : position]) is not None


class HelperCall(NamedTuple):
    """A call of a function that reads a parameter.

    Attributes:
        function: the name of the function.
        start: the offset of the parenthesis before its arguments.
        is_of_plugin: whether it reads an element of SDF, as the functions of ``gazebo_ros`` do.
    """

    function: str
    start: int
    is_of_plugin: bool


def find_helper_calls(text: str) -> Iterator[HelperCall]:
    """Yield the calls of functions that read parameters in a C++ source without comments."""
    for match in _CALL.finditer(text):
        if reads_parameter(match["name"]):
            is_of_plugin = _GAZEBO.search(text, max(0, match.start() - 40), match.start()) is not None
            yield HelperCall(match["name"], match.end(), is_of_plugin)


def read_elements(text: str) -> Iterator[ReadElement]:
    """Yield the elements of SDF that a C++ source of a plugin reads.

    Args:
        text: the source without comments.
    """
    names = "".join(rf"|\b{name}\b" for name in sorted(_find_elements(text)))
    receiver = f"(?:{_SDF}{names})"
    matches = [*re.finditer(_ELEMENT.replace("{receiver}", receiver), text)]
    for name in dict.fromkeys(re.findall(_CONSTANT_ELEMENT.replace("{receiver}", receiver), text)):
        for definition in re.finditer(_TEXTS.format(name=name), text):
            for item in re.finditer(r'"(\w+)"', definition[0]):
                yield ReadElement(item[1], "", definition.start() + item.start(1))
    if matches:  # other libraries have elements, too
        matches += _CHAINED.finditer(text)
    for match in matches:
        group = "own" if match["own"] is not None else "passed"
        default = _DEFAULT.match(text, match.end(group) + 1)
        yield ReadElement(match[group], "" if default is None else default["value"], match.start(group))


def _find_elements(text: str) -> set[str]:
    """Return the variables of a C++ source that are declared as elements of SDF or taken from other elements."""
    names = {match["name"] for match in _DECLARED.finditer(text)}
    for match in _ASSIGNED.finditer(text):
        if match["receiver"] in names or re.fullmatch(_SDF, match["receiver"]):
            names.add(match["name"])
    return names
