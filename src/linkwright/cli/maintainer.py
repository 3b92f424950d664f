"""The maintainer of a new package, from git's configuration or the login name."""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.packages.creation.request import Maintainer


def find_maintainer(name: str | None, email: str | None) -> Maintainer:
    """Return the maintainer of the new package.

    A missing name or address is taken from git's configuration, or else derived from the login name.
    """
    from linkwright.packages.creation.request import Maintainer
    from linkwright.packages.naming import is_email

    login = _find_login_name()
    if not name:
        name = _read_git_setting("user.name") or login
    if not email:
        # reject an address without a domain, which git may generate and colcon does not accept
        configured = _read_git_setting("user.email")
        email = configured if is_email(configured) else f"{_to_address_part(login)}@todo.todo"
    return Maintainer(name, email)


def _read_git_setting(key: str) -> str:
    """Return a value of git's configuration, or an empty string if the value or git is missing."""
    try:
        result = subprocess.run(  # noqa: S603 - fixed words, no shell
            ["git", "config", key],  # noqa: S607 - the user's own git, found as the shell finds it
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=5,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return result.stdout.strip()


def _find_login_name() -> str:
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # in a container, a user ID need not have a name
        return "user"


def _to_address_part(login: str) -> str:
    import re

    return re.sub(r"[^A-Za-z0-9_%+-]+", "-", login).strip("-") or "user"
