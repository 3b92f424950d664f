"""Find the topics that the filters of robot_localization no longer read."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase, quoted_names

_FILTER = re.compile(r"robot_localization/[eu]kf_\w+")
_SENSOR = re.compile(r"(?:odom|imu|pose|twist)\d+")
"""The parameters of a filter with the topics that it reads."""
_NAME = re.compile(r"/?[\w/]+")


def find_filter_topic_reason(program: str, parameter: str, old: str, new: str) -> Phrase | None:
    """Return the reason why another topic of a sensor is breaking, or None if it is not.

    Args:
        program: the package and the executable of the node.
        parameter: the name of the parameter.
        old: the old value, with the defaults of arguments.
        new: the new value, with the defaults of arguments.
    """
    if not _FILTER.fullmatch(program) or not _SENSOR.fullmatch(parameter):
        return None
    old, new = (value.strip("\"'") for value in (old, new))
    if not _NAME.fullmatch(old) or not _NAME.fullmatch(new) or old.strip("/") == new.strip("/"):
        return None
    return phrase("the filter no longer gets the messages of {names}", names=quoted_names([old]))
