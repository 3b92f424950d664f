"""World editing in the page: pages edit the world's text, and the simulation loads it.

The text comes from the file that the simulator's parameter ``world`` names. If there is no such file, or if it
contains another world, the text is the description that the simulator publishes. All pages edit the same text, and
their requests are handled in the order in which they arrive.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import LATCHED_QOS
from linkwright.messages import get_message, get_service
from linkwright.page.audience import Page
from linkwright.page.protocol.message import PageMessage, ServerMessage
from linkwright.page.protocol.simulation import (
    ModelingState,
    RedoWorld,
    RequestModels,
    SaveWorld,
    SetModeling,
    UndoWorld,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.locations import recovery_folder
from linkwright.simulation.page.services import SimulationServices, refuse

if TYPE_CHECKING:
    from linkwright.simulation.page.modeling.edited_world import EditedWorld

_DESCRIPTION_TOPIC = "/world_description"
_EMPTY_SERVICE, _LOAD_SERVICE = "std_srvs/srv/Empty", "simulation_interfaces/srv/LoadWorld"
_TIMEOUT_S = 30.0
"""The maximum time to wait for a response or the description of the simulation, in seconds."""


class ModelingFeature(PageFeature):
    """The feature that shows models and lights of the world in pages, and applies edits."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._services = SimulationServices(self.context)
        self._is_watching = False
        self._can_edit = False
        self._is_active = False
        self._edited_world: EditedWorld | None = None
        self._requests: asyncio.Queue[tuple[Page, PageMessage]] = asyncio.Queue()
        self._worker: asyncio.Task[None] | None = None

    def opening_messages(self) -> list[ServerMessage]:
        """Return the state of world editing for a new page.

        The method also begins to watch the graph for a simulated world.
        """
        if not self._is_watching:
            self._is_watching = True
            self.context.graph_changes.watch(self._update_availability)
            self._can_edit = self._is_available()
        return [self._build_state()]

    def remove_page(self, page: Page) -> None:
        """Stop watching the graph after the last page has closed, and keep the edits."""
        if self._is_watching and len(self.context.pages) == 0:
            self._is_watching = False
            self.context.graph_changes.unwatch(self._update_availability)

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store the unsaved text of the world in the recovery folder, and return a finding.

        The list is empty if there are no unsaved changes.
        """
        if self._edited_world is None or not self._edited_world.is_unsaved:
            return []
        return [self._edited_world.store_unsaved(recovery_folder())]

    def close(self) -> None:
        """Stop the feature permanently."""
        self.context.graph_changes.unwatch(self._update_availability)
        self._services.close()
        if self._worker is not None:
            self._worker.cancel()

    def receive(self, page: Page, message: Any) -> None:
        """Queue a request of a page.

        Requests are handled in the order in which they arrive.
        """
        self._requests.put_nowait((page, message))
        if self._worker is None:
            self._worker = asyncio.get_running_loop().create_task(self._handle_requests())

    # --- messages to pages -------------------------------------------------------------------------------------

    def _is_available(self) -> bool:
        """Return whether a simulation publishes the description of its world."""
        return bool(self.context.node.get_publishers_info_by_topic(_DESCRIPTION_TOPIC))

    def _update_availability(self) -> None:
        is_available = self._is_available()
        if is_available != self._can_edit:
            self._can_edit = is_available
            self._publish()

    def _build_state(self) -> ModelingState:
        edited_world = self._edited_world
        if edited_world is None:
            return ModelingState(self._can_edit, self._is_active, None, False, False, False, [])
        from linkwright.simulation.page.modeling.entities import list_entities

        file = None if edited_world.file is None else str(edited_world.file)
        entities = list_entities(edited_world.world)
        return ModelingState(
            self._can_edit,
            self._is_active,
            file,
            edited_world.is_unsaved,
            edited_world.can_undo,
            edited_world.can_redo,
            entities,
        )

    def _publish(self) -> None:
        self.context.pages.publish(self._build_state())

    # --- requests of pages ------------------------------------------------------------------------------------

    async def _handle_requests(self) -> None:
        """Handle the queued requests one at a time, because reading a large world takes long."""
        from linkwright.sdf.editing import EditError

        while True:
            page, message = await self._requests.get()
            try:
                await self._handle(page, message)
            except EditError as error:
                refuse(page, error.message)
            except LinkwrightError as error:
                finding = error.diagnostics[0]
                refuse(page, finding.located_message)
            except Exception as error:  # noqa: BLE001  # editing must continue after an error of this program
                self.context.node.get_logger().error(f"The world cannot be edited: {type(error).__name__}: {error}")
                refuse(page, f"{type(error).__name__}: {error}")

    async def _handle(self, page: Page, message: PageMessage) -> None:
        if isinstance(message, RequestModels):
            from linkwright.simulation.page.modeling.entities import list_model_choices

            page.send(await asyncio.to_thread(list_model_choices, self.context.finder))
        elif isinstance(message, SetModeling):
            await self._set_active(page, active=message.active)
        elif isinstance(message, SaveWorld):
            edited_world = await self._get_current_world()
            await asyncio.to_thread(edited_world.save, message.path)
            self._publish()
        else:
            edited_world = await self._get_current_world()
            await asyncio.to_thread(_create_edit(edited_world, message))
            self._publish()
            if self._requests.empty():
                await self._load(page, edited_world)

    async def _set_active(self, page: Page, *, active: bool) -> None:
        if active == self._is_active:
            return
        if active:
            await self._get_current_world()
            await self._call_service(page, _EMPTY_SERVICE, "/pause_physics")
            await self._call_service(page, _EMPTY_SERVICE, "/reset_simulation")
        else:
            await self._call_service(page, _EMPTY_SERVICE, "/unpause_physics")
        self._is_active = active
        self._publish()

    async def _get_current_world(self) -> EditedWorld:
        """Return the edited world, and read it on first use.

        If its file has changed and there are no unsaved edits, the world is read again.
        """
        from linkwright.simulation.page.modeling.edited_world import EditedWorld

        edited_world, packages = self._edited_world, self.context.finder
        if edited_world is not None and edited_world.file is not None:
            if not edited_world.is_unsaved and await asyncio.to_thread(lambda: edited_world.is_outdated):
                reloaded = await asyncio.to_thread(EditedWorld.from_file, edited_world.file, packages)
                await asyncio.to_thread(reloaded.reserve, edited_world.world.reserved)
                self._edited_world = reloaded
        elif edited_world is None:
            self._edited_world = await self._read_world()
        assert self._edited_world is not None, "one of the branches sets it"
        return self._edited_world

    async def _read_world(self) -> EditedWorld:
        """Return the simulated world from its file, or else from the published description."""
        from linkwright.sdf.editing import EditError
        from linkwright.sdf.resources import ResourceFinder
        from linkwright.simulation.page.modeling.edited_world import EditedWorld

        packages = self.context.finder
        published_world = await asyncio.to_thread(EditedWorld.from_text, await self._receive_description(), packages)
        name = await self._request_world_file()
        path = await asyncio.to_thread(ResourceFinder(packages).world, name) if name else None
        if path is not None:
            with suppress(EditError, LinkwrightError):  # On another machine, this path may be a different file.
                file_world = await asyncio.to_thread(EditedWorld.from_file, path.absolute(), packages)
                if file_world.world.world.name == published_world.world.world.name:
                    await asyncio.to_thread(file_world.reserve, published_world.world.entities)
                    return file_world
        return published_world

    async def _request_world_file(self) -> str:
        """Return the value of the simulator's parameter ``world``.

        An empty string is returned if there is no such parameter, or if the simulator does not respond.
        """
        node = self.context.node
        publishers = node.get_publishers_info_by_topic(_DESCRIPTION_TOPIC)
        if not publishers:
            return ""
        name = f"{publishers[0].node_namespace.rstrip('/')}/{publishers[0].node_name}/get_parameters"
        client = node.create_client(get_service("rcl_interfaces/srv/GetParameters"), name)
        world_file: asyncio.Future[str] = asyncio.get_running_loop().create_future()

        def on_response(future: Any) -> None:
            if not world_file.done():
                world_file.set_result(next((value.string_value for value in future.result().values), ""))

        try:
            if not client.service_is_ready():
                return ""
            client.call_async(client.srv_type.Request(names=["world"])).add_done_callback(on_response)
            return await asyncio.wait_for(world_file, _TIMEOUT_S)
        except asyncio.TimeoutError:
            return ""
        finally:
            node.destroy_client(client)

    async def _receive_description(self) -> str:
        """Wait for the description that the simulator publishes, and return it.

        Raises:
            EditError: no simulator publishes a description.
        """
        from linkwright.sdf.editing import EditError

        node = self.context.node
        text: asyncio.Future[str] = asyncio.get_running_loop().create_future()

        def on_description(message: Any) -> None:
            if not text.done():
                text.set_result(message.data)

        subscription = node.create_subscription(
            get_message("std_msgs/msg/String"), _DESCRIPTION_TOPIC, on_description, LATCHED_QOS
        )
        try:
            return await asyncio.wait_for(text, _TIMEOUT_S if self._is_available() else 0)
        except asyncio.TimeoutError:
            raise EditError(
                phrase("there is no world to edit, because no simulation publishes one; start a simulation")
            ) from None
        finally:
            node.destroy_subscription(subscription)

    async def _load(self, page: Page, edited_world: EditedWorld) -> None:
        """Ask the simulator to load the edited world in place of the current one."""
        resource = get_message("simulation_interfaces/msg/Resource")
        world_resource = resource(uri=str(edited_world.path.absolute()), resource_string=edited_world.world.text)
        fields = {"world_resource": world_resource, "ignore_missing_or_unsupported_assets": True}
        await self._call_service(page, _LOAD_SERVICE, "/load_world", fields)

    async def _call_service(
        self, page: Page, service_type: str, name: str, fields: dict[str, Any] | None = None
    ) -> None:
        """Call a service, wait for the response, and report a timeout to the page."""
        response_arrived: asyncio.Future[None] = asyncio.get_running_loop().create_future()

        def on_response(_: Any) -> None:
            if not response_arrived.done():
                response_arrived.set_result(None)

        self._services.call_service(page, service_type, name, fields or {}, on_response)
        try:
            await asyncio.wait_for(response_arrived, _TIMEOUT_S)
        except asyncio.TimeoutError:
            refuse(page, phrase("'{name}' did not respond", name=name))


def _create_edit(edited_world: EditedWorld, message: PageMessage) -> Callable[[], None]:
    """Return a function that applies a page's request to a world.

    The function is slow, so the caller runs it in a thread.
    """
    from linkwright.simulation.page.modeling.entities import apply_edit

    if isinstance(message, UndoWorld):
        return edited_world.undo
    if isinstance(message, RedoWorld):
        return edited_world.redo
    return partial(edited_world.edit, partial(apply_edit, message=message))
