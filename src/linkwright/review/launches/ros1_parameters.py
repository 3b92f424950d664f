"""The parameters that ``<rosparam>`` of ROS 1 sets: those of a file, and those that are written in it as YAML."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import yaml

from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.yaml_values import YamlValue, composed, yaml_values

_DEFAULT_COMMAND = "load"
_NULL = "null"
_NULL_TEXTS = ("", "~", _NULL)
WRITTEN_TEXT = "YAML text"
"""The name of parameters whose text is not YAML before substitution."""


def deletes_parameters(attributes: Mapping[str, str]) -> bool:
    """Return whether an element deletes parameters instead of setting them."""
    return attributes.get("command") == "delete"


def deleted_name(attributes: Mapping[str, str]) -> str:
    """Return the name of the parameters that an element deletes; empty for all in its namespace."""
    return "/".join(filter(None, (attributes.get("ns", "").rstrip("/"), attributes.get("param", ""))))


def written_parameters(attributes: Mapping[str, str], text: str) -> dict[str, str]:
    """Return the parameters that are written in the element, by name, or the whole text if it is not YAML.

    Args:
        attributes: the attributes of the element, such as the namespace and the name of a single parameter.
        text: the text in the element.
    """
    if not text.strip() or attributes.get("file"):
        return {}
    path = ".".join(filter(None, [attributes.get("ns", "").strip("/"), attributes.get("param", "")]))
    try:
        root = composed(textwrap.dedent(text))
        values = {} if root is None else yaml_values(root, {})
    except UnreadableFileError:
        values = {}
    if not values or (not path and not isinstance(root, yaml.MappingNode)):
        return {path or WRITTEN_TEXT: " ".join(text.split())}
    return {_joined(path, name): _text(value) for name, value in values.items()}


def _text(value: YamlValue) -> str:
    """Return the text of a value; an empty one is null, which is not an empty text."""
    return _NULL if value.type is None and not value.is_list and value.text in _NULL_TEXTS else value.text


def _joined(path: str, name: str) -> str:
    return f"{path}{name}" if not path or not name or name.startswith("[") else f"{path}.{name}"


def file_settings(attributes: Mapping[str, str]) -> dict[str, str]:
    """Return how the parameters of a file are loaded, without what is the default."""
    names = {"ns": "namespace", "param": "as parameter", "command": "command", "subst_value": "subst_value"}
    settings = {names[key]: value for key, value in attributes.items() if key in names and value}
    if settings.get("command") == _DEFAULT_COMMAND:
        del settings["command"]
    return settings
