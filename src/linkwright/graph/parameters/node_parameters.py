"""A node's parameter methods, as in ``rclpy.node.Node``, parameter services and events."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.parameters.parameter import (
    PARAMETER_SEPARATOR_STRING,
    Parameter,
    ParameterAlreadyDeclaredException,
    ParameterDescriptor,
    ParameterException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    get_message_class,
    get_service_type,
    parameter_value_to_python,
)
from linkwright.graph.parameters.store import (
    OnSetParameters,
    ParameterChange,
    ParameterStore,
    PostSetParameters,
    PreSetParameters,
)
from linkwright.graph.qos.profile import PARAMETERS_QOS
from linkwright.graph.time.clock import Clock


class NodeParameters:
    """The parameter methods of a node.

    This is the base class of `Node`. Descriptors, results and parameter values are accepted as Linkwright's own small
    classes and as messages of rcl_interfaces. Return values are messages, as in rclpy.
    """

    def __init__(self, parameters: ParameterStore) -> None:
        # The attribute has a mangled name, so that a user's node class may use the plain name.
        self.__parameters = parameters

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter.

        The parameter's value is the override that the node was started with, or else the default.

        Args:
            name: the parameter's name.
            value: the default, whose type every later value must have; or a ``Parameter.Type`` for a parameter that has
                no value at first.
            descriptor: the description of the parameter; its name and type are filled in.
            ignore_override: whether to ignore the override.

        Raises:
            TypeError: the name is not a string, or the descriptor is not a descriptor.
            ParameterAlreadyDeclaredException: the parameter is declared already.
            InvalidParameterException: the name is empty.
            InvalidParameterTypeException: the override and the default have different types.
            InvalidParameterValueException: a callback or the descriptor refuses the value.
        """
        declaration = (name,) if value is None and descriptor is None else (name, value, descriptor)
        name, value, descriptor, only_name = _check_declaration(0, declaration)
        return self.__parameters.declare(
            name, _to_python_value(value), descriptor, only_name=only_name, ignore_override=ignore_override
        )

    def declare_parameters(
        self, namespace: str, parameters: Sequence[Any], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare several parameters.

        Args:
            namespace: a prefix for each name, separated by a dot; empty for none.
            parameters: a tuple for each parameter: ``(name,)``, ``(name, default or type)``, or these two and a
                descriptor.
            ignore_override: whether to ignore overrides.

        Returns:
            A parameter for each tuple. If two tuples have the same name, the last one applies.

        Raises:
            TypeError: a tuple has another form.
            ParameterAlreadyDeclaredException: some parameters are declared already. The error names all of them, and no
                parameter is declared.
            ParameterException: as for `declare_parameter`. Parameters that were declared before the error stay
                declared.
        """
        declarations = [_check_declaration(index, declaration) for index, declaration in enumerate(parameters)]
        names = [f"{namespace}.{name}" if namespace else name for name, *_ in declarations]
        declared_names = [name for name in names if name in self.__parameters]
        if declared_names:
            raise ParameterAlreadyDeclaredException(declared_names)
        parameters_by_name = {
            name: self.__parameters.declare(
                name, _to_python_value(value), descriptor, only_name=only_name, ignore_override=ignore_override
            )
            for name, (_, value, descriptor, only_name) in dict(zip(names, declarations, strict=True)).items()
        }
        return [parameters_by_name[name] for name in names]

    def declare_parameters_from_overrides(self) -> None:
        """Declare each override that is not declared yet, with the type of the override."""
        for name, value in self.__parameters.overrides.items():
            if name not in self.__parameters:
                self.__parameters.declare(name, value, ParameterDescriptor(), ignore_override=True)

    # Programs read these attributes of rclpy, although their names start with an underscore.

    @property
    def _pre_set_parameters_callbacks(self) -> list[PreSetParameters]:
        """The callbacks registered with `add_pre_set_parameters_callback`, the last one first."""
        return self.__parameters.pre_set

    @property
    def _on_set_parameters_callbacks(self) -> list[OnSetParameters]:
        """The callbacks registered with `add_on_set_parameters_callback`, the last one first."""
        return self.__parameters.on_set

    _parameters_callbacks = _on_set_parameters_callbacks

    @property
    def _post_set_parameters_callbacks(self) -> list[PostSetParameters]:
        """The callbacks registered with `add_post_set_parameters_callback`, the last one first."""
        return self.__parameters.post_set

    def undeclare_parameter(self, name: str) -> None:
        """Undeclare a parameter.

        No callback is called, and no event is published.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterImmutableException: the parameter is read-only.
        """
        self.__parameters.undeclare(name)

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter is declared."""
        return name in self.__parameters

    def undeclared_overrides(self) -> list[str]:
        """Return the names of the overrides that no declared parameter has used, in order."""
        return [name for name in self.__parameters.overrides if name not in self.__parameters]

    def parameter_names(self) -> list[str]:
        """Return the names of the declared parameters, in order of declaration."""
        return self.__parameters.names()

    def get_parameter(self, name: str) -> Parameter:
        """Return a declared parameter.

        If undeclared parameters are allowed, a name that is not declared results in a parameter without a value.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterUninitializedException: the parameter was declared with a type only, and has no value yet.
        """
        return self.__parameters.get(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return several declared parameters. See `get_parameter`."""
        _check_names(names)
        return [self.__parameters.get(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter if it has a value, otherwise the alternative.

        Without an alternative, the result is a parameter without a value.
        """
        parameter = self.__parameters.get_if_set(name)
        if parameter is not None:
            return parameter
        return Parameter(name) if alternative_value is None else alternative_value

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters named ``prefix.rest``, with ``rest`` as the key.

        An empty prefix returns all parameters.
        """
        return self.__parameters.find_by_prefix(prefix)

    def get_parameter_type(self, name: str) -> int:
        """Return the type number of a parameter's value.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
        """
        return self.__parameters.get_type(name).value

    def get_parameter_types(self, names: Sequence[str]) -> list[int]:
        """Return the types of several parameters. See `get_parameter_type`."""
        _check_names(names)
        return [self.get_parameter_type(name) for name in names]

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[Any]:
        """Set parameters one by one, and return an rcl_interfaces/msg/SetParametersResult for each.

        If a parameter is set to no value and its descriptor allows dynamic typing, the parameter is undeclared.

        Raises:
            ParameterNotDeclaredException: a parameter is not declared. The parameters before it stay set.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> Any:
        """Set either all parameters or none, and return an rcl_interfaces/msg/SetParametersResult.

        Raises:
            ParameterNotDeclaredException: a parameter is not declared; none is set.
        """
        from linkwright.graph.parameters.parameter import to_result_message

        return to_result_message(self.__parameters.set_atomically(parameter_list))

    def list_parameters(self, prefixes: list[str], depth: int) -> Any:
        """List the names and prefixes of parameters, as rcl_interfaces/msg/ListParametersResult.

        Args:
            prefixes: restricts the list to these names and the names below them; empty for all names.
            depth: the number of levels below a prefix to list; 0 for all levels.

        Raises:
            TypeError: an argument is not of the declared type.
            ValueError: the depth is negative.
        """
        if not isinstance(prefixes, list):
            raise TypeError("The prefixes argument must be a list")
        if not all(isinstance(prefix, str) for prefix in prefixes):
            raise TypeError("All prefixes must be instances of type str")
        if not isinstance(depth, int):
            raise TypeError("The depth must be instance of type int")
        if depth < 0:
            raise ValueError("The depth must be greater than or equal to zero")
        from linkwright.graph.parameters.parameter import get_message_class

        names = [name for name in self.__parameters.names() if _is_listed(name, prefixes, depth)]
        name_prefixes = [name.rpartition(PARAMETER_SEPARATOR_STRING)[0] for name in names]
        result = get_message_class("ListParametersResult")()
        result.names = names
        result.prefixes = [prefix for prefix in dict.fromkeys(name_prefixes) if prefix]
        return result

    def describe_parameter(self, name: str) -> Any:
        """Return the descriptor of a parameter, as rcl_interfaces/msg/ParameterDescriptor.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
        """
        from linkwright.graph.parameters.parameter import to_descriptor_message

        descriptor = self.__parameters.get_descriptor(name)
        message = to_descriptor_message(descriptor)
        if message is not descriptor and name in self.__parameters:
            self.__parameters.replace_descriptor(name, message)
        return message

    def describe_parameters(self, names: Sequence[str]) -> list[Any]:
        """Return the descriptors of several parameters. See `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Replace the descriptor of a parameter.

        Args:
            name: the parameter's name.
            descriptor: the new descriptor.
            alternative_value: an rcl_interfaces/msg/ParameterValue to set if the current value does not satisfy the
                descriptor.

        Returns:
            The resulting value, as rcl_interfaces/msg/ParameterValue.

        Raises:
            ParameterNotDeclaredException: the parameter is not declared.
            ParameterImmutableException: the parameter is read-only.
            InvalidParameterValueException: neither value satisfies the descriptor.
        """
        parameter = self.__parameters.set_descriptor(name, descriptor, _to_python_value(alternative_value))
        return (Parameter(name) if parameter is None else parameter).get_parameter_value()

    def add_pre_set_parameters_callback(self, callback: PreSetParameters) -> None:
        """Register a callback that may change the list of parameters to be set.

        Callbacks are called in the reverse order of their registration.
        """
        self.__parameters.pre_set.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetParameters) -> None:
        """Register a callback that is called before parameters are declared or set.

        The callback may refuse the change with a reason.
        """
        self.__parameters.on_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetParameters) -> None:
        """Register a callback that is called after parameters were declared or set."""
        self.__parameters.post_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetParameters) -> None:
        """Unregister a callback that may change the list of parameters to be set.

        Raises:
            ValueError: the callback is not registered.
        """
        self.__parameters.pre_set.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetParameters) -> None:
        """Unregister a callback that is called before parameters are declared or set.

        Raises:
            ValueError: the callback is not registered.
        """
        self.__parameters.on_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetParameters) -> None:
        """Unregister a callback that is called after parameters were declared or set.

        Raises:
            ValueError: the callback is not registered.
        """
        self.__parameters.post_set.remove(callback)


