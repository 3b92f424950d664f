"""Convert exceptions in a user's launch file to findings, without a traceback.

The findings have a location, and their hints suggest similar names.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterable, Mapping
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
from linkwright.launch.errors.locations import CodeLocation, SourceLocation, error_at, read_source, with_location
from linkwright.packages.programs.code_files import is_user_file

MAX_NESTING_DEPTH = 300
"""The maximum nesting depth of launch actions.

Includes, groups, and functions that return actions increase the depth.
Python's own limit would be exceeded only slightly later, at an unrelated location."""

_MODULE_PATH = re.compile(r" \((?:/|[A-Z]:|unknown location).*\)$")
_MISSING_SELF = re.compile(r"\w+\.\w+\(\) takes 0 positional arguments but 1 was given")
_JOINED_SUBSTITUTION = re.compile(r'(concatenate str \(not "|operand type\(s\).*)(LaunchConfiguration|Command|Find\w+)')
_ACTION_FOR_LIST = re.compile(r"^'(Node|ExecuteProcess|IncludeLaunchDescription|\w+Action)' object is not iterable")
_MODULES_BY_NAME = {"Path": ("pathlib",), "glob": ("glob",)}
_PYTHON_CONSTANTS = {"true": "True", "false": "False", "null": "None", "none": "None"}
_MAX_SUGGESTED_MODULES = 3
_MAX_CALL_LINES = 5
"""The number of lines of a call that are searched for an argument."""
_MISSING_ARGUMENT = re.compile(r"\(\) missing \d+ required .*arguments?: (.*)$")
_UNEXPECTED_ARGUMENT = re.compile(r"([\w.]+)\(\) got an unexpected keyword argument '([^']+)'")


def explain(error: BaseException, subject: str, fallback: SourceLocation | None = None) -> LinkwrightError:
    """Return an error that reports an exception at the user's own line of code.

    Args:
        error: the exception; it may also come from ``sys.exit``.
        subject: the code that raised the exception, for the message, such as "launch file 'x.launch.py'".
        fallback: the location to report if no line of user code was running.

    Returns:
        The exception itself if it is a LinkwrightError, with the location added if it had none. Otherwise, a new error
            LAUNCH104.
    """
    user_locations = list(_find_user_locations(error.__traceback__))
    location = user_locations[-1] if user_locations else fallback
    if isinstance(error, LinkwrightError):
        return with_location(error, location)
    type_name = type(error).__name__
    text = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    text = _MODULE_PATH.sub("", (text.splitlines() or [""])[0]).rstrip(".")
    message = (
        phrase("{subject} raised {kind}: {text}", subject=subject, kind=type_name, text=foreign(text))
        if text
        else phrase("{subject} raised {kind}", subject=subject, kind=type_name)
    )
    source = location.source() if location else None
    span = location.span(source) if location else None
    callers = dict.fromkeys(reversed(user_locations[:-1]))  # report a recursive function only once
    notes = tuple(Note(phrase("called from here"), caller.span(read_source(caller.file))) for caller in callers)
    diagnostic = Diagnostic(
        "LAUNCH104", message, span, notes=notes, hint=create_hint(error, source, span), source=source
    )
    return as_ros_error(error if isinstance(error, Exception) else None, diagnostic)


def endless_nesting_error(location: SourceLocation | None) -> LinkwrightError:
    """Return the error for launch actions that are nested more deeply than the limit."""
    message = phrase(
        "launch actions are nested more than {count} levels deep, probably without end", count=MAX_NESTING_DEPTH
    )
    hint = phrase(
        "add a condition that ends the recursion, if a launch file includes itself or a function returns itself"
    )
    return error_at(location, "LAUNCH156", message, hint)


def too_deep_error(path: str) -> LinkwrightError:
    """Return the error for a launch file whose nesting exceeds the limit of Python's stack."""
    message = phrase("the elements of launch file '{path}' are nested too deeply to be read", path=display_path(path))
    return error_at(None, "LAUNCH156", message)


def _find_user_locations(traceback: TracebackType | None) -> Iterable[SourceLocation]:
    if traceback is None:
        return
    traceback_entry: TracebackType | None = traceback
    for frame, line in walk_tb(traceback):
        assert traceback_entry is not None
        if is_user_file(frame.f_code.co_filename):
            yield CodeLocation(frame.f_code, traceback_entry.tb_lasti, line)
        traceback_entry = traceback_entry.tb_next


