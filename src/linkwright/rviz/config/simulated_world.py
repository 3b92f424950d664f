"""The display entry of a simulated world, and the topics that describe the world."""

from __future__ import annotations

__all__ = ["DESCRIPTION_TOPIC", "POSES_TOPIC", "RAYS_TOPIC", "WATER_TOPIC", "WORLD_DISPLAY"]

WORLD_DISPLAY = "linkwright/World"
"""The class of the display."""
DESCRIPTION_TOPIC, POSES_TOPIC, RAYS_TOPIC = "/world_description", "/world_poses", "/world_rays"
"""The world as SDF, the poses of its links, and the measurements of its lidars."""
WATER_TOPIC = "/world_water"
"""The surface of the water in the world."""
