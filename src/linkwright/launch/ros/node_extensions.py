"""Extensions of the action `Node`.

Users' packages provide extensions, which run before a node is started.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.loading.extensions import extensions

if TYPE_CHECKING:
    from linkwright.launch.model.action import Action
    from linkwright.launch.model.context import LaunchContext

GROUP = "launch_ros.node_action"
"""The entry point group of node extensions, the same as in launch_ros."""


class NodeActionExtension:
    """The base class of extensions of `Node`.

    Attributes:
        NAME: the name of the entry point of the extension; None before it is loaded.
        EXTENSION_POINT_VERSION: the version of this interface that the extension implements.
    """

    NAME: str | None = None
    EXTENSION_POINT_VERSION: ClassVar[str] = "0.1"

    def prepare_for_execute(
        self, context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Action
    ) -> tuple[Sequence[Any], dict[str, Any]]:
        """Change the arguments of a node before it is started.

        Args:
            context: the context of the launch.
            ros_specific_arguments: the arguments for ``name`` and ``ns`` that are set, such as ``__node:=talker``.
            node_action: the action that starts the node.

        Returns:
            Substitutions to append to the command line, and the changed or unchanged ROS-specific arguments.
        """
        del context, node_action
        return [], ros_specific_arguments


@cache
def node_extensions() -> tuple[NodeActionExtension, ...]:
    """Return an instance of each installed extension.

    Raises:
        LinkwrightError: LAUNCH155, an extension cannot be loaded.
    """
    node_extensions_list = []
    for name, entry_point in extensions(GROUP).items():
        try:
            extension = entry_point.load()()
        except Exception as error:
            message = phrase("the node extension '{name}' cannot be loaded: {error}", name=name, error=foreign(error))
            raise LinkwrightError(Diagnostic("LAUNCH155", message)) from error
        extension.NAME = name
        node_extensions_list.append(extension)
    return tuple(node_extensions_list)