def create_hint(error: BaseException, source: SourceText | None = None, span: Span | None = None) -> Phrase | None:
    """Return a hint with the name that the user may have meant, or None if no name is similar.

    Args:
        error: the exception.
        source: the file in which it was raised, if it is known.
        span: the call that failed, if it is known.
    """
    if isinstance(error, ImportError):
        return _import_hint(error)
    if isinstance(error, NameError):
        frame = _find_innermost_frame(error)
        visible_names = {**frame.f_globals, **frame.f_locals} if frame else {}
        name = getattr(error, "name", None)
        if name in _PYTHON_CONSTANTS:
            return phrase("did you mean '{name}'?", name=_PYTHON_CONSTANTS[name])
        if name and (hint := _scope_hint(name, frame, visible_names)):
            return hint
        return (did_you_mean(name, visible_names) or import_hint(name)) if name else None
    if isinstance(error, AttributeError):
        if hint := _class_hint(error):
            return hint
        name, owner = getattr(error, "name", None), getattr(error, "obj", None)
        return (
            (did_you_mean(name, _find_public_names(owner)) or _unset_attribute_hint(name, owner, error))
            if name
            else None
        )
    if isinstance(error, TypeError):
        if _MISSING_SELF.search(str(error)):
            return phrase("the first parameter of a method is self: def NAME(self, ...)")
        return _keyword_hint(error) or _missing_argument_hint(error, source, span) or _substitution_hint(error)
    if (
        isinstance(error, ValueError)
        and "(expected 2)" in str(error)
        and "launch_arguments" in _read_call_text(source, span)
    ):
        return phrase("write .items() after the dict: launch_arguments={...}.items()")
    return None


def _scope_hint(name: str, frame: FrameType | None, visible_names: Mapping[str, object]) -> Phrase | None:
    """Return a hint about the scope of an undefined name.

    The name is ``self`` outside of a method, an attribute without ``self``, or a variable without a value. The result
    is None if the name has another cause.
    """
    if name == "self":
        return phrase("'self' exists only in methods with the parameter self; use the variable that holds the object")
    owner = frame.f_locals.get("self") if frame else None
    if owner is not None and hasattr(owner, name):
        return phrase("write self.{name}", name=name)
    if any(name == visible_name.lower() and isinstance(value, type) for visible_name, value in visible_names.items()):
        return phrase("no line before this one sets '{name}'; write '{name} = ...'", name=name)
    return None


def _read_call_text(source: SourceText | None, span: Span | None) -> str:
    """Return the lines of a call that failed, or an empty text if they are not known."""
    if source is None or span is None:
        return ""
    return "\n".join(source.text.splitlines()[span.line - 1 : span.line + _MAX_CALL_LINES])


def _class_hint(error: AttributeError) -> Phrase | None:
    """Return a hint about a class instead of an instance, or a method outside its class.

    The result is None if the error has another cause.
    """
    name, owner = getattr(error, "name", None) or "", getattr(error, "obj", None)
    if isinstance(owner, property):
        return phrase("a class is used where its instance is required; write its name with parentheses: NAME()")
    if name.startswith("_Node__"):
        return phrase("call super().__init__('NAME') first in __init__")
    if hasattr(owner, "TYPE_NAME") and name and (hint := _field_hint(name, owner)):
        return hint
    frame = _find_innermost_frame(error)
    if frame is not None and callable(frame.f_globals.get(name)) and "self" in frame.f_locals:
        return phrase("'{name}' is a function outside the class; indent it like the other methods", name=name)
    return None


def _field_hint(name: str, message: object) -> Phrase | None:
    """Return a hint about a field that a message lacks.

    The hint names the field of an inner message, a similar field, or an attribute of a field's value.
    """
    fields = [field for field in _find_public_names(message) if field.islower()]
    fields_with_name = [field for field in fields if hasattr(getattr(message, field), name)]
    message_fields = [field for field in fields_with_name if hasattr(getattr(message, field), "TYPE_NAME")]
    if not message_fields and (hint := did_you_mean(name, fields)):
        return hint
    names = [f".{field}.{name}" for field in message_fields or fields_with_name[:1]]
    return phrase("did you mean {names}?", names=quoted_names(names, " or ")) if names else None


def _unset_attribute_hint(name: str, owner: object, error: AttributeError) -> Phrase | None:
    """Return a hint about an attribute that a method reads before it is set, or None."""
    frame = _find_innermost_frame(error)
    if frame is None or frame.f_locals.get("self") is not owner or owner is None:
        return None
    return phrase("set self.{name} in __init__, before it is used", name=name)


def import_hint(name: str) -> Phrase | None:
    """Return a hint with the module from which an undefined name can be imported, or None."""
    from linkwright.messages.presentation import interface_names
    from linkwright.standins.table import find_modules_providing

    if name in sys.stdlib_module_names and name not in _MODULES_BY_NAME:
        return phrase("write 'import {name}' at the top of the file", name=name)
    interfaces = [full_name for kind in ("msg", "srv", "action") for full_name in interface_names(kind)]
    locations = [".".join(full_name.split("/")[:-1]) for full_name in interfaces if full_name.endswith(f"/{name}")]
    modules = [*_MODULES_BY_NAME.get(name, ()), *find_modules_providing(name), *locations][:_MAX_SUGGESTED_MODULES]
    if not modules:
        return None
    return phrase("import it from {modules}", modules=quoted_names(modules, " or "))


def _substitution_hint(error: TypeError) -> Phrase | None:
    """Return a hint about text joined with a substitution, or an action instead of a list.

    The result is None if the error has another cause.
    """
    text = str(error)
    if _JOINED_SUBSTITUTION.search(text):
        return phrase("a substitution has no text before the launch runs; put the parts into a list: ['xacro ', model]")
    if _ACTION_FOR_LIST.search(text):
        return phrase("put the actions into a list: LaunchDescription([...])")
    return None


