"""Read the public functions and data members that a C++ header declares, with their types."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from linkwright.review.sources.cpp.types import normalize_type

_PREPROCESSOR = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", re.MULTILINE)
_SCOPE = re.compile(r"\b(?:class|struct)\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?(?::(?!:).*)?$", re.DOTALL)
_OPEN_SCOPE = re.compile(r"^(?:inline\s+)?namespace\b|^extern\s*\"")
_ACCESS = re.compile(r"(?:^|\s)(?P<access>public|protected|private)\s*(?:slots|Q_SLOTS)?$")
_FUNCTION = re.compile(r"(?P<name>~?\w+|operator\s*\S+)\s*\(")
_INITIALIZERS = re.compile(r"(?<=\))\s*(?:noexcept\s*)?:(?!:).*$", re.DOTALL)
_QUALIFIERS = re.compile(
    r"\s*(?:const|volatile|noexcept(?:\([^)]*\))?|override|final|&&?|=\s*0|=\s*default|->[^()]*|\s)*", re.DOTALL
)
_TRAILING_RESULT = re.compile(r"->(?P<type>[^=;{]+)")
_NOT_RESULT = re.compile(
    r"\[\[.*?\]\]|\b(?:virtual|static|inline|explicit|constexpr|extern|friend)\b|\b[A-Z]\w*_(?:PUBLIC|EXPORT|API|LOCAL|DECL)\b"
)
_PARAMETER = re.compile(r"(?P<type>.*[\s*&>])(?P<name>\w+)\s*(?P<array>\[\w*\])?", re.DOTALL)
_MEMBER = re.compile(r"(?P<type>[\w:][^()=]*[\s*&>])(?P<name>\w+)\s*(?:\[[^\]]*\]\s*)*", re.DOTALL)
_NOT_MEMBERS = frozenset(
    {*("class", "struct", "enum", "union", "using", "typedef", "friend", "template", "namespace", "operator", "extern")}
)
"""The first words of declarations that do not declare data members."""
_TYPE_KEYWORDS = frozenset({"const", "unsigned", "signed", "long", "struct", "typename", "short", "enum", "class"})
_QUALIFYING_WORDS = frozenset({"const", "struct", "typename", "enum", "class"})
_NOT_NAMES = _TYPE_KEYWORDS | {"int", "char", "double", "float", "bool"}
"""The words at the end of a parameter that are not its name."""
_KEYWORDS = frozenset({"if", "for", "while", "switch", "return", "sizeof", "decltype", "alignas", "static_assert"})
PUBLIC = frozenset({"public"})
PROTECTED = frozenset({"protected"})
PRIVATE = frozenset({"private"})
HIDDEN = PROTECTED | PRIVATE

_LEVELS = ("public", "protected", "private")
"""The levels of access, the most open one first."""
_OPENING = re.compile(r"[({\[<]")
_CLOSING = re.compile(r"[)}\]>]")
_BASE = re.compile(r"(?:^|,)\s*(?:(?:public|protected|private|virtual)\s+)*(?:\w+\s*::\s*)*(?P<name>\w+)")
_TEMPLATE_ARGUMENTS = re.compile(r"<[^<>]*>")


class DeclaredFunction(NamedTuple):
    """A function of a header.

    Attributes:
        name: the name, qualified by its class.
        parameters: the types of the parameters. A parameter with a default ends with ``= ...``.
        is_pure: whether derived classes must define it.
        is_override: whether it overrides a function of a base class, which determines its callers.
        is_const: whether it can be called on constant objects.
        result: the type that it returns; empty if it is unknown, as of constructors.
        start: the offset of the declaration.
        is_defined: whether the header has its code.
        parameter_names: the names of the parameters; empty for those without a name.
    """

    name: str
    parameters: tuple[str, ...]
    is_pure: bool
    is_override: bool
    is_const: bool
    result: str
    start: int
    is_defined: bool
    parameter_names: tuple[str, ...]


class _Scope(NamedTuple):
    name: str
    is_open: bool
    access: str


class DeclaredMember(NamedTuple):
    """A data member of a class in a header.

    Attributes:
        name: the name, qualified by its class.
        type: the declared type, without superfluous spaces.
        start: the offset of its name.
    """

    name: str
    type: str
    start: int


def read_declared_functions(text: str, access: Collection[str] = PUBLIC) -> Iterator[DeclaredFunction]:
    """Yield the functions that a header declares.

    Args:
        text: the text of the header without comments.
        access: the levels of access of the functions to yield.
    """
    for chunk, classes, start, end in _read_chunks(text, access):
        if "(" in chunk and not chunk.startswith(("using", "typedef", "friend")):
            for function in _read_function(chunk, classes, start):
                definition = re.compile(
                    rf"\b\w+\s*(?:<[^;{{}}()]*>\s*)?::\s*{re.escape(function.name.rpartition('::')[2])}\s*\("
                )
                is_defined = text[end] == "{" or definition.search(text, end) is not None
                yield function._replace(is_defined=is_defined)


def read_declared_members(text: str, access: Collection[str] = PUBLIC) -> Iterator[DeclaredMember]:
    """Yield the data members of the classes that a header declares.

    Args:
        text: the text of the header without comments.
        access: the levels of access of the members to yield.
    """
    for chunk, classes, start, _ in _read_chunks(text, access):
        declaration = re.sub(r"(?<!:):(?!:)\s*\d+$", "", chunk)
        items = list(split_parameters(declaration))
        first_match = _MEMBER.fullmatch(items[0].partition("=")[0].strip()) if items and classes else None
        if first_match is None or not _NOT_MEMBERS.isdisjoint((*first_match["type"].split(), first_match["name"])):
            continue
        type_name = re.sub(r"\s*([*&<>,:])\s*", r"\1", " ".join(first_match["type"].split()))
        for item in (first_match["name"], *(item.partition("=")[0].strip(" \n\t*&") for item in items[1:])):
            name_match = re.search(rf"\b{re.escape(item.partition('[')[0])}\b(?!\s*(?:::|<))", text[start:])
            if name_match is not None:
                name = "::".join([*classes, item.partition("[")[0]])
                yield DeclaredMember(name, type_name, start + name_match.start())


def read_scopes(text: str, access: Collection[str]) -> Iterator[tuple[list[str], int]]:
    """Yield the enclosing classes of each declaration with a body, and the offset of its opening brace.

    Args:
        text: the text of the header without comments.
        access: the levels of access of the declarations to yield.
    """
    for _, classes, _, end in _read_chunks(text, access):
        if text[end] == "{":
            yield classes, end


def read_base_names(text: str) -> list[str]:
    """Return the names of the base classes in the text between the colon and the body of a class.

    The names lack their namespaces and template arguments.
    """
    while _TEMPLATE_ARGUMENTS.search(text):
        text = _TEMPLATE_ARGUMENTS.sub("", text)
    return [match["name"] for match in _BASE.finditer(text)]


def _read_chunks(text: str, levels: Collection[str]) -> Iterator[tuple[str, list[str], int, int]]:
    """Yield the beginning of each declaration, its enclosing classes and the offsets of its beginning and end.

    Args:
        text: the text of the header without comments.
        levels: the levels of access of the declarations to yield.
    """
    text = _PREPROCESSOR.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    scopes: list[_Scope] = []
    start = depth = 0
    for index, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth > 0 or character not in ";{}:":
            continue
        depth = 0
        chunk = text[start:index].strip()
        access = _ACCESS.search(chunk) if character == ":" else None
        if character == ":":
            if access is not None and scopes:
                scopes[-1] = scopes[-1]._replace(access=access["access"])
                start = index + 1
            continue
        level = max((scope.access for scope in scopes), key=_LEVELS.index, default="public")
        if character != "}" and all(scope.is_open for scope in scopes) and level in levels:
            yield chunk, [scope.name for scope in scopes if scope.name], start, index
        if character == "{":
            scopes.append(_read_scope(chunk))
        elif character == "}" and scopes:
            scopes.pop()
        start = index + 1


def _read_scope(chunk: str) -> _Scope:
    """Return the scope that a text opens.

    Only namespaces and classes can contain public declarations.
    """
    if _OPEN_SCOPE.search(chunk):
        return _Scope("", is_open=True, access="public")
    match = _SCOPE.search(chunk)
    if match is None or re.search(r"\benum\b", chunk) or ("(" in chunk and ")" in chunk and ":" not in chunk):
        return _Scope("", is_open=False, access="private")
    is_struct = re.search(rf"\bstruct\s+(?:\w+\s+)?{match['name']}\b", chunk) is not None
    return _Scope(match["name"], is_open=True, access="public" if is_struct else "private")


def _read_function(chunk: str, classes: list[str], start: int) -> Iterator[DeclaredFunction]:
    """Yield the declared function, unless the declaration is something else."""
    declaration = _INITIALIZERS.sub("", chunk)
    for match in _FUNCTION.finditer(declaration):
        end = _find_closing_parenthesis(declaration, match.end() - 1)
        suffix = declaration[end + 1 :]
        is_name = match["name"] not in _KEYWORDS and not match["name"].isupper() and not match["name"].startswith("~")
        if end < 0 or not _QUALIFIERS.fullmatch(suffix) or not is_name or "=" in declaration[: match.start()]:
            continue
        if declaration[: match.start()].rstrip().endswith("::"):
            return  # the definition of a method that its class declares
        parameters, names = read_parameters(declaration[match.end() : end])
        name = "::".join([*classes, "".join(match["name"].split())])
        is_override = re.search(r"\b(?:override|final)\b", suffix) is not None
        is_pure = re.search(r"=\s*0\s*$", suffix) is not None
        is_const = re.match(r"\s*const\b", suffix) is not None
        result = _read_result(declaration[: match.start()], suffix)
        yield DeclaredFunction(
            name, parameters, is_pure, is_override, is_const, result, start, is_defined=False, parameter_names=names
        )
        return


def _read_result(prefix: str, suffix: str) -> str:
    """Return the type of the result of a function, from the texts before its name and behind its parameters."""
    trailing = _TRAILING_RESULT.search(suffix)
    text = trailing["type"] if trailing is not None else _NOT_RESULT.sub("", prefix)
    is_known = re.fullmatch(r"[\w:<>,*&\s]+", text) is not None and not re.search(
        r"\b(?:auto|template|operator)\b", text
    )
    return normalize_type(text) if is_known else ""


def read_parameters(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the types and the names of the parameters in the text between parentheses."""
    texts = list(split_parameters(text))
    return tuple(map(_parse_parameter_type, texts)), tuple(map(_parse_parameter_name, texts))


