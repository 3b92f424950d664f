"""The Services panel, the counterpart of ``rqt_service_caller``."""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.messages import get_service
from linkwright.messages.presentation import prototype
from linkwright.nodes.service_waits import wait_for_future, wait_for_service
from linkwright.page.audience import Page
from linkwright.page.protocol.calls import (
    CallService,
    ChooseService,
    ServiceList,
    ServiceRequest,
    ServiceResponse,
    ServiceRow,
    WatchServices,
)
from linkwright.panels.monitor.message_texts import MessageTextError, fill_message
from linkwright.panels.monitor.topics import make_message_tree
from linkwright.panels.page_feature import FeatureHost, PageFeature

_RESPONSE_TIMEOUT_S = 30.0


class ServicesFeature(PageFeature):
    """The feature that sends the list of services to pages, and calls services for them."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: dict[Page, ServiceList | None] = {}
        self._calls: dict[Page, asyncio.Task[None]] = {}

    def receive(self, page: Page, message: WatchServices | ChooseService | CallService) -> None:
        """Handle a request. A new call of a page replaces the call that it waits for."""
        if isinstance(message, ChooseService):
            page.send(self._make_request(message.service))
        elif isinstance(message, CallService):
            self._cancel_call(page)
            self._calls[page] = asyncio.get_running_loop().create_task(self._call(page, message))
        elif message.watched:
            self._pages[page] = None
            self.context.graph_changes.watch(self._send_lists)
            self._send_lists()
        else:
            self._stop_watching(page)

    def remove_page(self, page: Page) -> None:
        """Discard the calls of the page."""
        self._cancel_call(page)
        self._stop_watching(page)

    def close(self) -> None:
        """Discard all calls."""
        for page in {*self._pages, *self._calls}:
            self.remove_page(page)

    def _stop_watching(self, page: Page) -> None:
        self._pages.pop(page, None)
        if not self._pages:
            self.context.graph_changes.unwatch(self._send_lists)

    def _cancel_call(self, page: Page) -> None:
        task = self._calls.pop(page, None)
        if task is not None:
            task.cancel()

    def _send_lists(self) -> None:
        services = self.context.node.get_service_names_and_types()
        service_list = ServiceList([ServiceRow(name, kinds[0]) for name, kinds in sorted(services) if kinds])
        for page, sent in self._pages.items():
            if sent != service_list:
                self._pages[page] = service_list
                page.send(service_list)

    def _find_kind(self, service: str) -> str:
        kinds = dict(self.context.node.get_service_names_and_types()).get(service)
        return kinds[0] if kinds else ""

    def _make_request(self, service: str) -> ServiceRequest:
        kind = self._find_kind(service)
        try:
            return ServiceRequest(service, kind, prototype(get_service(kind)), None)
        except LinkwrightError as error:
            return ServiceRequest(service, kind, "", error.diagnostics[0].message)

    async def _call(self, page: Page, message: CallService) -> None:
        loop = asyncio.get_running_loop()
        start = loop.time()
        fields, error = [], None
        try:
            fields = make_message_tree(await self._wait_for_response(message))
        except (_CallError, MessageTextError) as caught_error:
            error = str(caught_error)
        except LinkwrightError as caught_error:
            error = caught_error.diagnostics[0].message
        page.send(ServiceResponse(message.service, fields, loop.time() - start, error))

    async def _wait_for_response(self, message: CallService) -> Any:
        service, node = message.service, self.context.node
        kind = self._find_kind(service)
        if not kind:
            raise _CallError(phrase("no node offers the service {service}", service=service))
        service_class = get_service(kind)
        request = service_class.Request()
        for set_stamp in fill_message(request, message.text):
            set_stamp(node.get_clock().now().to_msg())
        client = node.create_client(service_class, service)
        try:
            if await wait_for_service(node, client, _RESPONSE_TIMEOUT_S):
                future = client.call_async(request)
                if await wait_for_future(node, future, _RESPONSE_TIMEOUT_S):
                    return future.result()
        finally:
            node.destroy_client(client)
        raise _CallError(
            phrase("{service} has not answered in {seconds:g} s", service=service, seconds=_RESPONSE_TIMEOUT_S)
        )


class _CallError(Exception):
    """Raised if a service does not answer; the text of the error is for the user."""
