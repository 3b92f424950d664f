"""What all parts of a viewer share: its node, files and pages."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Node
from linkwright.packages import PackageFinder
from linkwright.viewer.frames.history import FrameHistory
from linkwright.viewer.graph_changes import GraphChanges
from linkwright.viewer.web.audience import PageGroup
from linkwright.viewer.web.files import Downloads, MeshFolders


@dataclass(frozen=True, slots=True)
class ViewerContext:
    """The node, the files and the pages of a viewer.

    Attributes:
        node: the viewer's node, to subscribe and to log with.
        library: reads descriptions, each once for the whole process.
        finder: finds packages.
        pages: every open page.
        transforms: where frames were, to place messages by the time in their headers.
        graph_changes: tells that nodes or endpoints came or went.
        meshes: the folders that pages may read from.
        downloads: files that were made for a page, to be fetched once.
        display_ids: ids that no display of the viewer has had.
    """

    node: Node
    library: DescriptionLibrary
    finder: PackageFinder
    pages: PageGroup
    transforms: FrameHistory
    graph_changes: GraphChanges
    meshes: MeshFolders = field(default_factory=MeshFolders)
    downloads: Downloads = field(default_factory=Downloads)
    display_ids: Iterator[str] = field(default_factory=lambda: map("display-{}".format, itertools.count(1)))

    def report(self, diagnostic: Diagnostic) -> None:
        """Show a finding in the terminal."""
        where = f"{diagnostic.span}: " if diagnostic.span else ""
        logger = self.node.get_logger()
        log: Callable[[str], object] = logger.error if diagnostic.severity is Severity.ERROR else logger.warning
        log(where + diagnostic.message)
