"""Read the parameters of ``<rosparam>`` elements of ROS 1."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import yaml

from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import YamlValue, collect_values, compose_yaml

_DEFAULT_COMMAND = "load"
_NULL = "null"
_NULL_FORMS = ("", "~", _NULL)
WRITTEN_TEXT = "YAML text"
"""The name for parameters whose text is not YAML before substitution."""


def deletes_parameters(attributes: Mapping[str, str]) -> bool:
    """Return whether an element deletes parameters instead of setting them."""
    return attributes.get("command") == "delete"


def find_deleted_name(attributes: Mapping[str, str]) -> str:
    """Return the name of the parameters that an element deletes.

    The name is empty for all parameters in the namespace.
    """
    return "/".join(filter(None, (attributes.get("ns", "").rstrip("/"), attributes.get("param", ""))))


def read_written_parameters(attributes: Mapping[str, str], text: str) -> dict[str, str]:
    """Return the parameters written inside an element, by name.

    If the text is not YAML, it is the only value.

    Args:
        attributes: the attributes of the element, such as the namespace and the name of a single parameter.
        text: the text in the element.
    """
    if not text.strip() or attributes.get("file"):
        return {}
    path = ".".join(filter(None, [attributes.get("ns", "").strip("/"), attributes.get("param", "")]))
    try:
        root = compose_yaml(textwrap.dedent(text))
        values = {} if root is None else collect_values(root, {})
    except UnreadableFileError:
        values = {}
    if not values or (not path and not isinstance(root, yaml.MappingNode)):
        return {path or WRITTEN_TEXT: " ".join(text.split())}
    return {_join_path(path, name): _format_value(value) for name, value in values.items()}


def _format_value(value: YamlValue) -> str:
    """Return the text of a value. An empty value is null and differs from an empty text."""
    return _NULL if value.type is None and not value.is_list and value.text in _NULL_FORMS else value.text


def _join_path(path: str, name: str) -> str:
    return f"{path}{name}" if not path or not name or name.startswith("[") else f"{path}.{name}"


def read_file_settings(attributes: Mapping[str, str]) -> dict[str, str]:
    """Return the attributes that control how a file's parameters are loaded."""
    names = {"ns": "namespace", "param": "as parameter", "command": "command", "subst_value": "subst_value"}
    settings = {names[key]: value for key, value in attributes.items() if key in names and value}
    if settings.get("command") == _DEFAULT_COMMAND:
        del settings["command"]
    return settings
