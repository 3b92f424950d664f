"""rviz_common/Group."""

from __future__ import annotations

from linkwright.viewer.displays.base import ViewerDisplay
from linkwright.viewer.former_names import GROUP


class GroupDisplay(ViewerDisplay):
    """Holds other displays, and switches them off together."""

    CLASS = GROUP
