"""Measure reading and checking of URDF texts, compared with other readers in Python.

Run it with ``python -m benchmarks urdf``. "Cold" means that the reader's caches of earlier texts are empty. The other
readers check less: their errors have no location, and they accept much that urdfdom rejects. The command ``linkwright
check`` is compared with a bare interpreter, and with ruff on one Python file, as in a pre-commit hook.
"""

from __future__ import annotations

import io
import sys
import tempfile
from collections.abc import Callable
from contextlib import redirect_stderr
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import LINKWRIGHT, Row, measure_commands, measure_side_by_side, show
from benchmarks.robots import SHIPPED, make_detailed_robot, write_robot_with_mesh
from linkwright.descriptions import load
from linkwright.schema import reading
from linkwright.urdf import values

ROUNDS = 25
START_COUNT = 11
RUFF = Path(sys.executable).with_name("ruff")


def clear_caches() -> None:
    """Clear the reader's caches of values."""
    reading.forget()
    values.vector3.cache_clear()


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    table = []
    for links, moving, target in ((23, 12, ""), (88, 45, "1.6 ms")):
        text = make_detailed_robot(links, moving)
        readers = _make_peer_calls(text)

        times = measure_side_by_side({"warm": lambda text=text: load(text), **readers}, ROUNDS, repeat=5)
        times |= measure_side_by_side({"cold": lambda text=text: load(text)}, ROUNDS, before=clear_caches)
        others = {name: times[name] * 1e3 if name in times else None for name in readers}
        size = f"{links} links, {len(text) / 1000:.0f} kB"
        table.append(Row(f"text to Robot, {size}", times["warm"] * 1e3, "ms", target, others))
        table.append(Row(f"text to Robot, {size}, cold", times["cold"] * 1e3, "ms"))
    return table + _measure_checks()


def _measure_checks() -> list[Row]:
    files = sum(path.is_file() and path.suffix != ".pyc" for path in SHIPPED.rglob("*"))
    with tempfile.TemporaryDirectory() as folder:
        asked = {
            f"robot with a small mesh ({kind})": write_robot_with_mesh(Path(folder), kind) for kind in ("stl", "dae")
        }
        asked[f"package of {files} files"] = SHIPPED
        table = []
        for what, path in asked.items():
            target = "18 bare interpreters" if path == SHIPPED else "5.5 bare interpreters"
            calls = {
                "ours": [LINKWRIGHT, "check", str(path)],
                "ruff": [str(RUFF), "check", "--no-cache", __file__] if RUFF.is_file() else None,
                "bare interpreter": [sys.executable, "-c", "pass"],
            }
            times = {name: seconds * 1e3 for name, seconds in measure_commands(calls, START_COUNT).items()}
            others = {name: times.get(name) for name in calls if name != "ours"}
            table.append(Row(f"command check, {what}", times["ours"], "ms", target, others))
    return table


def _make_peer_calls(text: str) -> dict[str, Callable[[], object] | None]:
    data = text.encode()
    yourdfpy = peers.load_module("yourdfpy")
    parser = peers.load_module("urdf_parser_py", "urdf_parser_py.urdf")
    pinocchio = peers.load_module("pinocchio")

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
