"""The configuration of RViz for planning motions of a robot."""

from __future__ import annotations

from linkwright.planning.setup.groups import RobotGroups
from linkwright.planning.setup.yaml_text import quote_yaml
from linkwright.urdf import Robot

_TEXT = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
    Property Tree Widget:
      Expanded:
        - /MotionPlanning1
  - Class: rviz_common/Views
    Name: Views
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/Grid
      Name: Grid
      Enabled: true
      Value: true
      Reference Frame: <Fixed Frame>
    - Class: moveit_rviz_plugin/MotionPlanning
      Name: MotionPlanning
      Enabled: true
      Value: true
      Robot Description: robot_description
      Planning Scene Topic: monitored_planning_scene
      Velocity_Scaling_Factor: 0.1
      Acceleration_Scaling_Factor: 0.1
      MoveIt_Planning_Attempts: 10
      MoveIt_Planning_Time: 5
      Planned Path:
        Loop Animation: false
        Robot Alpha: 0.5
        Show Robot Visual: true
        Show Trail: false
        State Display Time: 0.05s
        Trajectory Topic: display_planned_path
      Planning Request:
        Planning Group: {group}
        Query Goal State: true
        Query Start State: false
      Scene Geometry:
        Scene Alpha: 1
        Show Scene Geometry: true
      Scene Robot:
        Robot Alpha: 1
        Show Robot Visual: true
  Enabled: true
  Global Options:
    Background Color: 48; 48; 48
    Fixed Frame: {frame}
    Frame Rate: 30
  Name: root
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Select
  Transformation:
    Current:
      Class: rviz_default_plugins/TF
  Value: true
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Name: Current View
      Target Frame: {frame}
      Distance: 2.5
      Focal Point:
        X: 0
        Y: 0
        Z: 0.4
      Pitch: 0.4
      Yaw: 0.8
    Saved: ~
Window Geometry:
  Height: 900
  Width: 1400
"""


def rviz_configuration(robot: Robot, groups: RobotGroups) -> str:
    """Return the text of ``moveit.rviz``, with the first group selected for planning."""
    return _TEXT.format(group=quote_yaml(groups.groups[0].name), frame=quote_yaml(robot.root))
