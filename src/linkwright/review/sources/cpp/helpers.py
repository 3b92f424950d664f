"""Find the functions and macros of C++ sources that make a topic, service, action or parameter from a given name."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from linkwright.review.sources.cpp.calls import Call, find_calls
from linkwright.review.sources.cpp.text import find_arguments, find_closing_bracket
from linkwright.review.sources.cpp.values import TEXT
from linkwright.review.sources.names import NameKind

_SUFFIX = r"\s*(?:const|noexcept|mutable|override|final|\s)*(?:->[^;{}()]*)?\{"
_DEFINITION = re.compile(
    r"\b(?P<lambda>\w+)\s*=\s*\[[^\[\]]*\]\s*(?=\()|[\w:>&*]\s+[&*]?(?:\w+(?:<[^<>()]*>)?::)*(?P<name>[A-Za-z_]\w*)\s*(?=\()"
)
_STRING = re.compile(
    r"\s*(?:const\s+)?(?:(?:std::)?string(?:_view)?|char)\s*(?:const\s*)?[&*]*\s*(?P<name>\w+)\s*(?:=.*)?", re.DOTALL
)
_PARAMETER = re.compile(r".*?\b(?P<name>\w+)\s*(?:=\s*(?P<default>.*?)\s*)?", re.DOTALL)
_JOINED = r"(?:\"(?P<before>[^\"\\]*)\"\s*\+\s*)?{name}(?:\.c_str\(\))?(?:\s*\+\s*\"(?P<after>[^\"\\]*)\")?"
_MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(?P<name>\w+)(?=\()", re.MULTILINE)
_IDENTIFIER = re.compile(r"\s*(?P<text>[A-Za-z_]\w*)\s*")
_VARIADIC, _REST = "...", "__VA_ARGS__"
_END_OF_MACRO = re.compile(r"(?<!\\)\n|\Z")
_TEMPLATE = re.compile(r"\btemplate\s*<(?P<names>[^;{}()]*)>[^;{}()]*\Z")
_MAX_HEAD_CHARACTERS = 300
_TEMPLATE_NAMES = re.compile(r"\b(?:typename|class)\s+(\w+)")
_RECEIVER = re.compile(r"(?P<name>\w+)\s*(?:\.|->)\s*(?:template\s+)?\Z")
_NO_FUNCTIONS = frozenset({"if", "for", "while", "switch", "return", "catch", "else", "new", "delete", "throw"})
KINDS_OF_NAMES = frozenset(
    {
        *(NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.CLIENT),
        *(NameKind.ACTION, NameKind.ACTION_CLIENT, NameKind.PARAMETER),
    }
)


class Helper(NamedTuple):
    """A function, lambda or macro that passes one of its parameters as a name.

    Attributes:
        name: the name of the function.
        is_macro: whether it is a macro, whose parameters may also be types.
        is_stringified: whether it is a macro that makes a text of the parameter with the name, as ``#x`` does.
        position: the index of the parameter with the name.
        call: the call inside of it that takes the name.
        before: the text that it puts before the name.
        after: the text that it puts behind the name.
        arguments: the texts of the other arguments of that call.
        parameters: the names of all parameters.
        defaults: the defaults of all parameters; empty for those without one.
        templates: the names of its template parameters.
        start: the offset of its name in its definition.
        end: the offset of the end of its body.
        receiver: the variable on which it makes the call; empty if there is none.
    """

    name: str
    is_macro: bool
    is_stringified: bool
    position: int
    call: Call
    before: str
    after: str
    arguments: tuple[str, ...]
    parameters: tuple[str, ...]
    defaults: tuple[str, ...]
    templates: tuple[str, ...]
    start: int
    end: int
    receiver: str = ""


class HelperUse(NamedTuple):
    """A call of a helper with a literal name, or of a macro with any.

    Attributes:
        call: the call inside of the helper, with the type that this call of the helper gives.
        name: the name, with the texts that the helper puts around it; empty for an expression.
        begin: the offset of the argument with the name.
        end: the end of that argument.
        arguments: the texts of the arguments of the inner call behind its name.
    """

    call: Call
    name: str
    begin: int
    end: int
    arguments: list[str]


def find_helpers(text: str) -> list[Helper]:
    """Return the helpers that a C++ source without comments defines.

    Functions that share their name but take the name elsewhere, and parameters that the body sets, are left out.
    """
    calls = [call for call in find_calls(text) if call.kind in KINDS_OF_NAMES and call.arguments]
    found: list[Helper] = []
    for match in _DEFINITION.finditer(text) if calls else ():
        name = match["lambda"] or match["name"]
        if name not in _NO_FUNCTIONS and name not in {call.function for call in calls}:
            found += _read_helper(text, match, name, calls)
    for match in _MACRO.finditer(text) if calls else ():
        found += _read_macro(text, match, calls)
    return [
        item for item in found if all(item.position == other.position for other in found if other.name == item.name)
    ]


def _read_helper(text: str, match: re.Match[str], name: str, calls: Sequence[Call]) -> Iterator[Helper]:
    opening = re.compile(_SUFFIX).match(text, find_closing_bracket(text, match.end()) + 1)
    if opening is None:
        return
    body = opening.end(), find_closing_bracket(text, opening.end() - 1)
    start = match.start("lambda" if match["lambda"] else "name")
    own = [call for call in calls if body[0] <= call.start < body[1]]
    yield from make_helpers(text, name, (start, match.end()), own, body)


def make_helpers(
    text: str,
    name: str,
    offsets: tuple[int, int],
    calls: Sequence[Call],
    body: tuple[int, int],
    names: Mapping[str, str] | None = None,
) -> Iterator[Helper]:
    """Yield a helper for each call that takes a text parameter of a function as its name.

    Args:
        text: the source without comments.
        name: the name of the function.
        offsets: the offsets of its definition and of its parameters.
        calls: the calls that the function makes.
        body: the offsets of its body.
        names: the variables that keep the parameters, by these; None for the parameters themselves.
    """
    start, position = offsets
    texts = [text[begin:end] for begin, end in find_arguments(text, position)]
    strings = {index: found["name"] for index, item in enumerate(texts) if (found := _STRING.fullmatch(item))}
    if not strings:
        return
    parameters = [_PARAMETER.fullmatch(item) for item in texts]
    all_names = tuple("" if item is None else item["name"] for item in parameters)
    defaults = tuple("" if item is None else item["default"] or "" for item in parameters)
    template = _TEMPLATE.search(text, max(0, start - _MAX_HEAD_CHARACTERS), start)
    templates = () if template is None else tuple(_TEMPLATE_NAMES.findall(template["names"]))
    for call in calls:
        given = text[slice(*call.arguments[0])].strip()
        others = tuple(text[slice(*argument)].strip() for argument in call.arguments[1:])
        receiver = _RECEIVER.search(text[max(0, call.start - _MAX_HEAD_CHARACTERS) : call.start])
        for index, string in strings.items():
            variable = string if names is None else names.get(string, "")
            joined = re.fullmatch(_JOINED.format(name=re.escape(variable)), given) if variable else None
            if joined is None or re.search(rf"\b{string}\s*\+?=(?!=)", text[slice(*body)]):
                continue
            yield Helper(
                name,
                is_macro=False,
                is_stringified=False,
                position=index,
                call=call,
                before=joined["before"] or "",
                after=joined["after"] or "",
                arguments=others,
                parameters=all_names,
                defaults=defaults,
                templates=templates,
                start=start,
                end=body[1],
                receiver="" if receiver is None else receiver["name"],
            )


def _read_macro(text: str, match: re.Match[str], calls: Sequence[Call]) -> Iterator[Helper]:
    names = tuple(text[slice(*item)].strip() for item in find_arguments(text, match.end()))
    body = find_closing_bracket(text, match.end()) + 1
    found = _END_OF_MACRO.search(text, body)
    end = len(text) if found is None else found.end()
    for call in calls:
        if not body <= call.start < end:
            continue
        given, *others = (" ".join(text[slice(*item)].replace("\\\n", " ").split()) for item in call.arguments)
        name = given.removeprefix("#").strip()
        if name in names:
            yield Helper(
                name=match["name"],
                is_macro=True,
                is_stringified=given.startswith("#"),
                position=names.index(name),
                call=call,
                before="",
                after="",
                arguments=tuple(others),
                parameters=names,
                defaults=("",) * len(names),
                templates=(),
                start=match.start("name"),
                end=end,
            )


def find_helper_uses(text: str, helpers: Sequence[Helper], *, is_own: bool) -> Iterator[HelperUse]:
    """Yield the calls of helpers with literal names in a C++ source without comments.

    Args:
        text: the source.
        helpers: the helpers that it or a header defines.
        is_own: whether the source itself defines them.
    """
    for helper in helpers:
        pattern = re.compile(
            rf"(?P<receiver>(?:->|\.)\s*)?\b{helper.name}\s*(?P<types><(?:[^<>;(){{}}]|<[^<>;(){{}}]*>)*>\s*)?(?=\()"
        )
        for match in pattern.finditer(text):
            is_of_other = match["receiver"] and not re.search(r"\bthis\s*$", text[: match.start()][-20:])
            if is_of_other or (is_own and helper.start == match.start()):
                continue
            use = make_use(text, helper, list(find_arguments(text, match.end())), match["types"] or "")
            if use is not None:
                yield use


def make_use(text: str, helper: Helper, arguments: Sequence[tuple[int, int]], types: str) -> HelperUse | None:
    """Return the use of a helper in a call with the offsets of its arguments; None if no literal gives the name.

    Args:
        text: the source that has the call.
        helper: the helper.
        arguments: the offsets of the arguments.
        types: the template arguments in angle brackets; empty if there are none.
    """
    is_variadic = helper.parameters[-1:] == (_VARIADIC,)
    if not helper.position < len(arguments) <= (len(arguments) if is_variadic else len(helper.parameters)):
        return None
    begin, end = arguments[helper.position]
    literal = (_IDENTIFIER if helper.is_stringified else TEXT).fullmatch(text[begin:end])
    if not helper.is_macro and (literal is None or not literal["text"]):
        return None
    given = [text[slice(*argument)].strip() for argument in arguments]
    values = dict(zip(helper.parameters, helper.defaults, strict=True))
    values.update(zip(helper.parameters, given, strict=False))
    values[_REST] = ", ".join(given[len(helper.parameters) - 1 :])
    values.update(zip(helper.templates, [item.strip() for item in types.strip()[1:-1].split(",")], strict=False))
    unknown = "" if helper.call.type in helper.templates else helper.call.type
    type_name = values.get(helper.call.type, unknown) if helper.call.type else ""
    texts = [values.get(item, item) for item in helper.arguments]
    name = "" if literal is None else f"{helper.before}{literal['text']}{helper.after}"
    return HelperUse(helper.call._replace(type=type_name), name, begin, end, texts)
