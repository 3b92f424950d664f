"""Open a Zenoh session with the settings of the environment."""

from __future__ import annotations

import json
import re
import threading

import zenoh

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, foreign, phrase
from linkwright.wire.zenoh.connection_problems import find_connection_problems
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE, Settings

_SOURCE_LOCATION = re.compile(r"\s+at /\S+?:\d+\.?")
_NOT_CONNECTED = "Unable to connect"
_ADDRESS_IN_USE = "already in use"
_TLS_FILES = "new TLS listener"
_CLOSE_TIMEOUT_S = 3.0
"""The maximum time, in seconds, for which `close_session` waits."""


def open_session(config: zenoh.Config) -> zenoh.Session:
    """Open a session with a configuration.

    Raises:
        LinkwrightError: DDS112, the session cannot be opened.
    """
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        raise session_error(error, config) from error


def close_session(session: zenoh.Session) -> None:
    """Close a session, in the background if that takes long.

    Zenoh waits without a limit for connections whose buffers are full. This function returns after `_CLOSE_TIMEOUT_S`
    at the latest, so that the process can end.
    """
    close_thread = threading.Thread(target=session.close, name="linkwright-zenoh-close", daemon=True)
    try:
        close_thread.start()
    except RuntimeError:  # Python is shutting down and starts no more threads.
        session.close()
    else:
        close_thread.join(_CLOSE_TIMEOUT_S)


def session_error(error: zenoh.ZError, config: zenoh.Config) -> LinkwrightError:
    """Return the error DDS112 for a session that cannot be opened."""
    reasons = find_connection_problems(config) if is_connection_failure(error) else []
    return LinkwrightError(
        Diagnostic(
            "DDS112",
            phrase("a Zenoh session cannot be opened: {reason}", reason=foreign(_shorten_message(error))),
            notes=tuple(Note(reason) for reason in reasons),
            hint=None if reasons else _find_hint(str(error)),
        )
    )


def is_connection_failure(error: zenoh.ZError) -> bool:
    """Return whether a session could not be opened because no address could be reached."""
    return _NOT_CONNECTED in str(error)


def is_client(settings: Settings) -> bool:
    """Return whether a session with the given settings is a client of a router.

    Raises:
        LinkwrightError: DDS111, the configuration is refused.
    """
    return bool(json.loads(build_config(settings).get_json("mode")) == "client")


def find_listen_addresses(config: zenoh.Config) -> list[str]:
    """Return the addresses at which sessions with a configuration listen.

    The list is empty if the addresses differ between session modes.
    """
    addresses = json.loads(config.get_json("listen/endpoints"))
    return [str(address) for address in addresses] if isinstance(addresses, list) else []


def build_config(settings: Settings) -> zenoh.Config:
    """Return the Zenoh configuration that follows from the settings.

    Raises:
        LinkwrightError: DDS111, the configuration is refused.
    """
    if settings.config_file:
        try:
            config = zenoh.Config.from_file(settings.config_file)
        except zenoh.ZError as error:
            raise LinkwrightError(
                Diagnostic(
                    "DDS111",
                    phrase("Zenoh refuses the configuration file '{path}'", path=settings.config_file),
                    hint=phrase("Zenoh reports: {reason}", reason=foreign(_shorten_message(error))),
                )
            ) from error
    else:
        config = zenoh.Config()
        for key, value in settings.default_entries:
            config.insert_json5(key, value)
    for key, value in settings.overrides:
        _override(config, key, value)
    return config


def _override(config: zenoh.Config, key: str, value: str) -> None:
    try:
        config.insert_json5(key, value)
    except zenoh.ZError as error:
        raise LinkwrightError(
            Diagnostic(
                "DDS111",
                phrase(
                    "Zenoh refuses '{key}={value}' of {variable}", key=key, value=value, variable=OVERRIDES_VARIABLE
                ),
                hint=phrase("Zenoh reports: {reason}", reason=foreign(_shorten_message(error))),
            )
        ) from error


def _shorten_message(error: Exception) -> str:
    """Return the message of an error, without the locations in Zenoh's source."""
    return _SOURCE_LOCATION.sub("", str(error)).strip().rstrip(".")


def _find_hint(reason: str) -> Phrase:
    if _NOT_CONNECTED in reason:
        return phrase(
            "no router answers at the address of 'connect/endpoints': start one there first; with TLS, check "
            "that one authority signed the certificates"
        )
    if _ADDRESS_IN_USE in reason:
        return phrase(
            "only one process can listen at an address of 'listen/endpoints': give the others port 0 for any "
            "free port, or leave the setting out"
        )
    if _TLS_FILES in reason:
        return phrase(
            "check the files of 'listen_certificate' and 'listen_private_key' below 'transport/link/tls': they "
            "must be readable and belong together, and relative paths start at the folder where the command "
            "runs"
        )
    return phrase(
        "check the addresses to listen at: one may be in use by another program, or not belong to this machine"
    )
