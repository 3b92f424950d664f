"""The actions and tags of ``ros_gz_sim`` and ``ros_gz_bridge``.

These actions start a simulation, spawn models, and bridge topics.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.ros.node import Node
from linkwright.launch.ros.parameter_lists import normalize_parameters
from linkwright.launch.ros.parsing import Entities, parse_parameters

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser

_CONTAINER_DEFAULTS = {
    "container_name": "ros_gz_container",
    "create_own_container": "False",
    "use_composition": "False",
}


class _SingleNodeAction(Action, ABC):
    """The base class of actions that start one node and whose options are texts.

    Args:
        kwargs: the options that `TEXTS` names, and the arguments of every action.
    """

    TEXTS: ClassVar[Mapping[str, str]] = {}
    """The name and default value of each text option."""

    def __init__(self, **kwargs: Any) -> None:
        option_values = {name: kwargs.pop(name, default) for name, default in self.TEXTS.items()}
        super().__init__(**kwargs)
        self._texts = {
            name: normalize_to_list_of_substitutions(text if isinstance(text, (str, list, tuple)) else _to_text(text))
            for name, text in option_values.items()
        }

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag.

        Each option in `TEXTS` may be an attribute of the tag.
        """
        _, kwargs = super().parse(entity, parser)
        for name in cls.TEXTS:
            text = entity.get_attr(name, data_type=str, optional=True)
            if text is not None:
                kwargs[name] = parser.parse_substitution(text)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the action that starts the node, to be visited next."""
        texts = {name: perform_substitutions(context, text) for name, text in self._texts.items()}
        node = self._create_node(texts)
        node.source_location = self.source_location
        return [node]

    @abstractmethod
    def _create_node(self, texts: Mapping[str, str]) -> Node:
        """Return the action that starts the node, for the evaluated text options."""


def _to_text(value: Any) -> Any:
    return str(value) if isinstance(value, (bool, int, float)) else value


@expose_action("gz_server")
class GzServer(_SingleNodeAction):
    """An action that starts the simulation without a window.

    Args:
        kwargs: ``world_sdf_file`` or ``world_sdf_string``. The options for containers have no effect.
    """

    TEXTS: ClassVar[Mapping[str, str]] = {"world_sdf_file": "", "world_sdf_string": "", **_CONTAINER_DEFAULTS}

    def _create_node(self, texts: Mapping[str, str]) -> Node:
        world = {name: texts[name] for name in ("world_sdf_file", "world_sdf_string") if texts[name]}
        return Node(package="ros_gz_sim", executable="gzserver", output="screen", parameters=[world])


@expose_action("gz_spawn_model")
class GzSpawnModel(_SingleNodeAction):
    """An action that spawns a model in the world.

    Args:
        kwargs: ``world``, one of ``file``, ``model_string`` and ``topic``, ``entity_name``, ``allow_renaming``, and the
            pose as ``x``, ``y``, ``z`` (m), ``roll``, ``pitch``, ``yaw`` (rad).
    """

    TEXTS: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("world", "file", "model_string", "topic", "entity_name"), ""),
        "allow_renaming": "False",
        **dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), "0.0"),
    }

    def _create_node(self, texts: Mapping[str, str]) -> Node:
        option_flags = {
            "world": "world",
            "file": "file",
            "model_string": "string",
            "topic": "topic",
            "entity_name": "name",
        }
        option_flags |= {"x": "x", "y": "y", "z": "z", "roll": "R", "pitch": "P", "yaw": "Y"}
        arguments = [
            argument for name, option in option_flags.items() if texts[name] for argument in (f"-{option}", texts[name])
        ]
        arguments += ["-allow_renaming", texts["allow_renaming"].lower()]
        return Node(package="ros_gz_sim", executable="create", output="screen", arguments=arguments)


@expose_action("ros_gz_bridge")
class RosGzBridge(_SingleNodeAction):
    """An action that starts a bridge between topics of the simulation and topics of ROS.

    Args:
        bridge_name: the name of the node.
        config_file: the path of a YAML file with the topics to bridge.
        extra_bridge_params: further parameters, as for a `Node`.
        kwargs: ``namespace`` and ``log_level``. The options for containers and respawning have no effect.
    """

    TEXTS: ClassVar[Mapping[str, str]] = {
        "bridge_name": "ros_gz_bridge",
        "config_file": "",
        "namespace": "",
        "log_level": "info",
        "use_respawn": "False",
        "bridge_params": "",
        **_CONTAINER_DEFAULTS,
    }

    def __init__(
        self,
        *,
        bridge_name: SomeSubstitutionsType,
        config_file: SomeSubstitutionsType,
        extra_bridge_params: Any = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(bridge_name=bridge_name, config_file=config_file, **kwargs)
        self._parameters = [] if extra_bridge_params is None else list(normalize_parameters(extra_bridge_params))

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag and its ``param`` tags."""
        _, kwargs = super().parse(entity, parser)
        tags = entity.get_attr("param", data_type=Entities, optional=True)
        if tags:
            kwargs["extra_bridge_params"] = parse_parameters(tags, parser)
        return cls, kwargs

    def _create_node(self, texts: Mapping[str, str]) -> Node:
        return Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            name=texts["bridge_name"],
            namespace=texts["namespace"],
            output="screen",
            parameters=[{"config_file": texts["config_file"]}, *self._parameters],
            arguments=["--ros-args", "--log-level", texts["log_level"]],
        )
