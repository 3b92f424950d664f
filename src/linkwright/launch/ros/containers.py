"""Component containers, and the action that loads nodes into them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, is_misspelled, joined, phrase
from linkwright.launch.errors.alternatives import find_alternative
from linkwright.launch.errors.locations import error_at, with_location
from linkwright.launch.errors.unavailable import mark_unavailable
from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import normalize_to_list_of_substitutions, perform_substitutions
from linkwright.launch.ros.components import (
    ComposableLifecycleNode,
    ComposableNode,
    get_composable_node_load_request,
)
from linkwright.launch.ros.deprecated_arguments import with_deprecated_arguments
from linkwright.launch.ros.executables import Executable, find_installed_executable
from linkwright.launch.ros.lifecycle import LifecycleEventManager, call_service, is_autostarted
from linkwright.launch.ros.lifecycle_events import ChangeState
from linkwright.launch.ros.names import make_namespace_absolute, record_node_start
from linkwright.launch.ros.node import Node
from linkwright.launch.ros.parsing import Entities
from linkwright.launch.ros.skipped_nodes import record_skipped_node, remove_skipped_nodes
from linkwright.packages import is_installed, is_substitute

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext
    from linkwright.launch.model.markup.entity import Entity, Parser
    from linkwright.packages import PackageFinder

_LOGGER_NAME = "launch_ros.actions.load_composable_nodes"
_CONFIGURE_TRANSITION, _ACTIVATE_TRANSITION = 1, 3


@expose_action("load_composable_node")
class LoadComposableNodes(Action):
    """An action that loads nodes into a container as soon as the container is available.

    The nodes are loaded one after another.

    Args:
        composable_node_descriptions: the nodes to load.
        target_container: the action of the container, or the container's full name.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Sequence[ComposableNode],
        target_container: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__composable_node_descriptions = list(composable_node_descriptions)
        if not isinstance(target_container, ComposableNodeContainer):
            try:
                target_container = normalize_to_list_of_substitutions(target_container)
            except TypeError as error:
                message = phrase(
                    "'target_container' must be a container or its name, not {target_container}",
                    target_container=repr(target_container),
                )
                raise error_at(self.source_location, "LAUNCH139", message, ros_error=error) from error
        self.__target_container = target_container

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag and its ``composable_node`` tags."""
        _, kwargs = super().parse(entity, parser)
        kwargs["target_container"] = parser.parse_substitution(entity.get_attr("target", data_type=str))
        kwargs["composable_node_descriptions"] = _parse_descriptions(entity, parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Start loading the nodes in the background.

        Raises:
            LinkwrightError: the parameters of a node have errors.
        """
        requests = []
        for description in self.__composable_node_descriptions:
            try:
                request = get_composable_node_load_request(description, context)
            except LinkwrightError as error:
                raise with_location(error, description.source_location) from error
            if request is not None:
                requests.append((description, request))
        if requests:
            name = self._evaluate_container_name(context)
            context.session.spawn(self._load_in_sequence(context, name, requests))

    def _evaluate_container_name(self, context: LaunchContext) -> str:
        if isinstance(self.__target_container, ComposableNodeContainer):
            return self.__target_container.node_name
        name = make_namespace_absolute(perform_substitutions(context, self.__target_container))
        assert name is not None
        return name

    async def _load_in_sequence(
        self, context: LaunchContext, container: str, requests: list[tuple[ComposableNode, Any]]
    ) -> None:
        launcher = context.session.host.launcher_node
        client = launcher.create_client("composition_interfaces/srv/LoadNode", f"{container}/_container/load_node")
        try:
            for description, request in requests:
                remove_skipped_nodes(context, request)
                response = await call_service(context, client, request)
                if response is None:
                    return
                self._log_response(context, container, description, request, response)
        finally:
            launcher.destroy_client(client)

    def _log_response(
        self, context: LaunchContext, container: str, description: ComposableNode, request: Any, response: Any
    ) -> None:
        log = context.session.log
        name = response.full_node_name or request.node_name
        if not response.success:
            message = phrase(
                "Failed to load node '{name}' of type '{plugin}' in container '{container}': {reason}",
                name=name,
                plugin=request.plugin_name,
                container=container,
                reason=foreign(response.error_message),
            )
            alternative = find_alternative(request.package_name)
            if alternative is not None:
                message = joined((message, alternative), "; ")
            error = with_location(LinkwrightError(Diagnostic("LAUNCH139", message)), description.source_location)
            if _is_third_party(context.session.finder, request.package_name, request.plugin_name):
                mark_unavailable(error)
                record_skipped_node(context, request.node_name)
            context.session.report_start_failure(description, error)
            return
        warning = record_node_start(context, name)
        if warning is not None:
            log.write_warning(container, warning)
        log.write_info(_LOGGER_NAME, f"Loaded node '{name}' in container '{container}'")
        if isinstance(description, ComposableLifecycleNode):
            _monitor_lifecycle_node(context, description, name)


