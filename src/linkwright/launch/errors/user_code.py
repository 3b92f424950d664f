"""Conversion of exceptions in a user's launch file to findings without a traceback.

The findings have a location, and their hints suggest similar names.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterable
from traceback import walk_tb
from types import FrameType, ModuleType, TracebackType
from typing import Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    SourceText,
    Span,
    did_you_mean,
    display_path,
    foreign,
    nearest,
    phrase,
    quoted_names,
)
from linkwright.launch.errors.exceptions import as_ros_error
from linkwright.launch.errors.places import CodePlace, Place, error_at, located, read_source
from linkwright.packages.programs.code_files import is_users

DEEPEST = 300
"""The maximum nesting of launch actions: files that include files, groups in groups, functions that return actions.
Python's own limit would be reached a little later, at an unrelated place."""

_PATH_OF_MODULE = re.compile(r" \((?:/|[A-Z]:|unknown location).*\)$")
_MISSING_ARGUMENT = re.compile(r"\(\) missing \d+ required .*arguments?: (.*)$")
_UNEXPECTED_ARGUMENT = re.compile(r"([\w.]+)\(\) got an unexpected keyword argument '([^']+)'")


def explain(error: BaseException, where: str, fallback: Place | None = None) -> LinkwrightError:
    """Convert an exception to an error that points at the user's own line.

    Args:
        error: the exception, which may come from ``sys.exit``.
        where: the code that was running, such as "launch file 'x.launch.py'".
        fallback: the place to report if no line of the user's code was running.

    Returns:
        The exception itself if it is a LinkwrightError, with a place if it had none; otherwise a new error LAUNCH104.
    """
    trail = list(_user_places(error.__traceback__))
    place = trail[-1] if trail else fallback
    if isinstance(error, LinkwrightError):
        return located(error, place)
    kind = type(error).__name__
    text = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    text = _PATH_OF_MODULE.sub("", (text.splitlines() or [""])[0]).rstrip(".")
    message = (
        phrase("{where} raised {kind}: {text}", where=where, kind=kind, text=foreign(text))
        if text
        else phrase("{where} raised {kind}", where=where, kind=kind)
    )
    source = place.source() if place else None
    span = place.span(source) if place else None
    callers = dict.fromkeys(reversed(trail[:-1]))  # report a recursive function only once
    notes = tuple(Note(phrase("called from here"), caller.span(read_source(caller.file))) for caller in callers)
    diagnostic = Diagnostic("LAUNCH104", message, span, notes=notes, hint=_hint(error, source, span), source=source)
    return as_ros_error(error if isinstance(error, Exception) else None, diagnostic)


def endless_nesting_error(place: Place | None) -> LinkwrightError:
    """Return the error for launch actions that are nested more deeply than the limit."""
    message = phrase("launch actions are nested without end: more than {count} levels", count=DEEPEST)
    hint = phrase(
        "a launch file that includes itself, or a function that returns itself, needs a condition that ends "
        "the recursion"
    )
    return error_at(place, "LAUNCH156", message, hint)


def too_deep_error(path: str) -> LinkwrightError:
    """Return the error for a launch file that is nested too deeply for Python's stack."""
    message = phrase("launch file '{path}' is nested too deeply to be read", path=display_path(path))
    return error_at(None, "LAUNCH156", message)


def _user_places(traceback: TracebackType | None) -> Iterable[Place]:
    if traceback is None:
        return
    current: TracebackType | None = traceback
    for frame, line in walk_tb(traceback):
        assert current is not None
        if is_users(frame.f_code.co_filename):
            yield CodePlace(frame.f_code, current.tb_lasti, line)
        current = current.tb_next


def _hint(error: BaseException, source: SourceText | None, span: Span | None) -> Phrase | None:
    """Return a hint on what the user may have meant, or None if there is no guess."""
    if isinstance(error, ImportError):
        return _import_hint(error)
    if isinstance(error, NameError):
        frame = _innermost_frame(error)
        known = {**frame.f_globals, **frame.f_locals} if frame else {}
        name = getattr(error, "name", None)
        return did_you_mean(name, known) if name else None
    if isinstance(error, AttributeError):
        name, owner = getattr(error, "name", None), getattr(error, "obj", None)
        return did_you_mean(name, _public_names(owner)) if name else None
    if isinstance(error, TypeError):
        return _keyword_hint(error) or _missing_hint(error, source, span)
    return None


