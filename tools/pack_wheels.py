"""Write the table of wheels of ``linkwright learn pack`` from ``uv.lock``.

Usage: python tools/pack_wheels.py [--check]

The table has the packages that `EXTRAS` need, with their markers, and the names, checksums and sizes of the wheels that
fit one of the targets of packs. A package without wheels is listed with its source distribution.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from linkwright.learning.packing.locked_files import OWN_PACKAGES, TABLE_FILE, rank_wheel
from linkwright.learning.packing.targets import SYSTEMS, Target, select_targets

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "uv.lock"
OMITTED_EXTRAS = {"parquet", "ray", "train"}
"""The extras that packs do not offer: they are for computers with a network, and larger than all others together."""

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
Package = dict[str, Any]


def format_table(lock: str) -> str:
    """Return the text of the table."""
    by_name: dict[str, list[Package]] = {}
    for package in tomllib.loads(lock)["package"]:
        by_name.setdefault(package["name"], []).append(package)
    targets = select_targets(tuple(SYSTEMS), ())
    (linkwright,) = by_name["linkwright"]
    extras = sorted(set(linkwright["optional-dependencies"]) - OMITTED_EXTRAS)
    rows: dict[str, Any] = {}
    queue = [(linkwright, ""), *((linkwright, extra) for extra in extras)]
    while queue:
        package, extra = queue.pop(0)
        row = rows.setdefault(_make_key(package), {"needs": [], "files": _list_files(package, targets)})
        listed_edges = row["needs"] if not extra else row.setdefault("extras", {}).setdefault(extra, [])
        if listed_edges:
            continue
        edges = (
            package.get("dependencies", ()) if not extra else package.get("optional-dependencies", {}).get(extra, ())
        )
        for edge in edges:
            needed_package = _find_package(edge, by_name)
            listed_edges.append(_make_edge(edge, needed_package))
            queue += [
                (needed_package, name)
                for name in ("", *edge.get("extra", ()))
                if not _has_row(rows, needed_package, name)
            ]
    return "{\n" + ",\n".join(f"{json.dumps(key)}: {_format_row(rows[key])}" for key in sorted(rows)) + "\n}\n"


def _format_row(row: Mapping[str, Any]) -> str:
    """Return the JSON of a package, with a line for each file, so that changes can be read."""
    files = ",\n  ".join(json.dumps(file) for file in row["files"])
    rest = {key: value for key, value in row.items() if key != "files" and (value or key == "extras")}
    return json.dumps(rest)[:-1] + (", " if rest else "") + f'"files": [{files}]}}'


def _make_key(package: Package) -> str:
    return package["name"] if package["name"] in OWN_PACKAGES else f"{package['name']} {package['version']}"


def _has_row(rows: Mapping[str, Any], package: Package, extra: str) -> bool:
    row = rows.get(_make_key(package))
    return row is not None and (not extra or extra in row.get("extras", {}))


def _find_package(edge: Mapping[str, Any], by_name: Mapping[str, list[Package]]) -> Package:
    """Return the package that an edge names.

    The lock file states the version if there are several.
    """
    (package,) = [
        package
        for package in by_name[edge["name"]]
        if edge.get("version", package.get("version")) == package.get("version")
    ]
    return package


def _make_edge(edge: Mapping[str, Any], needed: Package) -> dict[str, Any]:
    row: dict[str, Any] = {"key": _make_key(needed)}
    if "extra" in edge:
        row["extras"] = list(edge["extra"])
    if "marker" in edge:
        row["marker"] = edge["marker"]
    return row


def _list_files(package: Package, targets: list[Target]) -> list[list[Any]]:
    if package["name"] in OWN_PACKAGES:
        return []
    wheels = [
        wheel
        for wheel in package.get("wheels", ())
        if any(rank_wheel(wheel["path"], target) is not None for target in targets)
    ]
    return [list(_iterate_file_values(file)) for file in wheels or [package["sdist"]]]


def _iterate_file_values(file: Mapping[str, Any]) -> Iterator[Any]:
    yield file["path"]
    yield file["hash"].removeprefix("sha256:")
    yield file["size"]


def main(words: list[str]) -> int:
    """Write the table, or with ``--check`` report whether it is current."""
    text = format_table(LOCK.read_text(encoding="utf-8"))
    if TABLE_FILE.exists() and TABLE_FILE.read_text(encoding="utf-8") == text:
        return 0
    if "--check" in words:
        print(f"{TABLE_FILE} is stale: run python tools/pack_wheels.py", file=sys.stderr)
        return 1
    TABLE_FILE.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
