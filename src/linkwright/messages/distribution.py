"""Which distribution of ROS 2 is meant, where they differ."""

from __future__ import annotations

import os
from collections.abc import Mapping

ASSUMED = "LINKWRIGHT_ROS_DISTRO_ASSUMED"
"""Set where nobody named a distribution, and ``ROS_DISTRO`` is there only because launch files ask for it."""

BEFORE_IRON = ("dashing", "eloquent", "foxy", "galactic", "humble")
"""The distributions up to Humble."""


def is_before_iron(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether the distribution in ``ROS_DISTRO`` is Humble or an earlier one; without one, it is Humble."""
    distribution = variables.get("ROS_DISTRO", "").lower()
    return not distribution or distribution in BEFORE_IRON


def is_before_kilted(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether the distribution in ``ROS_DISTRO`` is Jazzy or an earlier one; without one, it is Humble."""
    return is_before_iron(variables) or variables.get("ROS_DISTRO", "").lower() in ("iron", "jazzy")
