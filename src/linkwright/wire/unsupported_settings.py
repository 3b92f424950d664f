"""ROS 2 settings that no transport supports: security, discovery servers, other middleware.

A real node applies these settings: it refuses nodes without certificates, or is found only through a server. A
Linkwright node would start anyway and find no other node, or send unencrypted data that the user believes to be
encrypted.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase

MIDDLEWARE_VARIABLE = "RMW_IMPLEMENTATION"
SECURITY_VARIABLES = ("ROS_SECURITY_ENABLE", "ROS_SECURITY_STRATEGY")
DISCOVERY_SERVER_VARIABLES = ("ROS_DISCOVERY_SERVER", "ROS2_EASY_MODE")
"""Variables of Fast DDS. ROS2_EASY_MODE exists since Kilted."""

ZENOH = "rmw_zenoh_cpp"
CYCLONE = "rmw_cyclonedds_cpp"
_FAST_DDS = ("rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")
_OTHER_DDS = (
    "rmw_connextdds",
    "rmw_connextddsmicro",
    "rmw_connext_cpp",
    "rmw_gurumdds_cpp",
    "rmw_opensplice_cpp",
    "rmw_coredx_cpp",
)
_KNOWN_MIDDLEWARES = (CYCLONE, *_FAST_DDS, ZENOH, *_OTHER_DDS)

_reported: set[str] = set()
"""The codes of the warnings that were reported in this process."""


def refuse_enforced_security(environment: Mapping[str, str] | None = None) -> None:
    """Raise an error if security is enforced.

    In that case, no node may join the graph without security.

    Args:
        environment: the environment variables; by default, the variables of this process.

    Raises:
        LinkwrightError: DDS121, security is enforced.
    """
    variables = os.environ if environment is None else environment
    if _is_security_enabled(variables) and variables.get("ROS_SECURITY_STRATEGY") == "Enforce":
        raise LinkwrightError(
            Diagnostic(
                "DDS121",
                phrase(
                    "ROS_SECURITY_STRATEGY is Enforce, but Linkwright does not support DDS security, so it does not "
                    "join the domain"
                ),
                hint=phrase(
                    "set ROS_SECURITY_ENABLE=false for this command, so that it joins nodes without security; "
                    "nodes with security need a real ROS 2"
                ),
            )
        )


def find_unsupported_settings(environment: Mapping[str, str] | None = None) -> list[Diagnostic]:
    """Return a warning for each setting in the environment that is not supported.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    variables = os.environ if environment is None else environment
    warnings = []
    middleware = variables.get(MIDDLEWARE_VARIABLE, "").strip()
    if _is_security_enabled(variables):
        warnings.append(
            Diagnostic(
                "DDS122",
                phrase("ROS_SECURITY_ENABLE is true, but Linkwright has no DDS security: it joins without security"),
                severity=Severity.WARNING,
                hint=phrase(
                    "set ROS_SECURITY_ENABLE=false if this is intended: messages are not encrypted, and "
                    "nodes with security may refuse them"
                ),
            )
        )
    variable = next((name for name in DISCOVERY_SERVER_VARIABLES if variables.get(name)), None)
    if variable is not None and middleware in ("", *_FAST_DDS):
        warnings.append(
            Diagnostic(
                "DDS123",
                phrase(
                    "{variable} is set, but Linkwright does not support discovery servers of Fast DDS: it does "
                    "not find nodes that use one",
                    variable=variable,
                ),
                severity=Severity.WARNING,
                hint=phrase(
                    "unset it for all nodes, or let them use {cyclone}; ROS_STATIC_PEERS names computers that multicast"
                    " does not reach",
                    cyclone=CYCLONE,
                ),
            )
        )
    if middleware and middleware not in _KNOWN_MIDDLEWARES:
        warnings.append(
            Diagnostic(
                "DDS124",
                phrase(
                    "RMW_IMPLEMENTATION is '{name}', a middleware that Linkwright does not support: it uses "
                    "DDS, as with {cyclone}",
                    name=middleware,
                    cyclone=CYCLONE,
                ),
                severity=Severity.WARNING,
                hint=phrase("unset it, or set it to {cyclone} or {zenoh}", cyclone=CYCLONE, zenoh=ZENOH),
            )
        )
    return warnings


def find_new_unsupported_settings(environment: Mapping[str, str] | None = None) -> list[Diagnostic]:
    """Return the warnings of `find_unsupported_settings` that were not returned before."""
    warnings = [diagnostic for diagnostic in find_unsupported_settings(environment) if diagnostic.code not in _reported]
    _reported.update(diagnostic.code for diagnostic in warnings)
    return warnings


def _is_security_enabled(variables: Mapping[str, str]) -> bool:
    """Return whether rcl would enable security, which requires exactly the value ``true``."""
    return variables.get("ROS_SECURITY_ENABLE") == "true"
