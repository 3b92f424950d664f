"""``linkwright doctor``: explain what is wrong with the running graph and how to fix it."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.cli import hello
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.numbers import positive_float
from linkwright.cli.session import run_in_graph
from linkwright.diagnostics import Severity, counted, display_path, joined, phrase, print_diagnostics, quoted
from linkwright.diagnostics.formats import FORMATS, format_diagnostics
from linkwright.diagnostics.translation import localized

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.doctor import FixedFrame, Observation


_DEFAULT_DURATION_S = 3.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``doctor``."""
    parser.add_argument(
        "--seconds",
        metavar="SECONDS",
        type=positive_float,
        default=_DEFAULT_DURATION_S,
        help="the time to observe the graph (default: %(default)g)",
    )
    parser.add_argument(
        "--rviz",
        metavar="FILE",
        action="append",
        default=[],
        help="an .rviz file whose Fixed Frame is also checked",
    )
    parser.add_argument("--fixed-frame", metavar="FRAME", action="append", default=[], help="a Fixed Frame to check")
    parser.add_argument(
        "--params-file",
        metavar="FILE",
        action="append",
        default=[],
        help="a parameter file; check that the nodes it names are running",
    )
    parser.add_argument("--format", choices=FORMATS, default="text", help="the output format (default: text)")
    parser.add_argument(
        "-r", "--report", action="store_true", help="also print a report on the computer, network, versions and topics"
    )
    parser.add_argument(
        "--report-failed", "-rf", action="store_true", help="print the report only if there are findings"
    )
    parser.add_argument(
        "--include-warnings",
        "-iw",
        action="store_true",
        help="accepted for compatibility with ros2; warnings are always included",
    )
    parser.add_argument("--exclude-packages", "-ep", action="store_true", help="accepted for compatibility with ros2")
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Observe the graph, print the findings, and return 1 if a finding needs a fix.

    If a subcommand is given, run the subcommand instead.
    """
    if "run_verb" in arguments:
        return run_nested(arguments)
    from linkwright.doctor import examine, examine_parameter_files, make_report, observe
    from linkwright.wire.unsupported_settings import find_new_unsupported_settings

    frames = _parse_fixed_frames(arguments)
    settings = find_new_unsupported_settings()  # reported as findings, not when joining the graph

    async def job(session: Session) -> int:
        if arguments.format == "text":
            print(
                localized(phrase("observing the running graph for {seconds:g} s ...", seconds=arguments.seconds)),
                file=sys.stderr,
            )
        observation = await observe(session.graph, session.node, arguments.seconds, fixed_frames=frames)
        diagnostics = [*settings, *examine(observation), *examine_parameter_files(observation, arguments.params_file)]
        failed = any(diagnostic.severity is not Severity.INFO for diagnostic in diagnostics)
        if arguments.report or (arguments.report_failed and failed):
            print(make_report(observation))
        if arguments.format == "text":
            print_diagnostics(diagnostics, sys.stderr)
            print(_format_summary(observation, len(diagnostics)))
        else:
            sys.stdout.write(format_diagnostics(diagnostics, arguments.format))
        return 1 if failed else 0

    return run_in_graph(arguments, job)


def _parse_fixed_frames(arguments: argparse.Namespace) -> list[FixedFrame]:
    from linkwright.doctor import FixedFrame

    frames = [FixedFrame(name, phrase("the command line")) for name in arguments.fixed_frame]
    if arguments.rviz:
        from linkwright.rviz.config.rviz_config import RvizConfig

        frames += [
            FixedFrame(RvizConfig.load(file).options.text("Fixed Frame"), quoted(display_path(file)))
            for file in arguments.rviz
        ]
    return frames


def _format_summary(observation: Observation, finding_count: int) -> str:
    frames = {name for transform in observation.transforms for name in (transform.parent, transform.child)}
    topics = {
        endpoint.name for endpoint in observation.endpoints if endpoint.kind.value in ("publisher", "subscription")
    }
    counts = joined(
        [
            counted("{count} node", "{count} nodes", len(observation.nodes)),
            counted("{count} topic", "{count} topics", len(topics)),
            counted("{count} frame", "{count} frames", len(frames)),
        ]
    )
    if not finding_count:
        return localized(phrase("No problems found: {counts}", counts=counts))
    findings_text = counted("{count} finding", "{count} findings", finding_count)
    return localized(phrase("{findings}; {counts}", findings=findings_text, counts=counts))


VERBS = {
    "hello": SubVerb(
        hello.configure,
        hello.run,
        help="send greetings to other computers over a topic and by multicast, and count the greetings received",
    ),
}
