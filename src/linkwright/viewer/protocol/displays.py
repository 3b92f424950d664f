"""The Displays tree."""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.viewer.protocol.parts import Property, PropertyValue, StatusLevel, StatusRow
from linkwright.viewer.protocol.record import record


@record
class Display:
    """One display of the Displays panel. `cls` is RViz's class, such as ``rviz_default_plugins/Grid``.

    `group` is the id of the group it is in, ``rviz_common/Group``, which comes before it. `enabled` is its own box; it
    is drawn when those of the groups around it are on too.

    `supported` is false for a class this program does not draw; it is kept and shown as such. What the rows mean:

    - RobotModel: a shape is drawn with the alpha of its colour, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. A link's row is a ``bool`` (draw its shapes) when it has any, else a ``group``.
    - TF: a frame is drawn when it has a row below ``Frames`` and that is on; frames that the filters leave out have
      none. ``Update Interval`` (seconds between updates, 0 for every frame) of both is applied by the page.
    """

    id: str
    cls: str
    name: str
    group: str | None
    enabled: bool
    supported: bool
    level: StatusLevel
    status: list[StatusRow]
    properties: list[Property]


@record
class Tree:
    """The whole Displays tree: sent at the start and whenever displays come or go."""

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]
    type: Literal["tree"] = "tree"


@record
class DisplayProperties:
    """The property rows of one display anew (the links of a new robot, the frames of TF)."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    properties: list[Property]
    type: Literal["display_properties"] = "display_properties"


@record
class PropertyChanged:
    """One value, set by any page or by the server. Enable boxes are the property ``<display>/Enabled``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue
    options: list[str] | None = None
    type: Literal["property_changed"] = "property_changed"


@record
class DisplayStatus:
    """The status rows of one display, or of ``global``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    level: StatusLevel
    status: list[StatusRow]
    type: Literal["display_status"] = "display_status"


@record
class SetProperty:
    """The user edited a property."""

    id: str
    value: PropertyValue
    type: Literal["set_property"] = "set_property"
