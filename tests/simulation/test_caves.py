"""Robots inside of concave static meshes."""

from __future__ import annotations

import numpy as np

from tests.geometry.test_decomposition import tunnel
from tests.simulation.worlds import box, make_simulation

SECOND_NS = 1_000_000_000


def test_box_that_starts_in_a_cave_stands_on_its_floor(tmp_path):
    points, faces = tunnel()
    lines = ["solid cave"]
    for triangle in points[faces]:
        corners = "".join(f"vertex {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in triangle.tolist())
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    (tmp_path / "cave.stl").write_text("\n".join([*lines, "endsolid cave"]))
    cave = (
        f'<model name="cave"><static>true</static><link name="rock"><collision name="rock"><geometry><mesh>'
        f"<uri>file://{tmp_path}/cave.stl</uri></mesh></geometry></collision></link></model>"
    )
    simulation = make_simulation(cave, box("crate", "6 0 -1 0 0 0", "0.4 0.4 0.4"))
    simulation.advance(3 * SECOND_NS)
    x, y, z = simulation.link_pose("crate::link")[:3]
    assert np.hypot(x - 6.0, y) < 0.2
    assert -1.85 < z < -1.65
