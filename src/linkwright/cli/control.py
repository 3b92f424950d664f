"""``linkwright control``: list and change the controllers and hardware of a robot.

Source: ros2controlcli (verbs, options, output without colors).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Coroutine, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import call
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.output import write_output
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from linkwright.cli.session import Session

ManagerCall = Callable[..., Coroutine[Any, Any, Any]]
"""A function that calls a service of the manager, such as ``list_controllers``.

Its keyword arguments are the fields of the request.
"""

MANAGER_EXTRA_WAIT_S = 55.0
"""Seconds to wait for the manager in addition to the usual time.

A simulated robot starts the manager late.
"""
_LOGS_HINT = "check controller_manager logs"
_INTERFACE_SECTIONS = {
    "claimed_interfaces": "claimed interfaces",
    "required_command_interfaces": "required command interfaces",
    "required_state_interfaces": "required state interfaces",
    "chained_interfaces": "chained to interfaces",
    "reference_interfaces": "exported reference interfaces",
}


def _add_common_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument(
        "-c",
        "--controller-manager",
        metavar="NAME",
        default="/controller_manager",
        help="the controller manager's node, default /controller_manager",
    )
    parser.add_argument("--include-hidden-nodes", action="store_true", help="accepted for compatibility with ros2")


def _add_controller_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("controller_name", metavar="CONTROLLER", help="the name of the controller")
    _add_common_arguments(parser)


def _run(
    job: Callable[[argparse.Namespace, ManagerCall], Coroutine[Any, Any, int]], arguments: argparse.Namespace
) -> int:
    async def run_job(session: Session) -> int:
        from linkwright.messages import get_service

        manager = f"/{arguments.controller_manager.strip('/')}"

        async def call_manager(service: str, **fields: Any) -> Any:
            package = "rcl_interfaces" if service == "set_parameters" else "controller_manager_msgs"
            service_type = f"{package}/srv/" + "".join(word.capitalize() for word in service.split("_"))
            name, request = f"{manager}/{service}", get_service(service_type).Request(**fields)
            return await call(session, service_type, name, request, extra_wait=MANAGER_EXTRA_WAIT_S)

        return await job(arguments, call_manager)

    return run_in_graph(arguments, run_job)


def _report_failure(text: str) -> int:
    print(text, file=sys.stderr)
    return 1


# --- queries ----------------------------------------------------------------------------------------------------------


def _configure_list_controllers(parser: argparse.ArgumentParser) -> None:
    for name in _INTERFACE_SECTIONS:
        parser.add_argument(f"--{name.replace('_', '-')}", action="store_true", help="also print these interfaces")
    parser.add_argument("-v", "--verbose", action="store_true", help="also print all of these interfaces")
    _add_common_arguments(parser)


async def _list_controllers(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    controllers = (await call_manager("list_controllers")).controller
    if not controllers:
        print("No controllers are currently loaded!")
        return 0
    name_width, type_width, state_width = (
        max(len(getattr(controller, field)) for controller in controllers) for field in ("name", "type", "state")
    )
    for controller in controllers:
        print(f"{controller.name:<{name_width}} {controller.type:<{type_width}}  {controller.state:<{state_width}}")
        for section, title in _INTERFACE_SECTIONS.items():
            if arguments.verbose or getattr(arguments, section):
                print(f"\t{title}:")
                for interface in _find_interfaces(controller, section):
                    print(f"\t\t{interface}")
    return 0


def _find_interfaces(controller: Any, section: str) -> Sequence[str]:
    if section != "chained_interfaces":
        names: Sequence[str] = getattr(controller, section)
        return names
    return [f"{name:20s}" for chain in controller.chain_connections for name in chain.reference_interfaces]


async def _list_types(_: argparse.Namespace, call_manager: ManagerCall) -> int:
    response = await call_manager("list_controller_types")
    for name, base in zip(response.types, response.base_classes, strict=True):
        print(f"{name:70s} {base}")
    return 0


def _configure_list_hardware(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-v", "--verbose", action="store_true", help="also print state interfaces, or data types")
    _add_common_arguments(parser)


async def _list_components(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    for number, component in enumerate((await call_manager("list_hardware_components")).component, start=1):
        print(f"Hardware Component {number}\n\tname: {component.name}\n\ttype: {component.type}")
        print(f"\tplugin name: {component.plugin_name}\n\tstate: id={component.state.id} label={component.state.label}")
        print("\tcommand interfaces")
        for command in component.command_interfaces:
            print(f"\t\t{command.name} {_format_availability(command)} {_format_claim(command)}")
        if arguments.verbose:
            print("\tstate interfaces")
            for state in component.state_interfaces:
                print(f"\t\t{state.name} {_format_availability(state)}")
    return 0


async def _list_interfaces(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    response = await call_manager("list_hardware_interfaces")
    print("command interfaces")
    for command in sorted(response.command_interfaces, key=lambda interface: interface.name):
        status = f"{_format_availability(command)} {_format_claim(command)}"
        print(f"\t{command.name}{_format_data_type(command, arguments)} {status}")
    print("state interfaces")
    for state in sorted(response.state_interfaces, key=lambda interface: interface.name):
        print(f"\t{state.name}{_format_data_type(state, arguments)}")
    return 0


def _format_availability(interface: Any) -> str:
    return "[available]" if interface.is_available else "[unavailable]"


def _format_claim(interface: Any) -> str:
    return "[claimed]" if interface.is_claimed else "[unclaimed]"


def _format_data_type(interface: Any, arguments: argparse.Namespace) -> str:
    return f" [{interface.data_type}]" if arguments.verbose else ""


def _configure_chains(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--save", action="store_true", help="accepted for compatibility with ros2; the diagram is always saved"
    )
    _add_common_arguments(parser)


async def _view_chains(_: argparse.Namespace, call_manager: ManagerCall) -> int:
    text = _format_graphviz((await call_manager("list_controllers")).controller)
    _save_diagram(text)
    return 0


def _save_diagram(text: str) -> None:
    from linkwright.urdf.diagram import render

    gv, diagram = Path("controller_diagram.gv"), Path("controller_diagram.pdf")
    write_output(gv, text)
    render(text, diagram)
    print(f"Saved controller diagram to {diagram.resolve()}")


def _format_graphviz(controllers: Sequence[Any]) -> str:
    """Return a Graphviz diagram of controllers and hardware, connected by their interfaces."""
    names = {controller.name for controller in controllers}
    lines = ["digraph g {", "rankdir=LR;", "node [shape=box, style=rounded];"]
    lines += [f'"{name}";' for name in sorted(names)]
    for controller in controllers:
        for interface in controller.required_command_interfaces:
            component_name, _, interface_name = interface.partition("/")
            target, label = (
                (component_name, interface_name) if component_name in names else ("hw command_interfaces", interface)
            )
            lines.append(f'"{controller.name}" -> "{target}" [label="{label}"];')
        for interface in controller.required_state_interfaces:
            component_name, _, interface_name = interface.partition("/")
            source, label = (
                (component_name, interface_name) if component_name in names else ("hw state_interfaces", interface)
            )
            lines.append(f'"{source}" -> "{controller.name}" [label="{label}"];')
    return "\n".join([*lines, "}", ""])


# --- changes ----------------------------------------------------------------------------------------------------------


_OLD_STATES = {"start": "active", "stop": "inactive", "configure": "inactive"}
"""Maps the names of states in launch files from before Humble to the current names."""


def _to_current_state_name(state: str) -> str:
    return _OLD_STATES.get(state, state)


def _to_absolute_path(text: str) -> Path:
    return Path(text).absolute()  # the manager may run in another folder


def _configure_load(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("controller_name", metavar="CONTROLLER", help="the name of the controller")
    parser.add_argument(
        "param_file",
        metavar="FILE",
        nargs="?",
        type=_to_absolute_path,
        help="the parameter file with the controller's type",
    )
    parser.add_argument(
        "--set-state",
        type=_to_current_state_name,
        choices=("unconfigured", "inactive", "active", "configured"),
        help="the state to switch the controller to after loading",
    )
    _add_common_arguments(parser)


async def _load_controller(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    name, state = arguments.controller_name, arguments.set_state
    if arguments.param_file is not None:
        failure = await _set_manager_parameters(name, arguments.param_file, call_manager)
        if failure:
            return _report_failure(failure)
    if not (await call_manager("load_controller", name=name)).ok:
        return _report_failure(f"Error loading controller, {_LOGS_HINT}")
    if state in (None, "unconfigured"):
        print(f"Successfully loaded controller {name}")
        return 0
    if not (await call_manager("configure_controller", name=name)).ok:
        return _report_failure("Error configuring controller")
    if state == "active" and not (await _request_switch(call_manager, [name], [])).ok:
        return _report_failure(f"Error activating controller, {_LOGS_HINT}")
    print(f"Successfully loaded controller {name} into state {'active' if state == 'active' else 'inactive'}")
    return 0


async def _set_manager_parameters(name: str, file: Path, call_manager: ManagerCall) -> str:
    """Tell the manager the parameter file and the type of a controller, and return why that failed, or ""."""
    from linkwright.graph import Parameter
    from linkwright.graph.parameters.files import read_parameter_file

    kind = read_parameter_file(str(file)).for_node(f"/{name.lstrip('/')}").get("type")
    values = {"params_file": [str(file)]} | ({} if kind is None else {"type": kind})
    parameters = [Parameter(f"{name}.{key}", value=value).to_parameter_msg() for key, value in values.items()]
    response = await call_manager("set_parameters", parameters=parameters)
    reasons = [result.reason for result in response.results if not result.successful]
    return f"Error setting the parameters of {name}: {', '.join(reasons)}" if reasons else ""


async def _request_switch(
    call_manager: ManagerCall, activate: Sequence[str], deactivate: Sequence[str], strictness: int = 2
) -> Any:
    return await call_manager(
        "switch_controller",
        activate_controllers=list(activate),
        deactivate_controllers=list(deactivate),
        strictness=strictness,
        activate_asap=True,
    )


async def _unload_controller(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    name = arguments.controller_name
    if not (await call_manager("unload_controller", name=name)).ok:
        return _report_failure(f"Error unloading controller {name}, {_LOGS_HINT}")
    print(f"Successfully unloaded controller {name}")
    return 0


def _configure_set_state(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("controller_name", metavar="CONTROLLER", help="the name of the controller")
    parser.add_argument(
        "state", type=_to_current_state_name, choices=("unconfigured", "inactive", "active"), help="the target state"
    )
    _add_common_arguments(parser)


async def _set_state(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    name, target_state = arguments.controller_name, arguments.state
    loaded_controller = next(
        (controller for controller in (await call_manager("list_controllers")).controller if controller.name == name),
        None,
    )
    if loaded_controller is None:
        return _report_failure(f"controller {name} does not seem to be loaded")
    steps: dict[tuple[str, str], tuple[str, str, Callable[[], Coroutine[Any, Any, Any]]]] = {
        ("inactive", "unconfigured"): (
            "cleaning up",
            "cleaned up",
            lambda: call_manager("cleanup_controller", name=name),
        ),
        ("unconfigured", "inactive"): (
            "configuring",
            "configured",
            lambda: call_manager("configure_controller", name=name),
        ),
        ("active", "inactive"): ("stopping", "deactivated", lambda: _request_switch(call_manager, [], [name])),
        ("inactive", "active"): ("activating", "activated", lambda: _request_switch(call_manager, [name], [])),
    }
    step = steps.get((loaded_controller.state, target_state))
    if step is None:
        verb = {"active": "activate", "unconfigured": "cleanup"}.get(target_state)
        action = f"cannot {verb} {name}" if verb else f"cannot put {name} in '{target_state}' state"
        return _report_failure(f"{action} from its current state {loaded_controller.state}")
    progress_text, success_text, send_request = step
    if not (await send_request()).ok:
        return _report_failure(f"Error {progress_text} controller, {_LOGS_HINT}")
    print(f"Successfully {success_text} {name}")
    return 0


def _configure_switch(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--deactivate", "--stop", metavar="NAME", nargs="*", default=[], help="controllers to deactivate"
    )
    parser.add_argument("--activate", "--start", metavar="NAME", nargs="*", default=[], help="controllers to activate")
    parser.add_argument("--strict", action="store_true", help="switch all of the controllers or none")
    parser.add_argument(
        "--activate-asap", "--start-asap", action="store_true", help="accepted for compatibility with ros2"
    )
    parser.add_argument(
        "--switch-timeout", metavar="SECONDS", type=float, default=5.0, help="accepted for compatibility with ros2"
    )
    _add_common_arguments(parser)


async def _switch_controllers(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    response = await _request_switch(
        call_manager, arguments.activate, arguments.deactivate, 2 if arguments.strict else 1
    )
    if not response.ok:
        return _report_failure(f"Error switching controllers, {_LOGS_HINT}")
    print("Successfully switched controllers")
    return 0


def _configure_reload(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--force-kill", action="store_true", help="deactivate active controllers first")
    _add_common_arguments(parser)


async def _reload(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    if not (await call_manager("reload_controller_libraries", force_kill=arguments.force_kill)).ok:
        return _report_failure(f"Error reloading libraries, {_LOGS_HINT}")
    print("Reload successful")
    return 0


def _configure_set_hardware(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("hardware_component_name", metavar="HARDWARE", help="the name of the hardware component")
    parser.add_argument("state", choices=("unconfigured", "inactive", "active"), help="the target state")
    _add_common_arguments(parser)


async def _set_hardware(arguments: argparse.Namespace, call_manager: ManagerCall) -> int:
    from linkwright.messages import get_message

    name = arguments.hardware_component_name
    if name not in [component.name for component in (await call_manager("list_hardware_components")).component]:
        return _report_failure(f"component {name} does not seem to be loaded")
    target_state = get_message("lifecycle_msgs/msg/State")(label=arguments.state)
    response = await call_manager("set_hardware_component_state", name=name, target_state=target_state)
    if not response.ok:
        return _report_failure(f"Error setting hardware component to {arguments.state}, {_LOGS_HINT}")
    print(f"Successfully set {name} to state {response.state}")
    return 0


VERBS = {
    "cleanup_controller": SubVerb(
        _add_controller_argument,
        partial(_run, lambda arguments, call_manager: _set_state(_with_state(arguments, "unconfigured"), call_manager)),
        help="clean up an inactive controller, so that it is unconfigured",
    ),
    "list_controller_types": SubVerb(
        _add_common_arguments, partial(_run, _list_types), help="list the available controller types"
    ),
    "list_controllers": SubVerb(
        _configure_list_controllers, partial(_run, _list_controllers), help="list the loaded controllers"
    ),
    "list_hardware_components": SubVerb(
        _configure_list_hardware, partial(_run, _list_components), help="list the hardware components and their states"
    ),
    "list_hardware_interfaces": SubVerb(
        _configure_list_hardware, partial(_run, _list_interfaces), help="list the interfaces of the hardware"
    ),
    "load_controller": SubVerb(_configure_load, partial(_run, _load_controller), help="load a controller"),
    "reload_controller_libraries": SubVerb(
        _configure_reload, partial(_run, _reload), help="unload all controllers and reload the controller types"
    ),
    "set_controller_state": SubVerb(
        _configure_set_state, partial(_run, _set_state), help="set the state of a controller"
    ),
    "set_hardware_component_state": SubVerb(
        _configure_set_hardware, partial(_run, _set_hardware), help="set the state of a hardware component"
    ),
    "switch_controllers": SubVerb(
        _configure_switch, partial(_run, _switch_controllers), help="deactivate controllers and activate others"
    ),
    "unload_controller": SubVerb(
        _add_controller_argument, partial(_run, _unload_controller), help="unload a controller that is not active"
    ),
    "view_controller_chains": SubVerb(
        _configure_chains, partial(_run, _view_chains), help="draw the controllers and the interfaces that they claim"
    ),
}


def _with_state(arguments: argparse.Namespace, state: str) -> argparse.Namespace:
    """Return a copy of arguments with a state."""
    return argparse.Namespace(**vars(arguments) | {"state": state})


configure = partial(configure_nested, verbs=VERBS)
run = run_nested
