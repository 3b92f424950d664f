"""Files that hosted nodes reload when they are saved."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic
from linkwright.hosting.plans import Supervisor

if TYPE_CHECKING:
    from linkwright.graph import Node
    from linkwright.hosting.xacro_calls import XacroCall
    from linkwright.nodes.followed_files import ReadWorld


class FollowedFiles:
    """Watches the files of one node, as its `FileFollower`.

    Args:
        session: the run to which the node belongs.
        launcher: returns the node that calls services.
    """

    def __init__(self, session: Supervisor, launcher: Callable[[], Node]) -> None:
        self._session = session
        self._launcher = launcher
        self._followed: set[tuple[XacroCall, str]] = set()

    @property
    def launcher_node(self) -> Node:
        """The launcher's own node, which calls services."""
        return self._launcher()

    def show(self, about: str, findings: Iterable[Diagnostic]) -> None:
        """Show the current findings about a subject in the viewers."""
        self._session.reload.show(about, findings)

    def follow_world(
        self,
        world: ReadWorld,
        read: Callable[[str], ReadWorld],
        load: Callable[[str], Awaitable[Sequence[Diagnostic]]],
    ) -> None:
        """Read the file of a world when it is saved, and load it if it has no new errors."""
        session = self._session
        call = session.descriptions.begin_with(world, read)

        async def load_saved(path: str) -> None:
            findings = await load(path)
            if findings:
                session.reload.report(call, findings)

        session.reload.bind(call, lambda path: session.spawn(load_saved(path)))

    def follow_text(self, text: str, name: str, renew: Callable[[str], None]) -> None:
        """Call back with each new text of a description, if this process expanded it from a file."""
        call = self._session.descriptions.call_of(text)
        if call is not None and (call, name) not in self._followed:
            self._followed.add((call, name))
            self._session.reload.bind(call, renew)