def _parse_parameter_type(text: str) -> str:
    """Return the type of a parameter, with a mark if it has a default."""
    value, _, default = text.partition("=")
    match = _match_parameter(text)
    type_name = normalize_type(value if match is None else match["type"] + (match["array"] or ""))
    return f"{type_name} = ..." if default else type_name


def _parse_parameter_name(text: str) -> str:
    match = _match_parameter(text)
    return "" if match is None else match["name"]


def _match_parameter(text: str) -> re.Match[str] | None:
    """Return the type and the name of a parameter, or None if it has no name."""
    match = _PARAMETER.fullmatch(text.partition("=")[0].strip())
    is_named = match is not None and set(match["type"].split()) - _QUALIFYING_WORDS and match["name"] not in _NOT_NAMES
    return match if is_named else None


def _find_closing_parenthesis(text: str, start: int) -> int:
    """Return the offset of the parenthesis that closes the parenthesis at an offset, or -1."""
    depth = 0
    for index in range(start, len(text)):
        depth += (text[index] == "(") - (text[index] == ")")
        if depth == 0:
            return index
    return -1


def split_parameters(text: str) -> Iterator[str]:
    """Yield the parameters in the text between parentheses."""
    depth = begin = 0
    for index, character in enumerate(text):
        depth += bool(_OPENING.match(character)) - bool(_CLOSING.match(character))
        if character == "," and depth == 0:
            yield text[begin:index]
            begin = index + 1
    if text[begin:].strip() not in ("", "void"):
        yield text[begin:]
