"""The elements of XML launch files, as launch and launch_ros (ROS 2) read them."""

from __future__ import annotations

from linkwright.schema import AttributeRule, ElementRule, ValueType

_TEXT = ValueType("text")
_NAME = ValueType("name")
_PATH = ValueType("path")
_BOOLEAN = ValueType("true or false")
_NUMBER = ValueType("number")
_INTEGER = ValueType("integer")


def _optional(name: str, kind: ValueType, meaning: str, default: str | None = None, unit: str = "") -> AttributeRule:
    return AttributeRule(name, kind, meaning, unit, default=default)


def _required(name: str, kind: ValueType, meaning: str) -> AttributeRule:
    return AttributeRule(name, kind, meaning, required=True)


def _usual(name: str, kind: ValueType, meaning: str) -> AttributeRule:
    return AttributeRule(name, kind, meaning, usually_written=True)


_CONDITIONS = (
    _optional("if", _BOOLEAN, "the condition under which the element has an effect", "true"),
    _optional("unless", _BOOLEAN, "the condition under which the element has no effect", "false"),
)


def _element(
    tag: str,
    meaning: str,
    *attributes: AttributeRule,
    children: tuple[ElementRule, ...] = (),
    is_recursive: bool = False,
) -> ElementRule:
    return ElementRule(tag, meaning, attributes, children, is_repeated=True, is_recursive=is_recursive)


def _action(
    tag: str,
    meaning: str,
    *attributes: AttributeRule,
    children: tuple[ElementRule, ...] = (),
    is_recursive: bool = False,
) -> ElementRule:
    return _element(tag, meaning, *attributes, *_CONDITIONS, children=children, is_recursive=is_recursive)


def _pair(tag: str, meaning: str, name: str = "the name", value: str = "the value") -> ElementRule:
    return _element(tag, meaning, _required("name", _NAME, name), _required("value", _TEXT, value))


