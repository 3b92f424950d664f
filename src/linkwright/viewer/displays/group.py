"""rviz_common/Group."""

from __future__ import annotations

from linkwright.viewer.config.former_names import GROUP
from linkwright.viewer.displays.base.display import ViewerDisplay


class GroupDisplay(ViewerDisplay):
    """Holds other displays, and switches them off together."""

    CLASS = GROUP
