"""Writing a robot as URDF, in the order of the robot, so that reading it back gives an equal robot."""

from __future__ import annotations

from linkwright.schema import write_element
from linkwright.urdf.model import Robot
from linkwright.urdf.schema import ROBOT
from linkwright.xmltree import Document, Element, Text, write


def save(robot: Robot) -> str:
    """The robot as URDF text; defaults are left out, numbers are as short as they can be without loss.

    Materials stand at robot level. Elements of other rooms (``gazebo``, ``ros2_control``, ...) follow at the end
    as they were read.
    """
    root = write_element(ROBOT, robot)
    root.children += map(_tidied, robot.extensions)
    if robot.element is not None:
        # The extensions may use prefixes that the file declared on its root.
        root.attributes |= {name: value for name, value in robot.element.attributes.items() if name.startswith("xmlns")}
    return write(Document(root))


def _tidied(root: Element) -> Element:
    """A copy whose texts beside elements have no blanks around them, or writing would add some each time."""
    top = Element(root.tag, dict(root.attributes))
    todo = [(root, top)]  # not by recursion: what is nested too deep is for the writer to say
    while todo:
        element, copy = todo.pop()
        mixed = any(not isinstance(child, Text) for child in element.children)
        for child in element.children:
            if isinstance(child, Element):
                inner = Element(child.tag, dict(child.attributes))
                copy.children.append(inner)
                todo.append((child, inner))
            elif mixed and isinstance(child, Text) and not child.cdata:
                if text := child.data.strip():
                    copy.children.append(Text(text))
            else:
                copy.children.append(child)
    return top
