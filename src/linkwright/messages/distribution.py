"""Determine which ROS 2 distribution to follow where distributions differ."""

from __future__ import annotations

import os
from collections.abc import Mapping

ASSUMED_DISTRIBUTION_VARIABLE = "LINKWRIGHT_ROS_DISTRO_ASSUMED"
"""The variable that is set if ``ROS_DISTRO`` does not come from the user.

In that case, ``ROS_DISTRO`` is set only for launch files.
"""

BEFORE_IRON = ("dashing", "eloquent", "foxy", "galactic", "humble")
"""The distributions up to Humble."""


def is_before_iron(variables: Mapping[str, str] = os.environ) -> bool:
    """Return whether ``ROS_DISTRO`` names Humble or an earlier distribution.

    If the variable is not set, Humble is assumed.
    """
    distribution = variables.get("ROS_DISTRO", "").lower()
    return not distribution or distribution in BEFORE_IRON


def is_before_kilted(variables: Mapping[str, str] = os.environ) -> bool:
    """Return whether ``ROS_DISTRO`` names Jazzy or an earlier distribution.

    If the variable is not set, Humble is assumed.
    """
    return is_before_iron(variables) or variables.get("ROS_DISTRO", "").lower() in ("iron", "jazzy")


def checks_fields_as_ros(variables: Mapping[str, str] = os.environ) -> bool:
    """Return whether field values are checked as in ROS 2, where fewer values are accepted.

    This is the case if the user's ``ROS_DISTRO`` names Humble or an earlier distribution, or if
    ``ROS_PYTHON_CHECK_FIELDS`` is 1. Newer distributions accept any value unless ``ROS_PYTHON_CHECK_FIELDS`` is set.
    """
    if variables.get("ROS_PYTHON_CHECK_FIELDS") == "1":
        return True
    return (
        bool(variables.get("ROS_DISTRO"))
        and ASSUMED_DISTRIBUTION_VARIABLE not in variables
        and is_before_iron(variables)
    )
