"""The parameters of one node as they are, kept current from ``/parameter_events``."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from linkwright.graph import Node
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.file_text import parameter_file_text, plain_value
from linkwright.viewer.features.monitor.pacing import Paced
from linkwright.viewer.features.monitor.parameter_texts import parameter_of, parameter_row, value_texts
from linkwright.viewer.protocol.parameters import (
    NodeParameters,
    ParameterDump,
    ParameterResult,
    ParameterRow,
    SetParameter,
)

_PATIENCE = 5.0
"""Seconds for services to appear, and for an answer."""

_LOOK_EVERY = 0.05
_TELL_PERIOD = 0.05


class NoAnswerError(Exception):
    """A node did not answer in time; the text says what was asked."""


class RemoteNode:
    """Reads and sets the parameters of a node, and knows them while it is watched.

    Args:
        node: makes the clients.
        name: full name of the node whose parameters these are.
        tell: called with all parameters when they are known, and on every change.
    """

    def __init__(self, node: Node, name: str, tell: Callable[[NodeParameters], None]) -> None:
        self.name = name
        self.known: NodeParameters | None = None
        self._tell = tell
        self._client = AsyncParameterClient(node, name)
        self._rows: dict[str, ParameterRow] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._turn = Paced(self._tell_rows, _TELL_PERIOD)

    def close(self) -> None:
        """Stop asking."""
        self._turn.cancel()
        for task in self._tasks:
            task.cancel()
        self._client.destroy()

    def refresh(self) -> None:
        """Ask for everything again."""
        self._run(self._refresh())

    def take(self, event: Any) -> None:
        """Take note of a rcl_interfaces/msg/ParameterEvent of the node."""
        for parameter in event.deleted_parameters:
            self._rows.pop(parameter.name, None)
        for parameter in event.changed_parameters:
            row = self._rows.get(parameter.name)
            if row is not None:
                row.kind, row.values = value_texts(parameter.value)
        if any(parameter.name not in self._rows for parameter in event.new_parameters):
            self.refresh()
        elif self.known is not None:
            self._turn.ask()

    def set(self, wanted: SetParameter, answer: Callable[[ParameterResult], None]) -> None:
        """Set a parameter, and answer with the outcome."""
        self._run(self._set(wanted, answer))

    def dump(self, answer: Callable[[ParameterDump], None]) -> None:
        """Answer a parameter file with all the parameters."""
        self._run(self._dump(answer))

    def _run(self, work: Any) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _refresh(self) -> None:
        try:
            names = await self._names()
            values = (await self._answer(self._client.get_parameters(names))).values if names else []
            descriptors = (await self._answer(self._client.describe_parameters(names))).descriptors if names else []
        except NoAnswerError as error:
            self.known = NodeParameters(self.name, [], str(error))
            self._tell(self.known)
            return
        pairs = zip(descriptors, values, strict=False)
        self._rows = {descriptor.name: parameter_row(descriptor, value) for descriptor, value in pairs}
        self._tell_rows()

    def _tell_rows(self) -> None:
        self.known = NodeParameters(self.name, [self._rows[name] for name in sorted(self._rows)], None)
        self._tell(self.known)

    async def _set(self, wanted: SetParameter, answer: Callable[[ParameterResult], None]) -> None:
        try:
            await self._ready()
            response = await self._answer(self._client.set_parameters([parameter_of(wanted)]))
        except (ValueError, NoAnswerError) as error:
            answer(ParameterResult(self.name, wanted.name, False, str(error)))
            return
        result = response.results[0]
        answer(ParameterResult(self.name, wanted.name, result.successful, result.reason))

    async def _dump(self, answer: Callable[[ParameterDump], None]) -> None:
        file = f"{self.name.strip('/').replace('/', '__')}.yaml"
        try:
            names = await self._names()
            values = (await self._answer(self._client.get_parameters(names))).values if names else []
        except NoAnswerError as error:
            answer(ParameterDump(self.name, file, "", str(error)))
            return
        plain = {name: plain_value(value) for name, value in zip(names, values, strict=False)}
        answer(ParameterDump(self.name, file, parameter_file_text(self.name, plain), None))

    async def _names(self) -> list[str]:
        await self._ready()
        return sorted((await self._answer(self._client.list_parameters())).result.names)

    async def _ready(self) -> None:
        loop = asyncio.get_running_loop()
        deadline = loop.time() + _PATIENCE
        while not self._client.services_are_ready():
            if loop.time() > deadline:
                raise NoAnswerError(f"node '{self.name}' does not offer its parameters")
            await asyncio.sleep(_LOOK_EVERY)

    async def _answer(self, future: Awaitable[Any]) -> Any:
        async def wait() -> Any:
            return await future

        try:
            return await asyncio.wait_for(wait(), _PATIENCE)
        except asyncio.TimeoutError:
            raise NoAnswerError(f"node '{self.name}' did not answer in {_PATIENCE:g} s") from None
