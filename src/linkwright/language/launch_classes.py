"""The classes of launch and launch_ros, with the arguments in their docstrings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from typing import Any

_MODULES = (
    "linkwright.launch.model.actions",
    "linkwright.launch.model.substitutions",
    "linkwright.launch.model.conditions",
    "linkwright.launch.model.description",
    "linkwright.launch.model.event_handlers",
    "linkwright.launch.model.process_event_handlers",
    "linkwright.launch.frontend.include",
    "linkwright.launch.frontend.sources",
    "linkwright.launch.ros",
)
_ARGUMENT = re.compile(r"^    (\w+): (.*(?:\n        .*)*)", re.MULTILINE)
_COMMON_ARGUMENTS = (
    *("package", "executable", "plugin", "name", "namespace", "output", "parameters", "remappings", "arguments"),
    *("launch_arguments", "default_value", "description", "condition"),
)
_HIDDEN = frozenset({"self", "kwargs", "unknown", "args"})


@cache
def _load_launch_classes() -> Mapping[str, Any]:
    meanings: dict[str, Any] = {}
    for module in map(import_module, _MODULES):
        for name, value in vars(module).items():
            if inspect.isclass(value) and value.__module__.startswith("linkwright.launch") and name[0] != "_":
                meanings.setdefault(name, value)
    return meanings


def load_classes() -> None:
    """Import the launch classes, and cache their arguments. The first import is slow."""
    for name in _load_launch_classes():
        class_arguments(name)


def describe_class(name: str) -> str | None:
    """Return the purpose and arguments of a launch class in Markdown, or None."""
    cls = _load_launch_classes().get(name)
    if cls is None:
        return None
    purpose, _, _ = (inspect.getdoc(cls) or "").partition("\nArgs:")
    arguments = [f"- `{argument}`: {meaning}" for argument, meaning in class_arguments(name).items() if meaning]
    return "\n\n".join(filter(None, (f"**{name}**: {_to_markdown(purpose.strip())}", "\n".join(arguments))))


@cache
def class_arguments(name: str) -> Mapping[str, str]:
    """Return the arguments of a launch class with their meanings in Markdown.

    Common arguments come first. A meaning that is not documented is empty. The mapping is empty if launch has no such
    class.
    """
    meanings: dict[str, str] = {}
    for cls in inspect.getmro(_load_launch_classes().get(name, object)):
        documented_arguments = {match[1]: match[2] for match in _ARGUMENT.finditer(inspect.getdoc(cls) or "")}
        for argument in _list_parameter_names(cls):
            meaning = documented_arguments.get(argument, "")
            if not meanings.get(argument):
                meanings[argument] = "" if meaning.startswith("see `") else _to_markdown(" ".join(meaning.split()))
    return dict(sorted(meanings.items(), key=lambda entry: _rank_argument(entry[0])))


def find_first_argument(name: str) -> str | None:
    """Return the name of the first positional argument of a class, or None."""
    cls = _load_launch_classes().get(name)
    try:
        parameters = [] if cls is None else [*inspect.signature(cls).parameters.values()]
    except (TypeError, ValueError):
        return None
    first = parameters[0] if parameters else None
    return first.name if first is not None and first.kind is first.POSITIONAL_OR_KEYWORD else None


def _rank_argument(argument: str) -> int:
    return _COMMON_ARGUMENTS.index(argument) if argument in _COMMON_ARGUMENTS else len(_COMMON_ARGUMENTS)


def _list_parameter_names(cls: Any) -> list[str]:
    constructor = vars(cls).get("__init__")
    if constructor is None or not cls.__module__.startswith("linkwright."):
        return []
    try:
        names = inspect.signature(constructor).parameters
    except (TypeError, ValueError):
        return []
    return [name for name in names if name not in _HIDDEN and not name.startswith("_")]


def _to_markdown(text: str) -> str:
    return text.replace("``", "`")
