"""Declare scenarios, and load a scenario from its file."""

from __future__ import annotations

import importlib.util
import inspect
import linecache
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Span,
    display_path,
    foreign,
    phrase,
    quoted_names,
)

Value = bool | int | float | str
"""The types of a parameter's values."""

F = TypeVar("F", bound=Callable[..., Mapping[str, object]])

_DECLARATION_ATTRIBUTE = "__linkwright_scenario__"
_MODULE_NAME = "linkwright_scenario"
SEED = "seed"
COLUMNS = ("row", SEED, "error")
"""The names of the columns of every table. Parameters and results cannot have these names."""


@dataclass(frozen=True, slots=True)
class Uniform:
    """A uniform distribution from `low` to `high`.

    The value of a parameter is drawn from it for each seed.
    """

    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Normal:
    """A normal distribution with `mean` and `stddev`.

    The value of a parameter is drawn from it for each seed.
    """

    mean: float
    stddev: float


Values = Sequence[Value] | Uniform | Normal
"""The values of a parameter: a list or a distribution.

One value is drawn from a distribution for each seed.
"""


@dataclass(frozen=True)
class Scenario:
    """A function that is run once for each combination of parameter values and seeds.

    Attributes:
        path: the file of the scenario.
        function: called with the parameters by name, and with ``seed`` if it has such a parameter; returns results by
            name.
        parameters: the values of each parameter.
        seeds: the seeds of the runs.
    """

    path: Path
    function: Callable[..., object]
    parameters: Mapping[str, Values]
    seeds: Sequence[int]

    @property
    def takes_seed(self) -> bool:
        """Whether the function has a parameter for the seed."""
        return SEED in inspect.signature(self.function).parameters


def scenario(*, seeds: int | Sequence[int] = 1, **parameters: Values) -> Callable[[F], F]:
    """Declare the parameters and seeds with which ``linkwright sweep`` runs a function.

    Example::

        @scenario(friction=[0.4, 1.0], mass=Uniform(0.8, 1.2), seeds=20)
        def drive(friction, mass, seed):
            ...
            return {"distance": ..., "arrived": ...}

    This function is run forty times: for each friction with each of 20 seeds. The mass is drawn for each seed.

    Args:
        seeds: the number of seeds, starting at 0, or the seeds themselves.
        parameters: for each parameter of the function a list of values, or a distribution.
    """

    def declare(function: F) -> F:
        setattr(function, _DECLARATION_ATTRIBUTE, (seeds, parameters))
        return function

    return declare


def load_scenario(path: Path) -> Scenario:
    """Load a scenario by running its file as a module.

    The module can import other modules from its folder.

    Raises:
        LinkwrightError: SWEEP101, the file cannot be read; SWEEP102, the file cannot be run; SWEEP103, the file does
            not contain exactly one scenario; SWEEP104, declared and function parameters differ; SWEEP105,
            the values are not valid.
    """
    module = _load_module(path)
    functions = [
        candidate
        for candidate in vars(module).values()
        if callable(candidate) and hasattr(candidate, _DECLARATION_ATTRIBUTE)
    ]
    if len(functions) != 1:
        spans = [_create_span(path, candidate.__code__.co_firstlineno) for candidate in functions]
        message = (
            phrase(
                "'{path}' contains {count} scenarios, but must contain one",
                count=len(functions),
                path=display_path(path),
            )
            if functions
            else phrase("no function in '{path}' is a scenario", path=display_path(path))
        )
        hint = phrase("decorate one function with @scenario(...) of `linkwright.sweep`")
        raise LinkwrightError(Diagnostic("SWEEP103", message, spans[1] if spans else None, hint=hint))
    function = functions[0]
    seeds, parameters = getattr(function, _DECLARATION_ATTRIBUTE)
    span = _create_span(path, function.__code__.co_firstlineno)
    _check_names(function, parameters, span)
    for name, values in parameters.items():
        check_values(name, values, span)
    return Scenario(path, function, parameters, _parse_seeds(seeds, span))


def check_values(name: str, values: object, span: Span | None = None) -> None:
    """Raise if a sweep cannot vary a parameter over some values.

    Raises:
        LinkwrightError: SWEEP105, the values are not valid.
    """
    if isinstance(values, Uniform | Normal):
        numbers = (values.low, values.high) if isinstance(values, Uniform) else (values.mean, values.stddev)
        if all(isinstance(number, int | float) and abs(number) < float("inf") for number in numbers):
            return
        problem: Phrase = phrase("the distribution of parameter '{name}' must have finite numbers", name=name)
    elif isinstance(values, str) or not isinstance(values, Sequence):
        problem = phrase("the values of parameter '{name}' must be a list, a Uniform or a Normal", name=name)
    elif not values:
        problem = phrase("parameter '{name}' has no values", name=name)
    else:
        invalid_values = [value for value in values if not isinstance(value, bool | int | float | str)]
        if not invalid_values:
            return
        type_name = type(invalid_values[0]).__name__
        problem = phrase(
            "a value of parameter '{name}' must be a number, text, True or False, not {kind}", name=name, kind=type_name
        )
    raise LinkwrightError(
        Diagnostic("SWEEP105", problem, span, hint=phrase("write for example {name}=[0.5, 1.0]", name=name))
    )


