"""What pages can ask for besides displays, one class each: joints, the description's story, monitors, ..."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.graph import Node
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.audience import Page
from linkwright.viewer.protocol import ServerMessage
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from linkwright.viewer.manager import VisualizationManager


@dataclass(slots=True)
class Desk:
    """What features work with.

    Attributes:
        node: the viewer's node, to subscribe and to log with.
        library: reads descriptions, each once for the whole process.
        finder: finds packages.
        publish: sends a message to every page.
        manager_of: gives what a page sees.
        managers: gives all managers there are now: the one that pages share, and those of single pages.
    """

    node: Node
    library: DescriptionLibrary
    finder: PackageFinder
    publish: Callable[[ServerMessage], None]
    manager_of: Callable[[Page], VisualizationManager]
    managers: Callable[[], list[VisualizationManager]]


class PageFeature:
    """Answers some of the messages of pages.

    Nothing of it may cost while no page asks for it: what a page asked to be sent is kept per page, and ended in
    `page_gone`.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = ()
    """The messages of pages that come to `receive`."""

    def start(self) -> None:
        """The viewer listens now."""

    def opening(self) -> list[ServerMessage]:
        """What a page must be told that opens now."""
        return []

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:  # noqa: ARG002
        """What a page must be told that sees a configuration: one that opens, or all when it is another."""
        return []

    def dropped(self, manager: VisualizationManager) -> None:
        """A manager has ended, and what is kept of it is needed no more."""

    def receive(self, page: Page, message: Any) -> None:
        """Do what a page asks for; the message is of one of the classes in `RECEIVES`."""

    def page_gone(self, page: Page) -> None:
        """A page was closed."""

    def close(self) -> None:
        """End for good."""
