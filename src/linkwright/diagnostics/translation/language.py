"""The language of messages: the one asked for, else that of the environment, else English."""

from __future__ import annotations

import os

ENGLISH, CHINESE = "en", "zh"
TAGS = {ENGLISH: "en", CHINESE: "zh-CN"}
"""The languages of messages, each with its tag in web pages: English, and Chinese in simplified characters."""

LANGUAGES = tuple(TAGS)

_VARIABLES = ("LINKWRIGHT_LANG", "LC_ALL", "LC_MESSAGES", "LANG")
"""The first that is set decides; the order of the last three is that of POSIX."""

_asked: str | None = None


def set_language(code: str | None) -> None:
    """Set the language, one of `LANGUAGES`, for the rest of the program's run; None for that of the environment."""
    global _asked  # noqa: PLW0603 - the language is one for the whole process, as the locale is
    if code is not None and code not in LANGUAGES:
        raise ValueError(f"there is no language '{code}'; the languages are {', '.join(LANGUAGES)}")
    _asked = code


def asked_language() -> str | None:
    """Return the language that was set, or None. Output for programs is not in English only if a language was set."""
    return _asked


def language() -> str:
    """The language for people, one of `LANGUAGES`."""
    if _asked is not None:
        return _asked
    for name in _VARIABLES:
        value = os.environ.get(name)
        if value:
            return language_of(value) or ENGLISH
    return ENGLISH


def language_of(locale: str) -> str | None:
    """The language of a locale's name such as ``zh_CN.UTF-8``; None if messages are not known in it.

    Any Chinese locale reads simplified characters: we have no others.
    """
    name = locale.strip().replace("-", "_").partition(".")[0].partition("_")[0].casefold()
    return name if name in LANGUAGES else None
