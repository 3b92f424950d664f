"""Find extensions of a robot that Gazebo ignored, because they name neither a link nor a joint."""

from __future__ import annotations

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.urdf import Robot

_GAZEBO = "gazebo"
_CONTENTS = "{change}: {contents}"
"""The form of the line about a removed extension."""


class UnusedReferences:
    """The ``<gazebo reference="...">`` elements of a robot that name neither a link nor a joint.

    Args:
        robot: the robot of the old version; None if it lacks parts that may have the names.
    """

    def __init__(self, robot: Robot | None) -> None:
        elements = () if robot is None else robot.extensions
        names = {element.attributes.get("reference", "") for element in elements if element.tag == _GAZEBO} - {""}
        self._names = set() if robot is None else names - robot.links.keys() - robot.joints.keys()

    def find_name(self, difference: Difference) -> str | None:
        """Return the unknown name if a difference is in such an element, which had no effect; else None."""
        tag, _, name = difference.name.partition(" ")
        return name if difference.subject == "extension" and tag == _GAZEBO and name in self._names else None

    def add_name(self, text: Phrase, difference: Difference) -> Phrase:
        """Return the line about a removed element, with the reason why it had no effect."""
        name = self.find_name(difference)
        if name is None or difference.kind != "removed":
            return text
        has_contents = text.template == _CONTENTS
        result = phrase(
            "{change}, which had no effect, because '{name}' was neither a link nor a joint",
            change=text.arguments["change"] if has_contents else text,
            name=name,
        )
        if not has_contents:
            return result
        return phrase("{change}: {contents}", change=result, contents=text.arguments["contents"])
