"""Simulate a robot with added masses, collisions and a drive, as ``linkwright drive`` does."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.descriptions import examine
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.checks.not_yet import NotYet
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.testing import SteppedSimulation

_UNDRIVABLE_CODES = {"DRIVE201", "DRIVE203", "DRIVE204"}
"""Findings of the inference that say why a robot cannot be driven."""


@contextmanager
def simulate_completed(path: Path, finder: PackageFinder) -> Iterator[SteppedSimulation]:
    """Return a simulation of a robot in an empty world, with missing elements added.

    Args:
        path: the URDF or xacro file of the robot, which has no errors.
        finder: the finder of packages.

    Raises:
        NotYet: the robot has no joint that can be driven.
    """
    from linkwright.inertia import MeshLibrary
    from linkwright.inference import infer
    from linkwright.inference.completion import complete_description
    from linkwright.testing import SteppedSimulation
    from linkwright.xmltree import write

    description = examine(path, packages=finder)
    assert description.robot is not None, "the file was read before"
    inference = infer(description.robot, MeshLibrary(finder, path.parent))
    problem = next((finding for finding in inference.diagnostics if finding.code in _UNDRIVABLE_CODES), None)
    if problem is not None:
        raise NotYet(describe_finding(problem))
    with ScratchFolder("driven") as folder:
        completed = Path(folder) / f"{path.stem}.urdf"
        completed.write_text(write(complete_description(description.document, inference)), encoding="utf-8")
        with SteppedSimulation("empty", completed, pose=(0.0, 0.0, -inference.ground_z, 0.0, 0.0, 0.0)) as test:
            yield test
