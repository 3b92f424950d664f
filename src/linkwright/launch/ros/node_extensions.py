"""Extensions of the node action, which users' packages bring: what is done before a node is started."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.extensions import extensions

if TYPE_CHECKING:
    from linkwright.launch.model.action import Action
    from linkwright.launch.model.context import LaunchContext

GROUP = "launch_ros.node_action"
"""The group of entry points, that of launch_ros."""


class NodeActionExtension:
    """The base of extensions of `Node`.

    Attributes:
        NAME: that of its entry point, when it was found by one.
        EXTENSION_POINT_VERSION: the version of this interface that the extension was written for.
    """

    NAME: str | None = None
    EXTENSION_POINT_VERSION: ClassVar[str] = "0.1"

    def prepare_for_execute(
        self, context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Action
    ) -> tuple[Sequence[Any], dict[str, Any]]:
        """Have a say before a node is started.

        Args:
            context: that of the launch.
            ros_specific_arguments: ``name`` and ``ns``, where the node is given them, as ``__node:=talker``.
            node_action: the action.

        Returns:
            Substitutions that go to the end of the command line; and the arguments, which may be changed.
        """
        del context, node_action
        return [], ros_specific_arguments


@cache
def node_extensions() -> tuple[NodeActionExtension, ...]:
    """An object of each extension that is installed.

    Raises:
        LinkwrightError: LAUNCH155, one of them cannot be loaded.
    """
    found = []
    for name, entry in extensions(GROUP).items():
        try:
            extension = entry.load()()
        except Exception as error:
            message = phrase("the node extension '{name}' cannot be loaded: {error}", name=name, error=foreign(error))
            raise LinkwrightError(Diagnostic("LAUNCH155", message)) from error
        extension.NAME = name
        found.append(extension)
    return tuple(found)