def _public_names(owner: object) -> list[str]:
    """Return the public names of an object, except submodules.

    Submodules are excluded, because they often have the name of an object inside them.
    """
    return [
        name
        for name in dir(owner)
        if not name.startswith("_") and not isinstance(getattr(owner, name, None), ModuleType)
    ]


def _import_hint(error: ImportError) -> Phrase | None:
    from linkwright.packages.programs.missing_modules import missing_name, other_module_hint, provider_hint

    found = missing_name(error)
    if found:
        name, module = found
        return other_module_hint(error) or did_you_mean(name, _public_names(sys.modules.get(module)))
    missing = error.name or ""
    parent, _, name = missing.rpartition(".")
    if parent in sys.modules:
        import pkgutil

        siblings = [
            iter_module.name for iter_module in pkgutil.iter_modules(getattr(sys.modules[parent], "__path__", ()))
        ]
        return did_you_mean(name, siblings)
    known = did_you_mean(missing, ("launch", "launch_ros", "ament_index_python"))
    if known or not missing:
        return known
    return provider_hint(missing)


def _keyword_hint(error: TypeError) -> Phrase | None:
    """Return a hint that suggests a valid name for an unexpected keyword argument.

    Returns:
        The hint; None if the error has another cause or no name is similar.
    """
    found = _UNEXPECTED_ARGUMENT.search(str(error))
    frame = _innermost_frame(error, users_only=True)
    if not found or frame is None:
        return None
    function, name = found.groups()
    called = _called_objects(frame, function.partition(".")[0])
    names = {parameter for called_object in called for parameter in _parameter_names(called_object)}
    return did_you_mean(name, names)


def _missing_hint(error: TypeError, source: SourceText | None, span: Span | None) -> Phrase | None:
    """Return a hint that a given keyword argument may be the misspelt name of a missing one.

    Returns:
        The hint; None if the error has another cause or no name is similar.
    """
    found = _MISSING_ARGUMENT.search(str(error))
    if not found or source is None or span is None:
        return None
    call = source.text[source.offset(span.line, span.column) : source.offset(span.end_line, span.end_column)]
    written = re.findall(r"\b(\w+)\s*=(?!=)", call)
    for missing in re.findall(r"'(\w+)'", found.group(1)):
        near = nearest(missing, (name for name in written if name != missing))
        if near:
            return phrase(
                "'{missing}' is missing; the call has {near}", missing=missing, near=quoted_names(near, " or ")
            )
    return None


def _called_objects(frame: FrameType, class_name: str) -> list[Any]:
    """Return the functions and classes visible in a frame to which a failed call may refer.

    These are the functions with the given name, and the classes with this name or derived from such a class.
    """
    known = [*frame.f_globals.values(), *frame.f_locals.values()]
    return [
        function_type
        for function_type in known
        if (inspect.isclass(function_type) and any(base.__name__ == class_name for base in function_type.__mro__))
        or (inspect.isfunction(function_type) and function_type.__name__ == class_name)
    ]


def _parameter_names(called: Any) -> Iterable[str]:
    functions = [vars(base).get("__init__") for base in called.__mro__] if inspect.isclass(called) else [called]
    for function in functions:
        if inspect.isfunction(function):
            for parameter in inspect.signature(function).parameters.values():
                if parameter.kind in (parameter.KEYWORD_ONLY, parameter.POSITIONAL_OR_KEYWORD):
                    yield parameter.name


def _innermost_frame(error: Exception, *, users_only: bool = False) -> FrameType | None:
    frame = None
    for candidate, _ in walk_tb(error.__traceback__):
        if not users_only or is_users(candidate.f_code.co_filename):
            frame = candidate
    return frame