def _parse_seeds(seeds: object, span: Span) -> Sequence[int]:
    if isinstance(seeds, int) and not isinstance(seeds, bool) and seeds > 0:
        return range(seeds)
    if isinstance(seeds, Sequence) and seeds and all(isinstance(seed, int) and seed >= 0 for seed in seeds):
        return tuple(seeds)
    message = phrase("the seeds must be a positive number of seeds, or a list of integers of at least 0")
    raise LinkwrightError(
        Diagnostic("SWEEP105", message, span, hint=phrase("write for example {name}=100", name="seeds"))
    )


def _check_names(function: Callable[..., object], parameters: Mapping[str, object], span: Span) -> None:
    function_parameters = inspect.signature(function).parameters
    keyword_kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    required = [
        name
        for name, parameter in function_parameters.items()
        if parameter.default is parameter.empty
        and parameter.kind in (*keyword_kinds, inspect.Parameter.POSITIONAL_ONLY)
        and name != SEED
    ]
    takes_all = any(parameter.kind is inspect.Parameter.VAR_KEYWORD for parameter in function_parameters.values())
    unknown = [
        name
        for name in parameters
        if not takes_all and (name not in function_parameters or function_parameters[name].kind not in keyword_kinds)
    ]
    missing = [name for name in required if name not in parameters]
    reserved = [name for name in parameters if name in COLUMNS]
    if reserved:
        message = phrase(
            "a parameter cannot be named {names}: the table already has this column", names=quoted_names(reserved)
        )
        hint = phrase("rename the parameter")
    elif unknown:
        message = phrase(
            "the function '{function}' does not accept {names}", function=function.__name__, names=quoted_names(unknown)
        )
        hint = phrase("give the function a parameter for each parameter of the scenario")
    elif missing:
        message = phrase(
            "the function '{function}' needs {names}, which @scenario does not set",
            function=function.__name__,
            names=quoted_names(missing),
        )
        hint = phrase("write for example {name}=[0.5, 1.0]", name=missing[0])
    else:
        return
    raise LinkwrightError(Diagnostic("SWEEP104", message, span, hint=hint))


def _load_module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(_MODULE_NAME, path)
    if path.suffix != ".py" or spec is None or spec.loader is None or not path.is_file():
        message = phrase("there is no scenario '{path}'", path=display_path(path))
        hint = phrase("pass a Python file, such as drive.py")
        raise LinkwrightError(Diagnostic("SWEEP101", message, hint=hint))
    module = importlib.util.module_from_spec(spec)
    folder = str(path.parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    sys.modules[_MODULE_NAME] = module
    linecache.checkcache(str(path))
    try:
        spec.loader.exec_module(module)
    except SyntaxError as error:
        line, column = error.lineno or 1, error.offset or 1
        span = Span(display_path(Path(error.filename or path)), line, column, line, column)
        message = phrase("the file is not valid Python: {reason}", reason=foreign(error.msg))
        raise LinkwrightError(Diagnostic("SWEEP102", message, span)) from None
    except OSError as error:
        if error.filename != str(path):
            raise _load_error(path, error) from None
        message = phrase("cannot read '{path}': {reason}", path=display_path(path), reason=foreign(error.strerror))
        raise LinkwrightError(Diagnostic("SWEEP101", message)) from None
    except LinkwrightError:
        raise
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a scenario may raise any exception
        raise _load_error(path, error) from None
    return module


def _load_error(path: Path, error: BaseException) -> LinkwrightError:
    line = find_line_in_traceback(path, error)
    message = phrase("the scenario cannot be loaded: {reason}", reason=foreign(describe_error(error)))
    return LinkwrightError(Diagnostic("SWEEP102", message, _create_span(path, line) if line else None))


def find_line_in_traceback(path: Path, error: BaseException) -> int | None:
    """Return the last line of a file in the traceback of an error, or None if there is none."""
    lines = [
        frame_summary.lineno
        for frame_summary in traceback.extract_tb(error.__traceback__)
        if frame_summary.filename == str(path)
    ]
    return lines[-1] if lines else None


def describe_error(error: BaseException) -> str:
    """Return an error as one line of text."""
    if isinstance(error, LinkwrightError):
        diagnostic = error.diagnostics[0]
        return (
            f"{diagnostic.code} {diagnostic.span}: {diagnostic.message}"
            if diagnostic.span
            else f"{diagnostic.code} {diagnostic.message}"
        )
    message = " ".join(str(error).split())
    return f"{type(error).__name__}: {message}" if message else type(error).__name__


def _create_span(path: Path, line: int) -> Span:
    return Span(display_path(path), line, 1, line, 1)