def _to_python_value(value: Any) -> Any:
    """Return a default, converted to a Python value if it is an rcl_interfaces ParameterValue."""
    if getattr(value, "TYPE_NAME", None) == "rcl_interfaces/msg/ParameterValue":
        return parameter_value_to_python(value)
    return value


def _check_declaration(index: int, declaration: Any) -> tuple[str, Any, Any, bool]:
    if not 1 <= len(declaration) <= 3:
        raise TypeError(
            f"Invalid parameter tuple length at index {index} in parameters list: {declaration}; "
            "expecting length between 1 and 3"
        )
    elements = [*declaration, None, None]
    name, value, descriptor = elements[:3]
    if not isinstance(name, str):
        raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
    if descriptor is None:
        descriptor = ParameterDescriptor()
    elif not hasattr(descriptor, "dynamic_typing"):
        raise TypeError(f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor.")
    return name, value, descriptor, len(declaration) == 1


def _check_names(names: Sequence[str]) -> None:
    if not all(isinstance(name, str) for name in names):
        raise TypeError("All names must be instances of type str")


def _is_listed(name: str, prefixes: Sequence[str], depth: int) -> bool:
    def is_within_depth(relative_name: str) -> bool:
        return depth == 0 or relative_name.count(PARAMETER_SEPARATOR_STRING) < depth

    if not prefixes:
        return is_within_depth(name)
    return any(
        name == prefix
        or (name.startswith(prefix + PARAMETER_SEPARATOR_STRING) and is_within_depth(name[len(prefix) + 1 :]))
        for prefix in prefixes
    )


EVENTS_TYPE = "rcl_interfaces/msg/ParameterEvent"
EVENTS_TOPIC = "/parameter_events"


class ParameterServices:
    """A node's six parameter services: ``~/describe_parameters`` and so on.

    The service types are created with the first request. Responses are those of rclpy: if one of several requested
    names is not declared, the response is empty.

    Args:
        node: the node whose parameters the services access.
        node_name: the node's name.
        create_service: the node's `Node.create_service`.
    """

    def __init__(self, node: NodeParameters, node_name: str, create_service: Callable[..., object]) -> None:
        self._node = node
        for service, callback in (
            ("describe_parameters", self._describe),
            ("get_parameters", self._get),
            ("get_parameter_types", self._get_types),
            ("list_parameters", self._list),
            ("set_parameters", self._set),
            ("set_parameters_atomically", self._set_atomically),
        ):
            create_service(get_service_type(service), f"{node_name}/{service}", callback, qos_profile=PARAMETERS_QOS)

    def _describe(self, request: Any, response: Any) -> Any:
        try:
            response.descriptors = self._node.describe_parameters(request.names)
        except ParameterNotDeclaredException:
            response.descriptors = []
        return response

    def _get(self, request: Any, response: Any) -> Any:
        try:
            response.values = [self._node.get_parameter(name).get_parameter_value() for name in request.names]
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            response.values = []
        return response

    def _get_types(self, request: Any, response: Any) -> Any:
        try:
            response.types = self._node.get_parameter_types(request.names)
        except ParameterNotDeclaredException:
            response.types = []
        return response

    def _list(self, request: Any, response: Any) -> Any:
        response.result = self._node.list_parameters(list(request.prefixes), request.depth)
        return response

    def _set(self, request: Any, response: Any) -> Any:
        response.results = [self._set_from_messages([parameter]) for parameter in request.parameters]
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._set_from_messages(request.parameters)
        return response

    def _set_from_messages(self, messages: Any) -> Any:
        try:
            return self._node.set_parameters_atomically([Parameter.from_parameter_msg(message) for message in messages])
        except (ParameterException, ValueError) as error:
            return get_message_class("SetParametersResult")(successful=False, reason=str(error))


class ParameterEvents:
    """A publisher of the changes to a node's parameters on ``/parameter_events``.

    Args:
        publisher: the publisher of ``/parameter_events``.
        clock: stamps the events.
        node_name: the full name of the node.
    """

    def __init__(self, publisher: Publisher[Any], clock: Clock, node_name: str) -> None:
        self._publisher = publisher
        self._clock = clock
        self._node_name = node_name

    def publish(self, change: ParameterChange) -> None:
        """Publish a change if a subscription matches.

        Late joiners never receive earlier changes.
        """
        if not self._publisher.get_subscription_count():
            return
        event: Any = self._publisher.msg_type()
        event.stamp = self._clock.now().to_msg()
        event.node = self._node_name
        event.new_parameters = [parameter.to_parameter_msg() for parameter in change.new]
        event.changed_parameters = [parameter.to_parameter_msg() for parameter in change.changed]
        event.deleted_parameters = [parameter.to_parameter_msg() for parameter in change.deleted]
        self._publisher.publish(event)
