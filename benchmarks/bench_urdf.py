"""Measure reading and checking of URDF texts, compared with other readers in Python.

Run it with ``python -m benchmarks urdf``. "Cold" forgets the values that the reader remembers from earlier texts. The
other readers check less: they name no place, and accept much that urdfdom refuses. Beside ``linkwright check``, whole
commands, stand a bare interpreter and ruff with one file of Python, which is what a hook before a commit usually takes.
"""

from __future__ import annotations

import io
import sys
import tempfile
from collections.abc import Callable
from contextlib import redirect_stderr
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import LINKWRIGHT, Row, commands, show, side_by_side
from benchmarks.robots import SHIPPED, detailed_robot, robot_with_mesh
from linkwright.descriptions import load
from linkwright.schema import reading
from linkwright.urdf import values

ROUNDS = 25
STARTS = 11
RUFF = Path(sys.executable).with_name("ruff")


def forget() -> None:
    """Clear the reader's caches of values."""
    reading.forget()
    values.vector3.cache_clear()


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    table = []
    for links, moving, target in ((23, 12, ""), (88, 45, "1.6 ms")):
        text = detailed_robot(links, moving)
        readers = _others(text)

        times = side_by_side({"warm": lambda text=text: load(text), **readers}, ROUNDS, repeat=5)
        times |= side_by_side({"cold": lambda text=text: load(text)}, ROUNDS, before=forget)
        others = {name: times[name] * 1e3 if name in times else None for name in readers}
        size = f"{links} links, {len(text) / 1000:.0f} kB"
        table.append(Row(f"text to Robot, {size}", times["warm"] * 1e3, "ms", target, others))
        table.append(Row(f"text to Robot, {size}, cold", times["cold"] * 1e3, "ms"))
    return table + _checks()


def _checks() -> list[Row]:
    files = sum(path.is_file() and path.suffix != ".pyc" for path in SHIPPED.rglob("*"))
    with tempfile.TemporaryDirectory() as folder:
        asked = {f"robot with a small mesh ({kind})": robot_with_mesh(Path(folder), kind) for kind in ("stl", "dae")}
        asked[f"package of {files} files"] = SHIPPED
        table = []
        for what, path in asked.items():
            target = "18 bare interpreters" if path == SHIPPED else "5.5 bare interpreters"
            calls = {
                "ours": [LINKWRIGHT, "check", str(path)],
                "ruff": [str(RUFF), "check", "--no-cache", __file__] if RUFF.is_file() else None,
                "bare interpreter": [sys.executable, "-c", "pass"],
            }
            times = {name: seconds * 1e3 for name, seconds in commands(calls, STARTS).items()}
            others = {name: times.get(name) for name in calls if name != "ours"}
            table.append(Row(f"command check, {what}", times["ours"], "ms", target, others))
    return table


def _others(text: str) -> dict[str, Callable[[], object] | None]:
    data = text.encode()
    yourdfpy = peers.load("yourdfpy")
    parser = peers.load("urdf_parser_py", "urdf_parser_py.urdf")
    pinocchio = peers.load("pinocchio")

    def with_yourdfpy() -> object:
        return yourdfpy.URDF.load(io.BytesIO(data), build_scene_graph=False, load_meshes=False)

    def with_parser() -> object:
        with redirect_stderr(io.StringIO()):
            return parser.URDF.from_xml_string(data)

    return {
        "yourdfpy": with_yourdfpy if yourdfpy else None,
        "urdf_parser_py": with_parser if parser else None,
        "pinocchio": (lambda: pinocchio.buildModelFromXML(text)) if pinocchio else None,
    }


def main() -> None:
    """Measure and print."""
    show(rows())


if __name__ == "__main__":
    main()
