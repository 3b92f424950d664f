"""mux and demux of topic_tools: forward from one of several topics, or to one of them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import Any, ClassVar

from linkwright.graph import Graph, ParameterType
from linkwright.messages import get_service
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.settings import declare_required, invalid_value_error
from linkwright.nodes.topic_tools.tool import TopicTool

NO_TOPIC = "__none"
"""The name that represents no selected topic."""


class _Switch(TopicTool):
    """The base class of mux and demux, which select one of several topics.

    Services add, delete, list and select topics.
    """

    _SERVICE_PREFIX: ClassVar[str]
    """The prefix of the types of the services."""
    _SINGLE_PARAMETER: ClassVar[str]
    """The name of the parameter with the single topic: the output of mux, or the input of demux."""
    _CHOICES_PARAMETER: ClassVar[str]
    """The name of the parameter with the topics to select from."""
    _SINGLE_DEFAULT: ClassVar[str]
    _STATE_TEXT: ClassVar[str]

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        super().__init__(graph, options)
        for verb, callback in (
            ("add", self._add),
            ("delete", self._delete),
            ("list", self._list),
            ("select", self._select),
        ):
            service_class = get_service(f"topic_tools_interfaces/srv/{self._SERVICE_PREFIX}{verb.capitalize()}")
            self._node.create_service(service_class, f"~/{verb}", callback)

    def _parse_options(self, options: NodeOptions, arguments: list[str]) -> NodeOptions:
        parameters: dict[str, object] = {self._SINGLE_PARAMETER: arguments[0]} if arguments else {}
        if arguments[1:]:
            parameters[self._CHOICES_PARAMETER] = arguments[1:]
        return replace(options, parameters={**options.parameters, **parameters})

    def _declare(self) -> None:
        node = self._node
        self._topics: list[str] = list(
            declare_required(node, self._CHOICES_PARAMETER, ParameterType.STRING_ARRAY, self.USAGE),
        )
        if not self._topics:
            raise invalid_value_error(self._CHOICES_PARAMETER, "[]", node.get_name())
        selected: str = node.declare_parameter("initial_topic", "").value
        single_topic: str = node.declare_parameter(self._SINGLE_PARAMETER, self._SINGLE_DEFAULT).value
        self._lazy = node.declare_parameter("lazy", False).value
        self._set_topics(single_topic, selected or self._topics[0])

    @abstractmethod
    def _set_topics(self, single_topic: str, selected: str) -> None:
        """Set the topics `_input` and `_output` for a selection.

        Args:
            single_topic: the output topic of mux, or the input topic of demux.
            selected: the selected input topic of mux, or output topic of demux.
        """

    @property
    @abstractmethod
    def _selected(self) -> str:
        """The name of the selected topic."""

    @abstractmethod
    def _replace_selected(self, selected: str) -> None:
        """Replace the selected topic."""

    def _update_endpoints(self) -> None:
        if self._selected == NO_TOPIC:
            self._stop()
        else:
            super()._update_endpoints()

    def _receive(self, message: Any) -> None:
        self._send(message)

    def _is_same_topic(self, first: str, second: str) -> bool:
        if NO_TOPIC in (first, second):
            return first == second
        return self._node.resolve_topic_name(first) == self._node.resolve_topic_name(second)

    def _add(self, request: Any, response: Any) -> Any:
        name, topic, logger = self.DEFAULT_NAME, request.topic, self._node.get_logger()
        logger.info(f"trying to add {topic} to {name}")
        response.success = False
        if topic == NO_TOPIC:
            logger.warning(f"failed to add topic {topic} to {name}, because it's reserved for special use")
        elif topic in self._topics:
            logger.warning(f"tried to add a topic that {name} was already {self._STATE_TEXT}: [{topic}]")
        else:
            self._topics.append(topic)
            logger.info(f"added {topic} to {name}")
            response.success = True
        return response

    def _delete(self, request: Any, response: Any) -> Any:
        name, topic, logger = self.DEFAULT_NAME, request.topic, self._node.get_logger()
        logger.info(f"trying to delete {topic} to {name}")
        response.success = False
        for candidate in self._topics:
            if not self._is_same_topic(candidate, topic):
                continue
            if self._is_same_topic(self._selected, topic):
                logger.warning(f"tried to delete currently selected topic {topic} from {name}")
                return response
            self._topics.remove(candidate)
            logger.info(f"deleted topic {topic} from {name}")
            response.success = True
            return response
        logger.warning(f"tried to delete non-subscribed topic {topic} from {name}")
        return response

    def _list(self, request: Any, response: Any) -> Any:
        response.topics = list(self._topics)
        return response

    def _select(self, request: Any, response: Any) -> Any:
        name, topic, logger = self.DEFAULT_NAME, request.topic, self._node.get_logger()
        previous = self._selected
        response.prev_topic = previous if any(self._is_same_topic(topic, previous) for topic in self._topics) else ""
        response.success = True
        if topic == NO_TOPIC:
            logger.info(f"{name} selected to no {'input' if name == 'mux' else 'output'}.")
        else:
            logger.info(f"trying to switch {name} to {topic}")
            response.success = any(self._is_same_topic(candidate, topic) for candidate in self._topics)
            if not response.success:
                return response
            logger.info(f"{name} selected {'input' if name == 'mux' else 'output'}: [{topic}]")
        self._replace_selected(topic)
        self._update_endpoints()
        return response


class Mux(_Switch):
    """The running mux node, which forwards the selected input topic.

    Raises:
        LinkwrightError: the parameter ``input_topics`` is missing (NODE431) or empty (NODE433).
    """

    DEFAULT_NAME = "mux"
    USAGE = "mux OUTPUT_TOPIC INPUT_TOPIC [INPUT_TOPIC ...]"
    _SERVICE_PREFIX, _SINGLE_PARAMETER, _CHOICES_PARAMETER, _SINGLE_DEFAULT = (
        "Mux",
        "output_topic",
        "input_topics",
        "~/selected",
    )
    _STATE_TEXT = "listening to"

    def _set_topics(self, single_topic: str, selected: str) -> None:
        self._input, self._output = selected, single_topic

    @property
    def _selected(self) -> str:
        return self._input

    def _replace_selected(self, selected: str) -> None:
        self._input = selected


class Demux(_Switch):
    """The running demux node, which forwards to the selected output topic.

    Raises:
        LinkwrightError: the parameter ``output_topics`` is missing (NODE431) or empty (NODE433).
    """

    DEFAULT_NAME = "demux"
    USAGE = "demux INPUT_TOPIC OUTPUT_TOPIC [OUTPUT_TOPIC ...]"
    _SERVICE_PREFIX, _SINGLE_PARAMETER, _CHOICES_PARAMETER, _SINGLE_DEFAULT = (
        "Demux",
        "input_topic",
        "output_topics",
        "~/input",
    )
    _STATE_TEXT = "publishing to"

    def _set_topics(self, single_topic: str, selected: str) -> None:
        self._input, self._output = single_topic, selected

    @property
    def _selected(self) -> str:
        return self._output

    def _replace_selected(self, selected: str) -> None:
        self._output = selected
