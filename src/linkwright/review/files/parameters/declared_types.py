"""Find the types with which sources and well-known nodes declare a parameter of ROS 2."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from linkwright.nodes.recorded_names import find_recorded_plugin_type, find_recorded_type
from linkwright.review.files.parameters.yaml_values import YamlType, YamlValue, parse_yaml_value

_CPP_TYPES = {
    **dict.fromkeys(("double", "float"), YamlType.FLOAT),
    **dict.fromkeys(("int", "long", "unsigned", "size_t", "int32_t", "int64_t", "uint32_t"), YamlType.INTEGER),
    "bool": YamlType.TRUTH,
    "string": YamlType.TEXT,
}
_VECTOR = re.compile(r"vector<(.*)>")
_FLOAT_SUFFIX = re.compile(r"(?<=[\d.])[fF]$")
_COMMENT = re.compile(r"(?:^|\s)(?:#|//)[^\n]*")
_DECLARATION = (
    r"\bdeclare_parameter\s*(?:<(?P<type>[^;()]+)>)?\s*\(\s*[\"']{name}[\"']\s*"
    r"(?:,\s*(?P<default>\[[^\]]*\]|\"[^\"]*\"|'[^']*'|[^,()\s]+)\s*)?[,)]"
)


def declare_type(texts: Iterable[str], parameter: str, value: YamlValue) -> bool:
    """Return whether sources declare a parameter, and all of them with the type of a value.

    Args:
        texts: the texts of the sources.
        parameter: the name of the parameter.
        value: the value.
    """
    pattern = re.compile(_DECLARATION.format(name=re.escape(parameter)))
    types = {declared for text in texts if parameter in text for declared in _find_types(text, pattern)}
    return types == {(value.type, value.is_list)}


def has_recorded_type(parameter: str, values: Mapping[str, YamlValue]) -> bool:
    """Return whether a value has the type with which a well-known node, or its plugin, declares the parameter.

    Args:
        parameter: the path of the parameter.
        values: the values of the file by path, also those that give plugins their classes.
    """
    value, (node, _, name) = values[parameter], parameter.partition(".ros__parameters.")
    group, _, own_name = parameter.rpartition(".")
    plugin = values.get(f"{group}.plugin")
    declared = "" if plugin is None else find_recorded_plugin_type(plugin.text, own_name)
    declared = declared or find_recorded_type(re.split(r"[./]", node)[-1], name)
    return value.type is not None and declared == f"{value.type.value}{'_array' * value.is_list}"


def _find_types(text: str, pattern: re.Pattern[str]) -> Iterator[tuple[YamlType | None, bool]]:
    """Yield the types of declarations, and whether they are lists; ``None`` for an unknown type."""
    for match in pattern.finditer(_COMMENT.sub("", text)):
        if match["type"]:
            name = match["type"].replace(" ", "").replace("std::", "")
            vector = _VECTOR.fullmatch(name)
            yield _CPP_TYPES.get(name if vector is None else vector[1]), vector is not None
            continue
        default = parse_yaml_value(_FLOAT_SUFFIX.sub("", match["default"] or ""))
        is_known = default is not None and (default.type is not YamlType.TEXT or match["default"][0] in "\"'")
        yield (default.type, default.is_list) if default is not None and is_known else (None, False)
