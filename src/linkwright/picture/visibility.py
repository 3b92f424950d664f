"""Count the pixels at which the outlined bodies of a scene are visible."""

from __future__ import annotations

import numpy as np

from linkwright.picture.camera import Camera
from linkwright.picture.rasterizer import MAX_TRIANGLES, NOTHING, DepthBuffer, ScreenTriangles
from linkwright.picture.scene import Scene


def count_outlined_pixels(scene: Scene, camera: Camera) -> int:
    """Return the number of pixels at which an outlined body is the nearest one."""
    mesh = scene.mesh
    if not len(mesh.faces):
        return 0
    width, height = camera.size
    x, y, nearness = camera.project(mesh.points)
    buffer = DepthBuffer(width, 0, height, float(nearness.max()), float(nearness.min()))
    buffer.add(ScreenTriangles.from_faces(x, y, nearness, mesh.faces), mesh.solid)
    nearest = buffer.keys[buffer.keys != NOTHING] & (MAX_TRIANGLES - 1)
    is_outlined = np.array([body.outline is not None for body in mesh.bodies], dtype=bool)
    return int(np.count_nonzero(is_outlined[mesh.parts[nearest]]))
