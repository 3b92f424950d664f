"""The distribution of ROS 2 to follow where they differ."""

from __future__ import annotations

import os
from collections.abc import Mapping

ASSUMED = "LINKWRIGHT_ROS_DISTRO_ASSUMED"
"""Set where the user named no distribution, and ``ROS_DISTRO`` is set only because launch files ask for it."""

BEFORE_IRON = ("dashing", "eloquent", "foxy", "galactic", "humble")
"""The distributions up to Humble."""


def is_before_iron(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether the distribution in ``ROS_DISTRO`` is Humble or an earlier one; without one, it is Humble."""
    distribution = variables.get("ROS_DISTRO", "").lower()
    return not distribution or distribution in BEFORE_IRON


def is_before_kilted(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether the distribution in ``ROS_DISTRO`` is Jazzy or an earlier one; without one, it is Humble."""
    return is_before_iron(variables) or variables.get("ROS_DISTRO", "").lower() in ("iron", "jazzy")


def checks_fields_as_ros(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether values of fields are checked as ROS 2 does, which accepts fewer than we do.

    They are where the user names Humble or an earlier distribution, and where ``ROS_PYTHON_CHECK_FIELDS`` asks for it,
    as in the newer ones, which otherwise accept any value.
    """
    if variables.get("ROS_PYTHON_CHECK_FIELDS") == "1":
        return True
    return bool(variables.get("ROS_DISTRO")) and ASSUMED not in variables and is_before_iron(variables)
