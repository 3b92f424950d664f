"""The writer of robots as URDF.

From the text, the reader returns an equal robot.
"""

from __future__ import annotations

from linkwright.schema import write_element
from linkwright.urdf.model import Robot
from linkwright.urdf.schema import ROBOT
from linkwright.xmltree import Document, write
from linkwright.xmltree.writer import strip_mixed_text


def save(robot: Robot) -> str:
    """Return the robot as URDF text.

    Defaults are omitted, and numbers are as short as possible without loss. Materials are written at the robot level.
    Other elements (``gazebo``, ``ros2_control``, ...) follow unchanged at the end.
    """
    root = write_element(ROBOT, robot)
    root.children += map(strip_mixed_text, robot.extensions)
    if robot.element is not None:
        # Extension elements may use prefixes that the original file declared on its root.
        root.attributes |= {name: value for name, value in robot.element.attributes.items() if name.startswith("xmlns")}
    return write(Document(root))
