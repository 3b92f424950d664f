"""The substitution that evaluates a Python expression."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    TextSubstitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


@expose_substitution("eval")
class PythonExpression(Substitution):
    """The value of a Python expression, as text.

    Args:
        expression: the expression.
        python_modules: modules whose names the expression may use, ``math`` by default (its members also bare).
    """

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType | Iterable[SomeSubstitutionsType] = ("math",),
    ) -> None:
        self._expression = normalize_to_list_of_substitutions(expression)
        self._modules = normalize_to_list_of_substitutions(python_modules)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """The class and its arguments, for an expression and perhaps modules with commas between them.

        Raises:
            TypeError: there are none, or more.
        """
        if len(data) not in (1, 2):
            raise TypeError("eval substitution expects 1 or 2 arguments")
        kwargs: dict[str, Any] = {"expression": data[0]}
        if len(data) == 2:
            if not all(isinstance(part, TextSubstitution) for part in data[1]):
                raise TypeError("the modules of an eval substitution must be plain text")
            names = "".join(part.text for part in data[1]).split(",")
            kwargs["python_modules"] = [TextSubstitution(text=name.strip()) for name in names if name.strip()]
        return cls, kwargs

    @property
    def expression(self) -> list[Substitution]:
        """The expression, as substitutions."""
        return self._expression

    @property
    def python_modules(self) -> list[Substitution]:
        """The modules, as substitutions."""
        return self._modules

    def describe(self) -> str:
        """The expression and the modules."""
        modules = ", ".join(module.describe() for module in self._modules)
        return f"PythonExpr({describe(self._expression)}, [{modules}])"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        The expression runs with all the rights of the launch file it is written in: that is a program anyway.

        Raises:
            Exception: LAUNCH126, with the class and text of what Python raises.
        """
        expression = perform_substitutions(context, self._expression)
        names: dict[str, Any] = {}
        try:
            for module in self._modules:
                name = perform_substitutions(context, [module])
                names[name] = importlib.import_module(name)
            if "math" in names:
                members = vars(names["math"]).items()
                names.update({name: value for name, value in members if not name.startswith("_")})
            return str(eval(expression, {}, names))  # noqa: S307 - launch files are programs by design
        except LinkwrightError:
            raise
        except Exception as error:
            problem = f"{type(error).__name__}: {error}"
            message = f"Python expression '{expression}' cannot be evaluated ({problem})"
            hint = None
            if isinstance(error, NameError):
                hint = "put quotes around the parts that are text: [\"'\", LaunchConfiguration('x'), \"' == 'y'\"]"
            raise error_at(self.place, "LAUNCH126", message, hint, promises=error) from error
