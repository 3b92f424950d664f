"""The Controllers panel, the counterpart of ``rqt_controller_manager``."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph import Node
from linkwright.messages import Duration, get_message, get_service
from linkwright.nodes.service_waits import wait_for_future, wait_for_service
from linkwright.page.audience import Page
from linkwright.page.protocol.controllers import (
    ChangeController,
    ChangeHardware,
    ControllerList,
    ControllerManagers,
    ControllerResult,
    ControllerRow,
    HardwareRow,
    WatchControllers,
)
from linkwright.panels.monitor.watched_items import WatchedItemsFeature

_LIST_SUFFIX = "/list_controllers"
_PERIOD_S = 1.0
_RESPONSE_TIMEOUT_S = 5.0
_SWITCH_TIMEOUT_S = 5.0
_STRICT = 2
_TYPE_PARAMETER = ".type"


class ControllersFeature(WatchedItemsFeature["_Manager"]):
    """The feature that sends the controllers of a manager to pages, and changes their states."""

    def receive(self, page: Page, message: WatchControllers | ChangeController | ChangeHardware) -> None:
        """Handle a request. A page can change only the manager that it watches."""
        if not isinstance(message, WatchControllers):
            manager = self.find_watched(page, message.manager)
            if manager is not None:
                manager.change(message, page.send)
            return
        manager = self.watch(page, message.manager, wants_list=message.wants_list)
        if manager is not None and manager.list is not None:
            page.send(manager.list)

    def create_item(self, name: str) -> _Manager:
        """Start to follow the controllers of a manager."""
        return _Manager(self.context.node, name, lambda controllers: self.publish(name, controllers))

    def make_list(self) -> ControllerManagers:
        """Return the names of the managers."""
        services = self.context.node.get_service_names_and_types()
        names = [name.removesuffix(_LIST_SUFFIX) for name, _ in services if name.endswith(_LIST_SUFFIX)]
        return ControllerManagers(sorted(names))


class _ManagerError(Exception):
    """Raised if a manager does not answer or refuses a change; the text of the error is for the user."""


class _Manager:
    """A client of a controller manager that follows the states of its controllers.

    Args:
        node: the node that creates the clients.
        name: the full name of the manager.
        publish: called with the controllers after each change.

    Attributes:
        list: the controllers; None until the manager has answered.
    """

    def __init__(self, node: Node, name: str, publish: Callable[[ControllerList], None]) -> None:
        self.name = name
        self.list: ControllerList | None = None
        self._node = node
        self._publish = publish
        self._clients: dict[str, Any] = {}
        self._tasks = {asyncio.get_running_loop().create_task(self._follow())}

    def close(self) -> None:
        """Cancel requests, and destroy the clients."""
        for task in self._tasks:
            task.cancel()
        for client in self._clients.values():
            self._node.destroy_client(client)

    def change(self, message: ChangeController | ChangeHardware, on_result: Callable[[ControllerResult], None]) -> None:
        """Change a state, and call the callback with the result."""
        task = asyncio.get_running_loop().create_task(self._change(message, on_result))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _follow(self) -> None:
        while True:
            await self._refresh()
            await asyncio.sleep(_PERIOD_S)

    async def _refresh(self) -> None:
        try:
            controllers = await self._list_controllers()
            hardware = await self._list_hardware()
            newest = ControllerList(self.name, controllers, hardware, None)
        except _ManagerError as error:
            newest = ControllerList(self.name, [], [], str(error))
        if newest != self.list:
            self.list = newest
            self._publish(newest)

    async def _list_controllers(self) -> list[ControllerRow]:
        response = await self._call("controller_manager_msgs/srv/ListControllers", "list_controllers")
        rows = [
            ControllerRow(controller.name, controller.type, controller.state, list(controller.claimed_interfaces))
            for controller in response.controller
        ]
        loaded = {row.name for row in rows}
        return rows + [row for row in await self._list_unloaded() if row.name not in loaded]

    async def _list_unloaded(self) -> list[ControllerRow]:
        """Return the controllers whose types are parameters of the manager."""
        names = (await self._call("rcl_interfaces/srv/ListParameters", "list_parameters")).result.names
        names = sorted(name for name in names if name.endswith(_TYPE_PARAMETER) and name.count(".") == 1)
        if not names:
            return []
        values = (await self._call("rcl_interfaces/srv/GetParameters", "get_parameters", names=names)).values
        return [
            ControllerRow(name.removesuffix(_TYPE_PARAMETER), value.string_value, "not loaded", [])
            for name, value in zip(names, values, strict=False)
            if value.string_value
        ]

    async def _list_hardware(self) -> list[HardwareRow]:
        response = await self._call("controller_manager_msgs/srv/ListHardwareComponents", "list_hardware_components")
        return [
            HardwareRow(
                component.name,
                component.type,
                component.plugin_name,
                component.state.label,
                [interface.name for interface in component.command_interfaces],
            )
            for component in response.component
        ]

    async def _change(
        self, message: ChangeController | ChangeHardware, on_result: Callable[[ControllerResult], None]
    ) -> None:
        text = ""
        try:
            if isinstance(message, ChangeHardware):
                await self._change_hardware(message)
            else:
                await self._change_controller(message)
        except _ManagerError as error:
            text = str(error)
        on_result(ControllerResult(self.name, message.name, text))
        await self._refresh()

    async def _change_hardware(self, message: ChangeHardware) -> None:
        state = get_message("lifecycle_msgs/msg/State")(label=message.state)
        response = await self._call(
            "controller_manager_msgs/srv/SetHardwareComponentState",
            "set_hardware_component_state",
            name=message.name,
            target_state=state,
        )
        if not response.ok:
            raise _ManagerError(phrase("the manager could not change '{name}'; see its log", name=message.name))

    async def _change_controller(self, message: ChangeController) -> None:
        name, action = message.name, message.action
        if action in ("activate", "deactivate"):
            response = await self._call(
                "controller_manager_msgs/srv/SwitchController",
                "switch_controller",
                **{f"{action}_controllers": [name]},
                strictness=_STRICT,
                timeout=Duration.from_nanoseconds(round(_SWITCH_TIMEOUT_S * 1e9)),
            )
            reason = str(getattr(response, "message", ""))
        else:
            kind = f"controller_manager_msgs/srv/{action.capitalize()}Controller"
            response, reason = await self._call(kind, f"{action}_controller", name=name), ""
        if not response.ok:
            raise _ManagerError(reason or phrase("the manager could not change '{name}'; see its log", name=name))

    async def _call(self, kind: str, service: str, **fields: Any) -> Any:
        """Call a service of the manager, and return the response.

        Raises:
            _ManagerError: the manager does not answer in time.
        """
        client = self._clients.get(service)
        if client is None:
            client = self._clients[service] = self._node.create_client(get_service(kind), f"{self.name}/{service}")

        if await wait_for_service(self._node, client, _RESPONSE_TIMEOUT_S):
            future = client.call_async(get_service(kind).Request(**fields))
            if await wait_for_future(self._node, future, _RESPONSE_TIMEOUT_S + _SWITCH_TIMEOUT_S):
                return future.result()
        raise _ManagerError(phrase("the controller manager '{name}' does not answer", name=self.name))
