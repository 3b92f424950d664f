"""Find the conditions around the commands of a ``CMakeLists.txt``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.cmake_syntax import (
    BLOCK_ENDS,
    MAX_NESTED_BLOCKS,
    Statement,
    find_end_of_block,
    parse_statements,
    split_branches,
)


def find_conditions(source: SourceText) -> dict[int, str]:
    """Return the condition of each argument in a file, by offset.

    Unconditional arguments are absent.
    """
    conditions: dict[int, str] = {}
    for statement, condition in iterate_conditional_commands(source):
        if condition:
            conditions |= {token.start: condition for token in statement.tokens}
    return conditions


def iterate_conditional_commands(source: SourceText) -> Iterator[tuple[Statement, str]]:
    """Yield the commands of a file with their conditions; empty for unconditional commands."""
    yield from _walk_block(list(parse_statements(source)), ())


def _walk_block(
    commands: Sequence[Statement], enclosing_conditions: tuple[str, ...], depth: int = 0
) -> Iterator[tuple[Statement, str]]:
    if depth > MAX_NESTED_BLOCKS:
        return
    index = 0
    while index < len(commands):
        statement = commands[index]
        index += 1
        if statement.name not in BLOCK_ENDS:
            yield statement, " AND ".join(enclosing_conditions)
            continue
        end = find_end_of_block(commands, index, statement.name)
        block = commands[index:end]
        if statement.name != "if":
            yield from _walk_block(block, enclosing_conditions, depth + 1)
        else:
            yield from _walk_branches(statement, block, enclosing_conditions, depth + 1)
        index = end + 1


def _walk_branches(
    if_command: Statement, commands: Sequence[Statement], enclosing_conditions: tuple[str, ...], depth: int
) -> Iterator[tuple[Statement, str]]:
    earlier: list[str] = []
    for condition, branch in split_branches(if_command, commands):
        if condition is None:
            texts = [f"NOT ({text})" if " " in text else f"NOT {text}" for text in earlier[:1]]
        else:
            text = " ".join(f'"{token.text}"' if token.is_quoted else token.text for token in condition.tokens)
            earlier.append(text)
            texts = [text]
        yield from _walk_block(branch, (*enclosing_conditions, *texts), depth)


def is_test_condition(condition: str) -> bool:
    """Return whether something is built or installed only for tests."""
    return re.search(r"(?<!NOT )\b(?:BUILD_TESTING|CATKIN_ENABLE_TESTING)\b", condition) is not None
