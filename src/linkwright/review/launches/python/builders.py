"""Compare objects that a chain of calls makes, such as ``MoveItConfigsBuilder("arm").robot_description(...)``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from linkwright.review.launches.outlines import BUILDER, Entry, LaunchOutline
from linkwright.review.texts.list_changes import nested_list_items

_BUILDER = re.compile(r"\b(?P<name>[A-Z]\w*Builder)(?=\()")
_METHOD = re.compile(r"\.(?P<name>\w+)(?=\()")
_KEYWORD = re.compile(r"(?P<name>\w+)=(?P<value>.*)", re.DOTALL)
_KEY = re.compile(r"(?P<name>[\w/]+): (?P<value>.*)", re.DOTALL)
_RESULTS = ("to_moveit_configs", "to_dict", "build")
"""The methods that end a chain. They have no settings."""
_DEFAULT_KEYWORDS = frozenset({"", "file_path", "pipelines"})
"""The keywords that say no more than the name of the method."""
_MAPPINGS = "mappings"
"""The keyword with the arguments of the description, each of which is a setting of its own."""


class _Chain(NamedTuple):
    """A chain of calls in a text: the name of the class, the whole text, and its settings."""

    name: str
    text: str
    settings: dict[str, str]


def separate_builders(old: LaunchOutline, new: LaunchOutline) -> tuple[LaunchOutline, LaunchOutline]:
    """Return two outlines with entries of their own for the object that both build.

    The actions that use it only name its class, so that a change to the object is reported once. Outlines that build
    no object of the same class, or several, stay as they are.
    """
    chains = [_find_chains(outline) for outline in (old, new)]
    if any(len(found) != 1 for found in chains) or chains[0][0].name != chains[1][0].name:
        return old, new
    return _separate(old, chains[0][0]), _separate(new, chains[1][0])


def _separate(outline: LaunchOutline, chain: _Chain) -> LaunchOutline:
    short = f"{chain.name}()"
    entries = [
        replace(entry, settings={name.replace(chain.text, short): value.replace(chain.text, short)
                                 for name, value in entry.settings.items()})
        for entry in outline.entries
    ]  # fmt: skip
    user = next(entry for entry in outline.entries if any(chain.text in text for text in _iterate_texts(entry)))
    return replace(outline, entries=[*entries, Entry(BUILDER, chain.name, chain.settings, user.span)])


def _find_chains(outline: LaunchOutline) -> list[_Chain]:
    """Return the different chains of calls in the settings of an outline."""
    found: dict[str, _Chain] = {}
    for text in (text for entry in outline.entries for text in _iterate_texts(entry)):
        for start in _BUILDER.finditer(text):
            chain = _read_chain(text, start)
            if chain is not None:
                found[chain.text] = chain
    return list(found.values())


def _iterate_texts(entry: Entry) -> Iterator[str]:
    yield from entry.settings
    yield from entry.settings.values()


def _read_chain(text: str, start: re.Match[str]) -> _Chain | None:
    """Return the chain that begins with the name of a class, or None if it is cut or has no calls of methods."""
    settings: dict[str, str] = {}
    name: str | None = None
    end = start.end()
    while True:
        close = _find_end(text, end)
        if close is None:
            return None
        arguments = nested_list_items(f"[{text[end + 1 : close - 1]}]")
        settings |= _split_arguments(name, arguments)
        end = close
        method = _METHOD.match(text, end)
        if method is None or name in _RESULTS:
            break
        name, end = method["name"], method.end()
    return None if name is None else _Chain(start["name"], text[start.start() : end], settings)


def _split_arguments(method: str | None, arguments: list[str]) -> dict[str, str]:
    """Return the settings that the arguments of a call give."""
    if not arguments:
        return {} if method is None or method in _RESULTS else {method: "()"}
    settings: dict[str, str] = {}
    for position, argument in enumerate(arguments):
        match = _KEYWORD.fullmatch(argument)
        keyword, value = ("", argument) if match is None else (match["name"], match["value"])
        items = [_KEY.fullmatch(item) for item in nested_list_items(f"[{value[1:-1]}]")]
        if keyword == _MAPPINGS and value.startswith("{") and all(items):
            settings |= {f"{_MAPPINGS} {item['name']}": item["value"] for item in items if item is not None}
            continue
        words = [word for word in (method, "" if keyword in _DEFAULT_KEYWORDS else keyword) if word]
        settings[" ".join(words) or f"argument {position + 1}"] = value
    return settings


def _find_end(text: str, start: int) -> int | None:
    """Return the index behind the parenthesis that closes the one at an index."""
    depth = 0
    for index in range(start, len(text)):
        depth += (text[index] == "(") - (text[index] == ")")
        if depth == 0:
            return index + 1
    return None
