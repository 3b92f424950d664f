"""The text of a newly created world."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

_TEXT = """\
<?xml version="1.0"?>
<!-- Lengths are in meters, angles in radians, masses in kg. A pose is: x y z roll pitch yaw. -->
<sdf version="1.6">
  <world name={name}>

    <!-- Steps of 1 ms, in real time. -->
    <physics type="ode">
      <max_step_size>0.001</max_step_size>
      <real_time_factor>1</real_time_factor>
      <real_time_update_rate>1000</real_time_update_rate>
    </physics>

    <light name="sun" type="directional">
      <cast_shadows>true</cast_shadows>
      <pose>0 0 10 0 0 0</pose>
      <diffuse>0.8 0.8 0.8 1</diffuse>
      <specular>0.2 0.2 0.2 1</specular>
      <direction>-0.5 0.1 -0.9</direction>
    </light>

    <!-- A static model never moves, and needs no mass. -->
    <model name="ground_plane">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
        </collision>
        <visual name="visual">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.8 0.8 0.8 1</ambient><diffuse>0.8 0.8 0.8 1</diffuse></material>
        </visual>
      </link>
    </model>

    <!-- A box of 1 kg, with edges of 0.5 m, on the ground. Its inertia about each axis is m (a2 + b2) / 12. -->
    <model name="box">
      <pose>2 0 0.25 0 0 0</pose>
      <link name="link">
        <inertial>
          <mass>1</mass>
          <inertia><ixx>0.0417</ixx><iyy>0.0417</iyy><izz>0.0417</izz></inertia>
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

    <!-- Models from other files, named by their folders; `linkwright world list` lists them.
    <include>
      <uri>model://traffic_cone</uri>
      <name>cone_1</name>
      <pose>1 1 0 0 0 0</pose>
    </include>
    -->
  </world>
</sdf>
"""


def starting_world(name: str) -> str:
    """Return the text of a commented world with ground, light and a box.

    Gazebo classic and gz can read this world.

    Args:
        name: the name of the world.
    """
    return _TEXT.format(name=quoteattr(name))
