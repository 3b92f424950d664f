"""Count the pixels at which the outlined bodies of a scene are visible."""

from __future__ import annotations

import numpy as np

from linkwright.picture.camera import Camera
from linkwright.picture.clipping import project_mesh
from linkwright.picture.rasterizer import MAX_TRIANGLES, NOTHING, DepthBuffer, ScreenTriangles
from linkwright.picture.scene import Scene


def count_outlined_pixels(scene: Scene, camera: Camera) -> int:
    """Return the number of pixels at which an outlined body is the nearest one."""
    mesh = scene.mesh
    if not len(mesh.faces):
        return 0
    width, height = camera.size
    projected = project_mesh(camera, mesh.points, mesh.faces)
    buffer = DepthBuffer(width, 0, height, float(projected.nearness.max()), float(projected.nearness.min()))
    triangles = ScreenTriangles.from_faces(projected.x, projected.y, projected.nearness, mesh.faces)
    buffer.add(triangles, projected.select(mesh.solid))
    nearest = buffer.keys[buffer.keys != NOTHING] & (MAX_TRIANGLES - 1)
    is_outlined = np.array([body.outline is not None for body in mesh.bodies], dtype=bool)
    return int(np.count_nonzero(is_outlined[mesh.parts[nearest]]))
