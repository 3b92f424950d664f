"""Images of robots and worlds, rendered without a browser, a graphics card or OpenGL.

The same scene gives the same pixels on every machine (decision 0134).
"""

from linkwright.picture.camera import VIEWS, Camera, View
from linkwright.picture.materials import SurfaceLibrary
from linkwright.picture.rendering import Image, Style, render
from linkwright.picture.robots import GHOST_COLOR, OUTLINE_COLOR, robot_scene
from linkwright.picture.scene import Scene, camera_for

__all__ = [
    "GHOST_COLOR",
    "OUTLINE_COLOR",
    "VIEWS",
    "Camera",
    "Image",
    "Scene",
    "Style",
    "SurfaceLibrary",
    "View",
    "camera_for",
    "render",
    "robot_scene",
]
