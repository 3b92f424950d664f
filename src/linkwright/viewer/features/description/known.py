"""What is derived from the description of one display, each part computed when it is first needed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from linkwright.packages import PackageFinder
from linkwright.urdf import Robot
from linkwright.viewer.protocol.description import Description, DescriptionChanged, DescriptionText, InertiaFindings

if TYPE_CHECKING:
    from linkwright.viewer.features.description.texts import SourceTexts


Part = TypeVar("Part")


class KnownDescription:
    """One description of a display. All of it may be asked for in another thread.

    Args:
        display: the RobotModel display.
        revision: counts the descriptions of the display.
        robot: what was read.
        text: what it was read from.
        prefix: the display's TF Prefix.
        files: what it was made from, as far as that is known.
    """

    def __init__(
        self, display: str, revision: int, robot: Robot, text: str, prefix: str, files: Iterable[Path]
    ) -> None:
        self.display = display
        self.revision = revision
        self.robot = robot
        self.text = text
        self.prefix = prefix
        self._files = tuple(files)

    @cached_property
    def texts(self) -> SourceTexts:
        """The files it was made from."""
        from linkwright.viewer.features.description.texts import SourceTexts

        return SourceTexts(self.robot.element, self._files)

    @cached_property
    def account(self) -> Description:
        """Its links and joints."""
        from linkwright.viewer.features.description.account import account  # which imports what takes long

        return account(
            self.robot,
            self.text,
            self.texts.names,
            display=self.display,
            revision=self.revision,
            prefix=self.prefix,
        )

    def changed_from(self, before: KnownDescription | None) -> DescriptionChanged:
        """What is another than in the description before; all of a first one is as it was."""
        links = _changed(before.robot.links, self.robot.links) if before else []
        joints = _changed(before.robot.joints, self.robot.joints) if before else []
        return DescriptionChanged(self.display, self.revision, links, joints)

    def named_text(self, file: str) -> DescriptionText:
        """One of its files, or the expanded text for an empty name; other files are refused."""
        text = self.text if file == "" else self.texts.text(file)
        return DescriptionText(self.display, self.revision, file, text)

    def findings(self, finder: PackageFinder) -> InertiaFindings:
        """What is implausible about its masses; found anew, for meshes may have changed."""
        from linkwright.viewer.features.description.masses import implausible

        return InertiaFindings(self.display, self.revision, implausible(self.robot, finder))


def _changed(before: Mapping[str, Part], after: Mapping[str, Part]) -> list[str]:
    """The links or joints that a robot lacked before or had otherwise; where they are written does not count."""
    # Elements, which know the places, take no part in comparisons of the model.
    return [name for name, part in after.items() if before.get(name) != part]
