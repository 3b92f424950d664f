"""The services that read and set a node's logger levels (``enable_logger_service``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.graph.log.logger import LogLevel
from linkwright.graph.node import Node
from linkwright.graph.qos.profile import SERVICES_QOS

if TYPE_CHECKING:
    from linkwright.graph.log.logger import LogLevels


class LoggerServices:
    """The services ``~/get_logger_levels`` and ``~/set_logger_levels`` (Jazzy and newer).

    Args:
        node: the node that owns the services.
        levels: the logger levels of the node's graph.
    """

    def __init__(self, node: Node, levels: LogLevels) -> None:
        self._levels = levels
        name = node.get_name()
        for service, type_name, callback in (
            ("get_logger_levels", "GetLoggerLevels", self._get),
            ("set_logger_levels", "SetLoggerLevels", self._set),
        ):
            node.create_service(
                f"rcl_interfaces/srv/{type_name}", f"{name}/{service}", callback, qos_profile=SERVICES_QOS
            )

    def _get(self, request: Any, response: Any) -> Any:
        from linkwright.graph.parameters.parameter import get_message_class

        level_class = get_message_class("LoggerLevel")
        response.levels = [level_class(name=name, level=int(self._levels.own_level(name))) for name in request.names]
        return response

    def _set(self, request: Any, response: Any) -> Any:
        from linkwright.graph.parameters.parameter import get_message_class

        result_class = get_message_class("SetLoggerLevelsResult")
        results = [self._set_one(level.name, level.level) for level in request.levels]
        response.results = [result_class(successful=not reason, reason=reason) for reason in results]
        return response

    def _set_one(self, name: str, level: int) -> str:
        """Set the level of one logger.

        Return an empty string, or the reason for a failure.
        """
        try:
            self._levels.set(name, LogLevel(level))
        except ValueError:
            levels = ", ".join(str(int(log_level)) for log_level in LogLevel)
            return f"{level} is not a log level: the levels are {levels}"
        return ""
