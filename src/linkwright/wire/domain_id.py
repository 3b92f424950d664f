"""Read ROS_DOMAIN_ID, the domain of this process."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase

MAX_DOMAIN_ID = 232
"""The highest domain for which the ports of RTPS exist (from 7400, 250 per domain)."""


def read_domain_id(variables: Mapping[str, str], domain_id: int | None = None) -> int:
    """Return the domain that environment variables specify.

    Args:
        variables: the environment variables.
        domain_id: the domain, which takes precedence over ROS_DOMAIN_ID; None for ROS_DOMAIN_ID.

    Raises:
        LinkwrightError: DDS101, the value is not a valid domain.
    """
    text = variables.get("ROS_DOMAIN_ID", "") if domain_id is None else str(domain_id)
    if not text.strip():
        return 0
    if text.strip().isdecimal() and int(text) <= MAX_DOMAIN_ID:
        return int(text)
    raise LinkwrightError(
        Diagnostic(
            code="DDS101",
            message=phrase("'{value}' is not a DDS domain ID", value=text),
            hint=phrase(
                "set ROS_DOMAIN_ID to a number from 0 to {maximum}; up to 101 is safe on every system",
                maximum=MAX_DOMAIN_ID,
            ),
        )
    )
