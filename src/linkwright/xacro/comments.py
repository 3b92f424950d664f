"""Comments that belong to tags that disappear in the expansion.

A comment just above a property, macro, argument, include, condition or macro call describes that tag, and disappears
with it. Which comments disappear follows ros/xacro to the letter: of a run of comments upwards those that are separated
by blank text with at most one newline; and a marker is left behind at which the next such run stops. There is one
marker in a document: it moves. It is blank text, so its only visible effect is that an element with text and a marker
is no longer written on one line.
"""

from __future__ import annotations

from linkwright.xmltree import Comment, Node, Text


class CommentSweeper:
    """Takes away the comments above tags that are expanded, in one document."""

    def __init__(self) -> None:
        self._marker = Text("\n\n")
        self._home: list[Node] | None = None

    def sweep(self, siblings: list[Node], *, followed: bool) -> bool:
        """Remove the comments above the tag: those at the end of a list of siblings.

        Args:
            siblings: the expanded nodes above the tag.
            followed: whether the tag has nodes below it.

        Returns:
            Whether the caller is to `mark` the place below the tag.
        """
        at = len(siblings) - 1
        while at >= 0:
            node = siblings[at]
            if isinstance(node, Text) and node.data.isspace() and not node.cdata and node.data.count("\n") <= 1:
                at -= 1
            if at >= 0 and isinstance(siblings[at], Comment):
                del siblings[at]
                at -= 1
            else:
                return followed
        return False

    def mark(self, siblings: list[Node]) -> None:
        """Move the marker to the end of a list of siblings."""
        home = self._home
        if home is not None:
            for at in range(len(home) - 1, -1, -1):
                if home[at] is self._marker:
                    del home[at]
                    break
        siblings.append(self._marker)
        self._home = siblings

    def moved(self, old: list[Node], new: list[Node]) -> None:
        """The nodes of a list have become the end of another one."""
        if self._home is old:
            self._home = new
