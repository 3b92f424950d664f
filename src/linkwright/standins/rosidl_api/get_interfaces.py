"""Lists of interfaces and their files (the API of ``rosidl_runtime_py.get_interfaces``)."""

from collections.abc import Iterable

from linkwright.diagnostics import phrase
from linkwright.messages.definitions.library import LIBRARY
from linkwright.packages import current_finder, interface_files


def get_interface_packages() -> list[str]:
    """Return the sorted names of the packages that define interfaces."""
    return sorted({name.partition("/")[0] for kind in ("msg", "srv", "action") for name in LIBRARY.names(kind)})


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages, services and actions of each package, such as ``msg/String``.

    Raises:
        LookupError: one of the packages does not exist.
    """
    return _find_interfaces_by_package(("msg", "srv", "action"), package_names)


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages of each package, such as ``msg/String``."""
    return _find_interfaces_by_package(("msg",), package_names)


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the services of each package, such as ``srv/SetBool``."""
    return _find_interfaces_by_package(("srv",), package_names)


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the actions of each package, such as ``action/Fibonacci``."""
    return _find_interfaces_by_package(("action",), package_names)


def get_interface_path(interface_name: str) -> str:
    """Return the path of the file that defines an interface.

    Raises:
        ValueError: `interface_name` is not the name of an interface.
        LookupError: the interface has no file.
    """
    parts = interface_name.split("/")
    if len(parts) != 3:
        raise ValueError(f"Invalid name '{interface_name}'. Expected three parts separated by '/'")
    package, kind, name = parts
    share = current_finder().find(package)
    path = interface_files.find_interface_file(share, kind, name) if share is not None else None
    if path is None:
        raise LookupError(f"Could not find the interface '{interface_name}'")
    return str(path)


def _find_interfaces_by_package(kinds: tuple[str, ...], package_names: Iterable[str]) -> dict[str, list[str]]:
    requested_packages = set(package_names)
    names_by_package: dict[str, list[str]] = {}
    for kind in kinds:
        for name in LIBRARY.names(kind):
            package, _, interface_name = name.partition("/")
            if not requested_packages or package in requested_packages:
                names_by_package.setdefault(package, []).append(interface_name)
    missing_packages = sorted(requested_packages - set(names_by_package) - set(get_interface_packages()))
    if missing_packages:
        raise LookupError(phrase("there is no package '{package}'", package=missing_packages[0]))
    return {package: sorted(names) for package, names in sorted(names_by_package.items())}
