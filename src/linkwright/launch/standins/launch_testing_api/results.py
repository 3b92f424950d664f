"""The results of tests, and their JUnit XML form for CI servers.

This module replaces ``launch_testing.test_result`` and ``launch_testing.junitxml``.
"""

from __future__ import annotations

import time
import unittest
from collections.abc import Collection, Iterable, Mapping
from typing import Any, Protocol
from xml.etree import ElementTree as ET

Case = unittest.TestCase


class _TestCases(Protocol):
    """The interface of a test run."""

    def all_cases(self) -> Iterable[Case]:
        """Return the tests of a run."""


class TestResult(unittest.TextTestResult):
    """The results of tests that ran, with the duration of each test."""

    __test__ = False  # keeps pytest from collecting the class as a test

    def __init__(self, stream: Any = None, descriptions: Any = None, verbosity: Any = None, **kwargs: Any) -> None:
        super().__init__(stream, descriptions, verbosity, **kwargs)
        self._durations: dict[Any, float] = {}
        self._start_times: dict[Any, float] = {}

    @property
    def testCases(self) -> Collection[Any]:
        """The tests that ran."""
        return list(self._start_times)

    @property
    def testTimes(self) -> dict[Any, float]:
        """The duration of each test in seconds."""
        return {case: self._durations.get(case, 0.0) for case in self._start_times}

    def startTest(self, test: Case) -> None:
        """Record the start of a test."""
        self._start_times[test] = time.monotonic()
        super().startTest(test)

    def stopTest(self, test: Case) -> None:
        """Record the duration of a test."""
        self._durations[test] = time.monotonic() - self._start_times[test]
        super().stopTest(test)

    def append(self, results: TestResult) -> None:
        """Add the results of further tests."""
        self._start_times.update(results._start_times)
        self._durations.update(results._durations)
        self.testsRun += results.testsRun
        for name in ("failures", "errors", "skipped", "expectedFailures", "unexpectedSuccesses"):
            getattr(self, name).extend(getattr(results, name))


class _NotRunResult(unittest.TestResult):
    """The results of tests that did not run."""

    def __init__(self, test_run: _TestCases) -> None:
        super().__init__()
        self.testCases = list(test_run.all_cases())
        self.testsRun = len(self.testCases)

    @property
    def testTimes(self) -> dict[Any, float]:
        """A duration of 0 seconds for each test."""
        return dict.fromkeys(self.testCases, 0)


class FailResult(_NotRunResult):
    """The results of tests whose launch ended before the tests finished: all of them failed.

    Args:
        test_run: the test run.
        message: the reason for the failure.
    """

    def __init__(self, test_run: _TestCases, message: str) -> None:
        super().__init__(test_run)
        for case in self.testCases:
            self.addFailure(case, (Exception, Exception(message), None))  # type: ignore[arg-type]  # no traceback

    def wasSuccessful(self) -> bool:
        """Return False, even if there are no tests."""
        return False


class SkipResult(_NotRunResult):
    """The results of tests whose launch was skipped.

    Args:
        test_run: the test run.
        skip_reason: the reason for the skip.
    """

    def __init__(self, test_run: _TestCases, skip_reason: str = "") -> None:
        super().__init__(test_run)
        for case in self.testCases:
            self.addSkip(case, skip_reason)


def unittestResultsToXml(
    *, name: str = "launch_test", test_results: Mapping[Any, Any] | None = None
) -> ET.ElementTree[ET.Element]:
    """Return an XML document ``testsuites`` with the results of several launches.

    Args:
        name: the name of the document.
        test_results: maps each launch, or its name, to the results of its tests.
    """
    results = test_results or {}
    seconds = sum(sum(result.testTimes.values()) for result in results.values())
    counts = {"tests": 0, "failures": 0, "errors": 0}
    for result in results.values():
        counts["tests"] += result.testsRun
        counts["failures"] += len(result.failures)
        counts["errors"] += len(result.errors)
    root = ET.Element("testsuites", {"name": name, **_format_counts(counts), "time": _format_seconds(seconds)})
    root.extend(unittestResultToXml(str(run), outcome) for run, outcome in results.items())
    return ET.ElementTree(root)


def unittestResultToXml(name: str, test_result: Any) -> ET.Element:
    """Return an XML element ``testsuite`` with the results of a launch."""
    counts = {
        "tests": test_result.testsRun,
        "failures": len(test_result.failures),
        "errors": len(test_result.errors),
        "skipped": len(test_result.skipped),
    }
    seconds = _format_seconds(sum(test_result.testTimes.values()))
    suite = ET.Element("testsuite", {"name": name, **_format_counts(counts), "time": seconds})
    suite.extend(unittestCaseToXml(test_result, case) for case in test_result.testCases)
    return suite


def unittestCaseToXml(test_result: Any, test_case: Any) -> ET.Element:
    """Return an XML element ``testcase`` for a single test."""
    method, _, qualifiers = test_case.id().partition(" ")
    class_name, _, test_name = method.rpartition(".")
    attributes = {
        "classname": class_name,
        "name": f"{test_name} {qualifiers}".strip(),
        "time": _format_seconds(test_result.testTimes[test_case]),
    }
    testcase = ET.Element("testcase", attributes)
    for tag, outcomes in (
        ("failure", test_result.failures),
        ("error", test_result.errors),
        ("skipped", test_result.skipped),
    ):
        testcase.extend(ET.Element(tag, message=str(text)) for case, text in outcomes if case == test_case)
    return testcase


def _format_counts(counts: Mapping[str, int]) -> dict[str, str]:
    return {name: str(count) for name, count in counts.items()}


def _format_seconds(value: float) -> str:
    return str(round(value, 3))
