"""Read the command-line options of a C++ source: TCLAP, Boost, cxxopts, CLI11, argparse, gflags, Abseil and getopt."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.names import YES, Detail

_TCLAP = re.compile(
    r"\b(?P<tclap>TCLAP::)?(?P<class>ValueArg|MultiArg|SwitchArg|MultiSwitchArg)\s*(?:<[^;(){}]*>)?[\s>]*(?:\w+\s*)?[({]"
)
_GROUP = re.compile(r"\badd_options\s*\(")
_METHOD = re.compile(r"[.>]\s*(?P<name>add_(?:option|flag|argument)(?:_function|_callback)?)\s*(?:<[^;(){}]*>)?\s*\(")
_FLAG = re.compile(r"\b(?P<absl>ABSL_FLAG|DEFINE_(?:bool|u?int32|u?int64|double|string))\s*\(")
_GETOPT = re.compile(r"\bgetopt(?:_long|_long_only)?\s*\(")
_LONG_OPTION = re.compile(
    r"\{\s*\"(?P<name>[\w-]+)\"\s*,\s*(?P<value>no_argument|required_argument|optional_argument|[012])\s*,[^{}\"]*\}"
)
_TEXT = re.compile(r'\s*"(?P<text>[^"\\]*)"\s*')
_DEFAULT = re.compile(r"(?:->|\.)\s*(?:default_val(?:ue)?|implicit_default)\s*\(")
_REQUIRED = re.compile(r"(?:->|\.)\s*required\s*\(\s*(?:true\s*)?\)")
_CLI_NAME = re.compile(r"!?(?P<name>--?[\w?-][\w.-]*)(?:\{[^}]*\})?")
_MAX_DEFAULT_CHARACTERS = 80

FindArguments = Callable[[str, int], Iterator[tuple[int, int]]]


class Option(NamedTuple):
    """An option that callers pass.

    Attributes:
        name: the name with its dashes.
        default: the default as code; empty if it is unknown.
        start: the offset of the name.
        end: the offset behind the name.
        details: the other properties.
    """

    name: str
    default: str
    start: int
    end: int
    details: tuple[tuple[Detail, str], ...] = ()


def find_options(text: str, find_arguments: FindArguments) -> Iterator[Option]:
    """Yield the command-line options of a C++ source.

    Args:
        text: the source without comments.
        find_arguments: the function that yields the offsets of the arguments in parentheses.
    """
    if "tclap" in text.lower():
        yield from _find_tclap(text, find_arguments)
    yield from _find_groups(text, find_arguments)
    yield from _find_methods(text, find_arguments)
    for match in _FLAG.finditer(text):
        arguments = list(find_arguments(text, match.end() - 1))
        index = 1 if match["absl"] == "ABSL_FLAG" else 0
        if len(arguments) == index + 3:
            start, end = arguments[index]
            name = text[start:end].strip()
            if re.fullmatch(r"\w+", name):
                yield Option(f"--{name}", _get_code(text, arguments[index + 1]), start, end)
    yield from _find_getopt(text, find_arguments)


def _find_tclap(text: str, find_arguments: FindArguments) -> Iterator[Option]:
    """Yield the options of TCLAP: flag, name, description; for values also whether it is required and the default."""
    has_namespace = re.search(r"\busing\s+namespace\s+TCLAP\b", text) is not None
    for match in _TCLAP.finditer(text):
        if match["tclap"] is None and not has_namespace:
            continue
        arguments = list(find_arguments(text, match.end() - 1)) if text[match.end() - 1] == "(" else []
        if len(arguments) < 3:
            continue
        flag, name = (_get_text(text, argument) for argument in arguments[:2])
        if flag is None or name is None or not flag + name:
            continue
        values = [_get_code(text, argument) for argument in arguments[3:]]
        is_required = match["class"] in ("ValueArg", "MultiArg") and values[:1] == ["true"]
        default = ""
        if match["class"] == "ValueArg" and len(values) > 1 and not is_required:
            default = values[1]
        elif match["class"] == "SwitchArg":
            default = next((value for value in values if value in ("true", "false")), "false")
        yield _make_option(f"--{name}" if name else f"-{flag}", default, arguments[1], is_required=is_required)


def _find_groups(text: str, find_arguments: FindArguments) -> Iterator[Option]:
    """Yield the options of Boost and cxxopts: ``add_options()("name,n", value, ...)``."""
    for match in _GROUP.finditer(text):
        position = _skip_parentheses(text, match.end() - 1, find_arguments)
        while position is not None:
            position = _skip_space(text, position)
            if text[position : position + 1] != "(":
                break
            arguments = list(find_arguments(text, position))
            names = _get_text(text, arguments[0]) if arguments else None
            words = [word.strip() for word in (names or "").split(",")]
            if arguments and all(re.fullmatch(r"[\w?.-]+", word) for word in words):
                longest = max(words, key=len)
                code = " ".join(text[start:end] for start, end in arguments[1:])
                name = f"--{longest}" if len(longest) > 1 else f"-{longest}"
                yield _make_chained_option(name, code, arguments[0], find_arguments)
            position = _skip_parentheses(text, position, find_arguments)


def _find_methods(text: str, find_arguments: FindArguments) -> Iterator[Option]:
    """Yield the options of CLI11 (``"-n,--name"``) and argparse (``"-n", "--name"``), which end with a semicolon."""
    for match in _METHOD.finditer(text):
        arguments = list(find_arguments(text, match.end() - 1))
        if match["name"] == "add_argument":
            texts = [_get_text(text, argument) for argument in arguments]
            names = [name for name in texts if name is not None]
        else:
            names = [name.strip() for name in (_get_text(text, arguments[0]) or "").split(",")] if arguments else []
        matches = [_CLI_NAME.fullmatch(name) for name in names]
        found = [name["name"] for name in matches if name is not None]
        if not found:
            continue
        end = _skip_parentheses(text, match.end() - 1, find_arguments)
        code = "" if end is None else text[end:].partition(";")[0]
        yield _make_chained_option(max(found, key=len), code, arguments[0], find_arguments)


def _find_getopt(text: str, find_arguments: FindArguments) -> Iterator[Option]:
    """Yield the options of getopt: the letters of its third argument, and the names of ``struct option``."""
    calls = list(_GETOPT.finditer(text))
    for match in calls:
        arguments = list(find_arguments(text, match.end() - 1))
        letters = _get_text(text, arguments[2]) if len(arguments) > 2 else None
        start, end = arguments[2] if len(arguments) > 2 else (0, 0)
        for letter in re.findall(r"[A-Za-z0-9?]", letters or ""):
            yield Option(f"-{letter}", "", start, end)
    for match in _LONG_OPTION.finditer(text) if calls else ():
        yield Option(f"--{match['name']}", "", match.start("name"), match.end("name"))


def _make_chained_option(name: str, code: str, argument: tuple[int, int], find_arguments: FindArguments) -> Option:
    """Return an option whose default and requirement are calls behind it, such as ``->default_value(1)``."""
    default = _DEFAULT.search(code)
    values = [] if default is None else list(find_arguments(code, default.end() - 1))
    text = _get_code(code, values[0]) if values else ""
    return _make_option(name, text, argument, is_required=_REQUIRED.search(code) is not None)


def _make_option(name: str, default: str, argument: tuple[int, int], *, is_required: bool) -> Option:
    details = ((Detail.REQUIRED, YES),) if is_required else ()
    return Option(name, default, *argument, details)


def _get_text(text: str, argument: tuple[int, int]) -> str | None:
    match = _TEXT.fullmatch(text[slice(*argument)])
    return None if match is None else match["text"]


def _get_code(text: str, argument: tuple[int, int]) -> str:
    """Return the code of an argument in one line; empty if it is long."""
    code = " ".join(text[slice(*argument)].split())
    return code if len(code) <= _MAX_DEFAULT_CHARACTERS else ""


def _skip_parentheses(text: str, start: int, find_arguments: FindArguments) -> int | None:
    """Return the offset behind the parentheses that begin at an offset, or None if they do not end."""
    arguments: Sequence[tuple[int, int]] = list(find_arguments(text, start))
    end = text.find(")", arguments[-1][1] if arguments else start)
    return None if end < 0 else end + 1


def _skip_space(text: str, position: int) -> int:
    while position < len(text) and text[position].isspace():
        position += 1
    return position