@expose_action("node_container")
@with_deprecated_arguments(node_executable="executable", node_name="name", node_namespace="namespace")
class ComposableNodeContainer(Node):
    """An action that starts a container, and loads nodes into it.

    Args:
        name: the name of the container.
        namespace: the namespace of the container.
        composable_node_descriptions: the nodes to load.
        kwargs: see `Node`.
    """

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Sequence[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__composable_node_descriptions = composable_node_descriptions
        self.__real: Executable | None = None

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: Sequence[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag and its ``composable_node`` tags."""
        _, kwargs = super().parse(entity, parser, ignore)
        kwargs["composable_node_descriptions"] = _parse_descriptions(entity, parser, optional=True)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Start the container, and return the action that loads the nodes.

        Raises:
            LinkwrightError: see `Node.execute`.
        """
        load_actions: list[Any] = []
        enabled_descriptions = [
            description
            for description in self.__composable_node_descriptions or ()
            if (condition := description.condition()) is None or condition.evaluate(context)
        ]
        if enabled_descriptions:
            # The nodes must be loaded in the same scope as the container, so the action is visited right after the
            # container.
            load_action = LoadComposableNodes(composable_node_descriptions=enabled_descriptions, target_container=self)
            load_action.source_location = self.source_location
            load_actions = [load_action]
        next_entities = super().execute(context)
        return [*(next_entities or ()), *load_actions] or None

    def _may_be_hosted(self, context: LaunchContext, package: str | None, executable: str) -> bool:
        """Return whether the container can run in the launcher's process.

        A container with third-party components runs in a separate process if its program is installed.
        """
        return super()._may_be_hosted(context, package, executable) and self._find_installed_container(context) is None

    def _find_executable(self, finder: PackageFinder, package: str, executable: str) -> Executable:
        return self.__real or super()._find_executable(finder, package, executable)

    def _find_installed_container(self, context: LaunchContext) -> Executable | None:
        from linkwright.nodes.options import COMPONENTS

        self.__real = None
        components = [
            tuple(
                perform_substitutions(context, substitutions)
                for substitutions in (composable_node_description.package, composable_node_description.node_plugin)
            )
            for composable_node_description in self.__composable_node_descriptions or ()
        ]
        if not all(component in COMPONENTS for component in components):
            package, executable = (
                perform_substitutions(context, normalize_to_list_of_substitutions(text))
                for text in (self.node_package, self.node_executable)
            )
            self.__real = find_installed_executable(context.session.finder, package, executable)
        return self.__real


def _is_third_party(finder: PackageFinder, package: str, plugin: str) -> bool:
    """Return whether a component belongs to third-party software that is not built here.

    A misspelled name of one of Linkwright's components does not count as third-party.
    """
    from linkwright.nodes.options import COMPONENTS

    share = finder.find(package)
    own_components = [f"{owner}/{name}" for owner, name in COMPONENTS]
    component = f"{package}/{plugin}"
    was_built = share is not None and is_installed(share) and not is_substitute(share)
    return not (was_built or component in own_components or is_misspelled(component, own_components))


def _parse_descriptions(entity: Entity, parser: Parser, *, optional: bool = False) -> list[ComposableNode]:
    tags = entity.get_attr("composable_node", data_type=Entities, optional=optional)
    descriptions = []
    for tag in tags or ():
        cls, kwargs = ComposableNode.parse(parser, tag)
        descriptions.append(cls(**kwargs))
    return descriptions


def _monitor_lifecycle_node(context: LaunchContext, description: ComposableLifecycleNode, full_name: str) -> None:
    """Monitor the state of a loaded lifecycle node.

    If ``autostart`` is set, also configure and activate the node.
    """
    description.record_full_name(full_name)
    LifecycleEventManager(description).setup_lifecycle_manager(context)
    if not is_autostarted(context, description.node_autostart):
        return
    from linkwright.launch.model.actions import EmitEvent
    from linkwright.launch.ros.lifecycle_events import OnStateTransition

    def request_transition(transition_id: int) -> ChangeState:
        return ChangeState(lifecycle_node_matcher=events.matches_action(description), transition_id=transition_id)

    activation = EmitEvent(event=request_transition(_ACTIVATE_TRANSITION))
    context.register_event_handler(
        OnStateTransition(
            target_lifecycle_node=description, goal_state="inactive", entities=[activation], handle_once=True
        )
    )
    context.emit_event_sync(request_transition(_CONFIGURE_TRANSITION))
