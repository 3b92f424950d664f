"""What is worked out about the description of one display, each thing when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.urdf import Robot
from linkwright.viewer.description.changes import changed_joints, changed_links
from linkwright.viewer.protocol import Description, DescriptionChanged, DescriptionText, InertiaFindings
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from linkwright.viewer.description.texts import SourceTexts


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
        from linkwright.viewer.description.texts import SourceTexts

        return SourceTexts(self.robot.element, self._files)

    @cached_property
    def account(self) -> Description:
        """Its links and joints."""
        from linkwright.viewer.description.account import account  # which imports what takes long

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
        links = changed_links(before.robot, self.robot) if before else []
        joints = changed_joints(before.robot, self.robot) if before else []
        return DescriptionChanged(self.display, self.revision, links, joints)

    def named_text(self, file: str) -> DescriptionText:
        """One of its files, or the expanded text for an empty name; other files are refused."""
        text = self.text if file == "" else self.texts.text(file)
        return DescriptionText(self.display, self.revision, file, text)

    def findings(self, finder: PackageFinder) -> InertiaFindings:
        """What is implausible about its masses; found anew, for meshes may have changed."""
        from linkwright.viewer.description.masses import implausible

        return InertiaFindings(self.display, self.revision, implausible(self.robot, finder))