_PROCESS_ATTRIBUTES = (
    _optional("name", _NAME, "the name of the process in the log"),
    _optional("output", ValueType("screen, log or both"), "where the output of the process goes", "log"),
    _optional("cwd", _PATH, "the working folder of the process"),
    _optional("launch-prefix", _TEXT, "words before the command, such as gdb -ex run --args"),
    _optional("respawn", _BOOLEAN, "whether the process is started again when it ends", "false"),
    _optional("respawn_delay", _NUMBER, "the time before the process is started again", "0", "s"),
    _optional("respawn_max_retries", _INTEGER, "how often the process is started again; -1 for any number", "-1"),
    _optional("shell", _BOOLEAN, "whether a shell runs the command", "false"),
    _optional("emulate_tty", _BOOLEAN, "whether the process has a terminal", "false"),
    _optional("sigterm_timeout", _NUMBER, "the time from SIGINT to SIGTERM", "5", "s"),
    _optional("sigkill_timeout", _NUMBER, "the time from SIGTERM to SIGKILL", "5", "s"),
    _optional("on_exit", ValueType("shutdown"), "the actions that run when the process ends"),
    _optional("log_cmd", _BOOLEAN, "whether the log shows the command", "false"),
    _optional("cached_output", _BOOLEAN, "whether the output is kept for tests", "false"),
    _optional("split_arguments", _BOOLEAN, "whether arguments are split at spaces after substitution", "false"),
)
_ENV = _pair("env", "an environment variable of the process")
_REMAP = _element(
    "remap",
    "another name for a topic, service or action of the node",
    _required("from", _NAME, "the name in the program"),
    _required("to", _NAME, "the name in the graph"),
)
_PARAM = _element(
    "param",
    "a parameter of the node, a group of parameters, or a file with parameters",
    _usual("name", _NAME, "the name of the parameter"),
    _usual("value", _TEXT, "the value, whose type follows from its form as in YAML"),
    _optional("from", _PATH, "a YAML file with parameters, instead of name and value"),
    _optional("type", ValueType("type of a parameter"), "the type of the value, such as str"),
    _optional("allow_substs", _BOOLEAN, "whether the file may contain substitutions", "false"),
    _optional("value-sep", _TEXT, "the separator of a list in the value"),
    is_recursive=True,
)
_NODE_ATTRIBUTES = (
    _required("pkg", ValueType("name of a package"), "the package of the executable"),
    _required("exec", ValueType("name of an executable"), "the executable in the package"),
    AttributeRule("name", _NAME, "the name of the node", usually_written=True),
    _optional("namespace", _NAME, "the namespace of the node"),
    *_PROCESS_ATTRIBUTES[1:],
    _optional("args", _TEXT, "the command line arguments"),
    _optional("ros_args", _TEXT, "the arguments after --ros-args"),
    _optional("exec_name", _NAME, "the name of the process in the log"),
)
_NAMED_NODE_ATTRIBUTES = tuple(
    _required(rule.name, rule.type, rule.meaning) if rule.name in ("name", "namespace") else rule
    for rule in _NODE_ATTRIBUTES
)
_NODE_CHILDREN = (_PARAM, _REMAP, _ENV)
_COMPOSABLE = _action(
    "composable_node",
    "a node that the container loads as a component",
    _required("pkg", ValueType("name of a package"), "the package of the component"),
    _required("plugin", ValueType("name of a class"), "the class of the component"),
    _usual("name", _NAME, "the name of the node"),
    _optional("namespace", _NAME, "the namespace of the node"),
    children=(
        _PARAM,
        _REMAP,
        _pair("extra_arg", "an option of the container for the node, such as use_intra_process_comms"),
    ),
)
_GZ_CONTAINER_ATTRIBUTES = tuple(
    _optional(name, kind, meaning, default)
    for name, kind, meaning, default in (
        ("container_name", _NAME, "the name of the container of the nodes", "ros_gz_container"),
        ("create_own_container", _BOOLEAN, "whether a container is started", "false"),
        ("use_composition", _BOOLEAN, "whether the node is loaded into a container", "false"),
    )
)
_SIMPLE_ACTIONS = (
    _action(
        "arg",
        "an argument of the launch file, which its caller can set",
        _required("name", _NAME, "the name in $(var NAME)"),
        _usual("default", _TEXT, "the value if the caller passes none; without a default, the argument is required"),
        _usual("description", _TEXT, "a description for --show-args"),
        children=(_element("choice", "an allowed value", _required("value", _TEXT, "the value")),),
    ),
    _action(
        "node",
        "starts a node",
        *_NODE_ATTRIBUTES,
        children=_NODE_CHILDREN,
    ),
    _action(
        "include",
        "includes another launch file",
        _required("file", _PATH, "the launch file, in any language"),
        children=(
            _pair("arg", "a value for an argument of the included file", "the name of the argument"),
            _pair("let", "a value for an argument of the included file", "the name of the argument"),
        ),
    ),
    _action(
        "let",
        "sets a launch configuration",
        _required("name", _NAME, "the name in $(var NAME)"),
        _required("value", _TEXT, "the value"),
    ),
    _action(
        "executable",
        "starts a program that is not a node",
        _required("cmd", _TEXT, "the command line"),
        *_PROCESS_ATTRIBUTES,
        children=(_ENV,),
    ),
    _action(
        "push_ros_namespace",
        "adds a namespace to all later nodes in the scope",
        _required("namespace", _NAME, "the namespace"),
    ),
    _action(
        "set_parameter",
        "sets a parameter of all later nodes in the scope",
        _required("name", _NAME, "the name of the parameter"),
        _required("value", _TEXT, "the value, whose type follows from its form as in YAML"),
    ),
    _action(
        "set_remap",
        "adds another name to all later nodes in the scope",
        _required("from", _NAME, "the name in the program"),
        _required("to", _NAME, "the name in the graph"),
    ),
    _action(
        "set_parameters_from_file",
        "sets the parameters in a YAML file for all later nodes in the scope",
        _required("filename", _PATH, "the YAML file"),
    ),
    _action(
        "set_use_sim_time",
        "sets use_sim_time of all later nodes in the scope",
        _required("value", _BOOLEAN, "whether nodes use simulated time"),
    ),
    _action(
        "node_container",
        "starts a container and loads nodes into it",
        *_NAMED_NODE_ATTRIBUTES,
        children=(_COMPOSABLE, *_NODE_CHILDREN),
    ),
    _action(
        "load_composable_node",
        "loads nodes into a container that runs",
        _required("target", _NAME, "the name of the container"),
        children=(_COMPOSABLE,),
    ),
    _action(
        "lifecycle_node",
        "starts a managed node",
        *_NAMED_NODE_ATTRIBUTES,
        _optional("autostart", _BOOLEAN, "whether the node is configured and activated", "false"),
        children=_NODE_CHILDREN,
    ),
    _action(
        "set_env",
        "sets an environment variable of all later processes",
        _required("name", _NAME, "the name of the variable"),
        _required("value", _TEXT, "the value"),
    ),
    _action("unset_env", "removes an environment variable", _required("name", _NAME, "the name of the variable")),
    _action(
        "append_env",
        "adds a value to an environment variable with a list",
        _required("name", _NAME, "the name of the variable"),
        _required("value", _TEXT, "the value"),
        _optional("prepend", _BOOLEAN, "whether the value comes first", "false"),
        _optional("separator", _TEXT, "the text between two values", ":"),
    ),
    _action("rep_env", "replaces all environment variables", children=(_ENV,)),
    _action("push_env", "saves the environment variables"),
    _action("pop_env", "restores the environment variables that push_env saved"),
    _action("reset_env", "restores the environment variables that the launch started with"),
    _action("unset", "removes a launch configuration", _required("name", _NAME, "the name in $(var NAME)")),
    _action(
        "reset",
        "removes all launch configurations except some",
        children=(_pair("keep", "a launch configuration that is kept"),),
    ),
    _action(
        "bool_arg",
        "an argument of the launch file that is true or false",
        _required("name", _NAME, "the name in $(var NAME)"),
        _usual("default", _BOOLEAN, "the value if the caller passes none; without a default, the argument is required"),
        _usual("description", _TEXT, "a description for --show-args"),
    ),
    _action(
        "log",
        "writes a line to the log",
        _required("level", ValueType("level of a log"), "the level"),
        _required("message", _TEXT, "the line"),
    ),
    *(
        _action(f"log_{level}", f"writes a line to the log at level {level}", _required("message", _TEXT, "the line"))
        for level in ("info", "debug", "warning", "error")
    ),
    _action("ready_to_test", "signals to launch_testing that tests may start"),
    _action(
        "shutdown", "ends the launch", _optional("reason", _TEXT, "the reason to write to the log", "no reason given")
    ),
    _action(
        "set_ros_log_dir",
        "changes the log folder of later processes",
        _required("new_log_dir", _PATH, "the folder"),
    ),
    _action(
        "gz_server",
        "starts Gazebo without a window",
        _usual("world_sdf_file", _PATH, "the world"),
        _optional("world_sdf_string", _TEXT, "the world as text"),
        *_GZ_CONTAINER_ATTRIBUTES,
    ),
    _action(
        "gz_spawn_model",
        "spawns a model in Gazebo",
        *(
            _optional(name, kind, meaning)
            for name, kind, meaning in (
                ("world", _NAME, "the name of the world"),
                ("file", _PATH, "the file of the model"),
                ("model_string", _TEXT, "the model as text"),
                ("topic", _NAME, "the topic with the model, such as /robot_description"),
                ("entity_name", _NAME, "the name of the model in the world"),
            )
        ),
        _optional("allow_renaming", _BOOLEAN, "whether the model gets another name if its name is taken", "false"),
        *(_optional(name, _NUMBER, "the position of the model", "0", "m") for name in "xyz"),
        *(_optional(name, _NUMBER, "the orientation of the model", "0", "rad") for name in ("roll", "pitch", "yaw")),
    ),
    _action(
        "ros_gz_bridge",
        "starts a bridge between topics of Gazebo and of ROS",
        _required("bridge_name", _NAME, "the name of the node"),
        _required("config_file", _PATH, "the YAML file with the topics"),
        _optional("namespace", _NAME, "the namespace of the node"),
        _optional("log_level", ValueType("level of a log"), "the level", "info"),
        _optional("use_respawn", _BOOLEAN, "whether the process is started again when it ends", "false"),
        _optional("bridge_params", _TEXT, "additional parameters of the node"),
        *_GZ_CONTAINER_ATTRIBUTES,
        children=(_PARAM,),
    ),
)
_MAX_DEPTH = 6
"""The depth to which actions are nested in the table. Deeper elements have no rules."""