def _find_public_names(owner: object) -> list[str]:
    """Return the public names of an object, without submodules.

    A submodule often has the same name as an object inside it.
    """
    return [
        name
        for name in dir(owner)
        if not name.startswith("_") and not isinstance(getattr(owner, name, None), ModuleType)
    ]


def _import_hint(error: ImportError) -> Phrase | None:
    from linkwright.messages.presentation import interface_names
    from linkwright.packages.programs.missing_modules import (
        find_missing_name,
        make_other_module_hint,
        make_provider_hint,
        make_ros_1_hint,
    )

    missing_attribute = find_missing_name(error)
    if missing_attribute:
        name, module = missing_attribute
        return (
            make_other_module_hint(error)
            or did_you_mean(name, _find_public_names(sys.modules.get(module)))
            or import_hint(name)
        )
    missing_module = error.name or ""
    parent, _, name = missing_module.rpartition(".")
    if parent in sys.modules:
        import pkgutil

        siblings = [
            iter_module.name for iter_module in pkgutil.iter_modules(getattr(sys.modules[parent], "__path__", ()))
        ]
        return did_you_mean(name, siblings) or _other_kind_hint(parent)
    if ros_1_hint := make_ros_1_hint(missing_module):
        return ros_1_hint
    packages = {full_name.split("/")[0] for full_name in interface_names("msg")}
    known_packages = ("launch", "launch_ros", "ament_index_python", "rclpy", *sorted(packages))
    suggestion = did_you_mean(missing_module, known_packages)
    if suggestion or not missing_module:
        return suggestion
    return make_provider_hint(missing_module)


def _other_kind_hint(package: str) -> Phrase | None:
    """Return a hint with the modules of a package of interfaces, or None for another package."""
    from linkwright.messages.presentation import interface_names

    kinds = [
        kind
        for kind in ("msg", "srv", "action")
        if any(full_name.partition("/")[0] == package for full_name in interface_names(kind))
    ]
    if not kinds:
        return None
    return phrase("import it from {modules}", modules=quoted_names([f"{package}.{kind}" for kind in kinds], " or "))


def _keyword_hint(error: TypeError) -> Phrase | None:
    """Return a hint with the valid name that is similar to an unexpected keyword argument.

    Returns:
        The hint; None if the error has another cause or no name is similar.
    """
    match = _UNEXPECTED_ARGUMENT.search(str(error))
    frame = _find_innermost_frame(error, users_only=True)
    if not match or frame is None:
        return None
    function, name = match.groups()
    candidates = _find_called_objects(frame, function.partition(".")[0])
    names = {parameter for candidate in candidates for parameter in _find_parameter_names(candidate)}
    return did_you_mean(name, names)


def _missing_argument_hint(error: TypeError, source: SourceText | None, span: Span | None) -> Phrase | None:
    """Return a hint with the keyword argument that is probably a misspelling of a missing one.

    Returns:
        The hint; None if the error has another cause or no name is similar.
    """
    match = _MISSING_ARGUMENT.search(str(error))
    if not match or source is None or span is None:
        return None
    call = source.text[source.offset(span.line, span.column) : source.offset(span.end_line, span.end_column)]
    keyword_names = re.findall(r"\b(\w+)\s*=(?!=)", call)
    for find_missing_name in re.findall(r"'(\w+)'", match.group(1)):
        similar_names = nearest(find_missing_name, (name for name in keyword_names if name != find_missing_name))
        if similar_names:
            return phrase(
                "argument '{missing}' is missing; the call passes {similar}",
                missing=find_missing_name,
                similar=quoted_names(similar_names, " or "),
            )
    return None


def _find_called_objects(frame: FrameType, class_name: str) -> list[Any]:
    """Return the functions and classes in a frame's scope that a failed call may refer to.

    These are the functions with the given name, and the classes with this name or with a base class of this name.
    """
    visible_objects = [*frame.f_globals.values(), *frame.f_locals.values()]
    return [
        visible_object
        for visible_object in visible_objects
        if (inspect.isclass(visible_object) and any(base.__name__ == class_name for base in visible_object.__mro__))
        or (inspect.isfunction(visible_object) and visible_object.__name__ == class_name)
    ]


def _find_parameter_names(callable_object: Any) -> Iterable[str]:
    functions = (
        [vars(base).get("__init__") for base in callable_object.__mro__]
        if inspect.isclass(callable_object)
        else [callable_object]
    )
    for function in functions:
        if inspect.isfunction(function):
            for parameter in inspect.signature(function).parameters.values():
                if parameter.kind in (parameter.KEYWORD_ONLY, parameter.POSITIONAL_OR_KEYWORD):
                    yield parameter.name


def _find_innermost_frame(error: Exception, *, users_only: bool = False) -> FrameType | None:
    frame = None
    for candidate, _ in walk_tb(error.__traceback__):
        if not users_only or is_user_file(candidate.f_code.co_filename):
            frame = candidate
    return frame
