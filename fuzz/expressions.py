"""Expressions of the xacro language, made from choices: sensible ones, odd ones and hostile ones."""

from __future__ import annotations

from fuzz.choices import Choices

NAMES = ["a", "b", "n", "items", "data", "name", "pi", "e", "x", "undefined", "true", "False", "None", "_", "ns"]
NUMBERS = [
    "1",
    "0",
    "2",
    "-1",
    "0.5",
    "1e3",
    "1e308",
    "007",
    "1_0",
    "0x1F",
    "10**3",
    "1j",
    "9" * 30,
    "1e-7",
    ".5",
    "3.",
]
STRINGS = ["'a'", "''", "'1'", "'%s'", "'%d %.3f'", "'a,b c'", "'x' 'y'", "r'\\d'", "b'a'", "'é'", "'\\x00'", '"q"']
BINARY = ["+", "-", "*", "/", "//", "%", "**", "<<", ">>", "&", "|", "^", "@"]
COMPARISONS = ["==", "!=", "<", "<=", ">", ">=", "is", "is not", "in", "not in"]
FUNCTIONS = [
    *("str", "int", "float", "len", "list", "dict", "map", "bool", "min", "max", "round", "sorted", "range"),
    *("sin", "cos", "sqrt", "radians", "degrees", "factorial", "pow", "floor", "comb", "perm", "prod", "hypot", "fsum"),
    *("python.sum", "python.abs", "python.zip", "python.enumerate", "python.filter", "python.set", "python.tuple"),
    *("python.isinstance", "python.type", "python.vars", "python.ord", "python.repr", "python.slice", "python.hash"),
    *("python.divmod", "python.reversed", "python.frozenset", "python.all", "python.any", "python.complex"),
    *("xacro.arg", "xacro.load_yaml", "xacro.tokenize", "xacro.dotify", "xacro.message", "xacro.warning"),
    *("xacro.abs_filename", "xacro.error", "xacro.fatal", "xacro.print_location", "load_yaml", "math.fmod", "gcd"),
]
METHODS = [
    *("upper", "lower", "split", "strip", "join", "replace", "format", "count", "index", "find", "zfill", "ljust"),
    *("append", "pop", "extend", "insert", "sort", "reverse", "get", "keys", "values", "items", "update", "copy"),
    *("is_integer", "bit_length", "real", "hex", "encode", "decode", "center", "expandtabs", "title", "clear"),
    *(
        "__class__",
        "_x",
        "gi_frame",
        "mro",
        "union",
        "add",
        "partition",
        "splitlines",
        "start",
        "setdefault",
        "popitem",
    ),
]


def expression(choices: Choices, depth: int = 0) -> str:
    """Return an expression, without the brackets of the language."""
    if depth > 5 or choices.left == 0:
        return choices.pick(NAMES)
    make = choices.pick(_FORMS)
    return make(choices, depth + 1)


def _name(choices: Choices, _depth: int) -> str:
    return choices.pick(NAMES)


def _number(choices: Choices, _depth: int) -> str:
    return choices.pick(NUMBERS)


def _string(choices: Choices, _depth: int) -> str:
    return choices.pick(STRINGS)


def _binary(choices: Choices, depth: int) -> str:
    return f"{expression(choices, depth)} {choices.pick(BINARY)} {expression(choices, depth)}"


def _comparison(choices: Choices, depth: int) -> str:
    return f"{expression(choices, depth)} {choices.pick(COMPARISONS)} {expression(choices, depth)}"


def _boolean(choices: Choices, depth: int) -> str:
    return f"{expression(choices, depth)} {choices.pick(['and', 'or', 'and not'])} {expression(choices, depth)}"


def _unary(choices: Choices, depth: int) -> str:
    return f"{choices.pick(['-', '+', '~', 'not '])}{expression(choices, depth)}"


def _bracketed(choices: Choices, depth: int) -> str:
    return f"({expression(choices, depth)})"


def _call(choices: Choices, depth: int) -> str:
    return f"{choices.pick(FUNCTIONS)}({_arguments(choices, depth)})"


def _method(choices: Choices, depth: int) -> str:
    return f"{_operand(choices, depth)}.{choices.pick(METHODS)}({_arguments(choices, depth)})"


def _attribute(choices: Choices, depth: int) -> str:
    return f"{_operand(choices, depth)}.{choices.pick([*METHODS, *NAMES, 'p', 'q'])}"


def _item(choices: Choices, depth: int) -> str:
    key = choices.pick(["0", "-1", "1:", "::-1", ":2", "'a'", "'b'", "...", "0, 1"])
    return f"{_operand(choices, depth)}[{key if choices.chance(2) else expression(choices, depth)}]"


def _list(choices: Choices, depth: int) -> str:
    return f"[{_arguments(choices, depth, plain=True)}]"


def _tuple(choices: Choices, depth: int) -> str:
    return f"({expression(choices, depth)}, {expression(choices, depth)})"


def _comprehension(choices: Choices, depth: int) -> str:
    targets = choices.pick(["x", "x, y", "(x, y)", "[x]", "*x, y", "x.a", "x[0]"])
    condition = f" if {expression(choices, depth)}" if choices.chance(3) else ""
    again = f" for b in {expression(choices, depth)}" if choices.chance(4) else ""
    opening, closing = choices.pick([("[", "]"), ("(", ")")])
    inside = f"{expression(choices, depth)} for {targets} in {expression(choices, depth)}{condition}{again}"
    return f"{opening}{inside}{closing}"


def _lambda(choices: Choices, depth: int) -> str:
    parameters = choices.pick(["x", "", "x, y", "x=1", "*x", "**x", "x, /, y", "*, x=n", "x, *y, b=2, **n"])
    call = f"({_arguments(choices, depth)})" if choices.chance(2) else ""
    return f"(lambda {parameters}: {expression(choices, depth)}){call}"


def _conditional(choices: Choices, depth: int) -> str:
    return f"{expression(choices, depth)} if {expression(choices, depth)} else {expression(choices, depth)}"


def _walrus(choices: Choices, depth: int) -> str:
    return f"({choices.pick(NAMES)} := {expression(choices, depth)})"


def _formatting(choices: Choices, depth: int) -> str:
    pattern = choices.pick(["%s", "%d", "%.3f", "%5s|", "%-10d", "%e", "%x", "%c", "%%", "%(a)s", "%*d", "%r", "%"])
    return f"'{pattern}' % {_operand(choices, depth)}"


def _odd(choices: Choices, _depth: int) -> str:
    return choices.pick(
        ["", "a b", "1 +", "f'a'", "yield", "await a", "*a", "a = 1", "print 1", "\\", "'", "a;b", "#", "..."]
    )


def _operand(choices: Choices, depth: int) -> str:
    return f"({expression(choices, depth)})" if choices.chance(2) else choices.pick(NAMES + STRINGS)


def _arguments(choices: Choices, depth: int, *, plain: bool = False) -> str:
    parts = [expression(choices, depth) for _ in range(choices.number(4))]
    if parts and choices.chance(8):
        parts[-1] = f"*{parts[-1]}"
    if not plain and choices.chance(6):
        parts.append(f"{choices.pick(['key', 'x', 'a', 'reverse', 'default'])}={expression(choices, depth)}")
    return ", ".join(parts)


_FORMS = [
    *(_name, _number, _string, _binary, _binary, _comparison, _boolean, _unary, _bracketed, _call, _call, _method),
    *(_method, _attribute, _item, _list, _tuple, _comprehension, _lambda, _conditional, _walrus, _formatting, _odd),
]