def _actions() -> tuple[ElementRule, ...]:
    """Return the rules of all actions, with nested actions up to a depth of `_MAX_DEPTH`."""
    inner = _SIMPLE_ACTIONS
    for _ in range(_MAX_DEPTH):
        inner = (*_SIMPLE_ACTIONS, *_containers(inner))
    return inner


def _containers(inner: tuple[ElementRule, ...]) -> tuple[ElementRule, ...]:
    period = (
        _required("period", _NUMBER, "the time in seconds"),
        _optional("cancel_on_shutdown", _BOOLEAN, "whether a shutdown ends the wait", "true"),
    )
    return (
        _action(
            "group",
            "actions with a condition, or with a scope of their own",
            _optional("scoped", _BOOLEAN, "whether settings inside end with the group", "true"),
            _optional("forwarding", _BOOLEAN, "whether settings from outside apply inside", "true"),
            children=(*inner, _pair("keep", "a launch configuration of the group")),
            is_recursive=True,
        ),
        _action("timer", "executes actions after a delay", *period, children=inner),
        _action(
            "ros_timer", "executes actions after a delay in ROS time, which may be simulated", *period, children=inner
        ),
        _action(
            "for_each",
            "repeats actions for each entry of a list; $(for-var NAME) is its value",
            _required("values", _TEXT, "the entries, such as name: a; name: b"),
            children=inner,
        ),
        _action(
            "for",
            "repeats actions; $(index NAME) is the number from 0",
            _required("len", _INTEGER, "the number of repetitions"),
            _required("name", _NAME, "the name in $(index NAME)"),
            children=inner,
        ),
    )


LAUNCH = ElementRule(
    "launch",
    "the root of a launch file",
    (
        _optional("version", _TEXT, "the version of the format"),
        _optional("deprecated", _TEXT, "a warning for the callers"),
    ),
    _actions(),
)
"""The rule of the root element of a launch file."""

_BOOLEANS = ("true", "false")
_OUTPUT_CHOICES = ("screen", "log", "both", "own_log", "full")
_LOG_LEVELS = ("info", "debug", "warning", "error", "critical")
_CHOICES_BY_ATTRIBUTE = {
    "output": _OUTPUT_CHOICES,
    "on_exit": ("shutdown",),
    "level": _LOG_LEVELS,
    "log_level": ("info", "debug", "warn", "error", "fatal"),
    "type": ("str", "int", "float", "bool", "list_of_str", "list_of_int", "list_of_float", "list_of_bool"),
}


def choices_of(rule: AttributeRule) -> tuple[str, ...]:
    """Return the allowed values of a launch attribute, the usual ones first.

    Returns an empty tuple if any value is allowed.
    """
    return _BOOLEANS if rule.type is _BOOLEAN else _CHOICES_BY_ATTRIBUTE.get(rule.name, ())
