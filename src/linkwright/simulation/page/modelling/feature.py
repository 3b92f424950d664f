"""World editing in the page: pages edit the text of the world, and the simulation loads the result.

The text is read from the file in the simulator's parameter ``world``. If there is no such file, or if it contains
another world, the text is the description that the simulator publishes. All pages edit the same text, and their
requests are handled one after the other.
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
    AskModels,
    ModellingState,
    RedoWorld,
    SaveWorld,
    SetModelling,
    UndoWorld,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config.locations import recovery_folder
from linkwright.simulation.page.services import SimulationServices, refuse

if TYPE_CHECKING:
    from linkwright.simulation.page.modelling.edited_world import EditedWorld

_DESCRIPTION = "/world_description"
_EMPTY, _LOAD = "std_srvs/srv/Empty", "simulation_interfaces/srv/LoadWorld"
_PATIENCE = 30.0
"""Seconds to wait for an answer of the simulation, or its description."""


class ModellingFeature(PageFeature):
    """The feature that shows pages the models and lights of the world, and applies the pages' edits."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._services = SimulationServices(self.context)
        self._listening = False
        self._available = False
        self._active = False
        self._edited: EditedWorld | None = None
        self._waiting: asyncio.Queue[tuple[Page, PageMessage]] = asyncio.Queue()
        self._worker: asyncio.Task[None] | None = None

    def opening(self) -> list[ServerMessage]:
        """Return the message that describes whether the world can be edited, and its entities once read."""
        if not self._listening:
            self._listening = True
            self.context.graph_changes.watch(self._review)
            self._available = self._is_available()
        return [self._state()]

    def page_closed(self, page: Page) -> None:
        """Stop watching the graph after the last page has closed; edits are kept."""
        if self._listening and len(self.context.pages) == 0:
            self._listening = False
            self.context.graph_changes.unwatch(self._review)

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store the text of an unsaved world in the recovery folder, and return the finding about it.

        The list is empty if nothing is unsaved.
        """
        if self._edited is None or not self._edited.unsaved:
            return []
        return [self._edited.store_unsaved(recovery_folder())]

    def close(self) -> None:
        """Stop the feature permanently."""
        self.context.graph_changes.unwatch(self._review)
        self._services.close()
        if self._worker is not None:
            self._worker.cancel()

    def receive(self, page: Page, message: Any) -> None:
        """Queue a request of a page; requests are handled in the order in which they arrive."""
        self._waiting.put_nowait((page, message))
        if self._worker is None:
            self._worker = asyncio.get_running_loop().create_task(self._work())

    # --- messages to pages -------------------------------------------------------------------------------------

    def _is_available(self) -> bool:
        """Return whether a simulation publishes the description of its world."""
        return bool(self.context.node.get_publishers_info_by_topic(_DESCRIPTION))

    def _review(self) -> None:
        available = self._is_available()
        if available != self._available:
            self._available = available
            self._publish()

    def _state(self) -> ModellingState:
        edited = self._edited
        if edited is None:
            return ModellingState(self._available, self._active, None, False, False, False, [])
        from linkwright.simulation.page.modelling.entities import entities_of

        file = None if edited.file is None else str(edited.file)
        entities = entities_of(edited.world)
        return ModellingState(
            self._available, self._active, file, edited.unsaved, edited.can_undo, edited.can_redo, entities
        )

    def _publish(self) -> None:
        self.context.pages.publish(self._state())

    # --- requests of pages ------------------------------------------------------------------------------------

    async def _work(self) -> None:
        """Handle the queued requests one after the other, because reading a large world takes time."""
        from linkwright.sdf.editing import EditError

        while True:
            page, message = await self._waiting.get()
            try:
                await self._do(page, message)
            except EditError as error:
                refuse(page, error.message)
            except LinkwrightError as error:
                found = error.diagnostics[0]
                refuse(page, found.placed_message)
            except Exception as error:  # noqa: BLE001  # editing must continue after an error of this program
                self.context.node.get_logger().error(f"The world cannot be edited: {type(error).__name__}: {error}")
                refuse(page, f"{type(error).__name__}: {error}")

    async def _do(self, page: Page, message: PageMessage) -> None:
        if isinstance(message, AskModels):
            from linkwright.simulation.page.modelling.entities import choices

            page.send(await asyncio.to_thread(choices, self.context.finder))
        elif isinstance(message, SetModelling):
            await self._set_active(page, active=message.active)
        elif isinstance(message, SaveWorld):
            edited = await self._world()
            await asyncio.to_thread(edited.save, message.path)
            self._publish()
        else:
            edited = await self._world()
            await asyncio.to_thread(_edit(edited, message))
            self._publish()
            if self._waiting.empty():
                await self._load(page, edited)

    async def _set_active(self, page: Page, *, active: bool) -> None:
        if active == self._active:
            return
        if active:
            await self._world()
            await self._ask(page, _EMPTY, "/pause_physics")
            await self._ask(page, _EMPTY, "/reset_simulation")
        else:
            await self._ask(page, _EMPTY, "/unpause_physics")
        self._active = active
        self._publish()

    async def _world(self) -> EditedWorld:
        """Return the edited world, which is read on first use.

        A world without unsaved edits is read again if its file has changed.
        """
        from linkwright.simulation.page.modelling.edited_world import EditedWorld

        edited, packages = self._edited, self.context.finder
        if edited is not None and edited.file is not None:
            if not edited.unsaved and await asyncio.to_thread(lambda: edited.is_outdated):
                fresh = await asyncio.to_thread(EditedWorld.of_file, edited.file, packages)
                await asyncio.to_thread(fresh.reserve, edited.world.reserved)
                self._edited = fresh
        elif edited is None:
            self._edited = await self._read()
        assert self._edited is not None, "one of the branches sets it"
        return self._edited

    async def _read(self) -> EditedWorld:
        """Return the simulated world from its file, or else from the published description."""
        from linkwright.sdf.editing import EditError
        from linkwright.sdf.resources import ResourceFinder
        from linkwright.simulation.page.modelling.edited_world import EditedWorld

        packages = self.context.finder
        described = await asyncio.to_thread(EditedWorld.of_text, await self._described(), packages)
        name = await self._request_world_file()
        path = await asyncio.to_thread(ResourceFinder(packages).world, name) if name else None
        if path is not None:
            with suppress(EditError, LinkwrightError):  # On another machine, this path may be a different file.
                found = await asyncio.to_thread(EditedWorld.of_file, path.absolute(), packages)
                if found.world.world.name == described.world.world.name:
                    await asyncio.to_thread(found.reserve, described.world.entities)
                    return found
        return described

    async def _request_world_file(self) -> str:
        """Return the value of the simulator's parameter ``world``.

        An empty string is returned if there is no such parameter, or if the simulator does not respond.
        """
        node = self.context.node
        publishers = node.get_publishers_info_by_topic(_DESCRIPTION)
        if not publishers:
            return ""
        name = f"{publishers[0].node_namespace.rstrip('/')}/{publishers[0].node_name}/get_parameters"
        client = node.create_client(get_service("rcl_interfaces/srv/GetParameters"), name)
        reply: asyncio.Future[str] = asyncio.get_running_loop().create_future()

        def receive(future: Any) -> None:
            if not reply.done():
                reply.set_result(next((value.string_value for value in future.result().values), ""))

        try:
            if not client.service_is_ready():
                return ""
            client.call_async(client.srv_type.Request(names=["world"])).add_done_callback(receive)
            return await asyncio.wait_for(reply, _PATIENCE)
        except asyncio.TimeoutError:
            return ""
        finally:
            node.destroy_client(client)

    async def _described(self) -> str:
        """Return the description that the simulator publishes.

        Raises:
            EditError: the simulator does not publish one.
        """
        from linkwright.sdf.editing import EditError

        node = self.context.node
        text: asyncio.Future[str] = asyncio.get_running_loop().create_future()

        def receive(message: Any) -> None:
            if not text.done():
                text.set_result(message.data)

        subscription = node.create_subscription(get_message("std_msgs/msg/String"), _DESCRIPTION, receive, LATCHED_QOS)
        try:
            return await asyncio.wait_for(text, _PATIENCE if self._is_available() else 0)
        except asyncio.TimeoutError:
            raise EditError(phrase("there is no world to edit: no simulation publishes one")) from None
        finally:
            node.destroy_subscription(subscription)

    async def _load(self, page: Page, edited: EditedWorld) -> None:
        """Ask the simulator to load the edited world in place of the current one."""
        resource = get_message("simulation_interfaces/msg/Resource")
        named = resource(uri=str(edited.path.absolute()), resource_string=edited.world.text)
        fields = {"world_resource": named, "ignore_missing_or_unsupported_assets": True}
        await self._ask(page, _LOAD, "/load_world", fields)

    async def _ask(self, page: Page, kind: str, name: str, fields: dict[str, Any] | None = None) -> None:
        """Call a service, wait for the response, and report a timeout to the page."""
        done: asyncio.Future[None] = asyncio.get_running_loop().create_future()

        def answered(_: Any) -> None:
            if not done.done():
                done.set_result(None)

        self._services.ask(page, kind, name, fields or {}, answered)
        try:
            await asyncio.wait_for(done, _PATIENCE)
        except asyncio.TimeoutError:
            refuse(page, phrase("'{name}' did not respond", name=name))


def _edit(edited: EditedWorld, message: PageMessage) -> Callable[[], None]:
    """Return a slow function, to be run in a thread, that applies a page's request to a world."""
    from linkwright.simulation.page.modelling.entities import apply_edit

    if isinstance(message, UndoWorld):
        return edited.undo
    if isinstance(message, RedoWorld):
        return edited.redo
    return partial(edited.edit, partial(apply_edit, message=message))
