"""A process with a graph of Linkwright.

Run it with ``python -m tests.wire.linkwright_program NODE_NAME``.
"""

from __future__ import annotations

import os
import sys
import threading
from typing import Any

from linkwright.graph import Graph
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.wire.joining import join
from tests.wire.programs import serve

Int32 = get_message("std_msgs/msg/Int32")
SetBool = get_service("std_srvs/srv/SetBool")
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


class LinkwrightProgram:
    def __init__(self, name: str) -> None:
        self.graph = Graph(threads=True)
        self.node = self.graph.create_node(name)
        self.transport = join(self.graph)
        self.publisher = self.node.create_publisher(Int32, "/flood", KEEP_ALL)
        self.node.create_service(SetBool, "/flip", self._flip)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        threading.Thread(target=self.executor.spin, daemon=True).start()
        assert self.transport is not None
        self.transport.wait_until_ready(60)

    def subscribers(self, topic: str) -> int:
        return self.node.count_subscribers(topic)

    def flood(self, _topic: str, count: int) -> None:
        for number in range(count):
            self.publisher.publish(Int32(data=number))

    def nodes(self) -> list[str]:
        return sorted(name for name, _ in self.node.get_node_names_and_namespaces())

    def fork(self) -> list[Any]:
        """Fork, and return whether the child could publish and end, and the number of its own threads."""
        child = os.fork()
        if not child:
            self.publisher.publish(Int32(data=1))
            os._exit(7 if self.publisher.send_remote is None else 8)
        return [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), threading.active_count()]

    @staticmethod
    def _flip(request: Any, response: Any) -> Any:
        response.success = not request.data
        return response


if __name__ == "__main__":
    program = LinkwrightProgram(sys.argv[1])
    serve(
        {
            "subscribers": program.subscribers,
            "flood": program.flood,
            "nodes": program.nodes,
            "fork": program.fork,
        }
    )
