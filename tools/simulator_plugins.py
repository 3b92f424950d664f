"""Write the table of simulator plugins and their parameters, for the language server.

Names, types and defaults are those of the classes that simulate the plugins. Importing these classes takes too long for
an editor, so they are recorded. The descriptions are in ``simulator_plugins.toml``.

Usage: python tools/simulator_plugins.py [--check]
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import MISSING, fields
from importlib import import_module
from pathlib import Path
from typing import Any

from linkwright.geometry.single import Vector3
from linkwright.loading.extensions import extensions
from linkwright.simulation.plugins.parameters import _get_types
from linkwright.simulation.plugins.registry import PLUGIN_GROUP, find_plugin_class

ROOT = Path(__file__).resolve().parent.parent
TEXTS_FILE = ROOT / "tools" / "simulator_plugins.toml"
TABLE_FILE = ROOT / "src" / "linkwright" / "language" / "simulator_plugins.json"

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

_TYPES = {
    str: "str",
    float: "float",
    float | None: "float",
    int: "int",
    bool: "bool",
    bool | None: "bool",
    Vector3: "vector",
    Vector3 | None: "vector",
    tuple[str, ...]: "str",
    tuple[float, ...]: "float",
}
_LISTS = (tuple[str, ...], tuple[float, ...])
_GZ_SYSTEM = re.compile(r"gz-sim-(.+)-system")


def _format_default(value: Any) -> str | None:
    if value is MISSING or value is None or value == () or value == "":
        return None
    if isinstance(value, tuple):
        return " ".join(str(_format_default(item)) for item in value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return None if math.isnan(value) or math.isinf(value) else f"{value:g}"
    return str(value)


def _iterate_parameters(library: str, texts: Any) -> Iterator[dict[str, Any]]:
    meanings, extension = texts["parameters"], extensions(PLUGIN_GROUP).get(library)
    cls = None if extension is None else find_plugin_class(library)
    format_table: Any = getattr(cls, "PARAMETERS", None)
    types = {} if format_table is None else _get_types(format_table)
    for field in () if format_table is None else fields(format_table):
        meaning, _, unit = meanings[field.name].partition(" | ")
        known = {"name": field.name, "type": _TYPES[types[field.name]], "meaning": meaning, "unit": unit}
        default = _format_default(field.default)
        yield (
            known
            | ({} if default is None else {"default": default})
            | ({"many": True} if types[field.name] in _LISTS else {})
            | ({"required": True} if field.default is MISSING else {})
        )
    for name, kind in texts["more"].get(library, {}).items():
        meaning, _, unit = meanings[name].partition(" | ")
        yield {"name": name, "type": kind, "meaning": meaning, "unit": unit}


def _find_class_name(library: str, texts: Any) -> str:
    system = _GZ_SYSTEM.fullmatch(library)
    derived = "" if system is None else "gz::sim::systems::" + system[1].title().replace("-", "")
    return str(texts["classes"].get(library, derived))


def format_table() -> str:
    """Return the text of the table."""
    texts = tomllib.loads(TEXTS_FILE.read_text(encoding="utf-8"))
    missing = {*extensions(PLUGIN_GROUP)} - {*texts["libraries"]}
    if missing:
        raise SystemExit(f"{TEXTS_FILE.name} has no words about {', '.join(sorted(missing))}")
    lines = []
    for library, about in sorted(texts["libraries"].items()):
        entry: dict[str, Any] = {"about": about, "class": _find_class_name(library, texts)}
        parameters = ",\n".join(
            "   " + json.dumps(parameter, ensure_ascii=False) for parameter in _iterate_parameters(library, texts)
        )
        inside = f'{json.dumps(entry, ensure_ascii=False)[:-1]}, "parameters": [\n{parameters}\n  ]}}'
        lines.append(f" {json.dumps(library)}: {inside}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def main(words: list[str]) -> int:
    """Write the table, or check it, and return the exit status."""
    text = format_table()
    if words == ["--check"]:
        if TABLE_FILE.read_text(encoding="utf-8") == text:
            return 0
        print(f"{TABLE_FILE.relative_to(ROOT)} is stale: run `python tools/simulator_plugins.py`", file=sys.stderr)
        return 1
    TABLE_FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
