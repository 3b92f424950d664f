"""The tags of elements whose texts are the names of links and joints.

Plugins, sensors and other programs read these elements.
"""

from __future__ import annotations

from linkwright.loading.deferred import lazy_pattern

LINK_TAG = lazy_pattern(r"(?i)(frame|link|body|bumper)(_?(id|name))?s?$")
"""The ends of the tags with the name of a link, such as ``robot_base_frame`` and ``bodyName``."""
JOINT_TAG = lazy_pattern(r"(?i)joint(_?names?)?s?(_\d+)?$")
"""The ends of the tags with the name of a joint, such as ``left_joint`` and ``jointName``."""
