"""The panels and topics that a perspective file of rqt contains."""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

_VALUES_BY_PACKAGE = {"rqt_image_view": "topic", "rqt_plot": "topics", "rqt_robot_steering": "topic"}
"""The setting of each plugin that becomes the positional arguments of its program, by package."""


def read_perspective(path: str) -> list[tuple[str, list[str]]]:
    """Return the plugins of a perspective file, each with its topics.

    Args:
        path: the file, which rqt writes as JSON; its values are literals of Python.

    Raises:
        LinkwrightError: LAUNCH144, the file cannot be read, or is not a perspective.
    """
    try:
        manager = json.loads(Path(path).read_text("utf-8"))["groups"]["pluginmanager"]
        running_plugins = _parse(manager["keys"]["running-plugins"])
        return [
            (plugin, list(_list_values(plugin, number, manager.get("groups", {}))))
            for plugin, numbers in running_plugins.items()
            for number in numbers
        ]
    except (OSError, ValueError, SyntaxError, KeyError, TypeError, AttributeError) as error:
        reason = getattr(error, "strerror", None) or error
        message = phrase("cannot read the perspective '{path}': {reason}", path=path, reason=foreign(reason))
        raise LinkwrightError(Diagnostic("LAUNCH144", message)) from None


def _list_values(plugin: str, number: int, groups: Mapping[str, Any]) -> Iterator[str]:
    """Yield the topics of a plugin, without those of its other windows."""
    name = f"plugin__{plugin.replace('/', '__')}__{number}"
    settings = groups.get(name, {}).get("groups", {}).get("plugin", {}).get("keys", {})
    setting = settings.get(_VALUES_BY_PACKAGE.get(plugin.partition("/")[0], ""))
    values = None if setting is None else _parse(setting)
    for value in [values] if isinstance(values, str) else values if isinstance(values, Sequence) else []:
        if isinstance(value, str) and value:
            yield value


def _parse(setting: Mapping[str, str]) -> Any:
    """Return the value of a setting."""
    return ast.literal_eval(setting["repr"])
