"""The Displays tree."""

from __future__ import annotations

from typing import ClassVar

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage
from linkwright.viewer.protocol.parts import Property, PropertyValue, StatusLevel, StatusRow


class Display(Record):
    """One display of the Displays panel. `cls` is RViz's class, such as ``rviz_default_plugins/Grid``.

    `group` is the id of the group it is in, ``rviz_common/Group``, which comes before it. `enabled` is its own box; it
    is drawn when those of the groups around it are on too.

    `drawing` is the class whose drawing the page uses: its own, or for a display of another package the one it is like.

    `supported` is false for a class this program does not draw; it is kept and shown as such. What the rows mean:

    - RobotModel: a shape is drawn with the alpha of its colour, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. A link's row is a ``bool`` (draw its shapes) when it has any, else a ``group``.
    - TF: a frame is drawn when it has a row below ``Frames`` and that is on; frames that the filters leave out have
      none. ``Update Interval`` (seconds between updates, 0 for every frame) of both is applied by the page.
    """

    id: str
    cls: str
    drawing: str
    name: str
    group: str | None
    enabled: bool
    supported: bool
    level: StatusLevel
    status: list[StatusRow]
    properties: list[Property]


class Tree(ServerMessage):
    """The whole Displays tree: sent at the start and whenever displays come or go."""

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]


class DisplayProperties(ServerMessage):
    """The property rows of one display anew (the links of a new robot, the frames of TF)."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    properties: list[Property]


class PropertyChanged(ServerMessage):
    """One value, set by any page or by the server. Enable boxes are the property ``<display>/Enabled``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue
    options: list[str] | None = None


class DisplayStatus(ServerMessage):
    """The status rows of one display, or of ``global``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    level: StatusLevel
    status: list[StatusRow]


class SetProperty(PageMessage):
    """The user edited a property."""

    id: str
    value: PropertyValue
