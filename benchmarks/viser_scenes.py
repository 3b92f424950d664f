"""The scenes with which our viewer is measured, shown by viser.

Usage: ``python -m benchmarks.viser_scenes arm|points``

The program prints the page's address as `linkwright` does, and ends with Ctrl-C.
"""

from __future__ import annotations

import itertools
import math
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import peers
from benchmarks.data_scenes import make_clouds
from benchmarks.page_programs import find_free_port
from benchmarks.robots import ARM_LENGTHS, write_arm_sweep

_ARM_RATE = 30.0
_POINTS_RATE = 10.0


def show_arm(server: Any) -> None:
    """Show the arm of `write_arm_sweep`, each joint of which moves at 30 Hz."""
    trimesh = peers.load_module("trimesh")
    assert trimesh is not None
    joints, name = [], ""
    with tempfile.TemporaryDirectory() as folder:
        write_arm_sweep(Path(folder), 30)
        for number in range(len(ARM_LENGTHS)):
            name += f"/link_{number}"
            position = (0.0, 0.0, ARM_LENGTHS[number - 1] if number else 0.0)
            joints.append(server.scene.add_frame(name, show_axes=False, position=position))
            mesh = trimesh.load(str(Path(folder) / f"link_{number}.stl"))
            color = (25 * (3 + number), 153, 204)
            server.scene.add_mesh_simple(f"{name}/shape", mesh.vertices, mesh.faces, color=color)
    for seconds in _iterate_ticks(_ARM_RATE):
        with server.atomic():
            for number, joint in enumerate(joints[1:], start=1):
                half = math.sin(seconds) / 2
                joint.wxyz = (math.cos(half), math.sin(half) * (number % 2), 0.0, math.sin(half) * (1 - number % 2))


def show_points(server: Any) -> None:
    """Show the clouds of `data_scenes`, ten per second, colored by height."""
    messages = []
    for message in make_clouds():
        array = np.frombuffer(message.data, np.float32).reshape(-1, 4)
        shade = (255 * (array[:, 2] - array[:, 2].min()) / np.ptp(array[:, 2])).astype(np.uint8)
        messages.append((array[:, :3].copy(), np.stack([shade, 255 - shade, np.full_like(shade, 128)], axis=-1)))
    shown = server.scene.add_point_cloud("/points", *messages[0], point_size=0.01)
    for (places, colors), _ in zip(itertools.cycle(messages), _iterate_ticks(_POINTS_RATE)):
        with server.atomic():
            shown.points, shown.colors = places, colors


def _iterate_ticks(rate: float) -> Any:
    begin = time.monotonic()
    for number in itertools.count():
        at = number / rate
        time.sleep(max(0.0, begin + at - time.monotonic()))
        yield at


def main() -> None:
    """Show one of the scenes."""
    viser = peers.load_module("viser")
    assert viser is not None
    port = find_free_port()
    server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    server.scene.add_grid("/grid", width=10, height=10)
    print(f"Viewer: http://127.0.0.1:{port}/", flush=True)
    try:
        {"arm": show_arm, "points": show_points}[sys.argv[1]](server)
    except KeyboardInterrupt:
        server.stop()


if __name__ == "__main__":
    main()
