"""Texts of worlds for tests of edits."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import has_errors
from linkwright.packages import PackageFinder
from linkwright.sdf.editing import WorldText
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.reader import read
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.text import parse_as_gazebo

BOX_MODEL = """\
    <model name='box'><!-- in single quotes -->
      <pose>2 0 0.250 0 0 0</pose>
      <link name="link">
        <inertial>
          <mass>2</mass>
          <inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>
        </inertial>
        <collision name="collision">
          <geometry><box><size>0.5 0.5 0.5</size></box></geometry>
        </collision>
        <visual name="visual">
          <geometry><box><size>0.5 0.5 0.5</size></box></geometry>
          <material><ambient>0.9 0.4 0.1 1</ambient><diffuse>0.9 0.4 0.1 1</diffuse></material>
        </visual>
      </link>
    </model>
"""
PLAIN_WORLD = f"""\
<?xml version="1.0"?>
<!-- -- dashes, which XML forbids -->
<sdf version="1.6">
  <world name="w">
    <include><uri>model://ground_plane</uri></include>

    <!-- the box -->
{BOX_MODEL}
    <light type="point" name="lamp">
      <pose>0 0 3 0 0 0</pose>
    </light>
  </world>
</sdf>
"""


def world_text(text: str, models: str = "") -> WorldText:
    """Return a world that finds the built-in models, and those in `models`."""
    packages = PackageFinder(start=Path("/nonexistent"), environment={})
    return WorldText(text, Path("/nowhere/w.world"), ResourceFinder(packages, {"GZ_SIM_RESOURCE_PATH": models}))


def is_rejected_by_simulators(world: WorldText) -> bool:
    """Return whether the world, or a file that it includes, has an error."""
    document, findings = parse_as_gazebo(world.text, str(world.path))
    reading = read(document)
    includes = resolve_includes(reading.sdf, world.path, world.finder)
    return has_errors([*findings, *reading.diagnostics, *includes.diagnostics])


def world_with(*parts: str, version: str = "1.9") -> WorldText:
    """Return a world with these elements."""
    return world_text(f'<sdf version="{version}">\n  <world name="w">\n{"".join(parts)}  </world>\n</sdf>\n')
