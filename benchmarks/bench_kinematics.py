"""Measure forward kinematics of all links for one and many configurations, and its peers.

Run it with ``python -m benchmarks kinematics``. Every figure is the time per configuration until the frames of all
links are arrays in Python. "numpy" is a simple loop over joints.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import peers
from benchmarks.measure import Row, measure_side_by_side, show
from benchmarks.robots import make_detailed_robot
from linkwright.descriptions import load
from linkwright.kinematics import KinematicTree
from linkwright.urdf import Robot, parent_joints

CONFIGURATION_COUNT = 10_000
FEW_CONFIGURATIONS = 200
"""The number of configurations for libraries that process them one by one."""
ROUNDS = 9


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    table = []
    for links, moving, target in ((23, 12, "2 us, aiming at 1"), (88, 45, "10 us, aiming at 5")):
        text = make_detailed_robot(links, moving)
        tree = KinematicTree(load(text))
        many = np.random.default_rng(0).uniform(-1, 1, (CONFIGURATION_COUNT, len(tree.joint_names)))
        calls = {"ours": lambda tree=tree, many=many: tree.forward(many)}
        calls["numpy"] = _PlainKinematics(load(text), tree).make_call(many)
        calls["urchin"], one_by_one = (
            _make_urchin_call(text, tree, many),
            _make_pinocchio_call(text, tree, many[:FEW_CONFIGURATIONS]),
        )
        times = measure_side_by_side(calls, ROUNDS)
        peer_times = {
            name: times[name] / CONFIGURATION_COUNT * 1e6 if name in times else None for name in ("numpy", "urchin")
        }
        slow = measure_side_by_side({"pinocchio": one_by_one}, ROUNDS)
        peer_times["pinocchio"] = slow["pinocchio"] / FEW_CONFIGURATIONS * 1e6 if slow else None
        size = f"{links} links, {len(tree.joint_names)} joints"
        microseconds = times["ours"] / CONFIGURATION_COUNT * 1e6
        table.append(
            Row(f"{size}, each of {CONFIGURATION_COUNT} configurations", microseconds, "us", target, peer_times)
        )
        single = measure_side_by_side({"ours": lambda tree=tree, one=many[0]: tree.forward(one)}, ROUNDS, repeat=300)
        peer_times = {"pinocchio": peer_times["pinocchio"]}
        table.append(
            Row(f"{size}, a single configuration", single["ours"] * 1e6, "us", "20 us, aiming at 15", peer_times)
        )
    return table


class _PlainKinematics:
    """A loop over joints, which computes all configurations of a joint at once."""

    def __init__(self, robot: Robot, tree: KinematicTree) -> None:
        joint_by_child = parent_joints(robot)
        index = {name: index_in_tree for index_in_tree, name in enumerate(tree.link_names)}
        self._steps = []
        for name in tree.link_names[1:]:
            joint = joint_by_child[name]
            column = tree.joint_names.index(joint.name) if joint.name in tree.joint_names else None
            still = KinematicTree(robot).forward(np.zeros(len(tree.joint_names)))
            origin = np.linalg.inv(still[index[joint.parent]]) @ still[index[name]]
            self._steps.append((index[name], index[joint.parent], origin, column))
        self._links = len(tree.link_names)

    def make_call(self, positions: Any) -> Callable[[], object]:
        def run() -> object:
            frames = np.empty((len(positions), self._links, 4, 4))
            frames[:, 0] = np.eye(4)
            for link, parent, origin, column in self._steps:
                if column is None:
                    frames[:, link] = frames[:, parent] @ origin
                    continue
                turn = np.zeros((len(positions), 4, 4))
                cosine, sine = np.cos(positions[:, column]), np.sin(positions[:, column])
                turn[:, 0, 0] = turn[:, 1, 1] = cosine
                turn[:, 1, 0], turn[:, 0, 1] = sine, -sine
                turn[:, 2, 2] = turn[:, 3, 3] = 1
                frames[:, link] = frames[:, parent] @ (origin @ turn)
            return frames

        return run


def _make_urchin_call(text: str, tree: KinematicTree, many: Any) -> Callable[[], object] | None:
    urchin = peers.load_module("urchin")
    if urchin is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.urdf"
        path.write_text(text, encoding="utf-8")
        robot = urchin.URDF.load(str(path), lazy_load_meshes=True)
    positions = {name: many[:, column] for column, name in enumerate(tree.joint_names)}
    return lambda: np.stack(list(robot.link_fk_batch(cfgs=positions).values()), axis=1)


def _make_pinocchio_call(text: str, tree: KinematicTree, few: Any) -> Callable[[], object] | None:
    pinocchio = peers.load_module("pinocchio")
    if pinocchio is None:
        return None
    model = pinocchio.buildModelFromXML(text)
    data = model.createData()
    order = [model.joints[model.getJointId(name)].idx_q for name in tree.joint_names]
    frames = [model.getFrameId(name) for name in tree.link_names]

    def run() -> object:
        result = np.empty((len(few), len(frames), 4, 4))
        q = np.zeros(model.nq)
        for number, positions in enumerate(few):
            q[order] = positions
            pinocchio.framesForwardKinematics(model, data, q)
            for place, frame in enumerate(frames):
                result[number, place] = data.oMf[frame].homogeneous
        return result

    return run


def main() -> None:
    """Measure and print."""
    show(rows())


if __name__ == "__main__":
    main()
